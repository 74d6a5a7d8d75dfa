// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "meshing/mesh.hpp"

#include <memory>
#include <vector>

namespace dielast::fem {

/// What a cable resists: with the strain e = (length now)/(length at rest) - 1 its tension is 0 where e < 0,
/// stiffness e^2/(2 crimp) up to e = crimp, where its fibres are straight, and stiffness (e - crimp/2)
/// beyond.
struct CableSection {
  double stiffness = 0;    ///< tension per strain of straight fibres, N
  double crimp = 0;        ///< > 0
  double prestretch = 1;   ///< length as drawn over that at rest; below 1: it hangs slack
  double line_density = 0; ///< mass per length at rest, kg/m
  double yield_strain = 0; ///< of straight fibres; 0: not known
};

/// Builds the cables of a block of 2- or 3-node lines: they pull along themselves, and resist neither
/// compression nor bending.
///
/// Energy: int W(|x'| prestretch/|X'| - 1) dS, dS = |X'| dxi/prestretch, dW/de the tension; one (2 nodes) or
/// two (3 nodes) Gauss points. A slack cable has no stiffness: what holds its nodes must be others. With
/// `straight`, lines of 3 nodes are taken from end to end, and a spring that a load alone stretches keeps the
/// node between them in their middle. Their mass is consistent. `numbers` are those of the lines in the
/// mesh's own block, for samples. Throws std::invalid_argument for a line of zero length.
std::unique_ptr<ElementBlock> make_cable_block(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                                               const CableSection& section, bool straight,
                                               std::vector<int> numbers);

} // namespace dielast::fem
