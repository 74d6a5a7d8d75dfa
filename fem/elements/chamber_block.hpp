// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "meshing/mesh.hpp"

#include <memory>
#include <vector>

namespace dielast::fem {

/// The pressure p of a chamber under a film, E = -p V with the volume between the film and the plane z = 0:
/// V = int z da_z over triangles, -2 pi int r z dr over meridians; the volume is the chamber's "charge" (see
/// Charges). Its gradient is the follower load p n da, and symmetric, but for what an edge adds: -z (dx v_y -
/// dy v_x) along the sides of triangles that move by v, -2 pi r z v_r at the end of a meridian (+ at its
/// beginning). It is nothing where an edge rests across z, or in a plane of symmetry, or at z = 0
/// (Schweizerhof & Ramm 1984); the caller sees to that, and gives edges of meridians that rest along z to
/// make_level_edge_block. `port`: place of the pressure among a state's voltages.
std::unique_ptr<ElementBlock> make_pressure_block(const meshing::Mesh& mesh, const meshing::CellBlock& film,
                                                  std::size_t port);

/// Force of a pressure, Pa, on each node of each cell of a wall, p int N n da, N; all around where it is of
/// meridians. Unlike the gradient of a pressure block it is nothing but what presses on the cell.
std::vector<Eigen::Vector3d> pressure_forces(const meshing::Mesh& mesh, const meshing::CellBlock& wall,
                                             const State& state, double pressure);

/// Edges of meridians that rest along z, wherever they go along r: E = -p pi r^2 z at a meridian's end, with
/// the other sign at its beginning, which takes what the edge adds to the block above off its gradient. Where
/// all ends are such, V = pi int r^2 dz, what is around the axis. `ends`: nodes of one cell each.
std::unique_ptr<ElementBlock> make_level_edge_block(const meshing::Mesh& mesh,
                                                    const meshing::CellBlock& meridians,
                                                    const std::vector<int>& ends, std::size_t port);

/// What closes a chamber besides the film: a rigid lid that moves along z with a node.
struct Lid {
  int node = 0;
  double area = 0; ///< m^2; 0: the film closes the chamber alone
};

/// E = -p A z_lid: the lid's share of the volume.
std::unique_ptr<ElementBlock> make_lid_block(const meshing::Mesh& mesh, const Lid& lid, std::size_t port);

} // namespace dielast::fem
