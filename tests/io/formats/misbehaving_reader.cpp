// SPDX-License-Identifier: GPL-3.0-or-later
// A reading program whose parsers crash, hang, and try to do harm (misbehaviour.hpp).
#include "misbehaviour.hpp"
#include "reading/program.hpp"

#include <fcntl.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <stdexcept>
#include <thread>

using namespace stylet;
using namespace stylet::test;

namespace {

Result<bool> end(const std::filesystem::path&, const std::string& how) {
  if (how == "words and a crash") {
    std::fputs("first line\nbad element 17\n", stderr);
    std::raise(SIGSEGV);
  }
  if (how == "abort") std::abort();
  if (how == "status 7") std::_Exit(7);
  if (how == "status 0") std::_Exit(0);
  if (how == "exception") throw std::runtime_error("odd number");
  if (how == "number") throw 17;
  if (how == "error") return failure("a", "b", "c");
  if (how == "loop") {
    for (volatile unsigned n = 0;; n = n + 1) {
    }
  }
  if (how == "sleep") std::this_thread::sleep_for(std::chrono::hours(1));
  if (how == "chatter") {
    for (int i = 0; i < 100000; ++i) std::printf("warning %d\n", i);
    std::fflush(stdout);
  }
  return true;
}

/// The errno of a call that returned this; 0 if it succeeded.
int errno_of(long returned) { return returned < 0 ? errno : 0; }

Result<int> attempt(const std::filesystem::path& path, const std::string& what) {
  const char* const file = path.c_str();
  const std::string other = path.string() + ".other";
  char* const nothing[] = {nullptr};
  const std::map<std::string, std::function<long()>> attempts{
      {"nothing", [] { return 0; }},
      {"read", [&] { return ::open(file, O_RDONLY); }},
      {"socket", [] { return ::socket(AF_INET, SOCK_STREAM, 0); }},
      {"local socket", [] { return ::socket(AF_UNIX, SOCK_DGRAM, 0); }},
      {"write", [&] { return ::open(file, O_WRONLY); }},
      {"read and write", [&] { return ::open(file, O_RDWR); }},
      {"append", [&] { return ::open(file, O_WRONLY | O_APPEND); }},
      {"create", [&] { return ::open(other.c_str(), O_RDONLY | O_CREAT, 0600); }},
      {"truncate by opening", [&] { return ::open(file, O_RDONLY | O_TRUNC); }},
      {"file without a name", [&] { return ::open(path.parent_path().c_str(), O_TMPFILE | O_RDWR, 0600); }},
      {"truncate", [&] { return ::truncate(file, 0); }},
      {"unlink", [&] { return ::unlink(file); }},
      {"rename", [&] { return ::rename(file, other.c_str()); }},
      {"link", [&] { return ::link(file, other.c_str()); }},
      {"symbolic link", [&] { return ::symlink(file, other.c_str()); }},
      {"folder", [&] { return ::mkdir(other.c_str(), 0700); }},
      {"pipe", [&] { return ::mkfifo(other.c_str(), 0600); }},
      {"mode", [&] { return ::chmod(file, 0777); }},
      {"exec", [&] { return ::execve("/bin/true", nothing, nothing); }},
      {"exec of an open file",
       [&] { return ::syscall(SYS_execveat, ::open("/bin/true", O_RDONLY), "", nothing, nothing, AT_EMPTY_PATH); }},
      {"fork", [] { return ::fork(); }},
      {"clone", [] { return ::syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr); }},
      {"ptrace", [] { return ::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr); }},
      {"ptrace of the parent", [] { return ::ptrace(PTRACE_SEIZE, ::getppid(), nullptr, nullptr); }},
      {"signal to the parent", [] { return ::kill(::getppid(), SIGCONT); }},
      {"signal to a thread of the parent", [] { return ::syscall(SYS_tgkill, ::getppid(), ::getppid(), SIGCONT); }},
      {"memory of the parent", [] { return ::syscall(SYS_process_vm_readv, ::getppid(), nullptr, 0, nullptr, 0, 0); }},
      {"ring of requests", [] { return ::syscall(SYS_io_uring_setup, 1, nullptr); }},
      {"new rights", [] { return ::setuid(0); }},
      {"limits", [] { return ::syscall(SYS_prlimit64, ::getppid(), 0, nullptr, nullptr); }}};
  return errno_of(attempts.at(what)());
}

}  // namespace

int main() {
  detail::TaskTable table;
  table.add(kEchoContours, [](const auto&, const ContourSet& set) -> Result<ContourSet> { return set; });
  table.add(kEchoImage, [](const auto&, const LabelImage& image) -> Result<LabelImage> { return image; });
  table.add(kManyNodes, [](const auto&, int millions) -> Result<TetMesh> {
    TetMesh mesh;
    mesh.nodes.assign(static_cast<std::size_t>(millions) * 1000000U, Vec3(1, 2, 3));
    return mesh;
  });
  table.add(kEnd, end);
  table.add(kAttempt, attempt);
  table.add(kReadsItself, [](const auto& path) -> Result<bool> {
    const Result<int> inner = detail::ask(kAttempt, path, "nothing");
    return inner ? Result<bool>(*inner == 0) : Result<bool>(inner.error());
  });
  return detail::run_reading_program(table);
}
