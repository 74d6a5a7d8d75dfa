// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/attachments.hpp"

#include "cases/text/diagnostics.hpp"
#include "fem/elements/distance_block.hpp"
#include "fem/elements/point_mass_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::cases {

namespace {

fem::Distance distance(const meshing::Mesh& mesh, const PlaceShares& shares,
                       const std::array<std::string, 2>& between, int axis) {
  const auto end = [&](const std::string& place) {
    return fem::DistanceEnd{mesh.node_sets.at(place), shares.at(place).of_nodes};
  };
  return {{end(between[0]), end(between[1])}, axis};
}

/// Refuses what pushes along an axis along which its ends do not differ: rounding would say which way.
void require_a_direction(const Case& one, const meshing::Mesh& mesh, const fem::Distance& distance,
                         const std::array<std::string, 2>& between, const std::string& object,
                         double extent) {
  std::array<double, 2> at{};
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t n = 0; n < distance.ends[end].nodes.size(); ++n)
      at[end] += distance.ends[end].weights[n] *
                 mesh.nodes[static_cast<std::size_t>(distance.ends[end].nodes[n])][distance.axis];
  if (between[0] == between[1] || std::abs(at[1] - at[0]) > 1e-9 * extent) return;
  const std::string key = object + ".along";
  throw one.error_at(
      key,
      fmt::format("\"{}\" and \"{}\" are drawn at the same {}: along it nothing says which way it pushes; an "
                  "end on a [[body]] is at its centre, which may lie elsewhere",
                  between[0], between[1], "xyz"[distance.axis]));
}

/// The shares of a place's nodes, without those that have none.
std::vector<std::pair<int, double>> shares_at(const std::string& place, const meshing::Mesh& mesh,
                                              const PlaceShares& shares) {
  const auto& nodes = mesh.node_sets.at(place);
  const std::vector<double>& share = shares.at(place).of_nodes;
  std::vector<std::pair<int, double>> found;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (share[n] != 0) found.emplace_back(nodes[n], share[n]);
  return found;
}

} // namespace

void add_springs(const Case& one, const meshing::Mesh& mesh, const PlaceShares& shares, fem::Model& model) {
  const auto add = [&](const std::string& object, const auto& link, bool pushes,
                       const fem::DistancePotential& potential) {
    const fem::Distance along = distance(mesh, shares, link.between, link.along);
    if (pushes) require_a_direction(one, mesh, along, link.between, object, model.extent);
    model.blocks.push_back(fem::make_distance_block(mesh, along, potential));
  };
  for (std::size_t s = 0; s < one.springs.size(); ++s) {
    const Spring& spring = one.springs[s];
    add(fmt::format("spring[{}]", s + 1), spring, spring.free_length > 0,
        fem::Spring{spring.stiffness, spring.free_length});
  }
  for (std::size_t l = 0; l < one.linkages.size(); ++l) {
    const Linkage& linkage = one.linkages[l];
    add(fmt::format("linkage[{}]", l + 1), linkage, true,
        fem::Linkage{linkage.force, linkage.arm, linkage.strut, linkage.offset});
  }
}

void add_masses(const Case& one, const meshing::Mesh& mesh, const PlaceShares& shares, fem::Model& model) {
  std::vector<fem::PointMass> at_nodes;
  std::vector<fem::RelativeMass> between; // what is spread moves as the elements do
  if (one.plate)
    at_nodes.push_back({mesh.node_sets.at(one.plate->place).front(), 2, one.plate->mass, one.plate->damping});
  for (const PointMass& point : one.point_masses) {
    for (const auto& [node, share] : shares_at(point.place, mesh, shares))
      for (int c = 0; c < 3; ++c) at_nodes.push_back({node, c, point.mass * share, point.damping * share});
    for (const auto& [nodes, share] :
         meshing::common_shares(mesh, one.dimension == fem::Dimension::axisymmetric, point.place))
      between.push_back({nodes[0], nodes[1], -point.mass * share, -point.damping * share});
  }
  if (!at_nodes.empty()) model.blocks.push_back(fem::make_point_mass_block(std::move(at_nodes)));
  if (!between.empty()) model.blocks.push_back(fem::make_relative_mass_block(std::move(between)));
}

Eigen::VectorXd weight_of(const Case& one, const std::vector<BodyNodes>& bodies,
                          const std::vector<FinPoints>& fins, const meshing::Mesh& mesh,
                          const PlaceShares& shares, const fem::Model& model) {
  const fem::DofMap& dofs = model.dofs;
  const Eigen::Vector3d pull = one.gravity.acceleration * one.gravity.down();
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(dofs.count());
  const auto add = [&](int node, double mass) {
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(node, c); e != fem::DofMap::absent) weight[e] += mass * pull[c];
  };
  if (one.gravity.film) {
    Eigen::VectorXd falls = Eigen::VectorXd::Zero(dofs.count());
    for (int n = 0; n < dofs.node_count(); ++n)
      for (int c = 0; c < 3; ++c)
        if (const int e = dofs.equation(n, c); e != fem::DofMap::absent) falls[e] = one.gravity.down()[c];
    weight = one.gravity.acceleration * (model.inertia().mass * falls);
    for (const FinPoints& fin : fins) // the mass that they add is of a fluid, which floats
      for (const FinPoints::Point& at : fin.points)
        weight[dofs.equation(at.node, fin.along)] -= at.mass * pull[fin.along];
    return weight;
  }
  for (const BodyNodes& body : bodies)
    for (const auto& [node, mass] : body.masses) add(node, mass);
  if (one.plate) add(mesh.node_sets.at(one.plate->place).front(), one.plate->mass);
  for (const PointMass& point : one.point_masses)
    for (const auto& [node, share] : shares_at(point.place, mesh, shares)) add(node, point.mass * share);
  return weight;
}

} // namespace dielast::cases
