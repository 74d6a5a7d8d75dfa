// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/shells/shell_block.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

namespace dielast::fem::test {

/// Two layers of different film, the first one charged on some elements and with a prestretch of its own, the
/// second one viscoelastic.
inline ShellSection two_layers() {
  return {.layers = {{vhb().material, 0.05, std::array{1.5, 1.1}}, {viscoelastic_vhb().material, 0.1}},
          .prestretch = {1.2, 0.9},
          .offset = 0.02};
}

/// As they may be curved as drawn.
inline ShellSection two_unstretched_layers() {
  ShellSection section = two_layers();
  section.prestretch = {1, 1};
  section.layers[0].prestretch.reset();
  return section;
}

/// Unit square of eight curved triangles in the xy plane.
inline meshing::Mesh flat_mesh() {
  meshing::Mesh mesh = distorted_square(2, 2);
  std::mt19937 random(5);
  for (int a = 9; a < mesh.node_count(); ++a)
    mesh.nodes[static_cast<std::size_t>(a)].head<2>() += random_vector(random, 2, 0.03);
  return mesh;
}

/// The square bent to a dome with a twist.
inline meshing::Mesh dome() {
  meshing::Mesh mesh = flat_mesh();
  for (auto& x : mesh.nodes) x.z() = 0.4 * x.x() * (1.5 - x.x()) + 0.3 * x.x() * x.y() - 0.2 * x.y() * x.y();
  return mesh;
}

/// As if something acted on the spins of all nodes.
inline void keep_spins(Model& model) {
  for (int n = 0; n < model.dofs.node_count(); ++n) model.dofs.keep_spins(n);
}

inline std::unique_ptr<Model> shell_model(const meshing::Mesh& mesh, const ShellSection& section,
                                          bool with_spins = false) {
  std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks[0].size()), 0);
  for (std::size_t e = 0; e < electrodes.size(); e += 3) electrodes[e] = passive;
  std::vector<std::vector<int>> all{electrodes};
  if (section.layers.size() > 1) all.emplace_back(electrodes.size(), passive);
  auto model =
      unnumbered_model(mesh.node_count(), false, make_shell_block(mesh, mesh.blocks[0], section, all));
  if (with_spins) keep_spins(*model);
  model->dofs.number();
  return model;
}

/// A flat shell whose mass is carried by nodes on its directors, behind those of `mesh`, to which they are
/// added.
inline std::unique_ptr<Model> shell_with_mass(meshing::Mesh& mesh, const ShellSection& section) {
  const ShellMass mass = ShellMass::of(section);
  const int drawn = mesh.node_count();
  for (int n = 0; n < drawn; ++n)
    mesh.nodes.emplace_back(mesh.nodes[static_cast<std::size_t>(n)] + mass.lever * Eigen::Vector3d::UnitZ());
  std::vector<int> carriers = mesh.blocks[0].nodes;
  for (int& node : carriers) node += drawn;
  const std::vector<std::vector<int>> electrodes(
      section.layers.size(), std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), passive));
  auto model =
      unnumbered_model(mesh.node_count(), false, make_shell_block(mesh, mesh.blocks[0], section, electrodes));
  model->blocks.push_back(make_shell_mass_block(mesh, mesh.blocks[0], mass, carriers));
  model->blocks.back()->claim_dofs(model->dofs, Dimension::spatial);
  for (int n = 0; n < drawn; ++n) model->dofs.tie({drawn + n, n, {0, 0, mass.lever}});
  model->dofs.number();
  return model;
}

/// Stretched, turned and shaken.
inline State random_state(const Model& model, const meshing::Mesh& mesh, std::mt19937& random) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 0) = 1.3;
  F(0, 1) = 0.2;
  State state = homogeneous(model, mesh, F);
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    state.displacement[a] += random_vector(random, 3, 0.03);
    state.rotation[a] = random_rotation(random, 0.2);
  }
  const State turned = moved(state, mesh, random_rotation(random, 3), {0.3, 0.2, -0.5});
  State charged = turned;
  charged.voltage = {3e5};
  charged.scheme = materials::TimeScheme::backward_euler(0.3);
  return charged;
}

} // namespace dielast::fem::test
