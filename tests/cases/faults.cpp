// SPDX-License-Identifier: GPL-3.0-or-later
// Loaded before the C library (LD_PRELOAD) into the program under test. Every call that changes a file is
// counted, in all processes of a study together. Number DIELAST_KILL_AT is not made: the program is killed
// there. Once DIELAST_DISK bytes were written the disk is full. With either, three seconds pass between any
// two looks at the clock, but none while a checkpoint is written: so there is one at every state, however
// long the next is put off for the time that this one takes.

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include <atomic>
#include <csignal>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

struct Shared { // by parents and children
  std::atomic<long> calls = 0, seconds = 0, bytes = 0;
  std::atomic<bool> stands = false; ///< the clock, at the next look
};

struct Faults {
  long kill_at = number("DIELAST_KILL_AT", -1), disk = number("DIELAST_DISK", -1);
  pid_t program = getpid(); ///< its children die with it
  Shared* shared =
      new (mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) Shared;

  static long number(const char* name, long otherwise) {
    const char* text = getenv(name);
    return text != nullptr ? atol(text) : otherwise;
  }
};

Faults& faults() {
  static Faults all;
  return all;
}

/// Made before main() forks; programs that it starts have no faults.
[[maybe_unused]] const int at_start = (faults(), unsetenv("LD_PRELOAD"));

void count() {
  Faults& f = faults();
  if (++f.shared->calls != f.kill_at) return;
  kill(f.program, SIGKILL);
  kill(getpid(), SIGKILL);
}

template<class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool is_file(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
}

} // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  static const auto real = next<int (*)(const char*, int, ...)>("open");
  if ((flags & O_CREAT) != 0) count();
  return real(path, flags, mode);
}

ssize_t write(int descriptor, const void* bytes, size_t size) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (descriptor > 2 && is_file(descriptor)) {
    count();
    if (const long disk = faults().disk; disk >= 0) {
      const long room = disk - faults().shared->bytes.fetch_add(static_cast<long>(size));
      if (room <= 0) {
        errno = ENOSPC;
        return -1;
      }
      if (room < static_cast<long>(size)) return real(descriptor, bytes, static_cast<size_t>(room));
    }
  }
  return real(descriptor, bytes, size);
}

int rename(const char* from, const char* to) {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  count();
  if (std::strstr(to, "checkpoint") != nullptr) faults().shared->stands = true;
  return real(from, to);
}

int unlink(const char* path) {
  static const auto real = next<int (*)(const char*)>("unlink");
  count();
  return real(path);
}

int remove(const char* path) {
  static const auto real = next<int (*)(const char*)>("remove");
  count();
  return real(path);
}

int mkdir(const char* path, mode_t mode) {
  static const auto real = next<int (*)(const char*, mode_t)>("mkdir");
  count();
  return real(path, mode);
}

int ftruncate(int descriptor, off_t size) {
  static const auto real = next<int (*)(int, off_t)>("ftruncate");
  count();
  return real(descriptor, size);
}

int clock_gettime(clockid_t clock, timespec* time) {
  static const auto real = next<int (*)(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, time);
  Shared& shared = *faults().shared;
  if (clock == CLOCK_MONOTONIC) time->tv_sec += 3 * (shared.seconds += shared.stands.exchange(false) ? 0 : 1);
  return result;
}
}
