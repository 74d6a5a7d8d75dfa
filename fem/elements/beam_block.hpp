// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "materials/beam_section.hpp"
#include "meshing/mesh.hpp"

#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace dielast::fem {

/// Builds the geometrically exact (Simo-Reissner) beams of a block of 2- or 3-node lines.
///
/// Energy: 1/2 int (Gamma.C_N Gamma + K.C_M K) ds with the material strains Gamma = R^T x' - (R^T x')_0 and
/// K = axial(R^T R') - (.)_0 (Simo 1985; Simo & Vu-Quoc 1986). The rotation field interpolates the nodes'
/// unit quaternions and normalises, R(s) = R(q/|q|) with q = sum_a N_a q_a (Romero 2004, Comput. Mech. 34,
/// sec. 4.2), so that Gamma and K are rational in the nodal quaternions: objective, path-independent, without
/// singularity below half a turn within one element, and with short exact derivatives. One (2 nodes) or two
/// (3 nodes) Gauss points: no shear or membrane locking. `section` has its axis 1 along the line and its axis
/// 3 along `normal`, which must not be parallel to any line. Nodes are shared with other blocks: that is the
/// tie to the film. `numbers` are those of the lines in the mesh's own block, for samples; empty: in their
/// order here. As drawn, the beams are free of stress. Their mass is that of the centreline (consistent);
/// what resists turning beside it is RotaryInertia. Throws std::invalid_argument for a line of zero length or
/// parallel to `normal`.
std::unique_ptr<ElementBlock> make_beam_block(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                                              const materials::BeamSection& section,
                                              const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ(),
                                              std::vector<int> numbers = {});

/// What resists the turning of sections, beside the mass of the centreline, as of masses on arms that turn
/// with a node: 1/2 m |d(R arm)/dt|^2 each. Per node the arms, m, as drawn, and the masses, kg.
using RotaryInertia = std::map<int, std::vector<std::pair<Eigen::Vector3d, double>>>;

/// Adds the rotary inertia of the beams that make_beam_block() makes of the lines, lumped at their nodes (by
/// the trapezoidal rule and Simpson's): an arm along each axis of the section, as long as the radius of
/// gyration, one for the lines that go straight on.
void add_rotary_inertia(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                        const materials::BeamSection& section, const Eigen::Vector3d& normal,
                        RotaryInertia& inertia);

} // namespace dielast::fem
