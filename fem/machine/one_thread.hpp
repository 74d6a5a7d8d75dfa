// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Of the OpenMP runtime of GCC, which CHOLMOD was compiled for; the one of another compiler would be a second
// in the process.
extern "C" int omp_get_max_active_levels();
extern "C" void omp_set_max_active_levels(int);
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace dielast::fem {

/// CHOLMOD opens as many OpenMP threads as it was compiled for, whatever the machine has, around loops that
/// are too short for them: switched off while it works. A BLAS that threads by itself would make results
/// depend on the number of threads, so it gets one.
class OneThread {
 public:
  OneThread() : levels_(omp_get_max_active_levels()) {
    omp_set_max_active_levels(0);
    if (openblas_set_num_threads) openblas_set_num_threads(1);
  }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_;
};

} // namespace dielast::fem
