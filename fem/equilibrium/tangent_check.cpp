// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/tangent_check.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace dielast::fem {

namespace {

/// value = d . K d
double quadratic_form(const SparseSymmetric& K, const Eigen::VectorXd& d) {
  double sum = 0;
  for (int c = 0; c < K.size; ++c)
    for (int k = K.column_start[static_cast<std::size_t>(c)];
         k < K.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int r = K.rows[static_cast<std::size_t>(k)];
      sum += (r == c ? 1 : 2) * K.values[static_cast<std::size_t>(k)] * d[c] * d[r];
    }
  return sum;
}

} // namespace

TangentCheck check_tangent(Equilibrium& equilibrium, const State& state, double amplitude, int directions) {
  const Model& model = equilibrium.model();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::VectorXd scale = Eigen::VectorXd::Constant(model.dofs.free_count(), amplitude);
  for (int n = 0; n < model.dofs.node_count(); ++n)
    for (int c = 3; c < DofMap::unknowns; ++c)
      if (const int e = model.dofs.equation(n, c); e != DofMap::absent && e < scale.size())
        scale[e] = amplitude / model.length_scale;
  const auto draw = [&] {
    Eigen::VectorXd d(scale.size());
    for (Eigen::Index i = 0; i < d.size(); ++i) d[i] = scale[i] * uniform(random);
    return d;
  };
  State base = state;
  model.dofs.advance(base, draw(), 1);
  Eigen::VectorXd residual;
  const double energy = equilibrium.internal_force(base, residual).energy;
  equilibrium.assembler().tangent(base);

  TangentCheck check{.directions = directions};
  for (int k = 0; k < directions; ++k) {
    const Eigen::VectorXd d = draw();
    const double slope = residual.head(d.size()).dot(d);
    const double curvature = quadratic_form(equilibrium.assembler().matrix(), d);
    const auto energy_at = [&](double s) {
      State moved = base;
      model.dofs.advance(moved, d, s);
      Eigen::VectorXd unused;
      return equilibrium.internal_force(moved, unused).energy;
    };
    // Fourth-order central differences; the steps balance truncation against round-off.
    const double h = 1e-2;
    const double p1 = energy_at(h), m1 = energy_at(-h), p2 = energy_at(2 * h), m2 = energy_at(-2 * h);
    const double slope_difference = (8 * (p1 - m1) - (p2 - m2)) / (12 * h);
    const double curvature_difference = (16 * (p1 + m1) - (p2 + m2) - 30 * energy) / (12 * h * h);
    check.residual = std::max(check.residual,
                              std::abs(slope - slope_difference) / (std::abs(slope) + std::abs(curvature)));
    check.tangent = std::max(check.tangent, std::abs(curvature - curvature_difference) / std::abs(curvature));
  }
  return check;
}

} // namespace dielast::fem
