#include "cases/device.hpp"

#include "cases/reader.hpp"
#include "fem/beam_block.hpp"
#include "fem/membrane_block.hpp"
#include "meshing/gmsh_reader.hpp"
#include "meshing/honeycomb_mesh.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/rings.hpp"

#include <algorithm>
#include <stdexcept>

namespace dielast::cases {

namespace {

template<class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};

/// The mesh's block of triangles or of lines; null when it has none.
const meshing::CellBlock* find_block(const meshing::Mesh& mesh, bool triangles) {
  for (const auto& block : mesh.blocks) {
    const bool is_triangle =
        block.type == meshing::CellType::triangle3 || block.type == meshing::CellType::triangle6;
    if (is_triangle == triangles && block.size() > 0) return &block;
  }
  return nullptr;
}

/// Electrode over each triangle.
std::vector<int> electrode_map(const Case& one, const meshing::Mesh& mesh, const meshing::CellBlock& film) {
  std::vector<int> map(static_cast<std::size_t>(film.size()), fem::passive);
  for (std::size_t e = 0; e < one.electrodes.size(); ++e) {
    const auto place = mesh.cell_sets.find(one.electrodes[e].place);
    if (place == mesh.cell_sets.end() || &mesh.blocks[static_cast<std::size_t>(place->second.block)] != &film)
      throw meshing::MeshError("electrode \"" + one.electrodes[e].name + "\": the place \"" +
                               one.electrodes[e].place + "\" is not a part of the film");
    for (const int cell : place->second.cells) map[static_cast<std::size_t>(cell)] = static_cast<int>(e);
  }
  return map;
}

/// Holds three (planar) or six displacements such that rigid motions are excluded and no reaction can arise:
/// the node next to the middle, one far from it along x and, in space, one far along y.
void pin(const meshing::Mesh& mesh, fem::DofMap& dofs) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& x : mesh.nodes) middle += x / static_cast<double>(mesh.nodes.size());
  const auto best = [&](auto&& cost) {
    int found = 0;
    for (int n = 1; n < mesh.node_count(); ++n)
      if (cost(mesh.nodes[static_cast<std::size_t>(n)]) < cost(mesh.nodes[static_cast<std::size_t>(found)]))
        found = n;
    return found;
  };
  const int first = best([&](const Eigen::Vector3d& x) { return (x - middle).norm(); });
  const Eigen::Vector3d anchor = mesh.nodes[static_cast<std::size_t>(first)];
  const int along_x =
      best([&](const Eigen::Vector3d& x) { return x.x() - anchor.x() + 2 * std::abs(x.y() - anchor.y()); });
  const int along_y =
      best([&](const Eigen::Vector3d& x) { return x.y() - anchor.y() + 2 * std::abs(x.x() - anchor.x()); });
  for (const int c : {0, 1, 2}) dofs.hold(first, c);
  for (const int c : {1, 2}) dofs.hold(along_x, c);
  dofs.hold(along_y, 2);
}

} // namespace

meshing::Mesh build_mesh(const Case& one) {
  const MeshOptions& options = one.mesh;
  try {
    return std::visit(
        Overloaded{
            [&](const Honeycomb& h) {
              return meshing::honeycomb_mesh({h.angle, h.columns, h.wall_length},
                                             {options.order, options.wall_elements, options.grading});
            },
            [&](const Disc& d) {
              return meshing::disc_mesh(d.radius, d.electrode_radius, options.rings, options.order, true);
            },
            [&](const Annulus& a) {
              return meshing::annulus_mesh(a.inner_radius, a.outer_radius, options.rings, options.order,
                                           true);
            },
            [&](const MeshFile& file) { return meshing::read_gmsh(file.path); },
        },
        one.geometry);
  } catch (const std::invalid_argument& error) {
    throw meshing::MeshError(error.what());
  }
}

std::vector<std::string> places_of(const meshing::Mesh& mesh) {
  std::vector<std::string> places;
  for (const auto& [name, nodes] : mesh.node_sets) places.push_back(name);
  return places;
}

Device build_device(const Case& one) {
  meshing::Mesh mesh = build_mesh(one);
  check_places(one, places_of(mesh));
  const bool planar = !one.three_dimensional;

  fem::Model model{.dofs = fem::DofMap(mesh.node_count())};
  for (const Electrode& electrode : one.electrodes) model.electrodes.push_back(electrode.name);
  Eigen::Vector3d low = mesh.nodes.front(), high = low;
  for (const auto& x : mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  model.extent = (high - low).norm();

  const meshing::CellBlock* film = find_block(mesh, true);
  if (!film) throw meshing::MeshError("the mesh has no triangles: there is no film");
  model.length_scale = model.extent / std::sqrt(static_cast<double>(film->size()));
  const int points = film->type == meshing::CellType::triangle6 ? one.mesh.quadrature : 1;
  try {
    model.blocks.push_back(
        fem::make_membrane_block(mesh, *film, {one.film.material, one.film.thickness, one.film.prestretch},
                                 electrode_map(one, mesh, *film), planar, points));
  } catch (const std::invalid_argument& error) {
    throw meshing::MeshError(error.what());
  }
  const auto* lattice = std::get_if<Honeycomb>(&one.geometry);
  if (const meshing::CellBlock* walls = find_block(mesh, false); walls && lattice)
    model.blocks.push_back(fem::make_beam_block(
        mesh, *walls,
        materials::rectangular_section(lattice->wall_material, lattice->wall_width, lattice->wall_height)));

  for (const auto& block : model.blocks) block->claim_dofs(model.dofs, planar);
  for (const Support& support : one.supports)
    for (const int node : mesh.node_sets.at(support.place))
      for (int c = 0; c < 3; ++c)
        if (support.fixed[static_cast<std::size_t>(c)]) model.dofs.hold(node, c);
  if (one.supports.empty()) pin(mesh, model.dofs);
  model.dofs.number();

  Device device{.mesh = std::move(mesh), .model = std::move(model), .free_body = one.supports.empty()};
  device.rest = {std::vector<double>(one.electrodes.size(), 0.0),
                 Eigen::VectorXd::Zero(device.model.dofs.count())};
  device.loads = device.rest.dead_force;
  for (const Load& load : one.loads) {
    const auto& nodes = device.mesh.node_sets.at(load.place);
    for (const int node : nodes)
      for (int c = 0; c < 3; ++c)
        if (const int e = device.model.dofs.equation(node, c); e != fem::DofMap::absent)
          device.loads[e] += load.force[static_cast<std::size_t>(c)] / static_cast<double>(nodes.size());
  }
  if (lattice) device.wall_width = lattice->wall_width;
  return device;
}

std::optional<Case> coarser(const Case& one) {
  if (std::holds_alternative<MeshFile>(one.geometry)) return std::nullopt;
  Case coarse = one;
  if (std::holds_alternative<Honeycomb>(one.geometry)) {
    if (one.mesh.wall_elements < 2) return std::nullopt;
    coarse.mesh.wall_elements = one.mesh.wall_elements / 2;
  } else {
    if (one.mesh.rings < 4) return std::nullopt;
    coarse.mesh.rings = one.mesh.rings / 2;
  }
  return coarse;
}

} // namespace dielast::cases
