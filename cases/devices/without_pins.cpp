// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/without_pins.hpp"

#include "cases/case/holding.hpp"
#include "fem/linear/rest.hpp"
#include "fem/linear/rigid_motions.hpp"
#include "fem/paths/renumbering.hpp"

namespace dielast::cases {

WithoutPins::WithoutPins(const Case& one, const Device& device, fem::Equilibrium& equilibrium,
                         const fem::State& state)
    : given_(device), equilibrium_(equilibrium), state_(state) {
  if (!device.pinned || !drifts()) return;
  own_.emplace(build_device(held_by(one, {std::vector<char>(one.supports.size()), false})));
  own_equilibrium_.emplace(own_->model, equilibrium.assembler().workers().count());
  state_ = fem::Renumbering(device.model.dofs, own_->model.dofs)(state);
}

void WithoutPins::take_off_drift(std::vector<fem::HarmonicResponse>& responses) {
  if (!drifts()) return;
  const fem::State at = fem::relaxed(state_);
  const fem::RigidMotions rigid =
      fem::rigid_motions(equilibrium(), at, fem::free_mass(equilibrium(), at), true);
  Eigen::MatrixXd parts(rigid.motions.rows(), 2);
  for (fem::HarmonicResponse& response : responses) {
    parts << response.displacement.real(), response.displacement.imag();
    rigid.take_off(parts);
    response.displacement.real() = parts.col(0);
    response.displacement.imag() = parts.col(1);
  }
}

} // namespace dielast::cases
