// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/tangent_check.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace dielast::fem {

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
  Eigen::VectorXd residual, residual_there;
  equilibrium.internal_force(base, residual);
  equilibrium.assembler().tangent(base);

  TangentCheck check{.directions = directions};
  for (int k = 0; k < directions; ++k) {
    const Eigen::VectorXd d = draw();
    const double slope = residual.head(d.size()).dot(d);
    const double curvature = equilibrium.assembler().matrix().quadratic_form(d);
    struct There {
      double energy, slope;
    };
    const auto at = [&](double s) {
      State moved = base;
      model.dofs.advance(moved, d, s);
      const double there = equilibrium.internal_force(moved, residual_there).energy;
      return There{there, residual_there.head(d.size()).dot(d)};
    };
    // Fourth-order central differences; the steps balance truncation against round-off. Stiffnesses may
    // change at once, where contact begins: the steps of residuals, which need not be long, rarely reach
    // across.
    const auto derivative = [&](double h, double There::*of) {
      return (8 * (at(h).*of - at(-h).*of) - (at(2 * h).*of - at(-2 * h).*of)) / (12 * h);
    };
    const double slope_difference = derivative(1e-2, &There::energy),
                 curvature_difference = derivative(1e-4, &There::slope);
    check.residual = std::max(check.residual,
                              std::abs(slope - slope_difference) / (std::abs(slope) + std::abs(curvature)));
    check.tangent = std::max(check.tangent, std::abs(curvature - curvature_difference) / std::abs(curvature));
  }
  return check;
}

} // namespace dielast::fem
