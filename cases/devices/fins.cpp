// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/fins.hpp"

#include "fem/elements/point_mass_block.hpp"

#include <cmath>
#include <numbers>

namespace dielast::cases {

namespace {

Eigen::Vector3d across(const FinPoints& fin, const fem::State& state) {
  return state.rotation[static_cast<std::size_t>(fin.master)] * Eigen::Vector3d::Unit(fin.along);
}

} // namespace

std::vector<FinPoints> add_fin_nodes(const Case& one, meshing::Mesh& mesh) {
  // Gauss points: exact for |v| v of a fin that turns about a point beside it.
  const double inner = std::sqrt(0.6) / 2;
  const std::array<std::pair<double, double>, 3> gauss{
      {{0.5 - inner, 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + inner, 5.0 / 18}}};
  std::vector<FinPoints> fins;
  for (const Fin& fin : one.fins) {
    const Eigen::Vector3d front(fin.from.data()), end(fin.to.data());
    FinPoints& points = fins.emplace_back(
        FinPoints{.master = mesh.node_sets.at(fin.body).front(), .along = fin.along, .length = end - front});
    const double length = points.length.norm();
    const double mass = fin.added_mass_coefficient * fin.fluid_density * std::numbers::pi / 4 * fin.height *
                        fin.height * length;
    const double drag = fin.drag_coefficient * fin.fluid_density / 2 * fin.height * length;
    for (const auto& [at, weight] : gauss) {
      mesh.nodes.push_back(front + at * points.length);
      points.points.push_back({mesh.node_count() - 1, weight * mass, weight * drag});
    }
    const Eigen::Vector3d half =
        fin.height / 2 * points.length.normalized().cross(Eigen::Vector3d::Unit(fin.along));
    const auto corner = [&mesh](const Eigen::Vector3d& x) {
      mesh.nodes.push_back(x);
      return mesh.node_count() - 1;
    };
    points.corners = {corner(front + half), corner(front - half), corner(end - half), corner(end + half)};
  }
  return fins;
}

std::vector<fem::PointMass> fluid_around(const std::vector<FinPoints>& fins) {
  std::vector<fem::PointMass> fluid;
  for (const FinPoints& fin : fins)
    for (const FinPoints::Point& at : fin.points)
      fluid.push_back({.node = at.node, .axis = fin.along, .mass = at.mass, .drag = at.drag});
  return fluid;
}

void tie_fins(const std::vector<FinPoints>& fins, const meshing::Mesh& mesh, fem::DofMap& dofs) {
  const auto drawn = [&mesh](int node) { return mesh.nodes[static_cast<std::size_t>(node)]; };
  for (const FinPoints& fin : fins) {
    const auto tie = [&](int node) { dofs.tie({node, fin.master, drawn(node) - drawn(fin.master)}); };
    for (const FinPoints::Point& at : fin.points) tie(at.node);
    for (const int node : fin.corners) tie(node);
  }
}

FinLoad load_on(const FinPoints& fin, const fem::Model& model, const fem::State& state) {
  FinLoad load;
  if (!state.motion) return load;
  for (const FinPoints::Point& at : fin.points) {
    const int e = model.dofs.equation(at.node, fin.along);
    const double velocity = state.motion->velocity[e];
    const double given =
        at.mass * state.motion->acceleration_now[e] + at.drag * std::abs(velocity) * velocity;
    load.force -= given;
    load.power += given * velocity;
  }
  // The fluid pushes along the normal of the fin, and so along its front where it has turned.
  load.thrust = -load.force * across(fin, state).dot(fin.length.normalized());
  return load;
}

double turn_of(const FinPoints& fin, const fem::State& state) {
  return std::acos(std::min(1.0, std::abs(across(fin, state)[fin.along])));
}

} // namespace dielast::cases
