// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/state.hpp"
#include "meshing/mesh.hpp"

#include <array>
#include <vector>

namespace dielast::fem {

/// Two walls of a lattice that came closer than they are wide.
struct WallContact {
  std::array<int, 2> lines; ///< the two nearest beams, numbered as in the mesh's block
  double distance = 0;      ///< between their centrelines, m
};

/// Finds walls that touch. Walls are chains of beams between joints (nodes where not two beams meet in line);
/// walls that share a joint always meet there and are left out. Distances are taken between the beams'
/// chords. Contact is reported, not resisted.
class WallContactSearch {
 public:
  /// `width`: distance of the centrelines at which walls touch, m.
  WallContactSearch(const meshing::Mesh& mesh, const meshing::CellBlock& lines, double width);

  /// The nearest pair of beams of every two walls in contact, by ascending distance.
  std::vector<WallContact> find(const State& state) const;

 private:
  struct Line {
    std::array<int, 2> node;
    int wall;
  };
  bool share_joint(int wall, int other) const;

  const meshing::Mesh& mesh_;
  double width_;
  std::vector<Line> lines_;
  std::vector<std::array<int, 2>> joints_; ///< end nodes of each wall
};

} // namespace dielast::fem
