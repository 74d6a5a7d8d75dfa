// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "fem/shells/shell_section.hpp"
#include "meshing/mesh.hpp"

#include <memory>

namespace dielast::fem {

/// Builds the shell elements of a block of 6-node triangles in space: layers of film that resist bending.
///
/// Energy: int_A0 sum_layers int Psi(C(Z), k(Z)) dZ dA0 + 1/2 int_A0 k_s mu H |gamma|^2 dA0 + drilling, with
/// C(Z) of ShellStrain, k(Z) of each layer's nominal field, which is such that its faces have one potential
/// each: -eps Phi^2/2 over int 1/(e det C) dZ, as in a cylindrical or spherical capacitor; and the transverse
/// shear gamma_i = x,i . d of each in its own unstretched film, k_s = 5/6, and what branches add to it, see
/// ShellShear. The director d_a = R_a D_a of a node turns with it; D_a is normal to this element as drawn, so
/// that folds and junctions are rigid corners. Strains are interpolated as ShellTables says: neither thin nor
/// curved elements lock. All are those of the layers' middle, whose nodes lie `offset` along the directors,
/// as drawn: how this distance follows the thickness is left out. Three Gauss points across each layer. Nodes
/// tilt, where DofMap::add_director() lets them; where they have three spins, those about the directors are
/// held to the film's own rotation by a stiffness of 1e-3 k_s mu H times the area. In elements that are more
/// than 30 thicknesses long (h, the root of twice the drawn area) the shear is resisted by (30 H/h)^2 of that
/// only: still a thousand times stiffer than the shortest waves that they can bend in, while thinner ones
/// would let directors buckle against each other where the film turns. As drawn, the shell is free of stress,
/// but for its prestretch. It has no mass: see make_shell_mass_block().
///
/// `electrodes`: for each layer, the electrode over each element, or `passive`. `numbers`: of the elements in
/// the mesh's own block, for samples and messages; empty: in their order here. Throws std::invalid_argument
/// for other elements, a non-positive Jacobian of a shell in the xy plane, one without area, and prestretch
/// where the shell is not drawn parallel to the xy plane.
std::unique_ptr<ElementBlock> make_shell_block(const meshing::Mesh& mesh, const meshing::CellBlock& cells,
                                               const ShellSection& section,
                                               std::vector<std::vector<int>> electrodes,
                                               std::vector<int> numbers = {});

/// The mass of such elements, consistent: all of it in the surface of its centres, where `carriers` are the
/// nodes, one for each of `cells.nodes`. Where the centre is not in the drawn surface these are nodes of
/// their own, which are tied to the drawn ones and lie along their directors: then the mass has its place,
/// its weight turns the shell, and the layers move as 1/2 int rho |d(x + Z d)/dt|^2 has it, but for what a
/// section's moment of inertia about its own centre adds: that lowers the frequency of waves 2 pi/k long by
/// (k H)^2/24 of it only. The lever is that of the drawing: how it follows the thickness is left out.
std::unique_ptr<ElementBlock> make_shell_mass_block(const meshing::Mesh& mesh,
                                                    const meshing::CellBlock& cells, const ShellMass& mass,
                                                    std::vector<int> carriers);

} // namespace dielast::fem
