// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/modal.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/algebra/orientation.hpp"
#include "fem/linear/rest.hpp"
#include "fem/linear/rigid_motions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace dielast::fem {

namespace {

constexpr int spare_vectors = 6, powers = 4, most_sweeps = 100;
constexpr int patience = 5;                ///< sweeps after which twice as many vectors are kept,
constexpr Eigen::Index most_vectors = 200; ///< up to so many
constexpr double tolerance = 1e-6;         ///< of modes; that of omega^2 is its square
constexpr double farther = 10;             ///< shifts one after another
constexpr double omega_round_off = 1e-13;  ///< of omega^2, over that of the stiffest unknowns

} // namespace

GeneralisedAlpha mass_times(double shift) { return {.dt = 1 / std::sqrt(shift), .beta = 1}; }

double VibrationMode::frequency() const { return std::sqrt(std::max(stiffness, 0.0)); }

std::optional<std::vector<VibrationMode>> vibration_modes(Equilibrium& equilibrium, const State& state,
                                                          const ModalOptions& options) {
  const Inertia& inertia = equilibrium.model().inertia();
  if (inertia.empty()) return std::vector<VibrationMode>{};
  const Eigen::Index free = equilibrium.model().dofs.free_count();
  const FreeMass mass = free_mass(equilibrium, state);
  const Eigen::SparseMatrix<double>& M = mass.M;
  const Eigen::Index massive = (M.diagonal().array() > 0).count();
  State at = relaxed(state);
  at.motion_scheme = {};
  RigidMotions rigid;
  if (options.drifts) rigid = rigid_motions(equilibrium, at, mass);
  const Eigen::Index elastic = massive - rigid.motions.cols();
  const Eigen::Index wanted = std::min<Eigen::Index>(options.count, elastic);
  if (wanted <= 0) return std::vector<VibrationMode>{};
  Eigen::Index width = std::min(elastic, wanted + spare_vectors);

  double shift = 0;
  const auto factor = [&](double shifted) {
    shift = shifted;
    at.motion_scheme = mass_times(shift);
    return equilibrium.factor(at);
  };
  const auto is_unstable = [&] { return equilibrium.tangent().unstable_modes() > 0; };
  if (options.drifts || !equilibrium.factor(at) || is_unstable()) {
    double below = least_shift * mass.fastest;
    if (!factor(below)) return std::nullopt;
    if (is_unstable()) { // what is nearest to zero need not be the lowest: just beyond all that is unstable
      double beyond = below;
      while (is_unstable())
        if (below = beyond; !factor(beyond *= farther)) return std::nullopt;
      for (int closer = 0; closer < 3; ++closer) {
        if (!factor(std::sqrt(below * beyond))) return std::nullopt;
        (is_unstable() ? below : beyond) = shift;
      }
      if (!factor(beyond)) return std::nullopt;
    }
  }
  const auto respond = [&](const Eigen::MatrixXd& X) { // K^-1 M X
    Eigen::MatrixXd Y = M * X;
    Eigen::VectorXd y;
    for (Eigen::Index i = 0; i < Y.cols(); ++i) {
      equilibrium.tangent().solve(Y.col(i), y);
      Y.col(i) = y;
    }
    if (options.drifts) rigid.take_off(Y);
    return Y;
  };
  Eigen::MatrixXd X = random_vectors(free, width);
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    Eigen::MatrixXd V(free, 0), W(free, 0); // W = K^-1 M V, without rigid motions
    if (options.drifts && sweep == 0) rigid.take_off(X);
    for (int power = 0; power < powers; ++power) {
      X = orthonormal_to(V, M, std::move(X));
      if (X.cols() == 0) break;
      append_columns(V, X);
      X = respond(X);
      append_columns(W, X);
    }
    if (V.cols() == 0) return std::nullopt; // the tangent's numbers are beyond double precision
    const Eigen::MatrixXd inverse = V.transpose() * (M * W);
    if (!inverse.allFinite()) return std::nullopt;
    const SymmetricEigen ritz = symmetric_eigen((inverse + inverse.transpose()) / 2);
    const Eigen::VectorXd& theta = ritz.values; // 1/(omega^2 + shift)
    std::vector<Eigen::Index> order(static_cast<std::size_t>(theta.size()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::ranges::sort(order, std::greater{}, [&](Eigen::Index i) { return std::abs(theta[i]); });
    order.resize(std::min(order.size(), static_cast<std::size_t>(width)));

    X = W * ritz.vectors(Eigen::all, order); // massless unknowns have followed
    const Eigen::MatrixXd before = V * ritz.vectors(Eigen::all, order);
    Eigen::VectorXd stiffness = theta(order).cwiseInverse().array() - shift;
    // Those wanted and what shares the last one's frequency: only all of them together can be oriented.
    const Eigen::Index last = std::min(wanted, X.cols()) - 1;
    Eigen::Index found = 0;
    bool converged = true;
    for (; found < X.cols() && converged; ++found) {
      const double inverse_square = theta[order[static_cast<std::size_t>(found)]];
      const Eigen::VectorXd residual = X.col(found) - inverse_square * before.col(found);
      const double error = std::sqrt(std::abs(residual.dot(M * residual)));
      converged = error <= tolerance * std::abs(inverse_square);
      if (found <= last) continue;
      const double distance = std::abs(inverse_square - theta[order[static_cast<std::size_t>(last)]]);
      const bool another = converged
                               ? !coincide(stiffness[found], stiffness[last], omega_round_off * mass.fastest)
                               : distance > error;
      if (!another) continue;
      converged = true;
      break;
    }
    if (!converged) { // of many that lie close to one another all are needed, as of waves across slack film
      if (sweep % patience == patience - 1)
        width = std::min({elastic, 2 * width, std::max(width, most_vectors)});
      continue;
    }
    Eigen::MatrixXd shapes = X.leftCols(found);
    for (auto shape : shapes.colwise()) shape /= std::sqrt(shape.dot(M * shape));
    stiffness.conservativeResize(found);
    orient(shapes, stiffness, omega_round_off * mass.fastest, equilibrium.weight().head(free).cwiseInverse());
    std::vector<VibrationMode> modes;
    for (Eigen::Index i = 0; i <= last; ++i) modes.push_back({stiffness[i], shapes.col(i)});
    std::ranges::stable_sort(modes, {}, &VibrationMode::stiffness);
    return modes;
  }
  return std::nullopt;
}

} // namespace dielast::fem
