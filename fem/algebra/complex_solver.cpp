// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/complex_solver.hpp"

#include "fem/algebra/mumps.hpp"

#include <zmumps_c.h>

namespace dielast::fem {

struct ComplexSolver::Factorisation : Mumps<ZMUMPS_STRUC_C, zmumps_c> {
  explicit Factorisation(const SparseSymmetric& matrix) : Mumps(matrix, false) {}
};

ComplexSolver::ComplexSolver(const SparseSymmetric& matrix)
    : factorisation_(matrix.size > 0 ? std::make_unique<Factorisation>(matrix) : nullptr) {}
ComplexSolver::~ComplexSolver() = default;

bool ComplexSolver::factor(std::vector<std::complex<double>>& values) {
  return !factorisation_ || factorisation_->factor(reinterpret_cast<ZMUMPS_COMPLEX*>(values.data()));
}

Eigen::MatrixXcd ComplexSolver::solve(Eigen::MatrixXcd B) {
  if (factorisation_ && B.cols() > 0)
    factorisation_->solve(reinterpret_cast<ZMUMPS_COMPLEX*>(B.data()), static_cast<int>(B.cols()));
  return B;
}

} // namespace dielast::fem
