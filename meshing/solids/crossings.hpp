// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace dielast::meshing {

/// What of a film passes through itself when it moves: its triangles; the outer sides of tetrahedra, and
/// where all lies in one plane those of triangles, and meridians. Sides with middle nodes are straight
/// between these.
class FilmSurface {
 public:
  /// `parts`: of each cell of mesh.film(); `kept_apart`: places whose surfaces something else keeps from one
  /// another. Pieces of one part, or of parts whose boxes as drawn have nothing in common, may cross.
  FilmSurface(const Mesh& mesh, std::span<const int> parts, std::span<const std::string> kept_apart);

  struct Crossing {
    std::array<int, 2> cells; ///< of mesh.film()
    Eigen::Vector3d at;       ///< about there, m
  };
  /// The first two pieces without a node in common that meet where the nodes are at `x`, and not as drawn.
  std::optional<Crossing> crossing(std::span<const Eigen::Vector3d> x) const;

 private:
  struct Piece {
    int cell;
    std::array<int, 3> nodes; ///< the last is -1 where it is a line in a plane
  };

  void add_line(int cell, std::span<const int> nodes);
  void add_triangle(int cell, std::span<const int> nodes);
  bool may_cross(const Piece& one, const Piece& other) const;

  std::vector<Eigen::Vector3d> drawn_;
  std::vector<char> kept_apart_;         ///< for every node
  std::vector<Piece> triangles_, lines_; ///< in space; in a plane
  std::vector<int> parts_;
  std::vector<Eigen::AlignedBox3d> boxes_; ///< of each part
};

} // namespace dielast::meshing
