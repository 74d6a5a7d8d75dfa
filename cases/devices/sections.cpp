// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/sections.hpp"

#include "cases/case/film_cells.hpp"
#include "cases/case/part_kind.hpp"
#include "cases/text/diagnostics.hpp"
#include "fem/elements/capacitor_block.hpp"
#include "fem/films/membrane_block.hpp"
#include "meshing/mesh_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace dielast::cases {
namespace {

/// Electrode over each triangle of the film itself, or of the layer of that name.
std::vector<int> electrode_map(const Case& one, const meshing::Mesh& mesh, const meshing::CellBlock& film,
                               const std::string& layer) {
  std::vector<int> map(static_cast<std::size_t>(film.size()), fem::passive);
  for (std::size_t e = 0; e < one.electrodes.size(); ++e) {
    if (!one.electrodes[e].ground.empty()) continue; // a surface
    if (one.electrodes[e].layer != layer) continue;
    const std::vector<int>* cells = mesh.cells_of(one.electrodes[e].place, &film);
    const std::string key = fmt::format("electrode[{}].place", e + 1);
    if (!cells)
      throw one.error_at(key,
                         fmt::format("\"{}\" is no part of the film, which an electrode covers: an edge, "
                                     "a point, or bars",
                                     one.electrodes[e].place));
    for (const int cell : *cells) {
      int& electrode = map[static_cast<std::size_t>(cell)];
      if (electrode != fem::passive)
        throw one.error_at(key, fmt::format("\"{}\" overlaps the electrode \"{}\"", one.electrodes[e].place,
                                            one.electrodes[static_cast<std::size_t>(electrode)].name));
      electrode = static_cast<int>(e);
    }
  }
  return map;
}

/// Film under the electrode of a layer must have that layer, which must have a permittivity.
void require_layers(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts) {
  for (std::size_t e = 0; e < one.electrodes.size(); ++e) {
    const Electrode& electrode = one.electrodes[e];
    if (electrode.layer.empty()) continue;
    const std::vector<int>* cells = mesh.cells_of(electrode.place, mesh.film());
    for (std::size_t i = 0; cells && i < cells->size(); ++i) {
      const int part = parts[static_cast<std::size_t>((*cells)[i])];
      const std::vector<Layer>& layers = one.parts[static_cast<std::size_t>(part)].film->further_layers;
      const auto layer = std::ranges::find(layers, electrode.layer, &Layer::name);
      const bool is_there = layer != layers.end();
      if (!is_there || layer->material.dielectric.permittivity == 0)
        throw one.error_at(fmt::format("electrode[{}].layer", e + 1),
                           fmt::format("some film of \"{}\" has no layer \"{}\"{}", electrode.place,
                                       electrode.layer, is_there ? " with a permittivity" : ""));
    }
  }
}

} // namespace

std::vector<int> film_parts(const Case& one, const meshing::Mesh& mesh) {
  const meshing::CellBlock& film = *mesh.film();
  std::vector<int> parts(static_cast<std::size_t>(film.size()), -1);
  const auto claim = [&](std::size_t p, const std::string& place, bool alone) {
    const std::vector<int>* cells = mesh.cells_of(place, &film);
    if (!cells)
      throw one.error_at(one.parts[p].key_prefix() + "place",
                         fmt::format("\"{}\" is no film of the mesh", place));
    for (const int cell : *cells) {
      int& part = parts[static_cast<std::size_t>(cell)];
      if (alone && part >= 0 && !one.parts[static_cast<std::size_t>(part)].has_mesh())
        throw one.error_at(one.parts[p].key_prefix() + "place",
                           fmt::format("\"{}\" overlaps the part \"{}\"", place,
                                       one.parts[static_cast<std::size_t>(part)].name));
      part = static_cast<int>(p);
    }
  };
  for (std::size_t p = 0; p < one.parts.size(); ++p)
    if (one.parts[p].has_mesh() && one.parts[p].film) claim(p, one.parts[p].called("film"), false);
  for (std::size_t p = 0; p < one.parts.size(); ++p)
    if (!one.parts[p].has_mesh() && one.parts[p].film) claim(p, one.parts[p].place, true);
  if (const auto without = std::ranges::count(parts, -1); without > 0)
    throw meshing::MeshError(
        fmt::format("{} of the film's {} elements belong to no part with a film; {}", without, film.size(),
                    one.unnamed() && one.unnamed()->film
                        ? "[film] is that of the mesh's own group \"film\": rename the group, or add a "
                          "[part.NAME] with the others' place"
                        : "add [film], or a [part.NAME] with their place"));
  return parts;
}

void add_films(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts, fem::Model& model) {
  const meshing::CellBlock& film = *mesh.film();
  const std::vector<int> electrodes = electrode_map(one, mesh, film, "");
  require_layers(one, mesh, parts);
  for (const PartKind& kind : part_kinds()) {
    std::vector<PartFilm> films;
    for (std::size_t p = 0; p < one.parts.size(); ++p) {
      if (kind_of(one.parts[p]) != &kind) continue;
      PartFilm own{&one.parts[p], cells_of_part(parts, p), {}, {}};
      if (own.cells.empty()) continue;
      const auto over_cells = [&](const std::vector<int>& all) {
        std::vector<int> over;
        for (const int cell : own.cells) over.push_back(all[static_cast<std::size_t>(cell)]);
        return over;
      };
      own.electrodes = over_cells(electrodes);
      for (const Layer& layer : one.parts[p].film->further_layers)
        own.of_layers.push_back(layer.name.empty() ? std::vector<int>(own.cells.size(), fem::passive)
                                                   : over_cells(electrode_map(one, mesh, film, layer.name)));
      films.push_back(std::move(own));
    }
    if (!films.empty()) kind.add(one, mesh, films, model);
  }
}

void add_capacitors(const Case& one, fem::Model& model) {
  const Part* const part = one.unnamed();
  const auto* strip = one.geometry<Strip>();
  for (std::size_t e = 0; e < one.electrodes.size(); ++e) {
    double beside = one.electrodes[e].stray_capacitance;
    if (strip && one.electrodes[e].place == "electrode") {
      const auto in_clamps = [&](const auto& film) {
        const materials::Dielectric& dielectric = film.material.dielectric;
        const auto [along_x, along_y] = film.prestretch;
        const double area = strip->layers * strip->clamped_electrode() *
                            strip->electrode_width.value_or(strip->width) / (along_x * along_y);
        return dielectric.permittivity * area / film.thickness *
               materials::capacitance_ratio_value(dielectric, along_x * along_x + along_y * along_y,
                                                  along_x * along_x * along_y * along_y);
      };
      const std::string& layer = one.electrodes[e].layer;
      beside += layer.empty()
                    ? in_clamps(*part->film)
                    : in_clamps(*std::ranges::find(part->film->further_layers, layer, &Layer::name));
    }
    if (beside > 0) model.blocks.push_back(fem::make_capacitor_block({e, beside}));
  }
}

namespace {

/// A wall as drawn: straight, between joints.
struct DrawnWall {
  const std::vector<int>* nodes;
  Eigen::Vector3d from, to;

  DrawnWall(const std::vector<int>& own, const meshing::Mesh& mesh) : nodes(&own) {
    const auto at = [&](int node) -> const Eigen::Vector3d& {
      return mesh.nodes[static_cast<std::size_t>(node)];
    };
    const auto farthest = [&](const Eigen::Vector3d& x) {
      return at(*std::ranges::max_element(own, {}, [&](int node) { return (at(node) - x).norm(); }));
    };
    from = farthest(at(own.front()));
    to = farthest(from);
  }
  double length() const { return (to - from).norm(); }
  double distance(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d along = to - from;
    return (x - from - std::clamp((x - from).dot(along) / along.squaredNorm(), 0.0, 1.0) * along).norm();
  }
};

/// The place on a wall's axis whose section holds a point under it: beside the point, but near a joint. There
/// the faces of two walls meet at a corner, a length m from the joint along either wall, and must move alike:
/// the corner goes with the joint, and what lies within 3 m of it with sections of all of that length.
Eigen::Vector3d holding_section(const DrawnWall& wall, const Eigen::Vector3d& x,
                                const std::vector<DrawnWall>& walls) {
  constexpr double spread = 3;
  const bool first = (x - wall.from).norm() < (x - wall.to).norm();
  const Eigen::Vector3d &joint = first ? wall.from : wall.to, &other = first ? wall.to : wall.from;
  const Eigen::Vector3d along = (other - joint).normalized();
  double station = (x - joint).dot(along);
  const Eigen::Vector3d beside = x - joint - station * along;
  const double close = 1e-6 * wall.length();
  for (const DrawnWall& next : walls) {
    const bool starts = (next.from - joint).norm() < close, ends = (next.to - joint).norm() < close;
    const Eigen::Vector3d away = (starts ? next.to - next.from : next.from - next.to).normalized();
    if (&next == &wall || !(starts || ends) || beside.dot(away) <= 0) continue;
    const double corner =
        beside.norm() * (1 + along.dot(away)) / along.cross(away).norm(); // d / tan(angle / 2)
    const double last = std::min(spread * corner, wall.length() / 2);
    if (station < last)
      station = corner < last ? std::max(0.0, (station - corner) * last / (last - corner)) : 0;
    break;
  }
  return joint + station * along;
}

} // namespace

void clamp_under_walls(const Case& one, const meshing::Mesh& mesh, fem::DofMap& dofs) {
  for (const Part& part : one.parts) {
    const auto* lattice = std::get_if<Honeycomb>(&part.geometry);
    if (!lattice || lattice->wall_bond != WallBond::width) continue;
    const auto at = [&](int node) -> const Eigen::Vector3d& {
      return mesh.nodes[static_cast<std::size_t>(node)];
    };
    std::vector<DrawnWall> walls;
    for (const auto& [name, nodes] : mesh.node_sets)
      if (name.starts_with(part.called("wall["))) walls.emplace_back(nodes, mesh);
    const auto& of_walls = mesh.node_sets.at(part.called("walls"));
    for (const int node : mesh.node_sets.at(part.called("under_walls"))) {
      if (std::ranges::binary_search(of_walls, node)) continue;
      const auto wall =
          std::ranges::min_element(walls, {}, [&](const DrawnWall& w) { return w.distance(at(node)); });
      const Eigen::Vector3d section = holding_section(*wall, at(node), walls);
      const int master =
          *std::ranges::min_element(*wall->nodes, {}, [&](int m) { return (at(m) - section).norm(); });
      dofs.tie({node, master, at(node) - at(master)});
    }
  }
}

void check_film_in_space(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts,
                         double extent) {
  std::map<int, std::pair<double, double>> range;
  const meshing::CellBlock& film = *mesh.film();
  for (int cell = 0; cell < film.size(); ++cell)
    for (const int node : film.cell(cell)) {
      const double z = mesh.nodes[static_cast<std::size_t>(node)].z();
      auto& [low, high] = range.try_emplace(parts[static_cast<std::size_t>(cell)], z, z).first->second;
      low = std::min(low, z);
      high = std::max(high, z);
    }
  for (const auto& [number, z] : range) {
    if (z.second - z.first <= 1e-9 * extent) continue;
    const Part& part = one.parts[static_cast<std::size_t>(number)];
    const std::string film_keys = part.key_prefix() + "film.";
    if (part.film->section != FilmSection::shell)
      throw one.error_at(
          film_keys + "section",
          "this film is not drawn in a plane of constant z, as a membrane must be: film that "
          "resists bending may be curved as drawn (section = \"shell\"), a closed surface of a "
          "solid is filled with section = \"solid\"");
    const auto require_unstretched = [&](const std::array<double, 2>& stretch, const std::string& key) {
      if (stretch != std::array{1.0, 1.0})
        throw one.error_at(film_keys + key, "a shell that is not drawn in a plane of constant z is free of "
                                            "stress as drawn: leave out prestretch");
    };
    require_unstretched(part.film->prestretch, "prestretch");
    for (std::size_t l = 0; l < part.film->further_layers.size(); ++l)
      require_unstretched(part.film->further_layers[l].prestretch,
                          fmt::format("layer[{}].prestretch", l + 1));
  }
}

} // namespace dielast::cases
