// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/machine/memory.hpp"

#include "fem/machine/one_thread.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <stdexcept>

extern "C" void dpotrf_(const char* uplo, const int* n, double* A, const int* stride, int* info);

namespace dielast::fem {

namespace {

/// The number behind a word in a file of words and numbers; `missing` where there is none.
double number_of(const char* file, const std::string& word, double missing) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(word)) return std::stod(line.substr(word.size()));
  return missing;
}

/// What is left of the memory that a container gets; pages of files can be had back.
double of_container() {
  std::ifstream limit("/sys/fs/cgroup/memory.max");
  double most = 0, used = 0;
  if (!(limit >> most)) return std::numeric_limits<double>::infinity(); // none, or "max"
  std::ifstream("/sys/fs/cgroup/memory.current") >> used;
  return most - used + number_of("/sys/fs/cgroup/memory.stat", "file ", 0);
}

} // namespace

double available_memory() {
  constexpr double kilobyte = 1024;
  const double of_machine =
      kilobyte * number_of("/proc/meminfo", "MemAvailable:", std::numeric_limits<double>::infinity());
  return std::min(of_machine, of_container());
}

void require_memory(double bytes, const std::string& what, double available) {
  if (bytes <= available) return;
  constexpr double gigabyte = 1e9;
  char text[200];
  std::snprintf(text, sizeof text, " takes %.1f GB of memory, and %.1f GB are free: use a coarser mesh",
                bytes / gigabyte, available / gigabyte);
  throw std::runtime_error(what + text);
}

void require_blas_buffer() {
  // Asked for beforehand, and taken at once by the smallest factorisation: then the buffer is there for good.
  [[maybe_unused]] static const bool taken = [] {
    if (!openblas_set_num_threads) return true;
    constexpr std::size_t buffer = (128 << 20) + (1 << 16);
    void* const memory = mmap(nullptr, buffer, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED)
      throw std::runtime_error(
          "the limit of memory is too low for OpenBLAS, which needs 128 MB: see ulimit -v");
    munmap(memory, buffer);
    double number = 1;
    const int one = 1;
    int info = 0;
    dpotrf_("L", &one, &number, &one, &info);
    return info == 0;
  }();
}

void keep_pages() {
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY) return;
  constexpr std::size_t heap = 512 << 20, page = 2 << 20;
  void* const all = std::malloc(heap); // of the end of the heap, to which it returns untouched
  if (!all) return;
  const auto begin = reinterpret_cast<std::uintptr_t>(all);
  const std::uintptr_t first = (begin + page - 1) / page * page, end = (begin + heap) / page * page;
  madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
  std::free(all);
}

} // namespace dielast::fem
