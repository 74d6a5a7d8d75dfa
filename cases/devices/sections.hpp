// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/device.hpp"
#include "fem/elements/point_mass_block.hpp"
#include "fem/shells/shell_section.hpp"

#include <vector>

namespace dielast::cases {

/// For each cell of the mesh's film the part to which it belongs, a number in Case::parts: a part that is a
/// place, otherwise the part whose mesh it is. Throws CaseError for a place that is no film, and two places
/// that overlap; MeshError for film of no part.
std::vector<int> film_parts(const Case& one, const meshing::Mesh& mesh);

/// Adds the blocks of all parts that are film, kind by kind; `parts` are film_parts(). Throws CaseError and
/// std::invalid_argument for electrodes and elements that cannot be.
void add_films(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts, fem::Model& model);

/// Adds what else an electrode charges: its stray capacitance, and what of it lies in a strip's clamps.
void add_capacitors(const Case& one, fem::Model& model);

/// Puts the bars whose axes lie beside the lines of the mesh on nodes of their own, and the ends of ribbons
/// that turn freely on the tip. Returns the rigid links and pins by which the lines' nodes carry them. Throws
/// CaseError as add_bars(), and for beams on film that does not lie across z, the direction of their height.
std::vector<fem::Tie> set_off_bars(const Case& one, meshing::Mesh& mesh);

/// Lets the nodes that carry them turn, as film alone does not, and ties the bars' nodes to them. Nothing but
/// the first end keeps a pinned ribbon from turning about itself.
void link_bars(const std::vector<fem::Tie>& links, fem::Dimension dimension, fem::DofMap& dofs);

/// Says which ribbon that turns freely at its ends is pushed in this state, as none can be; empty: no one.
std::string pushed_ribbon(const Case& one, const Device& device, const fem::State& state);

/// Adds the bars: walls of lattices, and parts along lines of the mesh. Throws CaseError for a place without
/// lines.
void add_bars(const Case& one, const meshing::Mesh& mesh, fem::Model& model);

/// Adds what keeps the walls of a lattice's cells, surfaces of solids, a solid and its table, or a roll and
/// its core apart, where the case has [contact]. Throws CaseError where walls or surfaces are closer as drawn
/// than the barrier reaches, and for surfaces that cross. `parts` are film_parts().
void add_contact(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts,
                 fem::Model& model);

/// Holds what a roll's core keeps at its radius, whether pressed or pulled. To be called behind the ties.
void hold_radii(const Case& one, const meshing::Mesh& mesh, fem::DofMap& dofs);

/// Adds nodes to the mesh, on the arms of the bars' rotary inertia; none where nothing accelerates. Returns
/// their masses. To be called behind set_off_bars(). Throws CaseError as add_bars().
std::vector<fem::RelativeMass> add_rotary_nodes(const Case& one, meshing::Mesh& mesh);

/// Ties these nodes to the bars'.
void tie_rotary_nodes(const std::vector<fem::RelativeMass>& masses, const meshing::Mesh& mesh,
                      fem::DofMap& dofs);

/// The mass of the shells of one part, and the nodes that carry it, see fem::make_shell_mass_block().
struct MassOfShells {
  fem::ShellMass mass;
  std::vector<int> cells;    ///< of the film
  std::vector<int> carriers; ///< for each of their nodes
};

/// Adds nodes to the mesh where the mass of a shell has its centre beside the drawn surface; none where
/// nothing accelerates or weighs. `parts` are film_parts().
std::vector<MassOfShells> add_mass_nodes(const Case& one, const std::vector<int>& parts, meshing::Mesh& mesh);

/// Adds these masses.
void add_masses_of_shells(const std::vector<MassOfShells>& shells, const meshing::Mesh& mesh,
                          fem::Model& model);

/// Ties the nodes that carry them to the shells'.
void tie_mass_nodes(const std::vector<MassOfShells>& shells, const meshing::Mesh& mesh, fem::DofMap& dofs);

/// The bar along each line of the mesh.
Bars bars(const Case& one, const meshing::Mesh& mesh);

/// Ties the nodes of film under walls that hold it over their width to the wall's nodes opposite to them:
/// they move with the wall's sections. Near a joint these are spread, so that corners of faces move with it.
void clamp_under_walls(const Case& one, const meshing::Mesh& mesh, fem::DofMap& dofs);

/// Throws CaseError where film that is not drawn in a plane of constant z is no shell, or is prestretched.
/// `extent`: of the mesh, m.
void check_film_in_space(const Case& one, const meshing::Mesh& mesh, const std::vector<int>& parts,
                         double extent);

} // namespace dielast::cases
