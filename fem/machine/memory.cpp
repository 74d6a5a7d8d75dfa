// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/machine/memory.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <stdexcept>

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

} // namespace dielast::fem
