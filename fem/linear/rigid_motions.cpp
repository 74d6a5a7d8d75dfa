// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/rigid_motions.hpp"

#include "fem/algebra/dense_algebra.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dielast::fem {
namespace {

constexpr double spanned = 1e-10; ///< part of a vector that is round-off
constexpr double none = 1e-11;    ///< resistance, over that of single unknowns

/// Translation along an axis (0..2) or a turn about one (3..5), per free equation.
Eigen::VectorXd rigid_motion(const Model& model, const State& state, int component) {
  const DofMap& dofs = model.dofs;
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(component % 3);
  const bool turns = component >= 3;
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(dofs.free_count());
  for (int node = 0; node < dofs.node_count(); ++node) {
    const auto n = static_cast<std::size_t>(node);
    const Eigen::Vector3d u = turns ? axis.cross(model.drawn[n] + state.displacement[n]) : axis;
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(node, c); dofs.is_free(e)) motion[e] = u[c];
    if (!turns) continue;
    const Eigen::Vector3d spin = dofs.turn_axes(state, node).transpose() * axis;
    const std::array<int, 3> equations = dofs.turns(node);
    for (std::size_t c = 0; c < 3; ++c)
      if (const int e = equations[c]; dofs.is_free(e)) motion[e] = spin[static_cast<Eigen::Index>(c)];
  }
  return motion;
}

/// Most that forces which do not balance, as in a state that has nearly come to rest, resist turns with, by
/// turning along or not: |f| |x| for a turn, and so for each of the motions X, 1/s^2.
double stiffness_of_imbalance(Equilibrium& equilibrium, State state, const Eigen::MatrixXd& X) {
  Balance balance;
  equilibrium.balance(state, balance);
  const Eigen::VectorXd force = balance.force.head(X.rows()).cwiseAbs();
  double most = 0;
  for (const auto& motion : X.colwise())
    most = std::max(most, motion.cwiseAbs().maxCoeff() * force.dot(motion.cwiseAbs()));
  return 2 * most / equilibrium.model().extent;
}

} // namespace

Eigen::MatrixXd projected(const SparseSymmetric& pattern, const std::vector<double>& values,
                          const Eigen::MatrixXd& V) {
  const Eigen::Map<const Eigen::SparseMatrix<double>> lower(
      pattern.size, pattern.size, static_cast<Eigen::Index>(values.size()), pattern.column_start.data(),
      pattern.rows.data(), values.data());
  return V.transpose() * (lower.selfadjointView<Eigen::Lower>() * V);
}

Eigen::MatrixXd orthonormal_to(const Eigen::MatrixXd& V, const Eigen::SparseMatrix<double>& M,
                               Eigen::MatrixXd X) {
  const auto norm = [&](Eigen::Index i) { return std::sqrt(X.col(i).dot(M * X.col(i))); };
  Eigen::Index kept = 0;
  for (Eigen::Index i = 0; i < X.cols(); ++i) {
    const double whole = norm(i);
    for (int twice = 0; twice < 2; ++twice) { // once loses digits
      const Eigen::VectorXd momentum = M * X.col(i);
      X.col(i) -= V * (V.transpose() * momentum);
      X.col(i) -= X.leftCols(kept) * (X.leftCols(kept).transpose() * momentum);
    }
    const double left = norm(i);
    if (!(left > spanned * whole)) continue;
    X.col(kept) = X.col(i) / left;
    ++kept;
  }
  return X.leftCols(kept);
}

void RigidMotions::take_off(Eigen::MatrixXd& X) const {
  const Eigen::MatrixXd shares = momenta.transpose() * X;
  X -= motions * shares;
}

FreeMass free_mass(const Equilibrium& equilibrium, const State& state) {
  const Model& model = equilibrium.model();
  const Eigen::SparseMatrix<double> all = model.dofs.jacobian(state);
  FreeMass mass{all.transpose() * model.inertia().mass * all};
  mass.fastest = equilibrium.stiffness().sum() / mass.M.diagonal().sum();
  return mass;
}

RigidMotions rigid_motions(Equilibrium& equilibrium, const State& state, const FreeMass& mass, bool damped) {
  const Eigen::SparseMatrix<double>& M = mass.M;
  Eigen::MatrixXd candidates(M.rows(), DofMap::components);
  for (int c = 0; c < DofMap::components; ++c)
    candidates.col(c) = rigid_motion(equilibrium.model(), state, c);
  const Eigen::MatrixXd X = orthonormal_to(Eigen::MatrixXd(M.rows(), 0), M, std::move(candidates));
  const double unseen = none * mass.fastest + stiffness_of_imbalance(equilibrium, state, X);
  Assembler& assembler = equilibrium.assembler();
  assembler.tangent(state);
  const SparseSymmetric& K = assembler.matrix();
  Eigen::MatrixXd resistance = projected(K, K.values, X) / unseen;
  if (const auto damping = assembler.damping(state); damped && !damping.empty())
    resistance += projected(K, damping, X) / (none * std::sqrt(mass.fastest));
  const SymmetricEigen resisted = symmetric_eigen(resistance); // ascending
  const Eigen::Index below = (resisted.values.array() < -1).count();
  const Eigen::Index free = (resisted.values.array() <= 1).count() - below;
  const Eigen::MatrixXd motions = X * resisted.vectors.middleCols(below, free);
  return {motions, M * motions};
}

} // namespace dielast::fem
