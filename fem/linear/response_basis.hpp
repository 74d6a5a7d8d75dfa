// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/linear/linearisation.hpp"

#include <optional>

namespace dielast::fem {

/// X(s) of Z(s) X = B with the Z(s) of a linearisation, for many s. Where Z(s) was factored, the real and
/// imaginary parts of X span a basis V; at another s Galerkin's X = V (V^T Z V)^-1 V^T B is taken where its
/// residual is negligible, and Z(s) is factored where it is not: rational interpolation (Grimme 1997) at
/// points that the residual chooses.
class ResponseBasis {
 public:
  using Complex = Linearisation::Complex;

  /// B has a row per free equation. `at` must outlive this.
  ResponseBasis(const Linearisation& at, Eigen::MatrixXd B);

  /// X(s); nothing where Z(s) is singular to working precision.
  std::optional<Eigen::MatrixXcd> solve(Complex s);
  /// Of Z(s) that were made.
  int factorisations() const { return factorisations_; }

 private:
  std::optional<Eigen::MatrixXcd> interpolated(Complex s) const;
  void add(const Eigen::MatrixXcd& X);

  const Linearisation& at_;
  Eigen::MatrixXd B_;            ///< columns that are not zero
  std::vector<Eigen::Index> of_; ///< their numbers
  Eigen::Index columns_;
  Eigen::VectorXd scale_; ///< per equation, roots of K's diagonal
  ComplexSolver solver_;
  Eigen::MatrixXd scaled_, V_;          ///< scale V, which is orthonormal, and V
  Eigen::Index widest_;                 ///< columns of V
  std::vector<Eigen::MatrixXd> TV_, P_; ///< per term T of Z: T V and V^T T V
  int factorisations_ = 0;
};

} // namespace dielast::fem
