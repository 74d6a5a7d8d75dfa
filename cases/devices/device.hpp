// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/devices/fins.hpp"
#include "fem/model/model.hpp"
#include "meshing/mesh.hpp"
#include "meshing/shares.hpp"

#include <map>
#include <optional>

namespace dielast::cases {

/// The bar along each line of a mesh.
struct Bars {
  std::vector<double> widths, heights; ///< across it in the plane of x and y, and along z, m
  std::vector<int> parts;              ///< numbers in Case::parts
};

/// A displacement that is held where nothing holds the device: along x, y or z.
struct Pin {
  int node = 0, axis = 0;
};

/// A case made computable: its mesh and its model.
struct Device {
  meshing::Mesh mesh;
  std::map<std::string, meshing::Shares> shares; ///< of the nodes of its places
  fem::Model model;
  std::vector<int> film_parts; ///< for each cell of the film, its part: a number in Case::parts
  int films = 0;               ///< blocks of film; they stand in front of the model's others
  Bars bars;
  bool tension_field = false;     ///< a film wrinkles where it would be compressed
  bool bears_compression = false; ///< every film is a shell or a solid: it may buckle, and does not wrinkle
  bool solid = false;             ///< its film is meshed across its thickness
  bool free_body = false;         ///< nothing holds it
  std::vector<Pin> pins{};        ///< against rigid motion, as the case has it, where nothing holds it
  Eigen::VectorXd weight;         ///< dead forces of gravity, per equation, N
  std::vector<FinPoints> fins{};  ///< in the order of Case::fins
  std::vector<std::string> warnings; ///< what the user should know of the mesh, one sentence each
};

/// The mesh that the case asks for. Throws meshing::MeshError, and CaseError for ties and regions that cannot
/// be.
meshing::Mesh build_mesh(const Case& one);

/// Names of all places of a mesh, sorted.
std::vector<std::string> places_of(const meshing::Mesh& mesh);

/// Mesh and model. Throws meshing::MeshError, and CaseError when the case names a place that the mesh lacks,
/// or has otherwise than the case takes it.
Device build_device(const Case& one);

} // namespace dielast::cases
