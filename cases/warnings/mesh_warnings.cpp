// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/warnings/mesh_warnings.hpp"

#include "cases/case/film_cells.hpp"
#include "cases/case/quantity_kind.hpp"
#include "cases/language/conditions.hpp"
#include "cases/text/diagnostics.hpp"
#include "meshing/normals.hpp"
#include "meshing/quality.hpp"
#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>
#include <set>

namespace dielast::cases {

namespace {

/// The part that a place of a mesh of its own belongs to; null: it is of the unnamed part's mesh.
const Part* named_part_of(const std::string& place, const Case& one) {
  const auto owner = std::ranges::find_if(one.parts, [&](const Part& part) {
    return !part.name.empty() && (place == part.name || place.starts_with(part.name + "."));
  });
  return owner == one.parts.end() ? one.unnamed() : &*owner;
}

/// A sentence for every bar that is tied to a shell at one node: a point of a plate carries no moment about
/// its normal. What does is the stiffness that holds spins about directors, which falls with the elements'
/// area.
std::vector<std::string> drilling_warnings(const Case& one, const meshing::Mesh& mesh) {
  std::vector<std::string> warnings;
  for (std::size_t t = 0; t < one.ties.size(); ++t) {
    const auto& between = one.ties[t].between;
    const std::array parts{named_part_of(between[0], one), named_part_of(between[1], one)};
    const auto any = [&](auto&& is) {
      return std::ranges::any_of(parts, [&](const Part* p) { return p && is(*p); });
    };
    if (!any([](const Part& p) { return p.film && p.film->section == FilmSection::shell; }) ||
        !any([](const Part& p) { return p.beam.has_value(); }))
      continue;
    const auto nodes_of = [&](const std::string& place) {
      const auto found = mesh.node_sets.find(place);
      return found == mesh.node_sets.end() ? std::vector<int>{} : found->second;
    };
    const std::vector<int> first = nodes_of(between[0]), second = nodes_of(between[1]);
    std::vector<int> common;
    std::ranges::set_intersection(first, second, std::back_inserter(common));
    if (common.size() != 1) continue;
    const std::string key = fmt::format("tie[{}].between", t + 1);
    warnings.push_back(one.warning_at(
        key, fmt::format("\"{}\" and \"{}\" have one node in common: a point of a shell carries next to no "
                         "moment about the shell's normal, about which the bar hangs as on a hinge; let a "
                         "[[body]] carry a side of the shell, and the bar's end, instead",
                         between[0], between[1])));
  }
  return warnings;
}

/// Of film, or of a layer on it, as drawn.
template<class Layer>
double drawn_thickness(const Layer& layer) {
  return layer.thickness / (layer.prestretch[0] * layer.prestretch[1]);
}

/// A sentence for every part whose layers are not as thick as what they fill.
std::vector<std::string> layer_warnings(const Case& one) {
  std::vector<std::string> warnings;
  const auto warn = [&](const Part& part, const std::string& message) {
    warnings.push_back(fmt::format("{}film.thickness: {}", part.key_prefix(), message));
  };
  for (const Part& part : one.parts) {
    if (!part.film) continue;
    const auto* slab = std::get_if<Slab>(&part.geometry);
    const bool charged = std::ranges::any_of(one.electrodes, [&](const Electrode& electrode) {
      return named_part_of(electrode.place, one) == &part;
    });
    if (slab && charged && part.film->is_solid() && !part.film->stacked_along) {
      const double height = slab->height - 2 * slab->cover_thickness;
      const double layers = height / part.film->thickness;
      const double farthest = std::max({slab->height, slab->length, slab->width.value_or(0)});
      const bool reaches_beyond = !one.ties.empty(); // from part to part
      if (part.film->potential && part.film->thickness > (1 + 1e-9) * farthest && !reaches_beyond)
        warn(part,
             fmt::format("it is the distance of the electrodes, {}, and the slab is no larger than {}",
                         post::engineering(part.film->thickness, "m"), post::engineering(farthest, "m")));
      if (!part.film->potential && (layers < 1 - 1e-9 || std::abs(layers - std::round(layers)) > 0.01))
        warn(part, fmt::format("a layer is {} thick, and where there is a field the slab is {} high, {:.4g} "
                               "layers: a stack has a whole number of them",
                               post::engineering(part.film->thickness, "m"), post::engineering(height, "m"),
                               layers));
    }
    if (const auto* roll = std::get_if<Roll>(&part.geometry)) {
      const double wall = roll->turns * drawn_thickness(*part.film);
      if (wall > 2 * roll->radius)
        warn(part,
             fmt::format("the wall of {} layers is {} thick, more than twice the radius of its middle, "
                         "{}: a roll cannot be wound like that",
                         roll->turns, post::engineering(wall, "m"), post::engineering(roll->radius, "m")));
    }
    if (const auto* sphere = std::get_if<HollowSphere>(&part.geometry)) {
      const double wall = sphere->outer_radius - sphere->inner_radius;
      if (std::abs(part.film->thickness - wall) > 1e-6 * wall)
        warn(part, fmt::format("{} has no effect here: from the inner to the outer radius it is {}",
                               post::engineering(part.film->thickness, "m"), post::engineering(wall, "m")));
    }
  }
  return warnings;
}

/// A sentence where a chamber is to hold far more than there is room for about the device.
std::vector<std::string> volume_warnings(const Case& one, const meshing::Mesh& mesh) {
  constexpr double far_more = 1e3;
  if (!one.chamber || !one.chamber->volume) return {};
  const auto [least, most] = one.chamber->volume->extremes();
  const double ball = std::numbers::pi / 6 * std::pow(mesh.bounds().diagonal().norm(), 3),
               volume = std::max(std::abs(least), std::abs(most));
  if (volume <= far_more * ball) return {};
  return {one.warning_at("chamber.volume",
                         fmt::format("{} is {:.1g} times as much as a ball as large as the device; a number "
                                     "without a unit is in m^3",
                                     post::engineering(volume, "m^3"), volume / ball))};
}

} // namespace

std::vector<std::string> mesh_warnings(const Case& one, const meshing::Mesh& mesh) {
  std::vector<std::string> warnings = drilling_warnings(one, mesh);
  std::ranges::move(volume_warnings(one, mesh), std::back_inserter(warnings));
  std::ranges::move(layer_warnings(one), std::back_inserter(warnings));
  if (one.dimension == fem::Dimension::spatial && one.any_geometry<HollowSphere>())
    warnings.push_back("hollow_sphere: in space its eighth at x, y, z >= 0 is computed; volumes, charges, "
                       "capacitances, energies and masses are those of the eighth");
  return warnings;
}

namespace {

/// But for those of bodies, which a body carries.
std::set<int> nodes_of_lines_and_places(const Case& one, const meshing::Mesh& mesh) {
  std::set<int> all;
  if (mesh.walls()) all.insert(mesh.walls()->nodes.begin(), mesh.walls()->nodes.end());
  for (const auto& [place, nodes] : mesh.node_sets)
    if (std::ranges::find(one.bodies, place, &Body::name) == one.bodies.end())
      all.insert(nodes.begin(), nodes.end());
  return all;
}

/// The mean angle, rad, between neighbours of a surface of 6-node triangles where these stand for facets of a
/// curved one: many meet at angles, none of them wide. 0 where they are curved or in one plane, or meet along
/// few folds.
double angle_of_facets(const meshing::Mesh& mesh, const meshing::CellBlock& film) {
  constexpr double least = 0.01, fold = 0.8; // rad
  constexpr double many = 0.1;
  std::map<int, std::vector<Eigen::Vector3d>> normals; // at the middles of sides
  const auto at = [&mesh](int node) -> const Eigen::Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(node)];
  };
  for (int cell = 0; cell < film.size(); ++cell) {
    const auto nodes = film.cell(cell);
    bool straight = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d &a = at(nodes[k]), &b = at(nodes[(k + 1) % 3]);
      straight = straight && (at(nodes[3 + k]) - (a + b) / 2).norm() < 1e-6 * (b - a).norm();
    }
    if (!straight) continue;
    const auto own = meshing::normals(mesh.nodes, nodes);
    for (std::size_t k = 3; k < own.size(); ++k) normals[nodes[k]].push_back(own[k]);
  }
  int sides = 0, edges = 0;
  double sum = 0;
  for (const auto& [node, beside] : normals) {
    if (beside.size() != 2) continue;
    const double angle = std::atan2(beside[0].cross(beside[1]).norm(), beside[0].dot(beside[1]));
    ++sides;
    if (angle < least || angle > fold) continue;
    ++edges;
    sum += angle;
  }
  return edges > many * sides ? sum / edges : 0;
}

/// Which side is above, where a shell whose layers lie beside its surface, or are several, is not drawn with
/// that side upwards all over; "" otherwise.
std::string side_text(const Film& film, const meshing::Mesh& mesh, const meshing::CellBlock& cells) {
  if (film.offset == 0 && film.further_layers.empty()) return "";
  const std::vector<Eigen::Vector3d> normals = meshing::node_normals(mesh, cells);
  const auto lowest = std::ranges::min_element(
      cells.nodes, {}, [&](int node) { return normals[static_cast<std::size_t>(node)].z(); });
  const Eigen::Vector3d& normal = normals[static_cast<std::size_t>(*lowest)];
  if (normal.z() > 0.01) return "";
  const Eigen::Vector3d x = 1e3 * mesh.nodes[static_cast<std::size_t>(*lowest)];
  return fmt::format("the film is not drawn with one side upwards: above is the side of its normal, which at "
                     "({:.4g}, {:.4g}, {:.4g}) mm is ({:.2f}, {:.2f}, {:.2f})",
                     x.x(), x.y(), x.z(), normal.x(), normal.y(), normal.z());
}

/// A sentence for every support or load of a place that has no node of the film: what gmsh writes lacks the
/// triangles of surfaces without a physical name.
std::vector<std::string> warnings_of_missing_film(const Case& one, const meshing::Mesh& mesh) {
  std::vector<std::string> warnings;
  if (!one.any_geometry<MeshFile>() || std::ranges::any_of(one.parts, has_bars)) return warnings;
  const std::set<int> film(mesh.film()->nodes.begin(), mesh.film()->nodes.end());
  const auto check = [&](const char* section, const auto& objects) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      if (std::ranges::count(one.bodies, objects[i].place, &Body::name) > 0) continue;
      const std::vector<int>& nodes = mesh.node_sets.at(objects[i].place);
      if (std::ranges::any_of(nodes, [&](int node) { return film.contains(node); })) continue;
      warnings.push_back(one.warning_at(
          fmt::format("{}[{}].place", section, i + 1),
          fmt::format(
              "none of the {} nodes of \"{}\" is one of the film, so that nothing acts on it: give the "
              "surfaces beside it a physical name in the drawing, too",
              nodes.size(), objects[i].place)));
    }
  };
  check("support", one.supports);
  check("load", one.loads);
  return warnings;
}

} // namespace

std::vector<std::string> mesh_file_warnings(const Case& one, const meshing::Mesh& mesh,
                                            std::span<const int> parts) {
  constexpr double largest = 1; // m, of the templates' dimensions
  std::vector<std::string> warnings = warnings_of_missing_film(one, mesh);
  for (std::size_t p = 0; p < one.parts.size(); ++p) {
    if (!one.parts[p].film || std::ranges::count(parts, static_cast<int>(p)) > 0) continue;
    const std::string key = one.parts[p].key_prefix() + "film.thickness";
    warnings.push_back(one.warning_at(key, "has no effect here: other parts take all of this film"));
  }
  for (std::size_t p = 0; p < one.parts.size(); ++p) {
    const Part& part = one.parts[p];
    if (!part.film || part.film->section != FilmSection::shell) continue;
    const std::vector<int> cells = cells_of_part(parts, p);
    if (cells.empty()) continue;
    if (const std::string text = side_text(*part.film, mesh, meshing::subset(*mesh.film(), cells));
        !text.empty())
      warnings.push_back(one.warning_at(
          part.key_prefix() + (part.film->further_layers.empty() ? "film.offset" : "film.layer[1].thickness"),
          text));
  }
  for (const Part& owner : one.parts) {
    if (!std::holds_alternative<MeshFile>(owner.geometry)) continue;
    std::vector<int> cells;
    for (std::size_t cell = 0; cell < parts.size(); ++cell) {
      const Part& part = one.parts[static_cast<std::size_t>(parts[cell])];
      if (&part == &owner || (owner.name.empty() && !part.has_mesh()))
        cells.push_back(static_cast<int>(cell));
    }
    const meshing::CellBlock film = meshing::subset(*mesh.film(), cells);
    if (film.size() == 0) continue;
    const std::string part = owner.key_prefix();
    if (const int cut = meshing::nodes_on_others(mesh, film))
      warnings.push_back(
          fmt::format("{}the film is cut: {} of its nodes lie on others; let gmsh fragment the drawing to "
                      "join its parts",
                      part.empty() ? "" : part + "mesh: ", cut));
    // of several meshes nodes may lie on others to which they are tied
    if (std::ranges::count_if(one.parts, &Part::has_mesh) == 1)
      if (const int beside = meshing::nodes_beside(mesh, nodes_of_lines_and_places(one, mesh), film))
        warnings.push_back(fmt::format(
            "lines or places are not joined to the film: {} of their nodes lie on nodes of the film and are "
            "others, so that what they hold or stiffen is not the film; let gmsh join them (Coherence Mesh)",
            beside));
    if (const std::string key = part + "mesh.quadrature";
        film.type == meshing::CellType::triangle3 && owner.mesh.quadrature != MeshOptions{}.quadrature)
      warnings.push_back(one.warning_at(key, "has no effect here: the file's triangles have 3 nodes"));
    Eigen::AlignedBox3d box;
    for (const int node : film.nodes) box.extend(mesh.nodes[static_cast<std::size_t>(node)]);
    const Eigen::Vector3d size = box.sizes();
    const bool level = one.dimension != fem::Dimension::spatial || !(size.z() > 1e-9 * size.norm());
    if (const double angle =
            !level && film.type == meshing::CellType::triangle6 ? angle_of_facets(mesh, film) : 0)
      warnings.push_back(one.warning_at(
          part + "mesh.file",
          fmt::format("the film is made of flat facets, {:.2g} deg between neighbours: error estimates and "
                      "mesh.refine divide these and come no nearer to a curved surface; let gmsh put middle "
                      "nodes onto the surface (Mesh.SecondOrderLinear = 0)",
                      angle * 180 / std::numbers::pi)));
    const bool has_unit = owner.mesh.unit.has_value();
    if (!has_unit || size.maxCoeff() > largest)
      warnings.push_back(
          fmt::format("{}mesh.unit{}: the film is {} x {}", part,
                      has_unit ? "" : " is missing, one unit of the mesh file is taken for 1 m",
                      post::engineering(size.x(), "m"), post::engineering(size.y(), "m")));
  }
  return warnings;
}

std::vector<std::string> thickness_warnings(const Case& one, const meshing::Mesh& mesh,
                                            std::span<const int> parts) {
  constexpr double thin = 5;    // times its thickness a film is wide at least
  constexpr double slender = 3; // times its width a wall is long at least
  std::vector<std::string> warnings;
  for (const Part& part : one.parts)
    if (const auto* lattice = std::get_if<Honeycomb>(&part.geometry);
        lattice && lattice->wall_length < slender * lattice->wall.width)
      warnings.push_back(
          one.warning_at(part.key_prefix() + "honeycomb.wall_width",
                         fmt::format("walls are {} wide and {} long: they are beams, of slender walls",
                                     post::engineering(lattice->wall.width, "m"),
                                     post::engineering(lattice->wall_length, "m"))));
  const meshing::CellBlock& cells = *mesh.film();
  const bool meridian = meshing::is_meridian(cells.type);
  if (!meridian && !meshing::is_triangle(cells.type)) return warnings;
  std::vector<Eigen::AlignedBox3d> bounds(one.parts.size());
  for (int c = 0; c < cells.size(); ++c)
    for (const int node : cells.cell(c))
      bounds[static_cast<std::size_t>(parts[static_cast<std::size_t>(c)])].extend(
          mesh.nodes[static_cast<std::size_t>(node)]);
  for (std::size_t p = 0; p < one.parts.size(); ++p) {
    const std::optional<Film>& film = one.parts[p].film;
    if (!film || film->is_solid() || bounds[p].isEmpty() ||
        std::holds_alternative<Patch>(one.parts[p].geometry))
      continue;
    Eigen::Vector3d size = bounds[p].sizes();
    std::ranges::sort(size, std::greater<>());
    const double width = meridian ? size[0] : size[1];
    double thickness = drawn_thickness(*film);
    for (const Layer& layer : film->further_layers) thickness += drawn_thickness(layer);
    if (const auto* strip = std::get_if<Strip>(&one.parts[p].geometry))
      thickness = strip->layers * thickness + 2 * strip->cover_thickness;
    if (width < thin * thickness)
      warnings.push_back(fmt::format(
          "{}film.thickness: the film is {} thick and {} wide; membranes and shells are "
          "of thin films, section = \"solid\" of thick ones",
          one.parts[p].key_prefix(), post::engineering(thickness, "m"), post::engineering(width, "m")));
  }
  return warnings;
}

std::vector<std::string> share_warnings(const Case& one,
                                        const std::map<std::string, meshing::Shares>& shares) {
  std::set<std::string> places;
  for (const Load& load : one.loads) places.insert(load.place);
  for (const PointMass& mass : one.point_masses) places.insert(mass.place);
  for (const Spring& spring : one.springs) places.insert(spring.between.begin(), spring.between.end());
  for (const Linkage& linkage : one.linkages) places.insert(linkage.between.begin(), linkage.between.end());
  for (const Quantity& quantity : one.quantities) {
    places.insert(quantity.between.begin(), quantity.between.end());
    if (quantity.kind->shares) places.insert(quantity.place.empty() ? quantity.of : quantity.place);
  }
  std::vector<std::string> warnings;
  for (const std::string& place : places)
    if (const auto found = shares.find(place); found != shares.end() && found->second.mixed)
      warnings.push_back(
          fmt::format("\"{}\" has nodes beside the cells, faces or sides that make it: each of its {} nodes "
                      "has the same share in loads and means; name its parts apart",
                      place, found->second.of_nodes.size()));
  return warnings;
}

} // namespace dielast::cases
