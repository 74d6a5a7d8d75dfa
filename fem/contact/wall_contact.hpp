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
/// walls that share a joint, or have joints that are drawn at one place (ends of two parts), always meet
/// there and are left out. Distances are taken between the beams' chords.
class WallContactSearch {
 public:
  /// `widths`: of the wall at each line, m; walls touch where their centrelines are the mean of theirs apart.
  WallContactSearch(const meshing::Mesh& mesh, const meshing::CellBlock& lines, std::vector<double> widths);

  /// Whether the walls of two lines have no joint in common.
  bool may_touch(int line, int other) const {
    return !share_joint(lines_[static_cast<std::size_t>(line)].wall,
                        lines_[static_cast<std::size_t>(other)].wall);
  }
  /// The nearest pair of beams of every two walls in contact, by ascending distance.
  std::vector<WallContact> find(const State& state) const;

 private:
  struct Line {
    std::array<int, 2> node;
    int wall;
  };
  bool share_joint(int wall, int other) const;

  const meshing::Mesh& mesh_;
  std::vector<double> widths_;
  double widest_ = 0;
  std::vector<Line> lines_;
  std::vector<std::array<int, 2>> joints_; ///< end nodes of each wall
};

} // namespace dielast::fem
