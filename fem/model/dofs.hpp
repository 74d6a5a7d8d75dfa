// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/state.hpp"

#include <Eigen/SparseCore>

#include <array>
#include <memory>
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

/// Node of a rigid body: x_node = x_master + R_master arm, R_node = R_master where it `turns` along;
/// otherwise it is pinned, and turns by itself.
struct Tie {
  int node = 0, master = 0;
  Eigen::Vector3d arm; ///< m, from the master as drawn
  bool turns = true;
};

/// Two axes that a node tilts about, as drawn: orthonormal, their cross product is the director.
using TiltAxes = Eigen::Matrix<double, 3, 2>;

/// Numbers the unknowns of a model. Each node may have six: displacement x, y, z (0..2) and spin about x, y,
/// z (3..5), the spatial rotation increment. Free unknowns get equations 0..free_count()-1, held ones follow,
/// then the displacements of tied nodes, which are functions of their masters' unknowns: a residual of
/// count() entries carries the reactions behind the free equations, and what acts on tied nodes until
/// gather() moves it.
///
/// A node of which nothing but a director counts (see add_director()) has two tilts (6, 7) instead of three
/// spins: spin = R A a, with the tilts a, the drawn axes A perpendicular to the director, and the node's
/// rotation R. They turn with the node, so that exp(spin) R = R exp(A a): no spin is ever about the director,
/// and energies' second derivatives in tilts are those in spins, seen along these axes. Such a node may carry
/// others that lie along its director and do not turn themselves.
///
/// Behind the nodes' unknowns come scalars, numbers of State::scalar that move nothing: pressures that keep a
/// volume, potentials of a field. They are multipliers: the energy is stationary in them, and largest, so
/// that each brings the tangent one negative eigenvalue at a stable state, too.
class DofMap {
 public:
  static constexpr int components = 6;         ///< along and about x, y, z
  static constexpr int tilt = 6, unknowns = 8; ///< the first tilt; all that a node may have
  static constexpr int absent = -1;

  explicit DofMap(int node_count)
      : equation_(static_cast<std::size_t>(node_count), unset()),
        turns_(static_cast<std::size_t>(node_count), Turns::by_spins),
        tie_of_(static_cast<std::size_t>(node_count), absent),
        carries_(static_cast<std::size_t>(node_count)) {}

  /// Gives the node this unknown, a displacement or a spin.
  void add(int node, int component);
  /// Gives the node what turns a director, a unit vector as drawn: two tilts where it is the only one
  /// (parallel ones are one), nothing else asked for spins (add(), share(), ties, keep_spins()), and all
  /// three or none are held; three spins elsewhere. number() decides; until then they are spins.
  void add_director(int node, const Eigen::Vector3d& director);
  /// Something acts on single spins of the node, if it turns: it is not to have tilts.
  void keep_spins(int node);
  /// The axes of every node, zero where it does not tilt: filled by number(), shared with who asks before.
  /// Null before add_director().
  std::shared_ptr<const std::vector<TiltAxes>> tilt_axes() const { return tilt_axes_; }
  /// Holds the unknown at its value, a displacement or a spin; ignored where the node does not have it.
  void hold(int node, int component);
  /// Gives two nodes one common unknown, as for a rigid body that only translates; held if either is held.
  void share(int node, int other, int component) { share(node, component, other, component); }
  /// Gives two displacements one common unknown, as for a square that stays a square.
  void share(int node, int component, int other, int other_component);
  /// Makes the node a part of the rigid body of `master`, which may itself be tied. Throws
  /// std::invalid_argument for a node that is tied already, to itself, or to one of its own, and to one that
  /// is pinned.
  void tie(const Tie& tie);
  bool is_tied_node(int node) const { return tie_of_[static_cast<std::size_t>(node)] != absent; }
  /// Adds a free scalar and returns its place in State::scalar. Its equation's unknown is the scalar over
  /// `unit` (in the scalar's own unit, positive), such that residuals are energies as those of spins are.
  int add_scalar(double unit);
  /// Numbers everything; to be called once, after the last of the calls above. Throws std::invalid_argument
  /// where a displacement of a tied node is held or shared.
  void number();

  int equation(int node, int unknown) const { return equation_[static_cast<std::size_t>(node)][unknown]; }
  bool tilts(int node) const { return equation(node, tilt) != absent; }
  /// Equations of what turns the node, its spins or its tilts, absent where it does not have them.
  std::array<int, 3> turns(int node) const {
    return tilts(node) ? std::array{equation(node, tilt), equation(node, tilt + 1), absent}
                       : std::array{equation(node, 3), equation(node, 4), equation(node, 5)};
  }
  /// About which they turn it, in columns: x, y and z, or R A and 0.
  Eigen::Matrix3d turn_axes(const State& state, int node) const;
  int scalar_equation(int scalar) const { return scalars_[static_cast<std::size_t>(scalar)].equation; }
  double scalar_unit(int scalar) const { return scalars_[static_cast<std::size_t>(scalar)].unit; }
  int scalar_count() const { return static_cast<int>(scalars_.size()); }
  int node_count() const { return static_cast<int>(equation_.size()); }
  int free_count() const { return free_count_; }
  int held_count() const { return held_count_; }
  int count() const { return count_; }
  bool is_free(int equation) const { return equation != absent && equation < free_count_; }
  bool is_held(int equation) const { return equation >= free_count_ && equation < free_count_ + held_count_; }
  bool is_tied(int equation) const { return equation >= free_count_ + held_count_; }
  const std::vector<Tie>& ties() const { return ties_; }

  /// state := state + scale * increment, rotations as exp(spin) R; increment has free_count() entries. Tied
  /// nodes are carried.
  void advance(State& state, const Eigen::VectorXd& increment, double scale) const;
  /// Puts tied nodes to where their masters are.
  void carry(State& state) const;
  /// Moves the forces on tied nodes (count() entries in all) to their masters: their sum and its moment.
  void gather(const State& state, Eigen::VectorXd& force) const;
  /// The spin of a node by its unknowns among `values` (count() entries), or the moment by forces on them; 0
  /// along what it does not have.
  Eigen::Vector3d spin(const State& state, int node, const Eigen::VectorXd& values) const;
  /// How all unknowns go with the free ones: count() x free_count().
  Eigen::SparseMatrix<double> jacobian(const State& state) const;
  /// How displacement `component` (0..2) of a tied node goes with what turns() its master; with the master's
  /// displacement it goes as one.
  Eigen::Vector3d lever(const Tie& tie, const State& state, int component) const;
  /// What forces that stay as they are (count() entries) do on the way of the tied nodes from one state to
  /// another, J.
  double work_on_tied(const Eigen::VectorXd& force, const State& from, const State& to) const;
  /// The increment by which advance() leads from one state to the other's free displacements and rotations,
  /// directors where nodes tilt.
  Eigen::VectorXd increment(const State& from, const State& to) const;

 private:
  static constexpr int free_mark = 0, held_mark = 1, tied_mark = 2; // before number()
  static constexpr std::array<int, unknowns> unset() {
    return {absent, absent, absent, absent, absent, absent, absent, absent};
  }
  enum class Turns : char { by_spins, by_tilts };
  void choose_tilts();
  bool lies_along_director(const Tie& tie) const;
  const TiltAxes& axes_of(std::size_t node) const { return (*tilt_axes_)[node]; }

  struct Scalar {
    double unit;
    int equation;
  };

  std::vector<std::array<int, unknowns>> equation_;
  std::vector<Turns> turns_;
  std::shared_ptr<std::vector<TiltAxes>> tilt_axes_; ///< before number() of all that may tilt
  std::vector<Scalar> scalars_;
  std::vector<std::array<int, 4>> shared_; ///< node, component, other node, its component
  std::vector<Tie> ties_;
  std::vector<int> tie_of_;   ///< of each node, its place in ties_, or absent
  std::vector<char> carries_; ///< whether a node has been a master
  int free_count_ = 0, held_count_ = 0, count_ = 0;
};

} // namespace dielast::fem
