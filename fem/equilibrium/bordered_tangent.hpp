// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/symmetric_solver.hpp"
#include "fem/model/assembler.hpp"

#include <Eigen/LU>

#include <memory>
#include <optional>

namespace dielast::fem {

/// Whether some electrode's voltage is not given: it follows from its charge, or from its circuit.
bool any_follows(const State& state);

/// One more unknown s with an equation of its own.
struct PathBorder {
  Eigen::VectorXd column; ///< change of the unbalanced forces per s, per free equation
  Eigen::VectorXd row;    ///< row . du + corner ds = g
  double corner = 0;
};

/// Tangent under the control that a state is in, factored. K at fixed voltages is bordered by the charges of
/// electrodes whose voltages follow (B = dQ/du, capacitances C = dQ/dPhi, with their circuits') and, along a
/// path, by s:
///   [ K     -B     column ] [du  ]   [f]
///   [-B^T   -C     0      ] [dPhi] = [0]
///   [ row^T  0     corner ] [ds  ]   [g]
/// solved by block elimination, so that K keeps its sparsity. Where K is nearly singular (a limit point under
/// voltage control is an ordinary point under charge control) a stiffness sigma is put on one diagonal entry
/// j and taken away again by one more border: column -sigma e_j, corner sigma, unknown du_j. Inertia by
/// Sylvester's law: that of K plus that of the borders' Schur complement.
class BorderedTangent {
 public:
  /// `stiffness`: per free equation, positive, of the model as drawn; tells what is nearly singular. All must
  /// outlive this.
  BorderedTangent(const Model& model, const Assembler& assembler, const Eigen::VectorXd& stiffness);

  /// Factors the assembler's current tangent, taken at `state`; `added` goes on the diagonal of K. False:
  /// singular under this control.
  [[nodiscard]] bool factor(const State& state, const PathBorder* path = nullptr,
                            const Eigen::VectorXd* added = nullptr);
  /// As factor(), for steps of Newton's method: where K has no borders and is positive definite a factor in
  /// single precision does, an earlier one where that is known, and solve() is as good as its tolerance.
  /// `close`: the last one was of a state close by, and stable. `right`: the f of solve() to come, if known.
  [[nodiscard]] bool precondition(const State& state, bool close = false,
                                  const Eigen::VectorXd* right = nullptr);
  /// Negative eigenvalues of K less those that the scalars of the model bring (see DofMap): unstable
  /// directions at fixed voltages.
  int negative_pivots() const { return negative_pivots_; }
  /// Those of K + B C^-1 B^T, likewise: unstable directions under the control of the state.
  int unstable_modes() const { return unstable_modes_; }

  /// du for forces f; returns ds (0 without a path). Requires a successful factor() or precondition().
  double solve(const Eigen::VectorXd& f, Eigen::VectorXd& du, double g = 0,
               double tolerance = SymmetricSolver::exact);
  /// dPhi of a port that follows, by the last solve().
  double voltage_step(std::size_t port) const;
  /// K^-1 B of a port that follows: displacements per voltage (pressure) at fixed other ones.
  Eigen::VectorXd response(std::size_t port) const;

  /// What solve() after precondition() depends on beside the tangent; null where that is nothing.
  const FactorMemory* memory() const { return solver_->memory(); }
  /// Of a tangent of the same pattern.
  void recall(FactorMemory memory);

  SymmetricSolver::Work work() const;

 private:
  void follow_pattern();
  void set_borders(const State& state, const PathBorder* path);
  void append_border(const Eigen::VectorXd& column, const Eigen::VectorXd& row, double corner);
  void eliminate();
  std::optional<int> weakest_equation() const;
  bool shift(int equation, const Eigen::VectorXd* added);
  void count_modes(bool shifted);

  const Model& model_;
  const Assembler& assembler_;
  const SparseSymmetric& matrix_;
  const Eigen::VectorXd& stiffness_;
  std::unique_ptr<SymmetricSolver> solver_; ///< of the assembler's pattern `pattern_`
  int pattern_ = 0;
  SymmetricSolver::Work earlier_;        ///< of solvers of other patterns
  int paths_ = 0;                        ///< borders: the path, the electrodes that follow, the shift
  std::vector<std::size_t> following_;   ///< ports that follow
  Eigen::VectorXd root_capacitance_;     ///< theirs
  Eigen::VectorXd border_unknowns_;      ///< of the last solve
  Eigen::MatrixXd columns_, rows_;       ///< each scaled so that a symmetric border's corner is -1 or 1
  Eigen::VectorXd corner_;               ///< diagonal
  Eigen::MatrixXd solved_;               ///< K^-1 columns
  Eigen::MatrixXd schur_;                ///< corner - rows^T K^-1 columns
  Eigen::FullPivLU<Eigen::MatrixXd> lu_; ///< of schur_
  int negative_pivots_ = 0, unstable_modes_ = 0;
};

} // namespace dielast::fem
