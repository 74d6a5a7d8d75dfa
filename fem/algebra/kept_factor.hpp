// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/multifrontal_cholesky.hpp"

#include <optional>
#include <vector>

namespace dielast::fem {

/// What the solutions of a KeptFactor depend on beside the matrix: with it another one goes on bit for bit.
struct FactorMemory {
  std::vector<double> values; ///< of the matrix that the factor was made of; none: it is still to be made
  bool proves = false;        ///< the factor is one of the matrix itself, see KeptFactor::prove()
  bool fails = false;         ///< single precision does not do
  double fresh = 0; ///< iterations per decade of the tolerance, of the first solve with it; 0 before
  double debt = 0;  ///< iterations beyond those
};

/// Solves with positive definite matrices of one pattern that change little from one to the next: conjugate
/// gradients (Hestenes & Stiefel 1952), preconditioned by the factor of an earlier matrix in single
/// precision. A factor is replaced when the iterations that a new one would have saved have cost as much as
/// it. Costs are counted, not measured: results do not depend on a clock.
class KeptFactor {
 public:
  /// All must outlive this.
  KeptFactor(const SparseSymmetric& matrix, const Supernodes& supernodes, Workers& workers);

  /// What a factor costs, in iterations with it.
  static double cost(const Supernodes& supernodes);
  /// Where a factor costs less, it is not worth keeping.
  static constexpr double least_cost = 3;
  /// Where a factor costs less, one in double precision is had for what more iterations cost.
  static constexpr double least_cost_to_prove = 5;
  /// To be called when the matrix has changed. False: single precision does not do for matrices like this
  /// one.
  [[nodiscard]] bool prepare();
  /// The same where nothing is known of the matrix: factors what is left when a part of its diagonal is taken
  /// off, much more than the rounding of single precision. True proves it to be positive definite. A solve
  /// with the `right` side, if it comes next, then costs less.
  [[nodiscard]] bool prove(const Eigen::VectorXd* right = nullptr);
  /// x = A^-1 b with the current values, by corrections until one is below `tolerance` of x, in the norm of
  /// A; from 1 on what the factor tells. False: A has turned out not to be positive definite, or not in
  /// single precision.
  [[nodiscard]] bool solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance);

  const FactorMemory& memory() const { return memory_; }
  /// Of a matrix of the same pattern.
  void recall(FactorMemory memory);

  int factorisations() const { return factorisations_; }
  int solves() const { return solves_; } ///< with the factor

 private:
  /// Columns that one thread takes together. What they contribute to the rows behind them, `spilled`, is
  /// added afterwards, block by block, so that sums do not depend on the number of threads.
  struct Block {
    int first, last;
    std::vector<int> row;        ///< of each number in `spilled`
    std::vector<int> place;      ///< in `spilled`, of each entry in these rows, column by column
    std::vector<double> spilled; ///< and a workspace
  };
  void divide_columns();
  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y);
  template<class Function>
  void for_blocks(const Function& f);
  double dot(const Eigen::VectorXd& x, const Eigen::VectorXd& y);
  static constexpr double rounded = 2e-6; ///< some thirty roundings
  bool make(bool proves = false, const Eigen::VectorXd* right = nullptr);
  bool factor_of_memory(const Eigen::VectorXd* right);
  void apply_factor();
  std::optional<int> iterate(Eigen::VectorXd& x, double& square, double tolerance, int most);

  const SparseSymmetric& matrix_;
  Workers& workers_;
  MultifrontalCholesky<float> factor_;
  std::vector<Block> blocks_;
  std::vector<double> sums_; ///< of the blocks
  double cost_;
  FactorMemory memory_;
  int factorisations_ = 0, solves_ = 0;
  Eigen::VectorXd ahead_; ///< right side that the factor has been made with
  bool is_ahead_ = false; ///< no solve has followed
  Eigen::VectorXd r_, z_, p_, Ap_;
};

} // namespace dielast::fem
