// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace dielast::fem {

/// The variable of the environment by which OpenBLAS is told, while it is loaded, whose kernels to take.
inline constexpr const char* blas_kernels_variable = "OPENBLAS_CORETYPE";

/// What that variable should say. OpenBLAS takes its oldest kernels ("Prescott") on processors that are
/// younger than itself: dense products then take two to four times as long. Null where its kernels serve, the
/// variable is set, or the BLAS is another one.
const char* better_blas_kernels();

} // namespace dielast::fem
