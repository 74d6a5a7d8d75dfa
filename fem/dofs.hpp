// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/state.hpp"

#include <array>
#include <vector>

namespace dielast::fem {

/// How a model can move.
enum class Dimension {
  planar,       ///< x and y, spin about z
  spatial,      ///< everything
  axisymmetric, ///< x, the radius, and z, of every half plane through the z axis alike
};

/// Whether a model moves along x, y, z (0..2) or spins about them (3..5).
constexpr bool moves(Dimension dimension, int component) {
  switch (dimension) {
  case Dimension::planar:
    return component == 0 || component == 1 || component == 5;
  case Dimension::spatial:
    return true;
  case Dimension::axisymmetric:
    return component == 0 || component == 2;
  }
  return false;
}

/// Numbers the unknowns of a model. Each node may have six: displacement x, y, z (0..2) and spin about x, y,
/// z (3..5), the spatial rotation increment. Free unknowns get equations 0..free_count()-1, held ones follow,
/// so that a residual of count() entries carries the reactions at its end.
class DofMap {
 public:
  static constexpr int components = 6;
  static constexpr int absent = -1;

  explicit DofMap(int node_count) : equation_(static_cast<std::size_t>(node_count), unset()) {}

  /// Gives the node this unknown.
  void add(int node, int component);
  /// Holds the unknown at its value; ignored where the node does not have it.
  void hold(int node, int component);
  /// Gives two nodes one common unknown, as for a rigid body that only translates; held if either is held.
  void share(int node, int other, int component) { share(node, component, other, component); }
  /// Gives two displacements one common unknown, as for a square that stays a square.
  void share(int node, int component, int other, int other_component);
  /// Numbers everything; to be called once, after the last of the calls above.
  void number();

  int equation(int node, int component) const { return equation_[static_cast<std::size_t>(node)][component]; }
  int node_count() const { return static_cast<int>(equation_.size()); }
  int free_count() const { return free_count_; }
  int count() const { return count_; }

  /// state := state + scale * increment, rotations as exp(spin) R; increment has free_count() entries.
  void advance(State& state, const Eigen::VectorXd& increment, double scale) const;
  /// The increment by which advance() leads from one state to the other's free displacements and rotations.
  Eigen::VectorXd increment(const State& from, const State& to) const;

 private:
  static constexpr int free_mark = 0, held_mark = 1; // before number()
  static constexpr std::array<int, components> unset() {
    return {absent, absent, absent, absent, absent, absent};
  }

  std::vector<std::array<int, components>> equation_;
  std::vector<std::array<int, 4>> shared_; ///< node, component, other node, its component
  int free_count_ = 0;
  int count_ = 0;
};

} // namespace dielast::fem
