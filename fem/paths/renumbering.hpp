// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/dofs.hpp"

#include <vector>

namespace dielast::fem {

/// What goes from one numbering of the unknowns of a model to another, which holds others of them.
class Renumbering {
 public:
  /// Of two numberings of one model's unknowns; throws std::logic_error where one has others.
  Renumbering(const DofMap& from, const DofMap& to);

  /// A vector with one entry per equation; what stands behind them stays.
  Eigen::VectorXd operator()(const Eigen::VectorXd& values) const;
  /// The state with its dead forces and its motion: what is held from now on is at rest, what is tied to it
  /// moves with what is left of its body, and what is let go is in balance.
  State operator()(State state) const;
  /// Of values per equation those at unknowns that are let go, 0 at all others.
  Eigen::VectorXd let_go(const Eigen::VectorXd& values) const;

 private:
  std::vector<char> caught() const;

  const DofMap& to_;
  std::vector<int> from_; ///< per new equation the old one
  std::vector<char> was_held_;
};

} // namespace dielast::fem
