// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/contact/barrier.hpp"
#include "fem/contact/slider.hpp"
#include "fem/model/state.hpp"
#include "meshing/mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace dielast::fem {

/// Friction of two surfaces in contact: a Slider at each node of either, along what it is pressed on or,
/// where nothing presses it yet, what is nearest. What that is, and across which direction, is told at the
/// last accepted state and follows by one increment; in between a slider's way is that beside the point of
/// the other surface where the node was. What holds the one surface pushes the other one. Partners, their
/// shape functions, directions, stretches, normal forces and the heat of sliding are internal variables.
///
/// Nodes: of a face (or side), at which its shape functions are those of the contact's distances.
template<int Nodes>
class SurfaceSliders {
 public:
  using Vector3d = Eigen::Vector3d;
  using Matrix3d = Eigen::Matrix3d;
  using Shape = Eigen::Vector<double, Nodes>;
  static constexpr int none = -1;

  /// The place of the other surface that is nearest to a node.
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity(); ///< m
    int face = none;
    Shape shape = Shape::Zero();        ///< there
    Vector3d normal = Vector3d::Zero(); ///< unit vector from there to the node
  };
  /// What presses each slider's node, N.
  using Forces = std::vector<Vector3d>;

  SurfaceSliders() = default;
  /// `areas`: what each node of the mesh stands for, times the share of its surface's integral, m^2; `up`:
  /// the second direction in the plane, y or z.
  SurfaceSliders(double friction, const Barrier& barrier, const std::array<meshing::CellBlock, 2>& faces,
                 const std::vector<double>& areas, const std::vector<Vector3d>& drawn, int up = 1)
      : friction_(friction), barrier_(barrier), faces_(faces), drawn_(drawn), up_(up) {
    for (std::size_t k = 0; k < 2; ++k) {
      std::map<int, int> numbers;
      for (const int node : faces[k].nodes) {
        const auto [at, fresh] = numbers.try_emplace(node, count());
        if (fresh)
          sliders_.push_back({node, k, static_cast<int>(slider_at_[k].size()) / Nodes,
                              areas[static_cast<std::size_t>(node)]});
        slider_at_[k].push_back(at->second);
      }
    }
  }

  bool any() const { return friction_ > 0; }
  int count() const { return static_cast<int>(sliders_.size()); }
  int history_size() const { return any() ? count() * per_node : 0; }
  void place_history(int first) { first_ = first; }
  /// That of node `a` of a face.
  int number(std::size_t surface, int face, int a) const {
    return slider_at_[surface][static_cast<std::size_t>(face * Nodes + a)];
  }
  int node(int slider) const { return this->slider(slider).node; }
  std::size_t surface(int slider) const { return this->slider(slider).surface; }
  /// use(surface, face of a slider, face of the other surface on which it is pressed).
  template<class Use>
  void for_each_pair(const History& history, const Use& use) const {
    for (int i = 0; i < history_size() / per_node; ++i)
      if (touches(history, i)) use(slider(i).surface, slider(i).face, partner(history, i));
  }
  /// Adds those of a face that are pressed on one of the other surface.
  template<class Sums>
  void add(const State& state, std::size_t surface, int own, int other, bool derivatives, Sums& sums) const {
    if (!any() || !state.history) return; // as drawn
    for (int a = 0; a < Nodes; ++a) {
      const int i = number(surface, own, a);
      if (slider(i).face != own || !touches(*state.history, i) || partner(*state.history, i) != other)
        continue;
      const Matrix3d along = this->along(*state.history, i);
      const Slider::Response pulled = spring(state, i).pulled(stretched(state, i), along);
      sums.any = true;
      sums.energy += pulled.energy;
      if (!derivatives) continue;
      Eigen::Vector<double, 2 * Nodes> weight = Eigen::Vector<double, 2 * Nodes>::Zero();
      weight[a] = 1;
      weight.template tail<Nodes>() = -shape(*state.history, i);
      constexpr int dim = std::remove_cvref_t<decltype(sums.first)>::RowsAtCompileTime / (2 * Nodes);
      const auto direction_of = [this](int c) { return dim == 2 && c == 1 ? up_ : c; };
      for (int p = 0; p < 2 * Nodes; ++p)
        for (int c = 0; c < dim; ++c) {
          sums.first[dim * p + c] += weight[p] * pulled.force[direction_of(c)];
          for (int q = 0; q < 2 * Nodes; ++q)
            for (int d = 0; d < dim; ++d)
              sums.second(dim * p + c, dim * q + d) +=
                  weight[p] * weight[q] * pulled.tangent(direction_of(c), direction_of(d));
        }
    }
  }
  /// Stored in the springs, J.
  double energy(const State& state) const {
    double sum = 0;
    for (int i = 0; i < history_size() / per_node; ++i)
      if (touches(*state.history, i)) sum += stiffness(i) * stretched(state, i).squaredNorm() / 2;
    return sum;
  }
  /// What they hold over the most that they may hold; 1 where what touches is not pressed.
  double in_use(const State& state) const {
    double held = 0, most = 0;
    bool any = false, presses = false;
    for (int i = 0; i < history_size() / per_node; ++i) {
      if (!touches(*state.history, i)) continue;
      held += stiffness(i) * stretched(state, i).norm();
      most += spring(state, i).most;
      any = true;
      presses = presses || Slider::presses(read(*state.history, i, normal));
    }
    return presses ? held / most : any ? 1 : 0;
  }
  /// Since the beginning, J.
  double heat(const State& state) const {
    double sum = 0;
    for (int i = 0; i < history_size() / per_node; ++i)
      sum += read(*state.history, i, warmth) * force_unit(i) * length_unit();
    return sum;
  }
  /// Writes what they are as drawn.
  void start(const Forces& forces, const std::vector<Nearest>& nearest, std::vector<double>& all) const {
    State drawn;
    drawn.displacement.assign(drawn_.size(), Vector3d::Zero());
    for (int i = 0; i < count(); ++i) {
      for (int v = 0; v < per_node; ++v) all[place(i, v)] = 0;
      settle(drawn, i, forces, nearest, Vector3d::Zero(), all);
    }
  }
  /// See Slider::much.
  bool is_pressed_first(const History& history, const Forces& forces) const {
    return dielast::fem::is_pressed_first(
        history_size() / per_node, [&](int i) { return read(history, i, normal); },
        [&](int i) { return forces[static_cast<std::size_t>(i)].norm(); },
        [&](int i) { return force_unit(i); });
  }
  /// Writes the normal forces that bound them, times `eased`, see Slider::bound().
  void bound(const Forces& forces, bool solved, double eased, std::vector<double>& all) const {
    bound_sliders(
        count(), [&](int i) -> double& { return all[place(i, normal)]; },
        [&](int i) { return eased * forces[static_cast<std::size_t>(i)].norm() / force_unit(i); }, solved);
  }
  /// Writes what they are in a state that is accepted.
  void advance(const State& state, const Forces& forces, const std::vector<Nearest>& nearest,
               std::vector<double>& all) const {
    for (int i = 0; i < count(); ++i) {
      Vector3d stretch = Vector3d::Zero();
      if (touches(*state.history, i)) {
        const Vector3d way = stretched(state, i),
                       force = spring(state, i).kept(way, along(*state.history, i),
                                                     friction_ * forces[static_cast<std::size_t>(i)].norm());
        stretch = force / stiffness(i);
        all[place(i, warmth)] +=
            Slider::heat_of(read(*state.history, i, pressed_then), read(*state.history, i, normal)) *
            force.dot(way - stretch) / (force_unit(i) * length_unit());
      }
      settle(state, i, forces, nearest, stretch, all);
    }
  }

 private:
  struct Place {
    int node;
    std::size_t surface;
    int face;    ///< one of the node's
    double area; ///< m^2
  };
  /// Internal variables of a slider: the other surface's face, shape functions there, the direction across,
  /// what the node was from there, and the stretch, both over length_unit(), the normal force that bounds it
  /// (0: it does not touch), the heat, and the normal force of the last accepted state likewise.
  static constexpr int other_face = 0, functions = 1, across = functions + Nodes, from = across + 3,
                       stretch_then = from + 3, normal = stretch_then + 3, warmth = normal + 1,
                       pressed_then = warmth + 1, per_node = pressed_then + 1;

  const Place& slider(int i) const { return sliders_[static_cast<std::size_t>(i)]; }
  std::size_t place(int i, int variable) const {
    return static_cast<std::size_t>(first_ + i * per_node + variable);
  }
  double read(const History& history, int i, int variable) const { return history.now[place(i, variable)]; }
  Vector3d read_vector(const History& history, int i, int variable) const {
    return {read(history, i, variable), read(history, i, variable + 1), read(history, i, variable + 2)};
  }
  void write(const Vector3d& value, int i, int variable, std::vector<double>& all) const {
    for (int c = 0; c < 3; ++c) all[place(i, variable + c)] = value[c];
  }
  bool touches(const History& history, int i) const { return read(history, i, normal) > 0; }
  int partner(const History& history, int i) const {
    return std::clamp(static_cast<int>(std::lround(read(history, i, other_face))), 0,
                      faces_[1 - slider(i).surface].size() - 1);
  }
  Shape shape(const History& history, int i) const {
    Shape values;
    for (int b = 0; b < Nodes; ++b) values[b] = read(history, i, functions + b);
    return values;
  }
  Matrix3d along(const History& history, int i) const {
    const Vector3d n = read_vector(history, i, across);
    return Matrix3d::Identity() - n * n.transpose();
  }
  double length_unit() const { return barrier_.thickness; }
  double force_unit(int i) const { return barrier_.stiffness * slider(i).area * length_unit(); }
  double stiffness(int i) const { return Slider::stick * barrier_.stiffness * slider(i).area; }
  Slider spring(const State& state, int i) const {
    const double force = read(*state.history, i, normal);
    return Slider::of(stiffness(i), friction_, force, force_unit(i), state.scheme.is_frozen());
  }
  /// The way from a point of a face of the other surface to the node, m.
  Vector3d way(const State& state, int i, int other, const Shape& at) const {
    const auto position = [&](int node) -> Vector3d {
      const auto n = static_cast<std::size_t>(node);
      return drawn_[n] + state.displacement[n];
    };
    Vector3d sum = position(slider(i).node);
    const auto nodes = faces_[1 - slider(i).surface].cell(other);
    for (int b = 0; b < Nodes; ++b) sum -= at[b] * position(nodes[static_cast<std::size_t>(b)]);
    return sum;
  }
  /// Along the surface.
  Vector3d stretched(const State& state, int i) const {
    const History& history = *state.history;
    const Vector3d slipped =
        way(state, i, partner(history, i), shape(history, i)) - length_unit() * read_vector(history, i, from);
    return along(history, i) * (slipped + length_unit() * read_vector(history, i, stretch_then));
  }
  /// Keeps where it is now.
  void settle(const State& state, int i, const Forces& forces, const std::vector<Nearest>& all_nearest,
              const Vector3d& stretch, std::vector<double>& all) const {
    const Vector3d& pressing = forces[static_cast<std::size_t>(i)];
    const Nearest& nearest = all_nearest[static_cast<std::size_t>(i)];
    const double force = pressing.norm(), unit = force_unit(i);
    const Vector3d n = force > 0 ? Vector3d(pressing / force) : nearest.normal;
    all[place(i, other_face)] = nearest.face;
    for (int b = 0; b < Nodes; ++b) all[place(i, functions + b)] = nearest.shape[b];
    write(n, i, across, all);
    write(way(state, i, nearest.face, nearest.shape) / length_unit(), i, from, all);
    write((stretch - stretch.dot(n) * n) / length_unit(), i, stretch_then, all);
    all[place(i, normal)] = std::max(force / unit, barrier_.touches(nearest.distance) ? Slider::light : 0.0);
    all[place(i, pressed_then)] = force / unit;
  }

  double friction_ = 0;
  Barrier barrier_;
  std::array<meshing::CellBlock, 2> faces_;
  std::vector<Vector3d> drawn_;
  int up_ = 1;
  std::vector<Place> sliders_;
  std::array<std::vector<int>, 2> slider_at_; ///< per node of each surface's faces
  int first_ = 0;
};

} // namespace dielast::fem
