// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/elements/point_mass_block.hpp"
#include "fem/paths/ramp.hpp"
#include "meshing/meridian.hpp"
#include "meshing/rings.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::test {

struct DiaphragmData {
  double shear_modulus = 40e3, density = 960, mass = 0.1, damping = 0;
  std::vector<materials::Branch> branches;
  std::optional<Circuit> circuit{};
  int elements = 40; ///< along the meridian
  int rings = 0;     ///< more than 0: of 6-node triangles instead
};

/// Film of H = 1 mm stretched 2 x 2, on a ring of 68.58 mm radius; a plate of 12.7 mm radius in the middle
/// moves along z alone. One electrode, permittivity 4.7.
struct Diaphragm {
  explicit Diaphragm(const DiaphragmData& data)
      : mesh(data.rings > 0 ? meshing::annulus_mesh(12.7e-3, 68.58e-3, data.rings, 2, true)
                            : meshing::annulus_meridian(12.7e-3, 68.58e-3, data.elements, 2, 4)) {
    const bool flat = data.rings > 0;
    const Dimension dimension = flat ? Dimension::spatial : Dimension::axisymmetric;
    const MembraneSection film{.material = {.law = materials::NeoHookean{data.shear_modulus},
                                            .dielectric = {.permittivity = 4.7 * 8.8541878128e-12},
                                            .density = data.density,
                                            .branches = data.branches},
                               .thickness = 1e-3,
                               .prestretch = {2, 2}};
    const std::vector<int> electrode(static_cast<std::size_t>(mesh.blocks[0].size()), 0);
    const std::vector<int>& inner = mesh.node_sets.at("inner");
    model.blocks.push_back(
        make_membrane_block(mesh, mesh.blocks[0], film, electrode, dimension, flat ? 6 : 3));
    model.blocks.push_back(make_point_mass_block({{inner.front(), 2, data.mass, data.damping}}));
    for (const auto& block : model.blocks) block->claim_dofs(model.dofs, dimension);
    for (const int a : inner) {
      for (const int c : {0, 1}) model.dofs.hold(a, c);
      model.dofs.share(inner.front(), a, 2);
    }
    for (const int a : mesh.node_sets.at("outer"))
      for (const int c : {0, 1, 2}) model.dofs.hold(a, c);
    model.dofs.number();
    model.ports[0].circuit = data.circuit;
    model.place_histories();
    model.length_scale = 1e-3;
    model.extent = 68.58e-3;
    plate = model.dofs.equation(inner.front(), 2);
    weight = 9.81 * data.mass;
  }

  /// Relaxed equilibrium under the weight and this voltage (of the source, where there is a circuit).
  State settled(Equilibrium& equilibrium, double volts) const {
    State state = model.initial_state();
    RampOptions options{.newton = {.tolerance = 1e-12}, .increments = 8};
    RampProgress progress = RampProgress::begin(state, model.dofs, options);
    Loads target = progress.start;
    target.voltage[0] = volts * (model.ports[0].circuit ? model.ports[0].circuit->steady_share() : 1);
    target.dead_force[plate] = -weight;
    const RampResult result =
        ramp(equilibrium, linear_path(model.dofs, progress.start, target), options, progress, {});
    EXPECT_EQ(result.end, RampEnd::complete);
    state = progress.points.back().state;
    if (!model.ports[0].circuit) return state;
    state.supply[0] = Supply::circuit;
    state.source[0] = volts;
    model.charge_circuits(state);
    return state;
  }
  double drop(const State& state) const {
    return -state.displacement[static_cast<std::size_t>(mesh.node_sets.at("inner").front())].z();
  }

  meshing::Mesh mesh;
  Model model{.dofs = DofMap(mesh.node_count()), .blocks = {}, .ports = {{"film"}}};
  int plate = 0;     ///< equation of its height
  double weight = 0; ///< N
};

} // namespace dielast::fem::test
