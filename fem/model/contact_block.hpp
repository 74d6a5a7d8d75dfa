// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/model.hpp"

#include <cstddef>
#include <functional>
#include <string_view>
#include <vector>

namespace dielast::fem {

/// Per node of the mesh: the normal force on it, N, and the area as drawn of the surface that may touch for
/// which it stands, m^2; both of points as far as they count, see SurfaceEnds.
struct NodalPressure {
  std::vector<double> force, area;
};

/// Elements that keep things apart.
class ContactBlock : public ElementBlock {
 public:
  /// Chooses its elements anew where some that may touch in this state are not among them; returns a number
  /// that changes with every choice. Only they touch: evaluate() is for such states.
  virtual std::size_t choose_elements(const State& /*state*/) { return 0; }
  /// The part of the straight way between two states, 0..1, that can be gone without passing through what
  /// is touched; 1: all of it.
  virtual double free_way(const State& from, const State& to) const = 0;
  /// Whether surfaces nearly meet where no barrier keeps them apart, between its points: edges that cross.
  virtual bool edges_meet(const State& /*state*/) const { return false; }
  /// Sum of the normal forces, N.
  virtual double contact_force(const State& state) const = 0;
  /// Whether the surface of this place is one of those that it keeps apart.
  virtual bool is_between(std::string_view /*place*/) const { return false; }
  /// Adds those of its surfaces.
  virtual void add_pressure(const State& /*state*/, NodalPressure& /*pressure*/) const {}
  /// Whether there are sliders, which keep what they slid: their path has corners, and no way back.
  virtual bool has_friction() const { return false; }
  /// Whether much of what friction holds has not been pressed before this state.
  virtual bool is_pressed_first(const State& /*state*/) const { return false; }
  /// Writes the normal forces of this state, times `eased`, as those that bound its friction; of what has
  /// just touched in a solution (`solved`) alone, not in a foretold state.
  virtual void bound_friction(const State& /*state*/, bool /*solved*/, double /*eased*/,
                              std::vector<double>& /*all*/) const {}
  /// What friction holds in an accepted state over the most that it may hold, 0..1; 1 where what touches is
  /// not pressed yet.
  virtual double friction_in_use(const State& /*state*/) const { return 0; }
  /// Of sliders since the beginning, J, in an accepted state.
  virtual double friction_heat(const State& /*state*/) const { return 0; }
};

/// The least of the model's contacts: see ContactBlock.
double free_way(const Model& model, const State& from, const State& to);
bool edges_meet(const Model& model, const State& state);
/// Applies loads; false where what they move, being held, would pass through something.
bool apply_freely(const Model& model, State& state, const std::function<void(State&)>& apply);
/// Their sums; of the forces those on one place's surface, where it is not empty.
double contact_force(const Model& model, const State& state, std::string_view place = {});
double friction_heat(const Model& model, const State& state);
bool has_friction(const Model& model);
/// The largest of the model's contacts: see ContactBlock.
double friction_in_use(const Model& model, const State& state);
bool is_pressed_first(const Model& model, const State& state);
/// Bounds friction by the normal forces of this state, a solution or a foretold one, times `eased`; returns
/// the largest change of a bound, over the largest of those that change.
double bound_friction(const Model& model, State& state, bool solved, double eased = 1);

/// Normal force over area as drawn, per node, Pa, the sum over contacts; 0 inside. Empty: no surface of a
/// solid may touch anything.
/// Of the state's displacements alone.
std::vector<double> contact_pressure(const Model& model, const State& state);

} // namespace dielast::fem
