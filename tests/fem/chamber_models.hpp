// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/elements/chamber_block.hpp"
#include "tests/fem/sample_models.hpp"

namespace dielast::fem::test {

/// The same block with every node's place changed: a chamber needs only its film's shape.
inline meshing::Mesh shaped(meshing::Mesh mesh,
                            const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& place) {
  for (Eigen::Vector3d& X : mesh.nodes) X = place(X);
  return mesh;
}

inline Dimension dimension_of(const meshing::Mesh& mesh) {
  return meshing::is_meridian(mesh.blocks[0].type) ? Dimension::axisymmetric : Dimension::spatial;
}

/// The mesh's film, under one electrode or none, over a chamber, which is the last port; hold() and number()
/// are left to the caller.
inline std::unique_ptr<Model> inflatable(const meshing::Mesh& mesh, const MembraneSection& film,
                                         double extent, const Lid& lid = {}, bool electrode = false,
                                         double bulk_modulus = 2.2e9) {
  const meshing::CellBlock& cells = mesh.blocks[0];
  const bool linear =
      cells.type == meshing::CellType::meridian2 || cells.type == meshing::CellType::triangle3;
  const int points = !linear ? 3 : meshing::is_meridian(cells.type) ? 2 : 1;
  const std::size_t chamber = electrode ? 1 : 0;
  auto model = unnumbered_model(
      mesh.node_count(), dimension_of(mesh),
      make_membrane_block(mesh, cells, film,
                          std::vector<int>(static_cast<std::size_t>(cells.size()), electrode ? 0 : passive),
                          dimension_of(mesh), points),
      make_pressure_block(mesh, cells, chamber));
  if (!electrode) model->ports = {};
  model->ports.push_back({.name = "inside", .chamber = Chamber{bulk_modulus}});
  if (lid.area > 0) model->blocks.push_back(make_lid_block(mesh, lid, chamber));
  model->length_scale = model->extent = extent;
  model->drawn = mesh.nodes;
  return model;
}

} // namespace dielast::fem::test
