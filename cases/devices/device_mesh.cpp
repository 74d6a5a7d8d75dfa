// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/device.hpp"

#include "meshing/gmsh/gmsh_reader.hpp"
#include "meshing/honeycomb_mesh.hpp"
#include "meshing/meridian.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/patch.hpp"
#include "meshing/refine.hpp"
#include "meshing/rings.hpp"

namespace dielast::cases {

namespace {

template<class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template<class... Functions> // Clang 14 deduces none for aggregates
Overloaded(Functions...)->Overloaded<Functions...>;

/// A user's mesh in m, without the lines that only name places.
meshing::Mesh film_of(meshing::Mesh mesh, double unit) {
  for (auto& x : mesh.nodes) x *= unit;
  for (int b = static_cast<int>(mesh.blocks.size()) - 1; b >= 0; --b) {
    if (!meshing::is_line(mesh.blocks[static_cast<std::size_t>(b)].type)) continue;
    mesh.blocks.erase(mesh.blocks.begin() + b);
    std::erase_if(mesh.cell_sets, [b](const auto& place) { return place.second.block == b; });
    for (auto& [name, set] : mesh.cell_sets) set.block -= set.block > b;
  }
  return mesh;
}

} // namespace

meshing::Mesh build_mesh(const Case& one) {
  const MeshOptions& options = one.mesh;
  const bool of_revolution = one.dimension == fem::Dimension::axisymmetric;
  try {
    return std::visit(
        Overloaded{
            [&](const Honeycomb& h) {
              return meshing::honeycomb_mesh({h.angle, h.columns, h.wall_length},
                                             {options.order, options.wall_elements, options.grading});
            },
            [&](const Disc& d) {
              if (of_revolution)
                return meshing::disc_meridian(d.radius, d.electrode_radius, options.rings, options.order);
              return meshing::disc_mesh(d.radius, d.electrode_radius, options.rings, options.order, true);
            },
            [&](const Annulus& a) {
              if (of_revolution)
                return meshing::annulus_meridian(a.inner_radius, a.outer_radius, options.rings, options.order,
                                                 options.grading);
              return meshing::annulus_mesh(a.inner_radius, a.outer_radius, options.rings, options.order, true,
                                           options.grading);
            },
            [&](const Balloon& b) {
              return meshing::balloon_meridian(b.radius, options.rings, options.order);
            },
            [&](const Patch& p) {
              return meshing::patch_mesh(p.length * one.film.prestretch[0], p.width * one.film.prestretch[1]);
            },
            [&](const MeshFile& file) {
              meshing::Mesh mesh = meshing::read_gmsh(file.path);
              for (int i = 0; i < options.refine; ++i) mesh = meshing::refined(std::move(mesh));
              return film_of(std::move(mesh), options.unit.value_or(1));
            },
        },
        one.geometry);
  } catch (const std::invalid_argument& error) {
    throw meshing::MeshError(error.what());
  }
}

} // namespace dielast::cases
