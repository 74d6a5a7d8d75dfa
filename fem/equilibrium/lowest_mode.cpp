// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/lowest_mode.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/algebra/orientation.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr int subspace = 4, most_iterations = 200;
constexpr double eigen_tolerance = 1e-6;  ///< of the mode; that of the eigenvalue is its square
constexpr double same_eigenvalue = 1e-13; ///< relative
constexpr double free_motion = 1e13;      ///< inverse of an eigenvalue that is of rounding
constexpr double singular_shift = 1e-9;   ///< of the stiffness as drawn, where the tangent cannot be factored

} // namespace

void normalise(const DofMap& dofs, const State& state, Eigen::VectorXd& direction) {
  double largest = 0;
  for (const Eigen::Vector3d& u : displacements(dofs, state, direction))
    largest = std::max(largest, u.norm());
  if (largest > 0) direction /= largest;
}

bool moves_freely(Equilibrium& equilibrium, const State& state) {
  const Eigen::VectorXd root = equilibrium.stiffness().cwiseSqrt();
  if (root.size() == 0) return false;
  if (!equilibrium.factor(state)) return true;
  Eigen::VectorXd x = random_vectors(root.size(), 1), y;
  double growth = 0;
  for (int solve = 0; solve < 2; ++solve) { // the first one brings out the weakest mode
    x.normalize();
    equilibrium.tangent().solve(root.cwiseProduct(x), y);
    x = root.cwiseProduct(y);
    growth = x.norm();
  }
  return !(growth < free_motion);
}

std::vector<Eigen::Vector3d> displacements(const DofMap& dofs, const State& state,
                                           const Eigen::VectorXd& direction) {
  const Eigen::VectorXd all = dofs.jacobian(state) * direction;
  std::vector<Eigen::Vector3d> result(static_cast<std::size_t>(dofs.node_count()), Eigen::Vector3d::Zero());
  for (int n = 0; n < dofs.node_count(); ++n)
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(n, c); e != DofMap::absent)
        result[static_cast<std::size_t>(n)][c] = all[e];
  return result;
}

std::vector<Eigen::Vector3d> spins(const DofMap& dofs, const State& state, const Eigen::VectorXd& direction) {
  const Eigen::VectorXd all = dofs.jacobian(state) * direction;
  std::vector<Eigen::Vector3d> result;
  for (int n = 0; n < dofs.node_count(); ++n) result.push_back(dofs.spin(state, n, all));
  return result;
}

std::optional<Mode> lowest_mode(Equilibrium& equilibrium, const State& state) {
  if (equilibrium.model().dofs.free_count() == 0) return std::nullopt;
  const Eigen::VectorXd& D = equilibrium.stiffness();
  double shift = 0;
  if (!equilibrium.factor(state)) {
    shift = singular_shift;
    const Eigen::VectorXd added = shift * D;
    if (!equilibrium.factor(state, nullptr, &added)) return std::nullopt;
  }
  // Subspace iteration with the inverse: a few vectors, so that close modes do not slow it down.
  const Eigen::Index width = std::min<Eigen::Index>(subspace, D.size());
  Eigen::MatrixXd X = D.cwiseSqrt().cwiseInverse().asDiagonal() * random_vectors(D.size(), width);
  Eigen::MatrixXd Y(D.size(), width);
  Eigen::VectorXd y;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Eigen::MatrixXd gram = X.transpose() * D.asDiagonal() * X;
    cholesky_factor(gram).triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(
        X); // orthonormal in D
    for (Eigen::Index i = 0; i < width; ++i) {
      equilibrium.tangent().solve(D.cwiseProduct(X.col(i)), y);
      Y.col(i) = y;
    }
    const Eigen::MatrixXd inverse = X.transpose() * D.asDiagonal() * Y;
    if (!inverse.allFinite()) return std::nullopt;
    const auto [theta, ritz] = symmetric_eigen(inverse); // theta: inverse eigenvalues
    Eigen::Index lowest = 0;
    const double tolerance = eigen_tolerance * theta.cwiseAbs().maxCoeff(&lowest);
    const Eigen::MatrixXd images = Y * ritz;
    const Eigen::MatrixXd residuals = images - X * ritz * theta.asDiagonal();
    const Eigen::VectorXd error = (residuals.transpose() * D.asDiagonal() * residuals).diagonal().cwiseSqrt();
    // All that share the lowest eigenvalue are needed to orient one. Whether another vector does, its error
    // must tell.
    std::vector<Eigen::Index> twins;
    bool told = error[lowest] <= tolerance;
    for (Eigen::Index i = 0; i < width; ++i) {
      if (error[i] > tolerance)
        told = told && std::abs(theta[i] - theta[lowest]) > error[i];
      else if (coincide(1 / theta[i], 1 / theta[lowest], same_eigenvalue))
        twins.push_back(i);
    }
    if (told) {
      Eigen::MatrixXd oriented = images(Eigen::all, twins) * theta(twins).cwiseInverse().asDiagonal();
      orient_twins(oriented, equilibrium.weight().head(D.size()).cwiseInverse());
      Mode mode{1 / theta[lowest] - shift, oriented.col(0)};
      normalise(equilibrium.model().dofs, state, mode.direction);
      return mode;
    }
    X = images;
    X.colwise().normalize();
  }
  return std::nullopt;
}

} // namespace dielast::fem
