// SPDX-License-Identifier: GPL-3.0-or-later
// The meshes of the geometries, as they are drawn by themselves.
#include "cases/case/part_kind.hpp"
#include "meshing/bars/bars.hpp"
#include "meshing/gmsh/gmsh_reader.hpp"
#include "meshing/gmsh/refine.hpp"
#include "meshing/honeycomb_mesh.hpp"
#include "meshing/meridian.hpp"
#include "meshing/patch.hpp"
#include "meshing/rings.hpp"
#include "meshing/solids/fill.hpp"
#include "meshing/solids/slab.hpp"
#include "meshing/solids/surface.hpp"

#include <algorithm>
#include <set>

namespace dielast::cases {

namespace {

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

} // namespace

meshing::Mesh mesh_of(const NoGeometry&, const Drawing&) { return {}; }

meshing::Mesh mesh_of(const Honeycomb& h, const Drawing& drawing) {
  const MeshOptions& options = drawing.part.mesh;
  return meshing::honeycomb_mesh({h.angle, h.columns, h.wall_length},
                                 {options.order, options.wall_elements, options.grading},
                                 {h.wall_bond == WallBond::width ? h.wall.width : 0, h.electrode_gap});
}

meshing::Mesh mesh_of(const Disc& d, const Drawing& drawing) {
  const MeshOptions& options = drawing.part.mesh;
  const double electrode = d.electrode_radius.value_or(d.radius);
  if (drawing.of_revolution) return meshing::disc_meridian(d.radius, electrode, options.rings, options.order);
  return meshing::disc_mesh(d.radius, electrode, options.rings, options.order, true);
}

meshing::Mesh mesh_of(const Annulus& a, const Drawing& drawing) {
  const MeshOptions& options = drawing.part.mesh;
  if (drawing.of_revolution)
    return meshing::annulus_meridian(a.inner_radius, a.outer_radius, options.rings, options.order,
                                     options.grading);
  return meshing::annulus_mesh(a.inner_radius, a.outer_radius, options.rings, options.order, true,
                               options.grading);
}

meshing::Mesh mesh_of(const Balloon& b, const Drawing& drawing) {
  return meshing::balloon_meridian(b.radius, drawing.part.mesh.rings, drawing.part.mesh.order);
}

meshing::Mesh mesh_of(const Patch& p, const Drawing& drawing) {
  const auto& [along, across] = drawing.part.film->prestretch;
  return meshing::patch_mesh(p.length * along, p.width * across, drawing.patch_order);
}

meshing::Mesh mesh_of(const Strip& s, const Drawing& drawing) {
  return meshing::strip_mesh({s.length, s.width, s.free_electrode(), s.electrode_width.value_or(s.width)},
                             drawing.part.mesh.across, drawing.part.mesh.order);
}

meshing::Mesh mesh_of(const Roll& roll, const Drawing& drawing) {
  const double along = drawing.part.film->prestretch[0];
  return meshing::roll_meridian(roll.length * along, roll.radius,
                                roll.electrode_length.value_or(roll.length) * along, drawing.part.mesh.rings,
                                drawing.part.mesh.order);
}

meshing::Mesh mesh_of(const Line& line, const Drawing& drawing) {
  const Eigen::Vector3d from(line.from.data()), to(line.to.data());
  return kind_of(drawing.part)->line(from, to, drawing.part.mesh);
}

meshing::Mesh mesh_of(const AntagonisticRolls& rolls, const Drawing& drawing) {
  const Part& part = drawing.part;
  return meshing::rolls_mesh({rolls.length * part.film->prestretch[0], part.hinge->length,
                              part.hinge->beam.width, part.ribbon->length, rolls.arm},
                             part.mesh.wall_elements, part.mesh.order);
}

meshing::Mesh mesh_of(const Slab& s, const Drawing& drawing) {
  const MeshOptions& options = drawing.part.mesh;
  const meshing::SlabShape shape{s.length, s.height, drawing.of_revolution ? s.inner_radius : 0.0,
                                 s.electrode.value_or(std::array{0.0, s.length}), s.cover_thickness};
  if (s.width && drawing.in_space)
    return meshing::block_mesh({shape, *s.width, s.electrode_width.value_or(*s.width)}, options.across,
                               options.grading);
  return meshing::slab_mesh(shape, options.across, options.grading, drawing.of_revolution);
}

meshing::Mesh mesh_of(const HollowSphere& h, const Drawing& drawing) {
  return (drawing.of_revolution ? meshing::hollow_sphere_mesh : meshing::sphere_eighth_mesh)(
      h.inner_radius, h.outer_radius, drawing.part.mesh.across);
}

meshing::Mesh mesh_of(const MeshFile& file, const Drawing& drawing) {
  const MeshOptions& options = drawing.part.mesh;
  const double unit = options.unit.value_or(1);
  meshing::Mesh mesh = meshing::is_surface_file(file.path) ? filled_surface(file.path, options.size, unit)
                                                           : meshing::read_gmsh(file.path);
  for (int i = 0; i < options.refine; ++i) mesh = meshing::refined(std::move(mesh));
  return film_and_bars(std::move(mesh), unit, drawing.bars);
}

} // namespace dielast::cases
