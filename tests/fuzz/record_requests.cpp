// SPDX-License-Identifier: GPL-3.0-or-later
// Named by STYLET_READER in the place of the reading program, this one keeps the file of each request as a seed for the
// fuzzer, and has the reading program that STYLET_FUZZ_READER names answer. Seeds are put into
// STYLET_FUZZ_SEEDS/TARGET/, each under the hash of its content.
#include "reading/ask.hpp"
#include "targets.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>

using namespace stylet;
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLargest = 150000;       // [bytes] larger files make a fuzzer slow
constexpr std::size_t kLargestHdf5 = 8000000;  // [bytes] larger ones cannot be shrunk (shrink_hdf5.py) in short time

void keep(const detail::ReadingRequest& request) {
  std::string path, arguments = request.arguments;
  detail::WireReader wire(request.arguments);
  wire(path);
  arguments.erase(0, sizeof(std::size_t) + path.size());
  const fs::path folder = fs::path(std::getenv("STYLET_FUZZ_SEEDS")) / fuzz::target_of(request.task, arguments);
  for (const std::string& input : fuzz::inputs_of(request.task, path, arguments)) {
    const std::size_t most = input.starts_with("\x89HDF") ? kLargestHdf5 : kLargest;
    if (input.empty() || input.size() > most) continue;
    fs::create_directories(folder);
    std::ofstream(folder / std::to_string(std::hash<std::string>()(input)), std::ios::binary) << input;
  }
}

}  // namespace

int main() {
  const std::string bytes{std::istreambuf_iterator<char>(std::cin), {}};
  ::lseek(STDIN_FILENO, 0, SEEK_SET);  // the request is a file in memory
  try {
    detail::ReadingRequest request;
    detail::WireReader wire(bytes);
    wire(request);
    keep(request);
  } catch (const std::exception&) {
    // A test asks for what cannot be read.
  }
  const char* const reader = std::getenv("STYLET_FUZZ_READER");
  ::execl(reader, reader, nullptr);
  return 3;
}
