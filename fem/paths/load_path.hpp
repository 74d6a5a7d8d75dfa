// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/dofs.hpp"
#include "fem/model/state.hpp"

#include <cstddef>
#include <functional>
#include <limits>
#include <span>

namespace dielast::fem {

/// Everything that is prescribed to a state.
struct Loads {
  std::vector<double> voltage; ///< V, or Pa, per port; where the charge is given it has no effect
  std::vector<double> charge;  ///< C, or m^3, per port; of driven ones it has no effect
  std::vector<double> source;  ///< V, per electrode, of the source of its circuit
  Eigen::VectorXd dead_force;  ///< per equation, N
  Eigen::VectorXd held;        ///< displacements of the held equations, m (rad for rotations: 0)

  static Loads of(const State& state, const DofMap& dofs);
  bool operator==(const Loads&) const = default;
  /// All of them in one vector.
  Eigen::VectorXd values() const;
  void apply(State& state, const DofMap& dofs) const;
};

/// Whether two sets of loads differ by more than rounding, over the largest value that each of them has in
/// `recent`: where a wave only turns, both sides of the break are computed, by other terms.
bool differ(const Loads& one, const Loads& other, std::span<const Loads> recent);

/// The loads of one step as functions of its load factor s in 0..1.
struct LoadPath {
  /// Sets everything that is prescribed at s, at a break what holds behind it.
  std::function<void(State&, double s)> apply;
  /// Sets what holds before a break at s; without it, what `apply` sets just before s.
  std::function<void(State&, double s)> apply_before;
  /// Monotonic in s: the parameter in which states are extrapolated.
  std::function<double(double s)> parameter = [](double s) { return s; };
  /// Load factors at which a load jumps or turns, 1e-9 or more apart.
  std::vector<double> breaks;

  /// Sets the loads that lead to s from below.
  void before(State& state, double s) const;
  /// Whether a load jumps at s, rather than turns.
  bool jumps(const DofMap& dofs, const State& state, double s) const;
};

/// Loads that grow linearly with s. The parameter is the largest Phi^2, in which the film's energy is linear,
/// where one voltage leads without changing its sign; chambers among the `ports` have none. `dofs` must
/// outlive the path.
LoadPath linear_path(const DofMap& dofs, Loads from, Loads to, const Ports* ports = nullptr);

} // namespace dielast::fem
