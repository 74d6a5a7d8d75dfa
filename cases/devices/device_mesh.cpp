// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/device.hpp"

#include "cases/tables/regions.hpp"
#include "meshing/assembly.hpp"
#include "meshing/bars.hpp"
#include "meshing/gmsh/gmsh_reader.hpp"
#include "meshing/honeycomb_mesh.hpp"
#include "meshing/meridian.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/patch.hpp"
#include "meshing/refine.hpp"
#include "meshing/regions/region_mesh.hpp"
#include "meshing/rings.hpp"
#include "meshing/solids/fill.hpp"
#include "meshing/solids/slab.hpp"
#include "meshing/solids/surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

namespace dielast::cases {

namespace {

template<class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template<class... Functions> // Clang 14 deduces none for aggregates
Overloaded(Functions...)->Overloaded<Functions...>;

/// Cells of a block that belong to one of the places, ascending.
std::vector<int> cells_in(const meshing::Mesh& mesh, const meshing::CellBlock& block,
                          const std::vector<std::string>& places) {
  std::set<int> cells;
  for (const std::string& place : places)
    if (const std::vector<int>* own = mesh.cells_of(place, &block)) cells.insert(own->begin(), own->end());
  return {cells.begin(), cells.end()};
}

/// A user's mesh in m, of its lines only those along which there are bars, and of triangles none where there
/// are tetrahedra: others only name places.
meshing::Mesh film_and_bars(meshing::Mesh mesh, double unit, const std::vector<std::string>& bars) {
  for (auto& x : mesh.nodes) x *= unit;
  const bool in_space = std::ranges::any_of(
      mesh.blocks, [](const meshing::CellBlock& block) { return meshing::is_tetrahedron(block.type); });
  for (int b = static_cast<int>(mesh.blocks.size()) - 1; b >= 0; --b) {
    meshing::CellBlock& block = mesh.blocks[static_cast<std::size_t>(b)];
    const bool surface = in_space && meshing::is_triangle(block.type);
    if (!surface && !meshing::is_line(block.type)) continue;
    const std::vector<int> kept = surface ? std::vector<int>{} : cells_in(mesh, block, bars);
    std::vector<int> number(static_cast<std::size_t>(block.size()), -1);
    for (std::size_t k = 0; k < kept.size(); ++k)
      number[static_cast<std::size_t>(kept[k])] = static_cast<int>(k);
    block = meshing::subset(block, kept);
    for (auto place = mesh.cell_sets.begin(); place != mesh.cell_sets.end();) {
      meshing::CellSet& set = place->second;
      const bool lies_here = set.block == b;
      if (lies_here)
        for (int& cell : set.cells) cell = number[static_cast<std::size_t>(cell)];
      const bool only_names = lies_here && (std::erase(set.cells, -1) > 0 || set.cells.empty());
      place = only_names ? mesh.cell_sets.erase(place) : std::next(place);
    }
    if (!kept.empty()) continue;
    mesh.blocks.erase(mesh.blocks.begin() + b);
    for (auto& [name, set] : mesh.cell_sets) set.block -= set.block > b;
  }
  return mesh;
}

/// What a user's surface bounds, in the file's unit (m). `size`: of tetrahedra, m.
meshing::Mesh filled_surface(const std::string& path, std::optional<double> size, double unit) {
  const meshing::Surface surface = meshing::read_surface(path);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : surface.points) box.extend(x);
  constexpr double parts = 10; // of its extent, where nothing is said
  return meshing::filled(surface, size ? *size / unit : box.diagonal().norm() / parts);
}

/// A disc or an annulus in which regions are drawn.
meshing::Mesh mesh_of_regions(const Part& part, const std::vector<meshing::Region>& regions) {
  const meshing::RoundFilm film = *round_film(part);
  meshing::Mesh mesh =
      meshing::region_mesh(film, regions, part.mesh.rings, std::max(1.0, part.mesh.grading), part.mesh.order);
  if (film.inner_radius == 0) { // the places of a disc that is all electrode
    mesh.cell_sets["electrode"] = mesh.cell_sets.at("film");
    mesh.node_sets["electrode"] = mesh.node_sets.at("film");
    mesh.node_sets["electrode_edge"] = mesh.node_sets.at("rim");
  }
  return mesh;
}

/// The mesh of a part, as it is drawn by itself.
meshing::Mesh mesh_of(const Part& part, fem::Dimension dimension, int patch_order,
                      const std::vector<std::string>& bars) {
  const MeshOptions& options = part.mesh;
  const bool of_revolution = dimension == fem::Dimension::axisymmetric;
  if (const auto regions = regions_of(part); !regions.empty()) return mesh_of_regions(part, regions);
  return std::visit(
      Overloaded{
          [](std::monostate) { return meshing::Mesh{}; },
          [&](const Honeycomb& h) {
            return meshing::honeycomb_mesh(
                {h.angle, h.columns, h.wall_length}, {options.order, options.wall_elements, options.grading},
                {h.wall_bond == WallBond::width ? h.wall.width : 0, h.electrode_gap});
          },
          [&](const Disc& d) {
            const double electrode = d.electrode_radius.value_or(d.radius);
            if (of_revolution)
              return meshing::disc_meridian(d.radius, electrode, options.rings, options.order);
            return meshing::disc_mesh(d.radius, electrode, options.rings, options.order, true);
          },
          [&](const Annulus& a) {
            if (of_revolution)
              return meshing::annulus_meridian(a.inner_radius, a.outer_radius, options.rings, options.order,
                                               options.grading);
            return meshing::annulus_mesh(a.inner_radius, a.outer_radius, options.rings, options.order, true,
                                         options.grading);
          },
          [&](const Balloon& b) { return meshing::balloon_meridian(b.radius, options.rings, options.order); },
          [&](const Patch& p) {
            return meshing::patch_mesh(p.length * part.film->prestretch[0],
                                       p.width * part.film->prestretch[1], patch_order);
          },
          [&](const Strip& s) {
            return meshing::strip_mesh(
                {s.length, s.width, s.free_electrode(), s.electrode_width.value_or(s.width)}, options.across,
                options.order);
          },
          [&](const Roll& roll) {
            const double along = part.film->prestretch[0];
            return meshing::roll_meridian(roll.length * along, roll.radius,
                                          roll.electrode_length.value_or(roll.length) * along, options.rings,
                                          options.order);
          },
          [&](const Line& line) {
            const Eigen::Vector3d from(line.from.data()), to(line.to.data());
            return part.rod ? meshing::rod_mesh(from, to)
                            : meshing::line_mesh(from, to, options.wall_elements, options.order);
          },
          [&](const AntagonisticRolls& rolls) {
            return meshing::rolls_mesh({rolls.length * part.film->prestretch[0], part.hinge->length,
                                        part.hinge->beam.width, part.ribbon->length, rolls.arm},
                                       options.wall_elements, options.order);
          },
          [&](const Slab& s) {
            const meshing::SlabShape shape{s.length, s.height, of_revolution ? s.inner_radius : 0.0,
                                           s.electrode.value_or(std::array{0.0, s.length}),
                                           s.cover_thickness};
            if (s.width && dimension == fem::Dimension::spatial)
              return meshing::block_mesh({shape, *s.width, s.electrode_width.value_or(*s.width)},
                                         options.across, options.grading);
            return meshing::slab_mesh(shape, options.across, options.grading, of_revolution);
          },
          [&](const HollowSphere& h) {
            return (of_revolution ? meshing::hollow_sphere_mesh : meshing::sphere_eighth_mesh)(
                h.inner_radius, h.outer_radius, options.across);
          },
          [&](const MeshFile& file) {
            const double unit = options.unit.value_or(1);
            meshing::Mesh mesh = meshing::is_surface_file(file.path)
                                     ? filled_surface(file.path, options.size, unit)
                                     : meshing::read_gmsh(file.path);
            for (int i = 0; i < options.refine; ++i) mesh = meshing::refined(std::move(mesh));
            return film_and_bars(std::move(mesh), unit, bars);
          },
      },
      part.geometry);
}

/// Turns a mesh about z and moves its origin to where the part is.
void place(meshing::Mesh& mesh, const Part& part) {
  const Eigen::Vector3d origin(part.at.data());
  const double half_turns = std::round(part.turned / std::numbers::pi); // without round-off where it is one
  const double sine =
      std::abs(part.turned - half_turns * std::numbers::pi) < 1e-12 ? 0 : std::sin(part.turned);
  const double cosine = std::cos(part.turned);
  for (auto& x : mesh.nodes)
    x = origin + Eigen::Vector3d(cosine * x.x() - sine * x.y(), sine * x.x() + cosine * x.y(), x.z());
}

} // namespace

meshing::Mesh build_mesh(const Case& one) {
  std::vector<std::string> bars;
  for (const Part& part : one.parts)
    if (part.beam) bars.push_back(part.place);
  // Two triangles of any order are exact for a patch; one mesh has triangles of one order.
  const bool curved = std::ranges::any_of(one.parts, [](const Part& part) {
    return part.has_mesh() && !std::holds_alternative<Patch>(part.geometry) && part.mesh.order == 2;
  });
  meshing::Mesh whole;
  try {
    for (const Part& part : one.parts) {
      if (!part.has_mesh()) continue;
      meshing::Mesh mesh = mesh_of(part, one.dimension, curved ? 2 : 1, bars);
      if (part.name.empty()) {
        whole = std::move(mesh);
        continue;
      }
      place(mesh, part);
      meshing::append(whole, mesh, part.name);
    }
    for (const TiedPlaces& tie : one.ties)
      if (std::ranges::all_of(tie.between,
                              [&](const auto& place) { return whole.node_sets.contains(place); }))
        meshing::join(whole, tie.between[0], tie.between[1]);
  } catch (const std::invalid_argument& error) {
    throw meshing::MeshError(error.what());
  }
  return whole;
}

} // namespace dielast::cases
