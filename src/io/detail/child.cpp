// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <vector>

namespace stylet::detail {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t noise_kept = 8192;

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
  write_all(result, &kCompleteMark, 1);
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

/// Waits for a child and what it answers. @param result, noise this side's ends of its pipes
ChildOutcome outcome_of(pid_t child, int result, int noise, const ChildLimits& limits) {
  ChildOutcome outcome;
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.wall_s));
  const bool in_time = collect(result, noise, deadline, outcome);
  if (!in_time) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool complete = !outcome.result.empty() && outcome.result.back() == kCompleteMark;
  if (!in_time) {
    outcome.end = ChildEnd::overdue;
  } else if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL) && !complete) {
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

ChildOutcome not_started(int reason) { return {.code = reason}; }

/// A file in memory with these bytes, to be read from its beginning; −1 if there is none to be had.
int file_with(std::string_view bytes) {
  const int file = ::memfd_create("request", MFD_CLOEXEC);
  if (file < 0) return -1;
  for (std::string_view rest = bytes; !rest.empty();) {
    const ssize_t written = ::write(file, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      ::close(file);
      return -1;
    }
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  ::lseek(file, 0, SEEK_SET);
  return file;
}

/// The environment of this process, in which no library starts threads.
std::vector<std::string> environment_of_program() {
  std::vector<std::string> all{"OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1", "VTK_SMP_BACKEND_IN_USE=Sequential"};
  const auto is_set = [one_thread = all](std::string_view variable) {
    return std::ranges::any_of(one_thread, [&](const std::string& set) {
      return variable.starts_with(std::string_view(set).substr(0, set.find('=') + 1));
    });
  };
  for (char** variable = environ; *variable != nullptr; ++variable) {
    if (!is_set(*variable)) all.emplace_back(*variable);
  }
  return all;
}

/// Starts a program with its three standard streams and the pipe for its answer, no other file and no signal handled or
/// blocked. @return 0 or an error number
int spawn(const std::filesystem::path& program, int input, int noise, int answer, pid_t& child) {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  if (const int wrong = posix_spawn_file_actions_init(&files)) return wrong;
  if (const int wrong = posix_spawnattr_init(&attributes)) {
    posix_spawn_file_actions_destroy(&files);
    return wrong;
  }
  posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, noise, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, noise, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&files, answer, kAnswerPipe);
  posix_spawn_file_actions_addclosefrom_np(&files, kAnswerPipe + 1);
  sigset_t all, none;
  sigfillset(&all);
  sigemptyset(&none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  std::vector<std::string> environment = environment_of_program();
  std::vector<char*> variables;
  for (std::string& variable : environment) variables.push_back(variable.data());
  variables.push_back(nullptr);
  std::string name = program.string();
  std::array<char*, 2> arguments{name.data(), nullptr};
  const int wrong = posix_spawn(&child, name.c_str(), &files, &attributes, arguments.data(), variables.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return wrong;
}

}  // namespace

ChildOutcome run_in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  Pipe result, noise;
  if (!result.open() || !noise.open()) return not_started(errno);
  std::fflush(nullptr);  // otherwise the child would inherit and print the content of the buffers
  const pid_t child = ::fork();
  if (child < 0) return not_started(errno);
  if (child == 0) be_child(work, limits, result.write, noise.write);
  result.close_write();
  noise.close_write();
  return outcome_of(child, result.read, noise.read, limits);
}

ChildOutcome run_program(const std::filesystem::path& program, std::string_view input, const ChildLimits& limits) {
  Pipe result, noise;
  if (!result.open() || !noise.open()) return not_started(errno);
  const int request = file_with(input);
  if (request < 0) return not_started(errno);
  pid_t child = 0;
  const int wrong = spawn(program, request, noise.write, result.write, child);
  ::close(request);
  if (wrong != 0) return not_started(wrong);
  result.close_write();
  noise.close_write();
  return outcome_of(child, result.read, noise.read, limits);
}

}  // namespace stylet::detail
