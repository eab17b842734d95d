// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/confine.hpp"

#include <fcntl.h>
#include <linux/landlock.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <string>

namespace stylet::detail {

namespace {

/// Refuses to write, make, remove, move and execute any file. Without an error where the kernel does not have it: the
/// filter of system calls refuses the same.
void refuse_changes_of_files() {
  const long version = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return;
  constexpr std::uint64_t kMoving = 1ULL << 13, kTruncating = 1ULL << 14;  // versions 2 and 3
  landlock_ruleset_attr refused{};
  refused.handled_access_fs = LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_WRITE_FILE |
                              LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                              LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                              LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO |
                              LANDLOCK_ACCESS_FS_MAKE_BLOCK | LANDLOCK_ACCESS_FS_MAKE_SYM |
                              (version >= 2 ? kMoving : 0) | (version >= 3 ? kTruncating : 0);
  const auto ruleset = static_cast<int>(::syscall(SYS_landlock_create_ruleset, &refused, sizeof refused, 0));
  if (ruleset < 0) return;
  ::syscall(SYS_landlock_restrict_self, ruleset, 0);
  ::close(ruleset);
}

/// The system calls that a parser and the libraries below it make. Opening files and signals have conditions of their
/// own.
constexpr std::array kAllowed{
    // files that are open, and what a path leads to
    "read", "readv", "pread64", "write", "writev", "close", "lseek", "fstat", "fstat64", "stat", "lstat", "newfstatat",
    "fstatat64", "statx", "statfs", "fstatfs", "access", "faccessat", "faccessat2", "readlink", "readlinkat", "getcwd",
    "getdents64", "fcntl", "fcntl64", "dup", "poll", "ppoll", "flock", "fadvise64",
    // memory
    "brk", "mmap", "mmap2", "munmap", "mremap", "mprotect", "madvise",
    // this process, its signals and its end
    "futex", "rt_sigaction", "rt_sigprocmask", "rt_sigreturn", "sigaltstack", "restart_syscall", "exit", "exit_group",
    "getpid", "gettid", "getuid", "geteuid", "getgid", "getegid", "getrusage", "getrlimit", "sched_yield",
    "sched_getaffinity", "set_robust_list", "rseq", "umask",
    // clocks, chance and the machine
    "clock_gettime", "clock_gettime64", "clock_getres", "clock_nanosleep", "nanosleep", "gettimeofday", "time", "times",
    "getrandom", "sysinfo", "uname"};

/// Loads the filter. @return 0 or a negative error number
int filter_calls() {
  const std::unique_ptr<void, decltype(&seccomp_release)> filter(seccomp_init(SCMP_ACT_ERRNO(ENOSYS)), seccomp_release);
  if (!filter) return -ENOMEM;
  for (const char* name : kAllowed) {
    const int call = seccomp_syscall_resolve_name(name);
    if (call == __NR_SCMP_ERROR) continue;  // no call of this kind of processor
    if (const int wrong = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 0)) return wrong;
  }
  constexpr scmp_datum_t kTemporary = 020000000;  // of O_TMPFILE, without O_DIRECTORY
  constexpr scmp_datum_t kWriting = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND | kTemporary;
  for (const auto& [name, at] : {std::pair("open", 1U), std::pair("openat", 2U)}) {
    const int call = seccomp_syscall_resolve_name(name);
    const scmp_arg_cmp reading{at, SCMP_CMP_MASKED_EQ, kWriting, O_RDONLY};
    if (const int wrong = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 1, reading)) return wrong;
  }
  // abort() and raise() send signals; only to this process.
  const scmp_arg_cmp itself{0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(::getpid()), 0};
  const int signal = seccomp_syscall_resolve_name("tgkill");
  if (const int wrong = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, signal, 1, itself)) return wrong;
  return seccomp_load(filter.get());
}

}  // namespace

Result<> confine() {
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  refuse_changes_of_files();
  if (const int wrong = filter_calls(); wrong != 0) {
    return failure("this system",
                   "the program that reads files cannot give up its rights (seccomp, error " + std::to_string(-wrong) +
                       "), and reads no file of unknown origin with them",
                   "Use a Linux kernel with filters of system calls (CONFIG_SECCOMP_FILTER)");
  }
  return Ok{};
}

}  // namespace stylet::detail
