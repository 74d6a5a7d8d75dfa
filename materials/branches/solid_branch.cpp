// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/branches/solid_branch.hpp"

#include "materials/algebra/small_matrices.hpp"
#include "materials/laws/principal_energy.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace dielast::materials {

namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Vector6 = Eigen::Vector<double, 6>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Principal frame of the elastic deformation: T^T C T = diag(b), T T^T = G. Nearby metrics are
/// T exp(X) T^T.
struct Frame {
  Matrix3 T;
  Vector3 b;

  /// From any root of G: root root^T.
  Frame(const Matrix3& C, const Matrix3& root) {
    const SymmetricEigen<3> eigen = symmetric_eigen<3>(root.transpose() * C * root);
    T = root * eigen.vectors;
    b = eigen.values;
  }
  /// T^T dC T, in components, from dC, in components.
  Matrix6 turn() const {
    Matrix6 R;
    for (int a = 0; a < 6; ++a)
      for (int c = 0; c < 6; ++c) {
        const auto [k, l] = solid_components[static_cast<std::size_t>(a)];
        const auto [i, j] = solid_components[static_cast<std::size_t>(c)];
        R(a, c) = T(i, k) * T(j, l) + (i == j ? 0 : T(j, k) * T(i, l));
      }
    return R;
  }
};

/// Weight of H : G over the step, and H.
struct Flow {
  double weight;
  Matrix3 H;
};

/// Step potential and its derivatives in the six components of X.
struct StepPotential {
  double value;
  Vector6 first;
  Matrix6 second;
};

/// Removes tr X: derivatives of f(X - tr(X)/3 1) from those of f, in the first three components.
template<class Rows>
void remove_trace(Eigen::MatrixBase<Rows>&& rows) {
  const auto mean = (rows.colwise().sum() / 3).eval();
  rows.rowwise() -= mean;
}

StepPotential step_potential(const PrincipalEnergy& W, const Flow& flow, const Frame& frame) {
  const Matrix3 K = flow.weight * frame.T.transpose() * flow.H * frame.T;
  StepPotential sum{W.value + K.trace() - 3 * flow.weight * std::cbrt(flow.H.determinant()),
                    {W.first[0] + K(0, 0), W.first[1] + K(1, 1), W.first[2] + K(2, 2), 2 * K(0, 1),
                     2 * K(1, 2), 2 * K(0, 2)},
                    Matrix6{{K(0, 0), 0, 0, K(0, 1), 0, K(0, 2)},
                            {0, K(1, 1), 0, K(0, 1), K(1, 2), 0},
                            {0, 0, K(2, 2), 0, K(1, 2), K(0, 2)},
                            {K(0, 1), K(0, 1), 0, K(0, 0) + K(1, 1), K(0, 2), K(1, 2)},
                            {0, K(1, 2), K(1, 2), K(0, 2), K(1, 1) + K(2, 2), K(0, 1)},
                            {K(0, 2), 0, K(0, 2), K(1, 2), K(0, 1), K(0, 0) + K(2, 2)}}};
  sum.second.topLeftCorner<3, 3>() += W.second;
  for (int a = 3; a < 6; ++a) {
    const auto [i, j] = solid_components[static_cast<std::size_t>(a)];
    sum.second(a, a) += (frame.b[i] + frame.b[j]) * W.difference(i, j);
  }
  remove_trace(sum.first.head<3>());
  remove_trace(sum.second.topRows<3>());
  remove_trace(sum.second.leftCols<3>().transpose());
  // tr X changes nothing: any stiffness against it keeps it at 0.
  sum.second.topLeftCorner<3, 3>().array() += sum.second.trace();
  return sum;
}

struct Settled {
  bool found;
  Frame frame;
};

/// Damped Newton for the metric that minimises the step potential at C, from the metric of `frame`.
Settled settle(const ElasticLaw& law, const Flow& flow, const Matrix3& C, Frame frame) {
  StepPotential at = step_potential(principal_energy(law, frame.b), flow, frame);
  for (int iteration = 0; iteration < 60 && std::isfinite(at.value); ++iteration) {
    const auto [stiffness, axes] = symmetric_eigen(at.second);
    const double scale = stiffness.cwiseAbs().maxCoeff();
    // Concave directions are turned downhill.
    Vector6 step =
        -(axes * (axes.transpose() * at.first).cwiseQuotient(stiffness.cwiseAbs().cwiseMax(1e-6 * scale)));
    // Convergence is quadratic: from an error of 1e-8 one more step reaches the last digits.
    const bool last = stiffness[0] > 0 && -at.first.dot(step) <= 1e-16 * scale;
    for (int halving = 0; halving < 40; ++halving, step /= 2) {
      const Matrix3 X{{step[0], step[3], step[5]}, {step[3], step[1], step[4]}, {step[5], step[4], step[2]}};
      const auto [logarithms, Q] = symmetric_eigen(X);
      const Matrix3 grow = Q * (logarithms / 2).array().exp().matrix().asDiagonal() * Q.transpose();
      const Frame there(C, frame.T * grow);
      const StepPotential trial = step_potential(principal_energy(law, there.b), flow, there);
      if (!(trial.value <= at.value + 1e-14 * scale)) continue;
      frame = there;
      at = trial;
      break;
    }
    if (last) return {true, frame};
  }
  return {false, frame};
}

Matrix3 tensor(const SolidInternal& y) {
  return Matrix3{{y[0], y[3], y[5]}, {y[3], y[1], y[4]}, {y[5], y[4], y[2]}};
}

/// A root of Cv^-1, scaled to unit determinant; not a number where there is none, so that nothing is found
/// from there.
Matrix3 inverse_root(const Matrix3& Cv) {
  const auto L = cholesky_factor(Cv);
  if (!L) return Matrix3::Constant(std::numeric_limits<double>::quiet_NaN());
  const Matrix3 root = L->inverse().transpose();
  return root / std::cbrt(root.determinant());
}

Flow flow_over(const Branch& branch, const TimeScheme& scheme, const SolidInternal& now,
               const SolidInternal& before) {
  const double weight = branch.viscosity / (2 * scheme.dt); // 0: relaxed
  const Flow euler{weight, tensor(now)};
  if (scheme.h2 == 0) return euler;
  const Matrix3 H = scheme.h1 * tensor(now) + scheme.h2 * tensor(before);
  return cholesky_factor(H) ? Flow{weight, H} : euler;
}

/// Starts where a neo-Hookean branch would end, Cv ~ H + dt mu/eta Cbar, or, where the law cannot be there,
/// fully relaxed.
Settled settle(const ElasticLaw& law, const Flow& flow, const Matrix3& C) {
  const Frame relaxed(C, inverse_root(C));
  if (flow.weight == 0) return {true, relaxed};
  const double rate = initial_shear_modulus(law) / (2 * flow.weight);
  const Frame start(C, inverse_root(flow.H + rate / std::cbrt(C.determinant()) * C));
  const Settled settled = settle(law, flow, C, start);
  return settled.found ? settled : settle(law, flow, C, relaxed);
}

/// W as a function of C at a fixed metric, in the components of T^T C T.
SolidPotential elastic(const PrincipalEnergy& W, const Vector3& b) {
  SolidPotential potential{W.value, Vector6::Zero(), Matrix6::Zero()};
  const Vector3 inverse = b.cwiseInverse();
  potential.first.head<3>() = W.first.cwiseProduct(inverse);
  potential.second.topLeftCorner<3, 3>() = inverse.asDiagonal() * W.second * inverse.asDiagonal();
  potential.second.diagonal().head<3>() -= potential.first.head<3>().cwiseProduct(inverse);
  for (int a = 3; a < 6; ++a) {
    const auto [i, j] = solid_components[static_cast<std::size_t>(a)];
    potential.second(a, a) =
        ((b[i] + b[j]) * W.difference(i, j) - W.first[i] - W.first[j]) * inverse[i] * inverse[j];
  }
  return potential;
}

SolidPotential turned(SolidPotential potential, const Frame& frame) {
  const Matrix6 R = frame.turn();
  return {potential.value, R.transpose() * potential.first, R.transpose() * potential.second * R};
}

/// The step potential as a function of C alone, around the settled metric that follows C.
SolidPotential condensed(const ElasticLaw& law, const Flow& flow, const Settled& settled) {
  if (!settled.found) return {std::numeric_limits<double>::quiet_NaN(), Vector6::Zero(), Matrix6::Zero()};
  const Frame& frame = settled.frame;
  const PrincipalEnergy W = principal_energy(law, frame.b);
  const StepPotential step = step_potential(W, flow, frame);
  SolidPotential potential = elastic(W, frame.b);
  potential.value = step.value;
  Matrix6 mixed = Matrix6::Zero(); // in X and T^T C T
  mixed.topLeftCorner<3, 3>() = W.second * frame.b.cwiseInverse().asDiagonal();
  remove_trace(mixed.topRows<3>());
  for (int a = 3; a < 6; ++a) {
    const auto [i, j] = solid_components[static_cast<std::size_t>(a)];
    mixed(a, a) = 2 * W.difference(i, j);
  }
  const Eigen::LDLT<Matrix6> stiffness(step.second);
  Matrix6 follows; // column by column: many at once take the compiler longer
  for (int a = 0; a < 6; ++a) follows.col(a) = stiffness.solve(mixed.col(a));
  potential.second -= mixed.transpose() * follows;
  return turned(potential, frame);
}

void require_logarithmic(const Branch& branch) {
  if (branch.dashpot != Dashpot::log)
    throw std::invalid_argument("a nominal dashpot is defined along the axes of a film, not in a solid");
}

} // namespace

SolidPotential solid_branch_potential(const Branch& branch, const Matrix3& C, const TimeScheme& scheme,
                                      const SolidInternal& now, const SolidInternal& before) {
  require_logarithmic(branch);
  if (scheme.is_frozen()) {
    const Frame frame(C, inverse_root(tensor(now)));
    return turned(elastic(principal_energy(branch.law, frame.b), frame.b), frame);
  }
  const Flow flow = flow_over(branch, scheme, now, before);
  return condensed(branch.law, flow, settle(branch.law, flow, C));
}

SolidInternal solid_branch_advance(const Branch& branch, const Matrix3& C, const TimeScheme& scheme,
                                   const SolidInternal& now, const SolidInternal& before) {
  require_logarithmic(branch);
  if (scheme.is_frozen()) return now;
  const Flow flow = flow_over(branch, scheme, now, before);
  const Matrix3 root = settle(branch.law, flow, C).frame.T.inverse();
  const Matrix3 Cv = root.transpose() * root;
  return {Cv(0, 0), Cv(1, 1), Cv(2, 2), Cv(0, 1), Cv(1, 2), Cv(0, 2)};
}

BranchPower solid_branch_power(const Branch& branch, const Matrix3& C, const SolidInternal& internal) {
  require_logarithmic(branch);
  const Frame frame(C, inverse_root(tensor(internal)));
  const PrincipalEnergy W = principal_energy(branch.law, frame.b);
  const Vector3 driving = W.first.array() - W.first.mean(); // half of the deviator of 2 dW/dG G
  return {W.value, 2 * driving.squaredNorm() / branch.viscosity};
}

} // namespace dielast::materials
