// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/model.hpp"

#include <cmath>
#include <limits>

namespace dielast::fem::test {

/// A free film in equal-biaxial stretch l = 1 + u as one element: u is node 0's x displacement (m, of a film
/// of 1 m). Energy: W(l) - C Phi^2 / 2 with I1 = 2 l^2 + l^-4, W = -mu J/2 ln(1 - (I1 - 3)/J) (Gent; J =
/// infinity: neo-Hookean) and C = l^4; mu = 1 Pa, permittivity 1 F/m, thickness and volume 1, so that Phi is
/// Phi/H sqrt(eps/mu).
class MaterialPoint final : public ElementBlock {
 public:
  explicit MaterialPoint(double stretch_limit) : stretch_limit_(stretch_limit) {}

  int element_count() const override { return 1; }
  int dofs_per_element() const override { return 1; }
  void claim_dofs(DofMap& dofs, Dimension) override { dofs.add(0, 0); }
  void element_equations(int, const DofMap& dofs, std::span<int> equations) const override {
    equations[0] = dofs.equation(0, 0);
  }
  Evaluation evaluate(const State& state, int, int, const Scatter& scatter) const override {
    const double l = stretch(state), phi = state.voltage[0];
    const double I = 2 * l * l + std::pow(l, -4), dI = 4 * l - 4 * std::pow(l, -5),
                 ddI = 4 + 20 * std::pow(l, -6);
    const double room =
        stretch_limit_ == std::numeric_limits<double>::infinity() ? 1 : 1 - (I - 3) / stretch_limit_;
    if (!(l > 0) || !(room > 0)) return {0, false};
    const double dW = dI / (2 * room), ddW = ddI / (2 * room) + dI * dI / (2 * stretch_limit_ * room * room);
    const double residual = dW - 2 * phi * phi * std::pow(l, 3), tangent = ddW - 6 * phi * phi * l * l;
    if (scatter.residual) scatter.add_residual(0, {&residual, 1});
    if (scatter.tangent) scatter.add_tangent(0, {&tangent, 1});
    const double W = room == 1 ? (I - 3) / 2 : -stretch_limit_ / 2 * std::log(room);
    return {W - phi * phi * std::pow(l, 4) / 2, true};
  }
  void sample(const State&, Samples&) const override {}
  void add_charges(const State& state, const DofMap* dofs, Charges& charges) const override {
    const double l = stretch(state), phi = state.voltage[0];
    charges.capacitance[0] += std::pow(l, 4);
    charges.charge[0] += phi * std::pow(l, 4);
    if (dofs) charges.coupling[0][dofs->equation(0, 0)] += 4 * phi * std::pow(l, 3);
  }

 private:
  static double stretch(const State& state) { return 1 + state.displacement[0].x(); }
  double stretch_limit_;
};

/// Voltage that keeps the film in equilibrium at stretch l.
inline double equilibrium_voltage(double stretch_limit, double l) {
  const double room = 1 - (2 * l * l + std::pow(l, -4) - 3) / stretch_limit;
  return std::sqrt((std::pow(l, -2) - std::pow(l, -8)) / room);
}

inline std::unique_ptr<Model> material_point(double stretch_limit) {
  auto model = std::make_unique<Model>(Model{.dofs = DofMap(1), .blocks = {}, .ports = {{"electrode"}}});
  model->blocks.push_back(std::make_unique<MaterialPoint>(stretch_limit));
  model->blocks[0]->claim_dofs(model->dofs, Dimension::planar);
  model->dofs.number();
  return model;
}

} // namespace dielast::fem::test
