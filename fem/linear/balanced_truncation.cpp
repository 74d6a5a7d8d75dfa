// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/balanced_truncation.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/algebra/orientation.hpp"

#include <algorithm>
#include <stdexcept>

namespace dielast::fem {

namespace {

constexpr double least_decay = 1e-6; ///< over the slowest rate
constexpr double round_off =
    1e-10; ///< of singular values, over the largest; of growth, over the fastest rate

/// R with R R^T = X, A X + X A^T + F F^T = 0: by columns in the Schur form A = U T U^H (Bartels & Stewart
/// 1972).
Eigen::MatrixXd gramian_root(const ComplexSchur& schur, const Eigen::MatrixXd& F) {
  const auto& [T, U] = schur;
  // Products of plain complex matrices all: every other pair of factors takes the compiler seconds.
  const Eigen::MatrixXcd U_H = U.adjoint(), G = U_H * F.cast<std::complex<double>>(), G_H = G.adjoint();
  Eigen::MatrixXcd Y = -(G * G_H);
  for (Eigen::Index j = T.rows() - 1; j >= 0; --j) {
    for (Eigen::Index k = j + 1; k < T.rows(); ++k) Y.col(j) -= std::conj(T(j, k)) * Y.col(k);
    Eigen::MatrixXcd shifted = T;
    shifted.diagonal().array() += std::conj(T(j, j));
    Y.col(j) = shifted.triangularView<Eigen::Upper>().solve(Y.col(j)).eval();
  }
  const Eigen::MatrixXd X = (U * Y * U_H).real();
  const SymmetricEigen eigen = symmetric_eigen((X + X.transpose()) / 2);
  return eigen.vectors * eigen.values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

} // namespace

StateSpace balanced_truncation(const StateSpace& model, int order) {
  if (model.order() == 0) return model;
  const Eigen::VectorXcd poles = eigenvalues(model.A);
  const double slowest = poles.cwiseAbs().minCoeff(), fastest = poles.cwiseAbs().maxCoeff();
  if (!(slowest > 0) || poles.real().maxCoeff() > round_off * fastest)
    throw std::domain_error("the linear model is not stable");
  Eigen::MatrixXcd A = model.A.cast<std::complex<double>>();
  A.diagonal().array() -= least_decay * slowest;
  const Eigen::MatrixXd reached = gramian_root(complex_schur(A), model.B);
  const Eigen::VectorXd sizes = (model.C * reached).rowwise().norm();
  const Eigen::MatrixXd C = (sizes.array() > 0).select(sizes, 1).cwiseInverse().asDiagonal() * model.C;
  const Eigen::MatrixXd seen = gramian_root(complex_schur(A.transpose()), C.transpose());
  const SingularValues svd = singular_values(seen.transpose() * reached);
  Eigen::VectorXd sigma = svd.values;
  const Eigen::Index told = (sigma.array() > round_off * sigma[0]).count();
  const auto scale = sigma.head(told).cwiseSqrt().cwiseInverse().asDiagonal();
  // States are oriented, before some are left out, by how they are seen, and by how their rates are. What
  // leads to and from them turns along.
  const Eigen::Index n = model.order(), outputs = C.rows();
  Eigen::MatrixXd states(2 * (n + outputs), told);
  states << reached * svd.V.leftCols(told) * scale, seen * svd.U.leftCols(told) * scale,
      Eigen::MatrixXd::Zero(2 * outputs, told);
  states.middleRows(2 * n, outputs) = C * states.topRows(n);
  states.bottomRows(outputs) = C * model.A * states.topRows(n) / fastest;
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(states.rows());
  weight.tail(2 * outputs).setOnes();
  sigma.conservativeResize(told);
  orient(states, sigma, round_off * sigma[0], weight);
  const Eigen::Index kept = std::min<Eigen::Index>(order, told);
  const Eigen::MatrixXd right = states.topLeftCorner(n, kept), left = states.block(n, 0, n, kept);
  return {left.transpose() * model.A * right, left.transpose() * model.B, model.C * right, model.D};
}

} // namespace dielast::fem
