// SPDX-License-Identifier: GPL-3.0-or-later
#include "library_faults.hpp"

#include "child.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <sanitizer/asan_interface.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

namespace stylet::fuzz {

sigjmp_buf after_known_fault;

namespace {

constexpr std::array kSignals{SIGSEGV, SIGBUS, SIGFPE, SIGABRT};
std::array<struct sigaction, 65> before{};  ///< what the sanitizer and libFuzzer do at each signal
std::string known_places;                   ///< with a blank before and behind each
bool is_signal = false;                     ///< a signal is reported, after which the sanitizer ends the program

bool is_known(std::string_view place) { return known_places.find(" " + std::string(place) + " ") != std::string::npos; }

std::string_view name_of(std::string_view path) { return path.substr(path.rfind('/') + 1); }

/// Libraries of the language, which only do what they are told to.
bool is_of_language(std::string_view library) {
  return library.starts_with("libc.") || library.starts_with("libstdc++.") || library.starts_with("libm.") ||
         library.starts_with("libgcc_s.") || library.starts_with("ld-linux");
}

using Place = std::array<char, 256>;

Place place_of(const Dl_info& library, std::uintptr_t offset) {
  Place place{};
  const std::string_view name = name_of(library.dli_fname);
  std::snprintf(place.data(), place.size(), "%.*s+0x%lx", static_cast<int>(name.size()), name.data(), offset);
  return place;
}

std::uintptr_t offset_in(const Dl_info& library, const void* address) {
  return reinterpret_cast<std::uintptr_t>(address) - reinterpret_cast<std::uintptr_t>(library.dli_fbase);
}

/// Whether a place in code, or that before it, is a known one. The second for places to which a call returns.
bool is_known_place(const Dl_info& library, const void* address) {
  const std::uintptr_t offset = offset_in(library, address);
  return is_known(place_of(library, offset).data()) || is_known(place_of(library, offset - 1).data());
}

/// Calls `look` with the innermost place on the stack that is not of the language, if that is in a library. Functions
/// of the language that the sanitizer replaces stand in this program, which names them and none of its own to others.
/// @return what `look` returns, or false
template <typename Look>
bool look_at_library(const void* fault, const Look& look) {
  std::array<void*, 64> stack{};
  const int depth = ::backtrace(stack.data(), static_cast<int>(stack.size()));
  void* const* const end = stack.data() + depth;
  Dl_info program{};
  if (::dladdr(reinterpret_cast<const void*>(&is_of_language), &program) == 0) return false;
  bool is_own = false;
  // Frames of the handler come first. The signal's own frame has the address of the fault.
  void* const* at = fault != nullptr ? std::find<void* const*>(stack.data(), end, fault) : stack.data();
  for (; at != end; ++at) {
    Dl_info library{};
    if (::dladdr(*at, &library) == 0 || library.dli_fname == nullptr) return false;
    if (is_of_language(name_of(library.dli_fname))) continue;
    if (library.dli_fbase != program.dli_fbase) return !is_own && look(library, *at);
    is_own = library.dli_sname == nullptr;
  }
  return false;
}

bool is_known_stack(const void* fault) { return look_at_library(fault, is_known_place); }

/// Tells the fuzzer the place of a fault of a child that is not known.
void note_stack(const void* fault) {
  look_at_library(fault, [](const Dl_info& library, const void* address) {
    note_place(place_of(library, offset_in(library, address)).data());
    return true;
  });
}

/// Whether the stack is full. Which function finds it so is chance: that which calls itself without end stands further
/// out, at a place that is known.
bool is_overflow(int signal, const siginfo_t& info, const mcontext_t& machine) {
  constexpr std::uintptr_t kNear = 1U << 16;
  const auto address = reinterpret_cast<std::uintptr_t>(info.si_addr);
  const auto top = static_cast<std::uintptr_t>(machine.gregs[REG_RSP]);
  return signal == SIGSEGV && address + kNear > top && address < top + kNear;
}

bool is_known_place_on_stack() {
  std::array<void*, 64> stack{};
  const int depth = ::backtrace(stack.data(), static_cast<int>(stack.size()));
  return std::any_of(stack.data(), stack.data() + depth, [](void* at) {
    Dl_info library{};
    return ::dladdr(at, &library) != 0 && library.dli_fname != nullptr && is_known_place(library, at);
  });
}

/// Adds a byte to a file that scripts/fuzz measures.
void count_one() {
  const int file = ::open("known", O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0 || ::write(file, "!", 1) != 1) return;
  ::close(file);
}

void at_signal(int signal, siginfo_t* info, void* context) {
  const mcontext_t& machine = static_cast<ucontext_t*>(context)->uc_mcontext;
  if (is_known_stack(reinterpret_cast<void*>(machine.gregs[REG_RIP])) ||
      (is_overflow(signal, *info, machine) && is_known_place_on_stack())) {
    count_one();
    end_child_at_last_fault();
    siglongjmp(after_known_fault, 1);
  }
  is_signal = true;
  if (!is_overflow(signal, *info, machine)) note_stack(reinterpret_cast<void*>(machine.gregs[REG_RIP]));
  if (signal == SIGABRT) end_child_by_itself();
  const struct sigaction& theirs = before[static_cast<std::size_t>(signal)];
  ::sigaction(signal, &theirs, nullptr);
  theirs.sa_sigaction(signal, info, context);
}

/// The place in a line of a stack, "#1 0x7f00 in name (/lib/libvtkIOPLY-9.1.so.1+0x100c4) (BuildId: …)".
std::string_view place_in(std::string_view line) {
  const auto start = line.find(" (/"), end = line.find(')', start);
  return start == std::string_view::npos ? std::string_view{} : name_of(line.substr(start + 2, end - start - 2));
}

/// A fault that the sanitizer finds in its own version of a function of the language is that of the caller. A write has
/// happened when the execution goes on, so it ends the fuzzer even if it is known, unless a child is at work.
void at_report(const char* report) {
  if (is_signal) return;
  const std::string_view text(report);
  const auto caller = text.find("#1 ");
  const bool is_write = text.find("WRITE of size") != std::string_view::npos;
  const auto end = std::min(text.find('\n', caller), text.size());
  if (caller != std::string_view::npos && is_known(place_in(text.substr(caller, end - caller)))) {
    if (!is_write || is_child()) count_one();
    if (!is_write) return;
    end_child_at_known_fault();
  }
  note_stack(nullptr);
  end_child_after_report();
  ::sigaction(SIGABRT, &before[SIGABRT], nullptr);
  std::abort();
}

}  // namespace

void add_known_place(std::string_view place) { known_places += std::string(place) + " "; }

void at_end_of_child() {
  if (is_signal) return;
  if (!is_known_stack(nullptr)) return note_stack(nullptr);
  count_one();
  end_child_at_known_fault();
}

void pass_over_known_faults() {
  const char* const places = std::getenv("STYLET_FUZZ_KNOWN");
  known_places = " " + std::string(places != nullptr ? places : "") + " ";
  std::array<void*, 1> first{};
  ::backtrace(first.data(), 1);  // loads what it needs, which a handler should not
  for (const int signal : kSignals) {
    struct sigaction own {};
    own.sa_sigaction = at_signal;
    own.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
    ::sigaction(signal, &own, &before[static_cast<std::size_t>(signal)]);
  }
  __asan_set_error_report_callback(at_report);
}

}  // namespace stylet::fuzz
