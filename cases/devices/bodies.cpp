// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/bodies.hpp"

#include "cases/text/diagnostics.hpp"
#include "fem/elements/point_mass_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace dielast::cases {

namespace {

/// The nodes of its places, each once.
std::set<int> nodes_of(const Body& body, const meshing::Mesh& mesh) {
  std::set<int> nodes;
  for (const std::string& place : body.places) {
    const auto& at = mesh.node_sets.at(place);
    nodes.insert(at.begin(), at.end());
  }
  return nodes;
}

/// As it is given, or the centroid of the places: by their lengths or areas, of points by the number of
/// nodes.
Eigen::Vector3d centre_of(const Body& body, const meshing::Mesh& mesh, const PlaceShares& shares) {
  if (body.centre) return Eigen::Vector3d(body.centre->data());
  const bool points =
      std::ranges::any_of(body.places, [&](const std::string& place) { return shares.at(place).size == 0; });
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double whole = 0;
  for (const std::string& place : body.places) {
    const std::vector<int>& nodes = mesh.node_sets.at(place);
    const meshing::Shares& share = shares.at(place);
    const double weight = points ? static_cast<double>(nodes.size()) : share.size;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      sum += weight * share.of_nodes[n] * mesh.nodes[static_cast<std::size_t>(nodes[n])];
    whole += weight;
  }
  return sum / whole;
}

/// Point masses, from the centre, with the mass and the moments of a body: pairs on the axes, at the distance
/// d at which nothing is left for the centre, 2 m d^2 = Ix + Iy + Iz. In the plane one pair has all; what is
/// of revolution does not turn.
std::vector<std::pair<Eigen::Vector3d, double>> equivalent_masses(const Body& body,
                                                                  fem::Dimension dimension) {
  if (body.mass == 0) return {};
  const bool planar = dimension == fem::Dimension::planar;
  const auto& [x, y, z] = body.inertia;
  const double sum = dimension == fem::Dimension::axisymmetric ? 0 : planar ? z : (x + y + z) / 2;
  if (sum == 0) return {{Eigen::Vector3d::Zero(), body.mass}};
  const double distance = std::sqrt(sum / body.mass);
  const std::array<double, 3> share =
      planar ? std::array{1.0, 0.0, 0.0}
             : std::array{(y + z - x) / (2 * sum), (z + x - y) / (2 * sum), (x + y - z) / (2 * sum)};
  std::vector<std::pair<Eigen::Vector3d, double>> masses;
  for (int c = 0; c < 3; ++c)
    if (const double half = share[static_cast<std::size_t>(c)] / 2; half > 0)
      for (const double side : {distance, -distance})
        masses.emplace_back(side * Eigen::Vector3d::Unit(c), half * body.mass);
  return masses;
}

} // namespace

std::vector<BodyNodes> add_body_nodes(const Case& one, const PlaceShares& shares, meshing::Mesh& mesh) {
  std::vector<BodyNodes> all;
  const auto add = [&mesh](const Eigen::Vector3d& x) {
    mesh.nodes.push_back(x);
    return mesh.node_count() - 1;
  };
  for (const Body& body : one.bodies) {
    const Eigen::Vector3d centre = centre_of(body, mesh, shares);
    BodyNodes nodes{add(body.pivot ? Eigen::Vector3d(body.pivot->data()) : centre), {}, body.damping_rate};
    for (const auto& [from_centre, mass] : equivalent_masses(body, one.dimension))
      nodes.masses.emplace_back(add(centre + from_centre), mass);
    mesh.node_sets[body.name] = {nodes.master};
    all.push_back(std::move(nodes));
  }
  return all;
}

std::vector<fem::PointMass> body_masses(const std::vector<BodyNodes>& bodies) {
  std::vector<fem::PointMass> masses;
  for (const BodyNodes& body : bodies)
    for (const auto& [node, mass] : body.masses)
      for (int c = 0; c < 3; ++c)
        masses.push_back({.node = node, .axis = c, .mass = mass, .damping = body.damping_rate * mass});
  return masses;
}

void tie_bodies(const Case& one, const std::vector<BodyNodes>& nodes, const meshing::Mesh& mesh,
                fem::DofMap& dofs) {
  std::map<int, std::string> carrier;
  for (std::size_t b = 0; b < one.bodies.size(); ++b) {
    const Body& body = one.bodies[b];
    const int master = nodes[b].master;
    for (int c = 0; c < fem::DofMap::components; ++c) {
      if (!fem::moves(one.dimension, c)) continue;
      dofs.add(master, c);
      const bool on_axis = one.dimension == fem::Dimension::axisymmetric && c == 0; // its middle stays there
      if (body.fixed[static_cast<std::size_t>(c)] || (body.pivot && c < 3) || on_axis) dofs.hold(master, c);
    }
    const auto tie = [&](int node) {
      const auto m = static_cast<std::size_t>(master), n = static_cast<std::size_t>(node);
      dofs.tie({node, master, mesh.nodes[n] - mesh.nodes[m]});
    };
    for (const int node : nodes_of(body, mesh)) {
      if (const auto [other, fresh] = carrier.try_emplace(node, body.name); !fresh)
        throw CaseError({{{one.source.string()},
                          fmt::format("body[{}].places", b + 1),
                          fmt::format("the body \"{}\" carries a part of them, too", other->second)}});
      tie(node);
    }
    for (const auto& [node, mass] : nodes[b].masses) tie(node);
  }
}

} // namespace dielast::cases
