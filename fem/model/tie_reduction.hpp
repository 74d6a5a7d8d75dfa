// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/sparse_matrix.hpp"
#include "fem/model/dofs.hpp"

namespace dielast::fem {

/// Takes tied nodes out of a tangent. K of free and tied unknowns becomes
///   S^T K S + sum over tied nodes of f . d2x/dtheta2,   S = d(free and tied)/d(free),
/// f being the unbalanced force on the tied node. Of a rigid body only the levers in S change with the state;
/// the places of all entries are found once.
class TieReduction {
 public:
  /// `full`: pattern over the free unknowns, then the tied ones.
  TieReduction(const DofMap& dofs, const SparseSymmetric& full);

  /// Over the free unknowns, values zero.
  SparseSymmetric pattern() const { return pattern_; }
  /// Values in pattern() of S^T K S.
  std::vector<double> reduce(const State& state, const std::vector<double>& full) const;
  /// Adds what the forces on the tied nodes resist rotation with; count() entries.
  void add_geometric(const State& state, const Eigen::VectorXd& force, std::vector<double>& values) const;

 private:
  struct Term { ///< one term of an unknown: free equation, factor
    int equation, factor;
  };
  struct Product { ///< entry `to` gets entry `from` times two factors
    int from, to, first, second;
  };
  std::vector<Term> terms(int unknown) const;

  const DofMap& dofs_;
  SparseSymmetric pattern_;
  std::vector<std::vector<Term>> of_tied_; ///< per displacement of a tied node
  std::vector<Product> products_;
  std::vector<std::array<int, 2>> copies_; ///< from, to: of free unknowns
};

} // namespace dielast::fem
