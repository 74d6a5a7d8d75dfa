// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/contact/face_contact_block.hpp"
#include "fem/contact/surface_contact_block.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/paths/ramp.hpp"
#include "fem/solids/solid_block.hpp"
#include "meshing/parts/assembly.hpp"
#include "meshing/solids/grid.hpp"
#include "meshing/solids/sides.hpp"

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace dielast::fem {

constexpr double mu = 45e3; ///< Pa, of the bodies

/// Two bodies, `upper` and `lower`, with the places `axis` (x = 0), `face` (what may touch) and `back`; the
/// lower back keeps its height, the upper one is moved down. In space they have the place `deep`, too (z =
/// 0). Both are held on `axis` and `deep`, across these; with friction they are not, the lower one's back
/// sticks, and the upper one's is free where `backs_stick` is false.
struct TwoBodies {
  TwoBodies(const meshing::Mesh& lower, const meshing::Mesh& upper, Dimension drawn, Barrier barrier,
            bool backs_stick, double size, bool lower_is_rigid = false, double friction = 0)
      : dimension(drawn), up(drawn == Dimension::axisymmetric ? 2 : 1) {
    meshing::append(mesh, lower, "lower");
    meshing::append(mesh, upper, "upper");
    meshing::CellBlock solid = mesh.blocks[0];
    if (lower_is_rigid)
      solid.nodes.erase(solid.nodes.begin(), solid.nodes.begin() + std::ssize(lower.blocks[0].nodes));
    const auto count = static_cast<std::size_t>(solid.size());
    SolidCells cells{solid, std::vector<int>(count, passive), std::vector<int>(count, 0)};
    const SolidSection section{.material = {.law = materials::NeoHookean{mu}}, .thickness = 1};
    const bool in_space = dimension == Dimension::spatial;
    const auto face = [&](const char* place) {
      return in_space ? meshing::faces_at(mesh, place)
                      : meshing::sides_at(mesh, place, meshing::CellType::meridian3);
    };
    model.dofs = DofMap(mesh.node_count());
    model.blocks.push_back(make_solid_block(mesh, cells, {section}, {}, dimension));
    const std::array<std::string, 2> places{"lower.face", "upper.face"};
    const std::array<meshing::CellBlock, 2> faces{face("lower.face"), face("upper.face")};
    const std::optional<double> width = up == 2 ? std::nullopt : std::optional(1.0);
    model.blocks.push_back(in_space
                               ? make_face_contact_block(mesh, {places, faces, barrier, friction})
                               : make_surface_contact_block(mesh, {places, faces, width, barrier, friction}));
    for (const auto& block : model.blocks) {
      block->place_scalars(model.dofs);
      block->claim_dofs(model.dofs, dimension);
    }
    for (const char* body : {"lower.", "upper."}) {
      if (lower_is_rigid && body[0] == 'l') continue;
      const bool sticks = backs_stick || (friction > 0 && body[0] == 'l');
      for (const int node : nodes(std::string(body) + "back")) {
        if (friction == 0 || sticks) model.dofs.hold(node, up);
        if (sticks) model.dofs.hold(node, 0);
        if (sticks && in_space) model.dofs.hold(node, 2);
      }
      if (friction > 0) continue;
      for (const int node : nodes(std::string(body) + "axis")) model.dofs.hold(node, 0);
      if (!in_space) continue;
      for (const int node : nodes(std::string(body) + "deep")) model.dofs.hold(node, 2);
    }
    model.dofs.number();
    model.place_histories();
    model.extent = size;
    model.length_scale = 0.01 * size;
  }
  const std::vector<int>& nodes(const std::string& place) const { return mesh.node_sets.at(place); }
  State press(double depth, double tolerance, int increments = 10) {
    Equilibrium equilibrium(model, 1);
    LoadPath path;
    path.apply = [&](State& state, double s) {
      for (const int node : nodes("upper.back"))
        state.displacement[static_cast<std::size_t>(node)][up] = -s * depth;
    };
    const RampOptions options{.newton = {.tolerance = tolerance, .max_iterations = 80},
                              .increments = increments,
                              .smallest_increment = 1e-6};
    RampProgress progress = RampProgress::begin(model.initial_state(), model.dofs, options);
    EXPECT_EQ(ramp(equilibrium, path, options, progress, {}).end, RampEnd::complete) << progress.load_factor;
    equilibrium.internal_force(progress.points.back().state, force);
    return progress.points.back().state;
  }
  /// With which a place's support holds it, N.
  double reaction(const std::string& place) const {
    double sum = 0;
    for (const int node : nodes(place)) sum += force[model.dofs.equation(node, up)];
    return sum;
  }
  NodalPressure pressure(const State& state) const {
    NodalPressure all{std::vector<double>(mesh.nodes.size(), 0), std::vector<double>(mesh.nodes.size(), 0)};
    dynamic_cast<const ContactBlock&>(*model.blocks[1]).add_pressure(state, all);
    return all;
  }

  Dimension dimension;
  int up;
  meshing::Mesh mesh;
  Model model{.dofs = DofMap(0)};
  Eigen::VectorXd force;
};

inline meshing::Mesh named(meshing::TriangleGrid grid, double face, double back) {
  grid.name_nodes("axis", [](double u, double) { return u == 0; });
  grid.name_nodes("face", [face](double, double v) { return v == face; });
  grid.name_nodes("back", [back](double, double v) { return v == back; });
  return grid.take();
}

inline std::vector<double> even_line(double from, double to, int parts) {
  std::vector<double> line;
  for (int i = 0; i <= parts; ++i) line.push_back(i == parts ? to : from + (to - from) * i / parts);
  return line;
}

} // namespace dielast::fem
