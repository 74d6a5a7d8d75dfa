// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/machine/blas_kernels.hpp"

#include <cstdlib>
#include <string_view>

extern "C" char* openblas_get_corename() __attribute__((weak));

namespace dielast::fem {

const char* better_blas_kernels() {
#ifdef __x86_64__
  if (std::getenv(blas_kernels_variable) || !openblas_get_corename) return nullptr;
  if (std::string_view(openblas_get_corename()) != "Prescott") return nullptr;
  const bool of_256_bits = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool of_512_bits = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
                           __builtin_cpu_supports("avx512vl");
  if (of_256_bits) return of_512_bits ? "SkylakeX" : "Haswell";
#endif
  return nullptr;
}

} // namespace dielast::fem
