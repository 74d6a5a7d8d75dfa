// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/device.hpp"
#include "fem/linear/harmonic.hpp"

#include <optional>
#include <span>
#include <vector>

namespace dielast::cases {

/// Holds three (planar) or six displacements such that rigid motions are excluded and no reaction can arise:
/// of these nodes, the first ones, that next to the middle, one far from it along x and, in space, one far
/// along y, or along other axes where nothing lies along these. Of revolution one, along the axis.
/// Axes are those of what is drawn turned about z by `quarters` of a turn, 0..3: a device is held alike then.
std::vector<Pin> pin(std::span<const Eigen::Vector3d> nodes, fem::Dimension dimension, int quarters,
                     fem::DofMap& dofs);

/// A state of a pinned body in space, turned and moved so that it lies as it was drawn: its film's normal, in
/// the mean of least squares over its area, is the axis along which three nodes are pinned, its middle along
/// that axis where it was; in the plane the pins hold what they do, but of a film that is drawn oblique,
/// which turns back as a whole. Dead forces turn along: it stays in equilibrium. Nothing where it lies so
/// already.
std::optional<fem::State> upright(const Device& device, const fem::State& state);

/// By which all parts of the case with meshes of their own are turned; 0 where they are not by one and the
/// same.
int quarter_turns(const Case& one);

/// A device in a state as it vibrates: one that is pinned, as nothing else holds it, without its pins, if it
/// has a mass. All that is given must outlive this.
class WithoutPins {
 public:
  WithoutPins(const Case& one, const Device& device, fem::Equilibrium& equilibrium, const fem::State& state);

  const Device& device() const { return own_ ? *own_ : given_; }
  fem::Equilibrium& equilibrium() { return own_equilibrium_ ? *own_equilibrium_ : equilibrium_; }
  const fem::State& state() const { return state_; }
  /// Nothing holds it but its mass.
  bool drifts() const { return given_.free_body && given_.model.inertia().mass.nonZeros() > 0; }
  /// Of responses to voltages, which push nothing as a whole.
  void take_off_drift(std::vector<fem::HarmonicResponse>& responses);

 private:
  const Device& given_;
  fem::Equilibrium& equilibrium_;
  fem::State state_;
  std::optional<Device> own_;
  std::optional<fem::Equilibrium> own_equilibrium_;
};

} // namespace dielast::cases
