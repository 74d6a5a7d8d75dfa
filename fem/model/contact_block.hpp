// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/model.hpp"

namespace dielast::fem {

/// Elements that keep things apart.
class ContactBlock : public ElementBlock {
 public:
  /// The part of the straight way between two states, 0..1, that can be gone without passing through what
  /// is touched; 1: all of it.
  virtual double free_way(const State& from, const State& to) const = 0;
  /// Sum of the normal forces, N.
  virtual double contact_force(const State& state) const = 0;
  /// Whether there are sliders, which keep what they slid: their path has corners, and no way back.
  virtual bool has_friction() const { return false; }
  /// Of sliders since the beginning, J, in an accepted state.
  virtual double friction_heat(const State& /*state*/) const { return 0; }
};

/// The least of the model's contacts: see ContactBlock.
double free_way(const Model& model, const State& from, const State& to);
/// Their sums.
double contact_force(const Model& model, const State& state);
double friction_heat(const Model& model, const State& state);
bool has_friction(const Model& model);

} // namespace dielast::fem
