// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/program.hpp"

#include "reading/confine.hpp"
#include "stylet/core/version.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <optional>

namespace stylet::detail {

namespace {

void limit(int resource, std::size_t value) {
  const rlimit both{value, value};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

/// Size of this process's address space [bytes].
std::size_t address_space() {
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

/// Everything on the standard input.
std::string standard_input() {
  std::string all;
  std::array<char, 65536> buffer;
  for (;;) {
    const ssize_t got = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return all;
    all.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

/// Writes the answer and the mark behind it. @return whether all of it went out
bool write_answer(std::string bytes) {
  bytes += kCompleteMark;
  for (std::string_view rest = bytes; !rest.empty();) {
    const ssize_t written = ::write(kAnswerPipe, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

void set_limits(const ReadingRequest& request) {
  std::signal(SIGXFSZ, SIG_IGN);  // writing a file fails instead of killing the process
  limit(RLIMIT_CORE, 0);
  ::prctl(PR_SET_DUMPABLE, 0);  // prevents crash reports, which some systems collect in spite of the limit
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, static_cast<std::size_t>(std::ceil(request.cpu_s)));
  limit(RLIMIT_AS, address_space() + request.bytes);
}

/// The request on the standard input; nothing if it is none of this version's.
std::optional<ReadingRequest> take_request() {
  try {
    const std::string bytes = standard_input();
    ReadingRequest request;
    WireReader wire(bytes);
    wire(request);
    if (request.release == this_release()) return request;
  } catch (const std::exception&) {
    // Another version may have another form of request.
  }
  return std::nullopt;
}

std::string error_bytes(const Error& error) {
  Result<std::string> result(error);
  return to_bytes(result);
}

}  // namespace

int run_reading_program(TaskTable table) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::fcntl(kAnswerPipe, F_GETFD) < 0) {
    std::fputs("stylet-reader reads files for stylet, which starts it by itself; there is nothing to do by hand.\n",
               stderr);
    return 2;
  }
  const std::optional<ReadingRequest> request = take_request();
  if (!request) {
    const Error error =
        failure("stylet-reader",
                fmt::format("this is version {}, the program that asks it to read is another one", this_release()),
                "Install both from one package, or set STYLET_READER to the stylet-reader of the same version");
    return write_answer(error_bytes(error)) ? 0 : 3;
  }
  if (::getppid() != request->parent) return 3;  // it ended before this process could ask to end with it
  set_limits(*request);
  if (const Result<> confined = confine(); !confined) return write_answer(error_bytes(confined.error())) ? 0 : 3;
  answer_here([&table](std::string_view task, std::string_view arguments) { return table.answer(task, arguments); });
  const bool answered = write_answer(table.answer(request->task, request->arguments));
  std::_Exit(answered ? 0 : 3);  // without the libraries' exit handlers: there is nothing to clean up
}

}  // namespace stylet::detail
