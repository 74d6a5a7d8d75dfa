// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "meshing/mesh.hpp"

#include <memory>

namespace dielast::fem {

/// The pressure p of a chamber under a film, E = -p V with the volume between the film and the plane z = 0:
/// V = int z da_z over triangles, -2 pi int r z dr over meridians. Its gradient is the follower load p n da
/// where the film's edges are held or move along z only (Schweizerhof & Ramm 1984): symmetric, and the volume
/// is the chamber's "charge" (see Charges). `port`: place of the pressure among a state's voltages.
std::unique_ptr<ElementBlock> make_pressure_block(const meshing::Mesh& mesh, const meshing::CellBlock& film,
                                                  std::size_t port);

/// What closes a chamber besides the film: a rigid lid that moves along z with a node.
struct Lid {
  int node = 0;
  double area = 0; ///< m^2; 0: the film closes the chamber alone
};

/// E = -p A z_lid: the lid's share of the volume.
std::unique_ptr<ElementBlock> make_lid_block(const meshing::Mesh& mesh, const Lid& lid, std::size_t port);

} // namespace dielast::fem
