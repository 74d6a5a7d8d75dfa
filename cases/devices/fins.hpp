// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "fem/elements/point_mass_block.hpp"
#include "fem/model/model.hpp"
#include "meshing/mesh.hpp"

#include <vector>

namespace dielast::cases {

/// A fin as points along it, each with its share of the added mass and the drag.
struct FinPoints {
  struct Point {
    int node = 0;
    double mass = 0; ///< added, kg
    double drag = 0; ///< N s^2/m^2
  };
  int master = 0;         ///< of its body
  int along = 1;          ///< the axis across it, as drawn
  Eigen::Vector3d length; ///< from its front to its trailing end, as drawn, m
  std::vector<Point> points{};
  std::array<int, 4> corners{}; ///< nodes around it, for drawing
};

/// What the fluid does with a fin as it moves.
struct FinLoad {
  double force = 0;  ///< of the fluid, along the axis across the fin as drawn, N
  double thrust = 0; ///< of the fluid, normal to the fin as it has turned, along it towards its front, N
  double power = 0;  ///< given to the fluid, W
};

/// Adds the points and corners of all fins to the mesh, behind the nodes of the bodies.
std::vector<FinPoints> add_fin_nodes(const Case& one, meshing::Mesh& mesh);
std::vector<fem::PointMass> fluid_around(const std::vector<FinPoints>& fins);
/// Ties them to the masters of their bodies.
void tie_fins(const std::vector<FinPoints>& fins, const meshing::Mesh& mesh, fem::DofMap& dofs);

/// Nothing in a state without inertia.
FinLoad load_on(const FinPoints& fin, const fem::Model& model, const fem::State& state);
/// By how much the fin has turned away from the axis across it as drawn, rad.
double turn_of(const FinPoints& fin, const fem::State& state);

} // namespace dielast::cases
