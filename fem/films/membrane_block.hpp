// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/membrane_section.hpp"
#include "fem/model/element_block.hpp"
#include "meshing/mesh.hpp"

#include <memory>

namespace dielast::fem {

/// Which electrode lies over each triangle of a block: its number, or `passive`.
constexpr int passive = -1;

/// Builds the membrane elements of a block of 3- or 6-node triangles that lies in the xy plane, or of 2- or
/// 3-node meridians of a film of revolution about the z axis, drawn in the plane y = 0, or of rods.
///
/// Energy: int_A0 H Psi(C, k) dA0, see film_block.hpp and film_kinematics.hpp. Isoparametric: the sides of
/// 6-node triangles and 3-node meridians may be curved. `integration_points`: 1, 3 or 6 of a triangle, 1 to 3
/// of a meridian or a rod. `numbers`: of the elements in the mesh's own block, for samples and messages;
/// empty: in their order here. Throws std::invalid_argument for an element with a non-positive Jacobian,
/// naming it, and where elements and dimension do not fit.
std::unique_ptr<ElementBlock> make_membrane_block(const meshing::Mesh& mesh, const meshing::CellBlock& cells,
                                                  const MembraneSection& section, std::vector<int> electrodes,
                                                  Dimension dimension, int integration_points,
                                                  std::vector<int> numbers = {});

} // namespace dielast::fem
