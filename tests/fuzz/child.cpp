// SPDX-License-Identifier: GPL-3.0-or-later
#include "child.hpp"

#include "library_faults.hpp"

#include <fcntl.h>
#include <sanitizer/common_interface_defs.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

// The counters of clang: how often each edge of the program was taken. The linker names both ends of this array.
extern "C" {
[[gnu::visibility("hidden")]] extern unsigned char begin_of_counters[] __asm__("__start___sancov_cntrs");
[[gnu::visibility("hidden")]] extern unsigned char end_of_counters[] __asm__("__stop___sancov_cntrs");
}

namespace stylet::fuzz {

namespace {

constexpr int kKnownFault = 99, kReported = 98;  // exit status of a child
constexpr std::size_t kLargestInput = 8U << 20;  // [bytes]; libFuzzer makes none beyond 1 MB of itself
constexpr std::size_t kLongestPlace = 256;       // [bytes] of the name of a library and an address, with its end
constexpr long kMostMemory_kB = 1 << 20;         // of a child, beyond which the next input has a new one

bool this_is_child = false;
int faults_left = 0;
pid_t child = 0;  ///< 0: there is none
int to_child = -1, from_child = -1;
int reports = -1;                 ///< where the sanitizer's reports go, which libFuzzer closes for all others
unsigned char* shared = nullptr;  ///< input, the place of a new fault, and the counters

unsigned char* place_of_fault() { return shared + kLargestInput; }
unsigned char* shared_counters() { return place_of_fault() + kLongestPlace; }
std::size_t counters() { return static_cast<std::size_t>(end_of_counters - begin_of_counters); }

bool transfer(ssize_t (*call)(int, void*, std::size_t), int pipe, void* data, std::size_t size) {
  ssize_t done = -1;
  do done = call(pipe, data, size);
  while (done < 0 && errno == EINTR);
  return done == static_cast<ssize_t>(size);
}

bool receive(int pipe, std::size_t& word) { return transfer(::read, pipe, &word, sizeof word); }

bool send(int pipe, std::size_t word) {
  const auto write = [](int to, void* data, std::size_t size) { return ::write(to, data, size); };
  return transfer(write, pipe, &word, sizeof word);
}

long memory_kB() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return used.ru_maxrss;
}

/// Reads inputs until the fuzzer ends. What the fuzzer would do at the end of a process is not for a child.
[[noreturn]] void serve(int inputs, int answers, void (*read)(std::string_view)) {
  this_is_child = true;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  __sanitizer_set_death_callback(at_end_of_child);
  __sanitizer_set_report_fd(reinterpret_cast<void*>(static_cast<std::intptr_t>(reports)));
  std::size_t size = 0;
  while (receive(inputs, size)) {
    std::fill(begin_of_counters, end_of_counters, 0);
    read({reinterpret_cast<const char*>(shared), size});
    std::memcpy(shared_counters(), begin_of_counters, counters());
    if (!send(answers, memory_kB() > kMostMemory_kB ? 1 : 0)) break;
  }
  std::_Exit(0);
}

void end_child() {
  ::close(to_child);
  ::close(from_child);
  child = 0;
}

void start_child(void (*read)(std::string_view)) {
  if (shared == nullptr) {
    ::signal(SIGPIPE, SIG_IGN);
    const std::size_t size = kLargestInput + kLongestPlace + counters();
    void* const memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) std::exit(2);
    shared = static_cast<unsigned char*>(memory);
  }
  std::array<int, 2> inputs{}, answers{};
  if (::pipe(inputs.data()) != 0 || ::pipe(answers.data()) != 0) std::exit(2);
  child = ::fork();
  if (child < 0) std::exit(2);
  if (child == 0) {
    ::close(inputs[1]);
    ::close(answers[0]);
    serve(inputs[0], answers[1], read);
  }
  ::close(inputs[0]);
  ::close(answers[1]);
  to_child = inputs[1];
  from_child = answers[0];
}

/// The fault of the child that has ended is known from now on. @return whether the child said where it is
bool keep_as_known(std::string_view input) {
  const std::string place = reinterpret_cast<const char*>(place_of_fault());
  if (place.empty()) return false;
  add_known_place(place);
  const std::string name = "fault-" + place;
  const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0 || ::write(file, input.data(), input.size()) != static_cast<ssize_t>(input.size())) std::exit(2);
  ::close(file);
  ::dprintf(reports, "%s\n", name.c_str());
  return true;
}

}  // namespace

bool is_child() { return this_is_child; }

void keep_stderr_for_children() { reports = ::dup(STDERR_FILENO); }

void run_in_child(std::string_view input, int faults, void (*read)(std::string_view input)) {
  faults_left = faults;
  if (child == 0) start_child(read);
  input = input.substr(0, kLargestInput);
  std::copy(input.begin(), input.end(), shared);
  *place_of_fault() = 0;
  std::size_t tired = 0;
  const bool answered = send(to_child, input.size()) && receive(from_child, tired);
  int status = 0;
  if (answered) {
    std::memcpy(begin_of_counters, shared_counters(), counters());
    if (tired == 0) return;
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
  } else {
    ::waitpid(child, &status, 0);
    if ((!WIFEXITED(status) || WEXITSTATUS(status) != kKnownFault) && !keep_as_known(input)) {
      if (!WIFEXITED(status) || WEXITSTATUS(status) != kReported)
        ::dprintf(reports, "==%d== ERROR: the child ended with the status 0x%x\n", child, status);
      std::abort();
    }
  }
  end_child();
}

void note_place(std::string_view place) {
  if (!this_is_child || place.size() >= kLongestPlace) return;
  std::copy(place.begin(), place.end(), place_of_fault());
  place_of_fault()[place.size()] = 0;
}

void end_child_at_last_fault() {
  if (faults_left-- == 0) end_child_at_known_fault();
}

void end_child_at_known_fault() {
  if (this_is_child) std::_Exit(kKnownFault);
}

void end_child_after_report() {
  if (this_is_child) std::_Exit(kReported);
}

void end_child_by_itself() {
  if (!this_is_child) return;
  ::dprintf(reports, "==%d== ERROR: a reader ended itself\n", ::getpid());
  __sanitizer_print_stack_trace();
  std::_Exit(kReported);
}

}  // namespace stylet::fuzz
