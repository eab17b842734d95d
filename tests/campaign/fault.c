/* SPDX-License-Identifier: GPL-3.0-or-later
   Preloaded before a program, makes its FAULT_NTH call of the kind FAULT_CALL fail with FAULT_ERRNO, and all later ones
   too with FAULT_EVER=1. Calls are counted from main() on; FAULT_LOG names a file that gets their number at the end. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

enum Call { NONE, WRITE, OPEN, RENAME, SYNC, FORK, MMAP, MALLOC };
static const char* const kNames[] = {"none", "write", "open", "rename", "sync", "fork", "mmap", "malloc"};

static enum Call failing = NONE;
static long nth, seen;
static int error, is_for_ever, is_counting;

static int fails(enum Call call) {
  if (call != failing || !is_counting) return 0;
  const long number = __sync_add_and_fetch(&seen, 1);
  if (nth == 0 || number < nth || (number > nth && !is_for_ever)) return 0;
  errno = error;
  return 1;
}

static void log_count(void) {
  const char* path = getenv("FAULT_LOG");
  char text[32];
  if (path == NULL) return;
  const long file = syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (file < 0) return;
  const int length = snprintf(text, sizeof text, "%ld\n", seen);
  syscall(SYS_write, file, text, length);
  syscall(SYS_close, file);
}

typedef int Main(int, char**, char**);
static Main* true_main;

static int counted_main(int count, char** words, char** environment) {
  const char* call = getenv("FAULT_CALL");
  const char* number = getenv("FAULT_NTH");
  const char* code = getenv("FAULT_ERRNO");
  for (int k = 0; call != NULL && k <= MALLOC; ++k)
    if (strcmp(call, kNames[k]) == 0) failing = (enum Call)k;
  nth = number != NULL ? atol(number) : 0;
  error = code != NULL ? atoi(code) : ENOMEM;
  is_for_ever = getenv("FAULT_EVER") != NULL;
  atexit(log_count);
  is_counting = 1;
  return true_main(count, words, environment);
}

int __libc_start_main(Main* main, int count, char** words, void (*begin)(void), void (*end)(void), void (*last)(void),
                      void* stack) {
  int (*const real)(Main*, int, char**, void (*)(void), void (*)(void), void (*)(void), void*) =
      dlsym(RTLD_NEXT, "__libc_start_main");
  true_main = main;
  return real(counted_main, count, words, begin, end, last, stack);
}

/* Defines a function that fails in its turn and is the real one otherwise. Standard error never fails, since errors are
   said there. */
#define WRAPPED(is_failing, failure, type, name, parameters, arguments) \
  type name parameters {                                                \
    static type(*real) parameters;                                      \
    if (real == NULL) real = dlsym(RTLD_NEXT, #name);                   \
    if (is_failing) return failure;                                     \
    return real arguments;                                              \
  }

WRAPPED(file != STDERR_FILENO && fails(WRITE), -1, ssize_t, write, (int file, const void* data, size_t size),
        (file, data, size))
WRAPPED(fails(WRITE), -1, ssize_t, pwrite, (int file, const void* data, size_t size, off_t at), (file, data, size, at))
WRAPPED(fails(WRITE), -1, ssize_t, pwrite64, (int file, const void* data, size_t size, off64_t at),
        (file, data, size, at))
WRAPPED(file != STDERR_FILENO && fails(WRITE), -1, ssize_t, writev, (int file, const struct iovec* parts, int count),
        (file, parts, count))
WRAPPED(file != stderr && fails(WRITE), 0, size_t, fwrite, (const void* data, size_t size, size_t count, FILE* file),
        (data, size, count, file))
WRAPPED(fails(WRITE), -1, int, ftruncate, (int file, off_t size), (file, size))
WRAPPED(fails(WRITE), -1, int, ftruncate64, (int file, off64_t size), (file, size))
WRAPPED(fails(OPEN), NULL, FILE*, fopen, (const char* path, const char* mode), (path, mode))
WRAPPED(fails(OPEN), NULL, FILE*, fopen64, (const char* path, const char* mode), (path, mode))
WRAPPED(fails(RENAME), -1, int, rename, (const char* from, const char* to), (from, to))
WRAPPED(fails(RENAME), -1, int, renameat2, (int a, const char* from, int b, const char* to, unsigned flags),
        (a, from, b, to, flags))
WRAPPED(fails(SYNC), -1, int, fsync, (int file), (file))
WRAPPED(fails(SYNC), -1, int, fdatasync, (int file), (file))
WRAPPED(fails(FORK), -1, pid_t, fork, (void), ())
WRAPPED(fails(FORK), -1, pid_t, vfork, (void), ())
WRAPPED(fails(FORK), error, int, posix_spawn,
        (pid_t * pid, const char* path, const posix_spawn_file_actions_t* actions, const posix_spawnattr_t* attributes,
         char* const words[], char* const environment[]),
        (pid, path, actions, attributes, words, environment))
WRAPPED(fails(MMAP), MAP_FAILED, void*, mmap, (void* at, size_t size, int rights, int flags, int file, off_t from),
        (at, size, rights, flags, file, from))
WRAPPED(fails(MMAP), MAP_FAILED, void*, mmap64, (void* at, size_t size, int rights, int flags, int file, off64_t from),
        (at, size, rights, flags, file, from))

/* The mode is there only where a file may be created. */
#define OPENED(name, parameters, arguments)                           \
  int name parameters {                                               \
    static int(*real) parameters;                                     \
    if (real == NULL) real = dlsym(RTLD_NEXT, #name);                 \
    va_list more;                                                     \
    va_start(more, flags);                                            \
    const mode_t mode = (flags & O_CREAT) ? va_arg(more, mode_t) : 0; \
    va_end(more);                                                     \
    if (fails(OPEN)) return -1;                                       \
    return real arguments;                                            \
  }

OPENED(open, (const char* path, int flags, ...), (path, flags, mode))
OPENED(open64, (const char* path, int flags, ...), (path, flags, mode))
OPENED(openat, (int folder, const char* path, int flags, ...), (folder, path, flags, mode))
OPENED(openat64, (int folder, const char* path, int flags, ...), (folder, path, flags, mode))

/* Looking for the real functions allocates, so these call the C library's own. */
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
void* malloc(size_t size) { return fails(MALLOC) ? NULL : __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return fails(MALLOC) ? NULL : __libc_calloc(count, size); }
void* realloc(void* old, size_t size) { return fails(MALLOC) ? NULL : __libc_realloc(old, size); }
void* aligned_alloc(size_t alignment, size_t size) { return fails(MALLOC) ? NULL : __libc_memalign(alignment, size); }
int posix_memalign(void** to, size_t alignment, size_t size) {
  if (fails(MALLOC)) return ENOMEM;
  *to = __libc_memalign(alignment, size);
  return *to == NULL ? ENOMEM : 0;
}
