// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "meshing/mesh.hpp"

namespace dielast::cases {

/// What nothing moves in any step. The three must outlive it.
class HeldPlaces {
 public:
  HeldPlaces(const Case& one, const meshing::Mesh& mesh, const fem::DofMap& dofs)
      : one_(one), mesh_(mesh), dofs_(dofs) {}

  /// Whether the node never moves along the axis (0..2).
  bool rests(int node, int axis) const;
  /// Whether no node of the place ever does.
  bool rests(const std::string& place, int axis) const;

 private:
  const Case& one_;
  const meshing::Mesh& mesh_;
  const fem::DofMap& dofs_;
};

} // namespace dielast::cases
