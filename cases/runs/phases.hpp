// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/holding.hpp"
#include "fem/model/dofs.hpp"
#include "meshing/mesh.hpp"

namespace dielast::cases {

/// The case with these supports alone.
Case with_supports(Case one, const std::vector<char>& holding);

/// Throws CaseError where in one step two supports move the same unknown to different places. What a support
/// merely holds another one may move. `dofs` numbered.
void require_one_motion(const Case& one, const meshing::Mesh& mesh, const fem::DofMap& dofs);

/// What goes from one numbering of the unknowns of a model to another, which holds others of them.
class Renumbering {
 public:
  Renumbering(const fem::DofMap& from, const fem::DofMap& to);

  /// A vector with one entry per equation; what stands behind them stays.
  Eigen::VectorXd operator()(const Eigen::VectorXd& values) const;
  /// The state with its dead forces and its motion; what is held from now on is at rest, and what is let go
  /// in balance.
  fem::State operator()(fem::State state) const;
  /// Of values per equation those at unknowns that are let go, 0 at all others.
  Eigen::VectorXd let_go(const Eigen::VectorXd& values) const;

 private:
  const fem::DofMap& to_;
  std::vector<int> from_; ///< per new equation the old one
  std::vector<char> was_held_;
};

} // namespace dielast::cases
