// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/chamber.hpp"

#include "cases/text/diagnostics.hpp"
#include "cases/warnings/held_places.hpp"
#include "fem/elements/chamber_block.hpp"
#include "meshing/solids/sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

namespace dielast::cases {

meshing::CellBlock wall_of_chamber(const Case& one, const meshing::Mesh& mesh) {
  const std::string& place = one.chamber->place;
  if (place.empty()) return *mesh.film();
  if (one.dimension != fem::Dimension::spatial)
    return meshing::sides_at(mesh, place, meshing::CellType::meridian3);
  // It must be closed, or be so with its mirror images, or its volume would depend on where its edge is.
  meshing::CellBlock faces = meshing::faces_at(mesh, place);
  if (!one.geometry<HollowSphere>() && !meshing::is_closed(faces))
    throw one.error_at("chamber.at",
                       fmt::format("the surface \"{}\" has an edge; a chamber in a solid is closed", place));
  return faces;
}

namespace {

/// Tells of every edge whether a pressure has a potential there, see fem/elements/chamber_block.hpp.
class Edges {
 public:
  Edges(const Case& one, const meshing::Mesh& mesh, bool free_body, const fem::Model& model)
      : one_(one), mesh_(mesh), held_(one, mesh, model.dofs), free_body_(free_body), extent_(model.extent) {}

  /// Of a meridian: held along z, it may move along the radius.
  bool is_level(int node) const { return rests({&node, 1}, 2); }
  void require_potential(std::span<const int> edge, bool of_meridian) const {
    const bool upright = rests(edge, 0) && (of_meridian || rests(edge, 1));
    const bool fits = of_meridian
                          ? is_level(edge[0])
                          : (rests(edge, 2) && lies(edge, 2, 0)) || slides(edge, 0) || slides(edge, 1);
    if (upright || fits) return;
    const Eigen::Vector3d& x = drawn(edge[0]);
    const std::string at = of_meridian ? fmt::format("x = {:.4g} mm, z = {:.4g} mm", 1e3 * x.x(), 1e3 * x.z())
                                       : fmt::format("x = {:.4g} mm, y = {:.4g} mm, z = {:.4g} mm",
                                                     1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z());
    const char* remedy =
        of_meridian
            ? "let a [[support]] fix x or z there, in all steps and without a displacement along it"
            : "let a [[support]] fix x and y there, or z where z = 0, or y of an edge along x (x of one "
              "along y), in all steps and without a displacement along these";
    const char* key = !one_.chamber->place.empty() ? "chamber.at"
                      : one_.chamber->pressure     ? "chamber.pressure"
                                                   : "chamber.volume";
    throw CaseError(
        {{one_.where(key), "chamber",
          fmt::format("the surface on which it presses has an edge at {} ({}) that may move across "
                      "itself, where a pressure has no potential: its work depends on the way. "
                      "Close the surface, or {}",
                      at, place_of(edge), remedy)}});
  }

 private:
  bool rests(std::span<const int> nodes, int axis) const {
    return std::ranges::all_of(nodes, [&](int node) {
      const bool on_axis =
          one_.dimension == fem::Dimension::axisymmetric && axis == 0 && drawn(node).x() <= 1e-12 * extent_;
      return on_axis || (!free_body_ && held_.rests(node, axis)); // a pin holds what would not move anyhow
    });
  }
  bool lies(std::span<const int> edge, int axis, double at) const {
    return std::ranges::all_of(edge,
                               [&](int node) { return std::abs(drawn(node)[axis] - at) <= 1e-9 * extent_; });
  }
  /// Whether a side of triangles stays in its plane across the axis x or y, as in a plane of symmetry.
  bool slides(std::span<const int> edge, int axis) const {
    return rests(edge, axis) && lies(edge, axis, drawn(edge[0])[axis]);
  }
  const Eigen::Vector3d& drawn(int node) const { return mesh_.nodes[static_cast<std::size_t>(node)]; }
  /// The smallest place that has the whole edge.
  std::string place_of(std::span<const int> edge) const {
    const std::pair<const std::string, std::vector<int>>* found = nullptr;
    for (const auto& place : mesh_.node_sets)
      if (std::ranges::all_of(edge,
                              [&](int node) { return std::ranges::binary_search(place.second, node); }) &&
          (!found || place.second.size() < found->second.size()))
        found = &place;
    return found ? fmt::format("on \"{}\"", found->first) : "on no named place";
  }

  const Case& one_;
  const meshing::Mesh& mesh_;
  HeldPlaces held_;
  bool free_body_;
  double extent_; ///< of the model, m
};

/// The holes in the film around which a plate's edge runs and which it closes, m^2, in a part of a device
/// that edge and planes of symmetry through the origin; 0 where the film goes on below the plate.
double area_under_plate(const Case& one, const meshing::Mesh& mesh, const meshing::CellBlock& wall) {
  const std::vector<int>& edge = mesh.node_sets.at(one.plate->place);
  const auto drawn = [&](int node) { return mesh.nodes[static_cast<std::size_t>(node)]; };
  const auto turned = [&](int from, int to) { // about the origin, the area between
    return (drawn(from).x() * drawn(to).y() - drawn(from).y() * drawn(to).x()) / 2;
  };
  double area = 0;
  std::map<int, int> ends; // sides that leave a node, less those that come to it
  for (const meshing::OuterSide& side : meshing::outer_sides(wall)) {
    const std::span<const int> corners = side.corners();
    if (!std::ranges::all_of(corners, [&](int node) { return std::ranges::binary_search(edge, node); }))
      continue;
    if (corners.size() == 1) { // a circle, around which the film lies or within
      const double radius = drawn(corners[0]).x();
      const bool around =
          std::ranges::all_of(wall.cell(side.cell), [&](int node) { return drawn(node).x() >= radius; });
      area += (around ? 1 : -1) * std::numbers::pi * radius * radius;
    } else { // the film lies on its left
      const int from = corners[0], to = corners[1];
      const std::span<const int> middle = side.middles(); // of a parabola
      area -= middle.empty() ? turned(from, to)
                             : (4 * (turned(from, middle[0]) + turned(middle[0], to)) - turned(from, to)) / 3;
      ++ends[from];
      --ends[to];
    }
  }
  const double off = 1e-9 * mesh.bounds().diagonal().norm();
  for (const auto& [end, count] : ends)
    if (const Eigen::Vector3d x = drawn(end); count != 0 && std::min(std::abs(x.x()), std::abs(x.y())) > off)
      throw one.error_at(
          "plate.at",
          fmt::format(
              "found \"{}\": what of the [chamber] this plate closes is not known, as its edge ends at "
              "x = {:.4g} mm, y = {:.4g} mm: it is closed, or ends where x = 0 or y = 0 is a plane of "
              "symmetry",
              one.plate->place, 1e3 * x.x(), 1e3 * x.y()));
  if (area < 0)
    throw one.error_at("plate.at", "how far a chamber reaches under a plate that lies around the film is not "
                                   "known: the plate must close a hole in it");
  return area;
}

} // namespace

void add_chamber(const Case& one, const meshing::Mesh& mesh, bool free_body, fem::Model& model) {
  if (!one.chamber) return;
  const std::size_t port = model.ports.size();
  model.ports.push_back({.name = "chamber", .chamber = fem::Chamber{one.chamber->bulk_modulus}});
  const meshing::CellBlock wall = wall_of_chamber(one, mesh);
  model.blocks.push_back(fem::make_pressure_block(mesh, wall, port));
  const bool of_meridian = meshing::is_meridian(wall.type);
  const Edges edges(one, mesh, free_body, model);
  std::vector<int> level;
  for (const meshing::OuterSide& side : meshing::outer_sides(wall)) {
    const std::span<const int> edge = side.nodes();
    edges.require_potential(edge, of_meridian);
    if (of_meridian && edges.is_level(edge[0]) && mesh.nodes[static_cast<std::size_t>(edge[0])].z() != 0)
      level.push_back(edge[0]);
  }
  if (!level.empty()) model.blocks.push_back(fem::make_level_edge_block(mesh, wall, level, port));
  if (!one.plate || !one.chamber->place.empty()) return;
  if (const double area = area_under_plate(one, mesh, wall); area > 0)
    model.blocks.push_back(
        fem::make_lid_block(mesh, {mesh.node_sets.at(one.plate->place).front(), area}, port));
}

} // namespace dielast::cases
