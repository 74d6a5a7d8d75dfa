// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "fem/solids/solid_section.hpp"
#include "meshing/mesh.hpp"

#include <memory>

namespace dielast::fem {

/// Elements of solids.
struct SolidCells {
  meshing::CellBlock elements;
  std::vector<int> electrodes; ///< over each element, or `passive`
  std::vector<int> sections;   ///< what each is made of
  std::vector<int> numbers{};  ///< of the elements in the mesh's own block; empty: in their order here
};

/// Builds solid elements of 6-node triangles: in the plane z = 0 in plane strain (planar models), or in the
/// half plane y = 0, x >= 0, revolved about z (axisymmetric models); or of 10-node tetrahedra (spatial
/// models).
///
/// Energy: int_V0 Psi(C, p, E0) dV0, Psi of SolidResponse. Displacements quadratic, pressures linear (Taylor
/// & Hood 1973), continuous within what is of one section and under one electrode: pressures jump where
/// materials and fields do. Six integration points, of tetrahedra four. The field E0 per undeformed length is
/// that of layers of the section's thickness under the voltage of the element's electrode, E0 = Phi/H along
/// their normal, or E0 = -grad phi with the quadratic potential phi as one more unknown. Free of stress as
/// drawn.
///
/// `potentials`: empty for layers; otherwise for each node of the mesh its electrode or a NodePotential.
/// Throws std::invalid_argument for other elements, a non-positive Jacobian and a model of another dimension.
std::unique_ptr<ElementBlock> make_solid_block(const meshing::Mesh& mesh, SolidCells cells,
                                               const std::vector<SolidSection>& sections,
                                               std::vector<int> potentials, Dimension dimension);

} // namespace dielast::fem
