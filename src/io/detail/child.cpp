// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>

namespace stylet::detail {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t noise_kept = 8192;
constexpr char complete_mark = '\x17';  // last byte of a complete result; it is missing if the child died while writing

struct Pipe {
  int read = -1, write = -1;
  bool open() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return false;
    read = beyond_standard_streams(ends[0]);
    write = beyond_standard_streams(ends[1]);
    return read >= 0 && write >= 0;
  }
  void close_read() { close(read); }
  void close_write() { close(write); }
  ~Pipe() {
    close_read();
    close_write();
  }

 private:
  /// Moves a pipe end above the numbers of the standard streams: if those are closed, a pipe would get their numbers
  /// and receive everything that is printed.
  static int beyond_standard_streams(int end) {
    if (end > STDERR_FILENO) return end;
    const int moved = ::fcntl(end, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    const int reason = errno;
    ::close(end);
    errno = reason;
    return moved;
  }
  static void close(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
};

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

void write_all(int file, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(file, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ::_exit(3);
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

[[noreturn]] void be_child(const std::function<std::string()>& work, const ChildLimits& limits, int result, int noise) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // Reset the signal handlers of the program (interrupt, crash reports), which must not run in the child.
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXCPU}) {
    std::signal(signal, SIG_DFL);
  }
  std::signal(SIGXFSZ, SIG_IGN);  // writing a file fails instead of killing the process
  const int null = ::open("/dev/null", O_RDONLY);
  ::dup2(null, STDIN_FILENO);
  ::dup2(noise, STDOUT_FILENO);
  ::dup2(noise, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  ::prctl(PR_SET_DUMPABLE, 0);  // prevents crash reports, which some systems collect in spite of the limit
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, static_cast<std::size_t>(std::ceil(limits.cpu_s)));
#ifndef __SANITIZE_ADDRESS__  // the sanitizer reserves terabytes of address space
  limit(RLIMIT_AS, address_space() + limits.memory_bytes);
#endif
  const std::string bytes = work();
  write_all(result, bytes.data(), bytes.size());
  write_all(result, &complete_mark, 1);
  ::_exit(0);  // skips destructors and exit handlers, which belong to the parent
}

/// Reads the available bytes. @return false if the other side has closed
bool take(int file, std::string& into) {
  std::array<char, 65536> buffer;
  const ssize_t got = ::read(file, buffer.data(), buffer.size());
  if (got > 0) into.append(buffer.data(), static_cast<std::size_t>(got));
  return got > 0 || (got < 0 && (errno == EINTR || errno == EAGAIN));
}

/// Collects both streams until the result pipe closes. @return false on timeout
bool collect(int result, int noise, Clock::time_point deadline, ChildOutcome& outcome) {
  std::array<pollfd, 2> files{pollfd{result, POLLIN, 0}, pollfd{noise, POLLIN, 0}};
  while (files[0].fd >= 0) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    if (::poll(files.data(), files.size(), static_cast<int>(std::min<long>(left, 1000))) < 0 && errno != EINTR)
      return false;
    if (files[0].revents != 0 && !take(result, outcome.result)) files[0].fd = -1;
    if (files[1].revents != 0 && !take(noise, outcome.noise)) files[1].fd = -1;
    if (outcome.noise.size() > 2 * noise_kept) outcome.noise.erase(0, outcome.noise.size() - noise_kept);
    files[0].revents = files[1].revents = 0;
  }
  // The child has ended; read its last output from the pipe.
  while (files[1].fd >= 0 && ::poll(&files[1], 1, 0) > 0 && take(noise, outcome.noise)) {
  }
  return true;
}

}  // namespace

ChildOutcome run_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  ChildOutcome outcome;
  Pipe result, noise;
  if (!result.open() || !noise.open()) {
    outcome.code = errno;
    return outcome;
  }
  std::fflush(nullptr);  // otherwise the child would inherit and print the content of the buffers
  const pid_t child = ::fork();
  if (child < 0) {
    outcome.code = errno;
    return outcome;
  }
  if (child == 0) be_child(work, limits, result.write, noise.write);
  result.close_write();
  noise.close_write();
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.wall_s));
  const bool in_time = collect(result.read, noise.read, deadline, outcome);
  if (!in_time) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool complete = !outcome.result.empty() && outcome.result.back() == complete_mark;
  if (!in_time || (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL) && !complete)) {
    outcome.end = ChildEnd::timed_out;  // the hard limit on processor time causes SIGKILL
  } else if (WIFSIGNALED(status)) {
    outcome.end = ChildEnd::signalled;
    outcome.code = WTERMSIG(status);
  } else if (WEXITSTATUS(status) != 0 || !complete) {
    outcome.end = ChildEnd::exited;
    outcome.code = WEXITSTATUS(status);
  } else {
    outcome.end = ChildEnd::finished;
    outcome.result.pop_back();
  }
  return outcome;
}

}  // namespace stylet::detail
