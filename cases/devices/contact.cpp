// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/sections.hpp"
#include "fem/contact/centreline.hpp"
#include "fem/contact/face.hpp"
#include "fem/contact/face_contact_block.hpp"
#include "fem/contact/plane_contact_block.hpp"
#include "fem/contact/surface_contact_block.hpp"
#include "fem/contact/wall_contact.hpp"
#include "fem/contact/wall_contact_block.hpp"
#include "meshing/solids/sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>

namespace dielast::cases {

namespace {

/// What a contact does as the mesh is drawn.
fem::Evaluation as_drawn(const fem::ElementBlock& block, const meshing::Mesh& mesh) {
  fem::State state;
  state.displacement.assign(mesh.nodes.size(), Eigen::Vector3d::Zero());
  return block.evaluate(state, 0, block.element_count(), {});
}

void add_walls(const Case& one, const Part& part, const meshing::Mesh& mesh, fem::Model& model) {
  const meshing::CellBlock& lines = *mesh.walls();
  const std::vector<double> widths = bars(one, mesh).widths;
  const fem::WallContactSearch walls(mesh, lines, widths);
  const auto at = [&](int node) -> const Eigen::Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(node)];
  };
  std::map<int, std::vector<int>> lines_at;
  for (int line = 0; line < lines.size(); ++line)
    for (const int node : lines.cell(line)) lines_at[node].push_back(line);
  std::vector<fem::ContactPair> pairs;
  for (const auto& place : mesh.node_sets) {
    if (!place.first.starts_with(part.called("cell["))) continue;
    const std::vector<int>& nodes = place.second;
    std::vector<int> around;
    std::map<int, double> length; // that a node stands for, by Simpson's rule
    for (int line = 0; line < lines.size(); ++line) {
      const auto own = lines.cell(line);
      if (!std::ranges::all_of(own, [&](int node) { return std::ranges::binary_search(nodes, node); }))
        continue;
      around.push_back(line);
      const double whole = (at(own[1]) - at(own[0])).norm();
      for (const int end : {own[0], own[1]}) length[end] += own.size() == 3 ? whole / 6 : whole / 2;
      if (own.size() == 3) length[own[2]] += whole * 4 / 6;
    }
    for (const auto& [node, stands_for] : length) {
      const std::vector<int>& meeting = lines_at.at(node);
      std::map<int, int> beams_at; // how many that it may touch have this end
      for (const int line : around) {
        if (!std::ranges::all_of(meeting, [&](int other) { return walls.may_touch(line, other); })) continue;
        const double touching =
            (widths[static_cast<std::size_t>(line)] + widths[static_cast<std::size_t>(meeting.front())]) / 2;
        constexpr int none = fem::ContactPair::none;
        const auto own = lines.cell(line);
        pairs.push_back({node, {own[0], own[1], own.size() == 3 ? own[2] : none}, touching, stands_for});
        for (const int end : {own[0], own[1]})
          if (++beams_at[end] > 1) pairs.push_back({node, {end, none, none}, touching, -stands_for});
      }
    }
  }
  const Beam& wall = std::get<Honeycomb>(part.geometry).wall;
  const double thickness = one.contact->thickness;
  // A gap of half the barrier's thickness carries about what strains a wall across itself by 1 %.
  model.blocks.push_back(fem::make_wall_contact_block(
      mesh, std::move(pairs), {thickness, 0.01 * wall.material.youngs_modulus * wall.height / thickness}));
  const fem::Evaluation drawn = as_drawn(*model.blocks.back(), mesh);
  if (!drawn.feasible || drawn.energy > 0)
    throw one.error_at(
        "contact.thickness",
        fmt::format("walls of a cell are closer as drawn than these {:.6g} mm", 1e3 * thickness));
}

/// How low, m, the faces or sides of a solid are that lie on a table. Throws CaseError where the place is not
/// all surface, or does not face down where it is lowest.
double lowest_of_underside(const Case& one, const meshing::Mesh& mesh, const meshing::CellBlock& sides,
                           int up) {
  const auto fail = [&one](const char* what) {
    throw one.error_at("table.at", fmt::format("\"{}\" {}: name the surface that lies on the table, at the "
                                               "bottom of the solid",
                                               one.table->place, what));
  };
  const auto drawn = [&mesh](int node) -> const Eigen::Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(node)];
  };
  const std::set<int> on_surface(sides.nodes.begin(), sides.nodes.end());
  if (!std::ranges::all_of(mesh.node_sets.at(one.table->place),
                           [&](int n) { return on_surface.contains(n); }))
    fail("is no surface, but has nodes inside the solid");
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const int node : on_surface) {
    lowest = std::min(lowest, drawn(node)[up]);
    highest = std::max(highest, drawn(node)[up]);
  }
  const double near = lowest + 1e-9 * (highest - lowest + mesh.bounds().sizes().norm());
  for (int side = 0; side < sides.size(); ++side) {
    const auto own = sides.cell(side);
    if (std::ranges::none_of(own, [&](int node) { return drawn(node)[up] <= near; })) continue;
    const Eigen::Vector3d along = drawn(own[1]) - drawn(own[0]), beside = drawn(own[2]) - drawn(own[0]);
    // Normals point into the solid, which lies on the right of the sides of triangles.
    const double steep = own.size() == 6 ? along.cross(beside).normalized()[up] : -along.x() / along.norm();
    if (steep > 1e-6) return lowest;
  }
  fail("does not face down where it is lowest");
  return lowest;
}

/// What the cells are made of that have sides of a surface.
struct Behind {
  double modulus = std::numeric_limits<double>::infinity(); ///< Young's, of the softest, Pa
  double width = 0;                                         ///< in plane strain, m: all have one

  double barrier_stiffness(double thickness) const { // a gap of half of it bears about 1 % of the modulus
    return 0.01 * modulus / thickness;
  }
};
Behind behind(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts,
              const meshing::CellBlock& sides) {
  const std::set<int> on_surface(sides.nodes.begin(), sides.nodes.end());
  Behind found;
  for (int cell = 0; cell < mesh.film()->size(); ++cell) {
    const auto own = mesh.film()->cell(cell);
    if (std::ranges::count_if(own, [&](int node) { return on_surface.contains(node); }) <
        std::ssize(sides.cell(0)))
      continue;
    const Film& film = *one.parts[static_cast<std::size_t>(parts[static_cast<std::size_t>(cell)])].film;
    found.modulus = std::min(found.modulus, 3 * materials::initial_shear_modulus(film.material.law));
    found.width = film.width;
  }
  return found;
}

/// The plane is where the barrier of the surface's lowest node begins.
void add_table(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts, fem::Model& model) {
  const bool of_revolution = one.dimension == fem::Dimension::axisymmetric,
             in_space = one.dimension == fem::Dimension::spatial;
  const int up = of_revolution ? 2 : 1;
  const double thickness = one.contact->thickness, height = mesh.bounds().sizes()[up];
  if (thickness > height)
    throw one.error_at("contact.thickness",
                       fmt::format("found {:.6g} mm, and what lies on the table is {:.6g} mm high: the solid "
                                   "may sink in by as much as the first",
                                   1e3 * thickness, 1e3 * height));
  const meshing::CellBlock sides =
      in_space ? meshing::faces_at(mesh, one.table->place)
               : meshing::sides_at(mesh, one.table->place, meshing::CellType::meridian3);
  const Behind solid = behind(one, mesh, parts, sides);
  fem::PlaneContact contact =
      in_space ? fem::surface_of(mesh, sides)
               : fem::surface_of(mesh, sides, of_revolution ? std::nullopt : std::optional(solid.width));
  contact.normal = Eigen::Vector3d::Unit(up);
  contact.origin = (lowest_of_underside(one, mesh, sides, up) - thickness) * contact.normal;
  contact.barrier = {.thickness = thickness, .stiffness = solid.barrier_stiffness(thickness), .foot = 1};
  contact.place = one.table->place;
  contact.friction = one.table->friction;
  model.blocks.push_back(fem::make_plane_contact_block(mesh, std::move(contact)));
}

/// Whether two surfaces cross as they are drawn: chords of their sides do.
bool cross(const meshing::Mesh& mesh, const meshing::CellBlock& one, const meshing::CellBlock& other,
           int up) {
  using Eigen::Vector2d;
  constexpr int chords = 8; // of a side
  const auto points = [&](std::span<const int> side) {
    std::array<Vector2d, 3> x;
    for (std::size_t a = 0; a < 3; ++a) {
      const Eigen::Vector3d& at = mesh.nodes[static_cast<std::size_t>(side[a])];
      x[a] = {at.x(), at[up]};
    }
    std::array<Vector2d, chords + 1> along;
    for (int i = 0; i <= chords; ++i) {
      const std::array<double, 3> N =
          fem::Centreline(fem::Centreline::Shape::parabola).shape(static_cast<double>(i) / chords);
      along[static_cast<std::size_t>(i)] = N[0] * x[0] + N[1] * x[1] + N[2] * x[2];
    }
    return along;
  };
  const auto turn = [](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  };
  const auto box = [](const Vector2d& a, const Vector2d& b) {
    return Eigen::AlignedBox2d(a.cwiseMin(b), a.cwiseMax(b));
  };
  for (int i = 0; i < one.size(); ++i) {
    const auto a = points(one.cell(i));
    for (int j = 0; j < other.size(); ++j) {
      const auto b = points(other.cell(j));
      for (std::size_t k = 0; k < chords; ++k)
        for (std::size_t l = 0; l < chords; ++l)
          if (box(a[k], a[k + 1]).intersects(box(b[l], b[l + 1])) && // or apart on one line
              turn(a[k], a[k + 1], b[l]) * turn(a[k], a[k + 1], b[l + 1]) <= 0 &&
              turn(b[l], b[l + 1], a[k]) * turn(b[l], b[l + 1], a[k + 1]) <= 0)
            return true;
    }
  }
  return false;
}

bool cross(const meshing::Mesh& mesh, const meshing::CellBlock& one, const meshing::CellBlock& other) {
  const auto face = [&](std::span<const int> nodes) {
    fem::FaceNodes x;
    for (std::size_t a = 0; a < 6; ++a)
      x.col(static_cast<int>(a)) = mesh.nodes[static_cast<std::size_t>(nodes[a])];
    return x;
  };
  for (int i = 0; i < one.size(); ++i)
    for (int j = 0; j < other.size(); ++j)
      if (fem::cross(face(one.cell(i)), face(other.cell(j)))) return true;
  return false;
}

/// Whether a node of a surface lies within a cell of others as drawn: then solids lie in each other. Of cells
/// with straight sides; beside its own, whose sides may be hollow, a node may lie.
bool lies_inside(const meshing::Mesh& mesh, const meshing::CellBlock& surface) {
  constexpr double on_its_side = 1e-6; // of a cell
  const meshing::CellBlock& cells = *mesh.film();
  const int dimension = meshing::is_tetrahedron(cells.type) ? 3 : 2;
  const auto at = [&](int node) -> const Eigen::Vector3d& {
    return mesh.nodes[static_cast<std::size_t>(node)];
  };
  Eigen::AlignedBox3d around;
  for (const int node : surface.nodes) around.extend(at(node));
  for (int c = 0; c < cells.size(); ++c) {
    const auto own = cells.cell(c).first(static_cast<std::size_t>(dimension) + 1); // corners
    Eigen::AlignedBox3d box;
    for (const int node : own) box.extend(at(node));
    if (!box.intersects(around)) continue;
    Eigen::Matrix3d sides = Eigen::Matrix3d::Identity();
    for (int k = 0; k < dimension; ++k) sides.col(k) = at(own[static_cast<std::size_t>(k) + 1]) - at(own[0]);
    if (dimension == 2) sides.col(2) = sides.col(0).cross(sides.col(1));
    const Eigen::Matrix3d local = sides.inverse();
    for (const int node : surface.nodes) {
      if (!box.contains(at(node)) || std::ranges::count(cells.cell(c), node) > 0) continue;
      const Eigen::VectorXd share = (local * (at(node) - at(own[0]))).head(dimension);
      if (std::min(share.minCoeff(), 1 - share.sum()) > on_its_side) return true;
    }
  }
  return false;
}

/// Nodes of two surfaces, ascending, in planes across which supports hold nodes of both for good: planes of
/// symmetry.
std::vector<int> mirrored(const Case& one, const meshing::Mesh& mesh,
                          const std::array<meshing::CellBlock, 2>& surfaces) {
  const double nearly = 1e-3 * one.contact->thickness;
  std::set<int> all;
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<std::map<double, std::vector<int>>, 2> planes; // nodes by where they are held
    for (const Support& support : one.supports) {
      if (!support.fixed[c] || support.motion[c] || !support.from.empty() || !support.until.empty()) continue;
      const std::vector<int>& held = mesh.node_sets.at(support.place);
      for (std::size_t k = 0; k < 2; ++k)
        for (const int node : surfaces[k].nodes)
          if (std::ranges::binary_search(held, node))
            planes[k][mesh.nodes[static_cast<std::size_t>(node)][static_cast<int>(c)]].push_back(node);
    }
    for (std::size_t k = 0; k < 2; ++k)
      for (const auto& [at, nodes] : planes[k])
        if (const auto other = planes[1 - k].lower_bound(at - nearly);
            other != planes[1 - k].end() && other->first <= at + nearly)
          all.insert(nodes.begin(), nodes.end());
  }
  return {all.begin(), all.end()};
}

/// Every surface and each other one.
void add_surfaces(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts,
                  fem::Model& model) {
  const bool of_revolution = one.dimension == fem::Dimension::axisymmetric,
             in_space = one.dimension == fem::Dimension::spatial;
  const double thickness = one.contact->thickness;
  const std::vector<std::string>& places = one.contact->between;
  std::vector<meshing::CellBlock> surfaces;
  std::vector<Behind> solids;
  for (const std::string& place : places) {
    surfaces.push_back(in_space ? meshing::faces_at(mesh, place)
                                : meshing::sides_at(mesh, place, meshing::CellType::meridian3));
    solids.push_back(behind(one, mesh, parts, surfaces.back()));
    if (lies_inside(mesh, surfaces.back()))
      throw one.error_at(
          "contact.between",
          fmt::format("\"{}\" lies inside a solid as drawn: what is to touch is drawn apart", place));
  }
  for (std::size_t a = 0; a < places.size(); ++a)
    for (std::size_t b = a + 1; b < places.size(); ++b) {
      const auto fail = [&](const std::string& reason) {
        throw one.error_at("contact.between",
                           fmt::format("the surfaces \"{}\" and \"{}\" {}", places[a], places[b], reason));
      };
      constexpr int most = 1'000'000;
      if (!in_space && std::int64_t{2} * surfaces[a].size() * surfaces[b].size() > most)
        fail(fmt::format("have {} and {} sides: any may meet any, which is too much; name the parts of "
                         "them that may touch",
                         surfaces[a].size(), surfaces[b].size()));
      const Behind& softer = solids[a].modulus < solids[b].modulus ? solids[a] : solids[b];
      const auto contact = [&](double reach) {
        const fem::Barrier barrier{
            .thickness = reach, .stiffness = softer.barrier_stiffness(thickness), .foot = 1};
        const std::array<std::string, 2> names{places[a], places[b]};
        const std::array<meshing::CellBlock, 2> both{surfaces[a], surfaces[b]};
        const std::vector<int> on_symmetry = mirrored(one, mesh, both);
        if (in_space)
          return fem::make_face_contact_block(mesh,
                                              {names, both, barrier, one.contact->friction, on_symmetry});
        return fem::make_surface_contact_block(
            mesh, {names, both, of_revolution ? std::nullopt : std::optional(softer.width), barrier,
                   one.contact->friction, on_symmetry});
      };
      try {
        model.blocks.push_back(contact(thickness));
      } catch (const std::invalid_argument& error) {
        fail(error.what());
      }
      if (in_space ? cross(mesh, surfaces[a], surfaces[b])
                   : cross(mesh, surfaces[a], surfaces[b], of_revolution ? 2 : 1))
        fail("cross as drawn");
      // As far apart as the barrier reaches, to rounding.
      const fem::Evaluation drawn = as_drawn(*contact((1 - 1e-6) * thickness), mesh);
      if (!drawn.feasible || drawn.energy > 0)
        fail(fmt::format("are closer as drawn than the {:.6g} mm of contact.thickness", 1e3 * thickness));
    }
}

/// The core is where the barrier of the film as drawn begins.
void add_core(const Case& one, const Roll& roll, const meshing::Mesh& mesh, fem::Model& model) {
  const Film& film = *one.unnamed()->film;
  const double thickness = one.contact->thickness;
  fem::PlaneContact contact = fem::surface_of(mesh, *mesh.film(), std::nullopt);
  contact.normal = Eigen::Vector3d::UnitX();
  contact.origin = (roll.radius - thickness) * contact.normal;
  const double modulus = 3 * materials::initial_shear_modulus(film.material.law);
  const double wound = roll.turns * film.thickness / (film.prestretch[0] * film.prestretch[1]);
  // A gap of half the barrier's thickness bears the film's tension around the core at 1.7 times its modulus.
  contact.barrier = {
      .thickness = thickness, .stiffness = modulus * wound / roll.radius / thickness, .foot = 1};
  for (int c = 0; c < mesh.film()->size(); ++c) {
    const auto own = mesh.film()->cell(c); // ends, and a middle
    for (const auto& [end, other] : {std::array{own[0], own[1]}, std::array{own[1], own[0]}})
      for (const char* cap : {"lower_end", "upper_end"})
        if (std::ranges::count(mesh.node_sets.at(cap), end) > 0)
          contact.kept.push_back({end, own.size() == 3 ? own[2] : other});
  }
  model.blocks.push_back(fem::make_plane_contact_block(mesh, std::move(contact)));
}

} // namespace

void hold_radii(const Case& one, const meshing::Mesh& mesh, fem::DofMap& dofs) {
  const auto* roll = one.geometry<Roll>();
  if (!roll || roll->core != RollCore::two_sided) return;
  for (const int node : mesh.node_sets.at("film"))
    if (!dofs.is_tied_node(node)) dofs.hold(node, 0); // end caps keep their radius
}

void add_contact(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts,
                 fem::Model& model) {
  if (!one.contact) return;
  if (!one.contact->between.empty()) add_surfaces(one, mesh, parts, model);
  if (one.table) add_table(one, mesh, parts, model);
  if (const auto* roll = one.geometry<Roll>(); roll && !one.table && one.contact->between.empty())
    add_core(one, *roll, mesh, model);
  if (one.dimension != fem::Dimension::planar) return;
  for (const Part& part : one.parts)
    if (std::holds_alternative<Honeycomb>(part.geometry)) add_walls(one, part, mesh, model);
}

} // namespace dielast::cases
