// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/ask.hpp"

#include "detail/file_kind.hpp"
#include "detail/input_file.hpp"
#include "detail/text.hpp"
#include "reading/find_program.hpp"
#include "stylet/core/version.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

namespace stylet::detail {

namespace fs = std::filesystem;

namespace {

constexpr double kBase_s = 5.0;
constexpr double kPacked_s = 2.0;     // time limit per megabyte of the file
constexpr double kUnpacked_s = 0.03;  // time limit per megabyte of unpacked data
constexpr double kMostUnpacked_s = 100.0;
constexpr double kDeflate = 1000.0;  // largest ratio of unpacked to packed size, whatever a forged file claims
constexpr double kEntry_s = 0.002;   // time limit per entry of a folder
constexpr int kMostEntries = 50000;

/// Size of a file together with the data file that it names, packed and unpacked [MB].
struct Megabytes {
  double packed = 0, unpacked = 0;
};

double size_of(const fs::path& path) {
  std::error_code code;
  const std::uintmax_t size = fs::is_regular_file(path, code) ? fs::file_size(path, code) : 0;
  return code ? 0.0 : static_cast<double>(size) / 1e6;
}

/// Unpacked size [MB] according to the last four bytes of a gzip stream, little endian. It is wrong only in forged
/// files and beyond 4 GB.
double gzip_size_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<unsigned char, 4> end{};
  if (!file.seekg(-4, std::ios::end) || !file.read(reinterpret_cast<char*>(end.data()), 4)) return 0;
  double size = 0;
  for (int n = 3; n >= 0; --n) size = 256 * size + end[n];
  return size / 1e6;
}

bool is_gzip(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 2> head{};
  return file.read(head.data(), 2) && head[0] == '\x1f' && head[1] == '\x8b';
}

/// Description of an image's data from its header.
struct ImageData {
  fs::path file;         ///< the file with the data
  bool gzip = false;     ///< NRRD
  double megabytes = 0;  ///< unpacked size of a compressed MetaImage, from its dimensions
};

/// The data of an NRRD or MetaImage file. Data files that the reader would not open are ignored.
ImageData data_of_image(const fs::path& path, FileKind kind) {
  constexpr std::size_t kMostHeader = 1 << 20;  // [bytes] largest part of the header that is read
  ImageData data{.file = path};
  std::string name;
  bool compressed = false;
  double voxels = 1, voxel_bytes = 8;
  std::ifstream file(path, std::ios::binary);
  for (std::size_t seen = 0; seen < kMostHeader;) {
    const auto line = next_header_line(file);
    if (!line || !line->whole || (kind == FileKind::nrrd && line->text.empty())) break;
    seen += line->text.size() + 1;
    const auto separator = line->text.find_first_of(kind == FileKind::nrrd ? ":" : "=:");
    if (separator == std::string::npos) continue;
    const std::string key = lower(trimmed(line->text.substr(0, separator)));
    const std::string value = trimmed(line->text.substr(separator + 1));
    if (key == "data file" || key == "datafile" || key == "elementdatafile") name = value;
    if (key == "elementdatafile") break;
    if (key == "encoding") data.gzip = lower(value) == "gzip" || lower(value) == "gz";
    if (key == "compresseddata") compressed = lower(value) == "true";
    if (key == "elementtype") {
      const bool one = value.ends_with("CHAR"), two = value.ends_with("SHORT");
      voxel_bytes = one ? 1 : two ? 2 : value == "MET_INT" || value == "MET_UINT" || value == "MET_FLOAT" ? 4 : 8;
    }
    if (key == "dimsize") {
      for (const auto part : split(value, ' ')) voxels *= std::max(to_number(part).value_or(1.0), 1.0);
    }
  }
  if (compressed) data.megabytes = voxels * voxel_bytes / 1e6;
  if (!name.empty() && lower(name) != "local") {
    if (const Result<fs::path> beside = data_file_of(path, name)) data.file = *beside;
  }
  return data;
}

Megabytes megabytes_of(const fs::path& path) {
  Megabytes size;
  size.packed = size.unpacked = size_of(path);
  if (is_gzip(path)) {
    size.unpacked = gzip_size_of(path);
  } else if (const Result<FileKind> kind = identify(path);
             kind && (*kind == FileKind::nrrd || *kind == FileKind::metaimage)) {
    const ImageData data = data_of_image(path, *kind);
    if (data.file != path) size.packed += size_of(data.file);
    size.unpacked = std::max(size.packed, data.gzip ? gzip_size_of(data.file) : data.megabytes);
  }
  size.unpacked = std::clamp(size.unpacked, size.packed, kDeflate * size.packed);
  return size;
}

int entries_of(const fs::path& folder) {
  std::error_code code;
  int entries = 0;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    if (++entries == kMostEntries) break;
  }
  return entries;
}

/// The error for a parser that ended without an answer.
Error died(const fs::path& path, const ChildOutcome& outcome, const ChildLimits& limits, const char* cure) {
  switch (outcome.end) {
    case ChildEnd::not_started:
      return failure(path.string(),
                     fmt::format("no process could be started to read it ({})", std::strerror(outcome.code)),
                     "Close other programs and try again");
    case ChildEnd::timed_out:
      return input_error(path.string(), fmt::format("the parser did not finish within {:.0f} s", limits.cpu_s), cure);
    case ChildEnd::overdue:  // says nothing about the file: a parser that hangs takes processor time
      return failure(path.string(), fmt::format("reading it was not done after {:.0f} s", limits.wall_s),
                     "Try again when this machine and its disk are less busy");
    case ChildEnd::signalled:
      return input_error(path.string(), fmt::format("the parser stopped (signal {})", outcome.code), cure);
    case ChildEnd::exited:
    case ChildEnd::finished:
      break;
  }
  return input_error(path.string(), fmt::format("the parser gave up (exit status {})", outcome.code), cure);
}

/// The answers inside of the reading program; empty outside of it.
std::function<std::string(std::string_view, std::string_view)>& here() {
  static std::function<std::string(std::string_view, std::string_view)> answer;
  return answer;
}

}  // namespace

std::string this_release() {
  const std::string whole = version();
  return whole.substr(0, whole.find('+'));
}

ChildLimits limits_for(const fs::path& path) {
  std::error_code code;
  const bool regular = fs::is_regular_file(path, code);
  const Megabytes size = regular ? megabytes_of(path) : Megabytes{};
  ChildLimits limits;
  limits.cpu_s = kBase_s + kPacked_s * size.packed + std::min(kUnpacked_s * size.unpacked, kMostUnpacked_s);
  if (fs::is_directory(path, code)) limits.cpu_s += kEntry_s * entries_of(path);
  limits.wall_s = 30.0 + 3.0 * limits.cpu_s;  // generous, since the machine may be busy
  limits.memory_bytes += static_cast<std::size_t>(40e6 * size.packed);
  return limits;
}

Error threw(const fs::path& path, const char* cure) { return input_error(path.string(), "the parser gave up", cure); }

Error out_of_memory(const fs::path& path) {
  return input_error(
      path.string(), "reading it needs more memory than a file of its size should",
      "Export the file again if a size in its header is wrong, or crop it if it is too large for this machine");
}

void answer_here(std::function<std::string(std::string_view, std::string_view)> answer) { here() = std::move(answer); }

Result<std::string> answer_bytes(std::string_view task, const fs::path& path, std::string arguments, const char* cure) {
  if (here()) return here()(task, arguments);
  const Result<fs::path> program = find_reading_program();
  if (!program) return program.error();
  const ChildLimits limits = limits_for(path);
  ReadingRequest request{.release = this_release(),
                         .parent = ::getpid(),
                         .cpu_s = limits.cpu_s,
                         .bytes = limits.memory_bytes,
                         .task = std::string(task),
                         .arguments = std::move(arguments)};
  WireWriter wire;
  wire(request);
  ChildOutcome outcome = run_program(*program, wire.bytes, limits);
  if (outcome.end != ChildEnd::finished) return died(path, outcome, limits, cure);
  return std::move(outcome.result);
}

}  // namespace stylet::detail
