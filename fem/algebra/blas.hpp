// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Of BLAS and LAPACK what a supernodal factorisation needs, in both precisions. Matrices by columns; `stride`
// is the distance of columns.

extern "C" {
void spotrf_(const char* uplo, const int* n, float* A, const int* stride, int* info);
void dpotrf_(const char* uplo, const int* n, double* A, const int* stride, int* info);
void strsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m,
            const int* n, const float* alpha, const float* A, const int* stride, float* B, const int* of_B);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m,
            const int* n, const double* alpha, const double* A, const int* stride, double* B,
            const int* of_B);
void ssyrk_(const char* uplo, const char* trans, const int* n, const int* k, const float* alpha,
            const float* A, const int* stride, const float* beta, float* C, const int* of_C);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
            const double* A, const int* stride, const double* beta, double* C, const int* of_C);
}

namespace dielast::fem::blas {

/// Calls the routine of the precision of Real.
template<class Real, class Single, class Double>
auto of(Single single, Double twice) {
  if constexpr (sizeof(Real) == sizeof(float))
    return single;
  else
    return twice;
}

/// A = L L^T, L in the lower triangle; false where A is not positive definite.
template<class Real>
bool cholesky(int n, Real* A, int stride) {
  int info = 0;
  of<Real>(spotrf_, dpotrf_)("L", &n, A, &stride, &info);
  return info == 0;
}

/// B <- B L^-T, B of m rows and n columns.
template<class Real>
void divide_by_transposed(int m, int n, const Real* L, int stride, Real* B) {
  const Real one = 1;
  of<Real>(strsm_, dtrsm_)("R", "L", "T", "N", &m, &n, &one, L, &stride, B, &stride);
}

/// Lower triangle of C = -A A^T, A of n rows and k columns.
template<class Real>
void minus_square(int n, int k, const Real* A, int stride, Real* C, int stride_C) {
  const Real minus = -1, zero = 0;
  of<Real>(ssyrk_, dsyrk_)("L", "N", &n, &k, &minus, A, &stride, &zero, C, &stride_C);
}

} // namespace dielast::fem::blas
