#pragma once

#include "fem/element_block.hpp"
#include "fem/membrane_section.hpp"
#include "meshing/mesh.hpp"

#include <memory>

namespace dielast::fem {

/// Which electrode lies over each triangle of a block: its number, or `passive`.
constexpr int passive = -1;

/// Builds the membrane elements of a block of 3- or 6-node triangles that lies in the xy plane.
///
/// Energy: int_A0 H Psi(C, k) dA0 with C = F^T F, F = sum_a x_a (x) grad N_a w.r.t. the unstretched film, and
/// k = eps (Phi/H)^2 under the triangle's electrode (see materials/plane_stress.hpp). Isoparametric: the
/// sides of 6-node triangles may be curved. `planar` elements have two unknowns per node, others three.
/// Throws std::invalid_argument for a triangle with a non-positive Jacobian, naming it.
std::unique_ptr<ElementBlock> make_membrane_block(const meshing::Mesh& mesh,
                                                  const meshing::CellBlock& triangles,
                                                  const MembraneSection& section, std::vector<int> electrodes,
                                                  bool planar, int integration_points);

} // namespace dielast::fem
