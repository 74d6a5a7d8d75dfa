// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/device.hpp"

#include "cases/case/part_kind.hpp"
#include "cases/tables/regions.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/parts/assembly.hpp"
#include "meshing/regions/region_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace dielast::cases {

namespace {

/// A disc or an annulus in which regions are drawn. Throws MeshError.
meshing::Mesh mesh_of_regions(const Part& part, const std::vector<meshing::Region>& regions) {
  const meshing::RoundFilm film = *round_film(part);
  meshing::Mesh mesh =
      meshing::region_mesh(film, regions, part.mesh.rings, std::max(1.0, part.mesh.grading), part.mesh.order);
  if (film.inner_radius == 0 && !mesh.cell_sets.contains("electrode")) { // of a disc that is all electrode
    mesh.cell_sets["electrode"] = mesh.cell_sets.at("film");
    mesh.node_sets["electrode"] = mesh.node_sets.at("film");
    mesh.node_sets.try_emplace("electrode_edge", mesh.node_sets.at("rim"));
  }
  for (int k = 0; part.sectors && k < part.sectors->count; ++k) { // "a" is "sector[0]", too
    const std::string& name = regions[static_cast<std::size_t>(k)].name;
    mesh.cell_sets[fmt::format("sector[{}]", k)] = mesh.cell_sets.at(name);
    mesh.node_sets[fmt::format("sector[{}]", k)] = mesh.node_sets.at(name);
  }
  return mesh;
}

/// The mesh of a part of a case, as it is drawn by itself.
meshing::Mesh own_mesh(const Case& one, const Drawing& drawing) {
  const Part& part = drawing.part;
  if (const auto regions = regions_of(part); !regions.empty()) {
    try {
      return mesh_of_regions(part, regions);
    } catch (const meshing::MeshError& error) {
      const auto drawn = std::ranges::find(part.regions, error.region, &DrawnRegion::name);
      if (drawn == part.regions.end()) throw; // a sector, or none
      throw one.error_at(
          fmt::format("{}region[{}].name", part.key_prefix(), drawn - part.regions.begin() + 1),
          error.what());
    }
  }
  return std::visit([&](const auto& geometry) { return mesh_of(geometry, drawing); }, part.geometry);
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

/// The edge that a plate carries goes by its name, too.
void name_plate(meshing::Mesh& mesh, const std::string& edge) {
  const auto nodes = mesh.node_sets.find(edge);
  if (nodes == mesh.node_sets.end()) return; // reported elsewhere
  mesh.node_sets.try_emplace("plate", nodes->second);
  if (const auto cells = mesh.cell_sets.find(edge); cells != mesh.cell_sets.end())
    mesh.cell_sets.try_emplace("plate", cells->second);
}

} // namespace

meshing::Mesh build_mesh(const Case& one) {
  std::vector<std::string> bars;
  for (const Part& part : one.parts)
    if (const PartKind* kind = kind_of(part); kind && kind->bars) bars.push_back(part.place);
  // Two triangles of any order are exact for a patch; one mesh has triangles of one order.
  const bool curved = std::ranges::any_of(one.parts, [](const Part& part) {
    return part.has_mesh() && !std::holds_alternative<Patch>(part.geometry) && part.mesh.order == 2;
  });
  meshing::Mesh whole;
  try {
    for (const Part& part : one.parts) {
      if (!part.has_mesh()) continue;
      meshing::Mesh mesh = own_mesh(one, {part, one.dimension == fem::Dimension::axisymmetric,
                                          one.dimension == fem::Dimension::spatial, curved ? 2 : 1, bars});
      if (part.name.empty()) {
        whole = std::move(mesh);
        continue;
      }
      place(mesh, part);
      meshing::append(whole, mesh, part.name);
    }
    for (std::size_t t = 0; t < one.ties.size(); ++t) {
      const std::array<std::string, 2>& between = one.ties[t].between;
      if (!std::ranges::all_of(between, [&](const auto& place) { return whole.node_sets.contains(place); }))
        continue; // reported elsewhere
      try {
        meshing::join(whole, between[0], between[1]);
      } catch (const meshing::MeshError& error) {
        throw one.error_at(fmt::format("tie[{}].between", t + 1), error.what());
      }
    }
  } catch (const std::invalid_argument& error) {
    throw meshing::MeshError(error.what());
  }
  if (one.plate) name_plate(whole, one.plate->place);
  return whole;
}

} // namespace dielast::cases
