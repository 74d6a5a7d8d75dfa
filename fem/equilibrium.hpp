#pragma once

#include "fem/assembler.hpp"
#include "fem/symmetric_solver.hpp"

#include <functional>

namespace dielast::fem {

/// One line of the iteration log.
struct Iteration {
  int number = 0;
  double residual = 0;     ///< relative
  double step_length = 0;  ///< fraction of the Newton step taken to get here
  int negative_pivots = 0; ///< of the tangent whose step led here
};

struct NewtonOptions {
  double tolerance = 1e-9; ///< on |R_free| over the largest norm of a block's nodal forces (of the reactions,
                           ///< where one block is held)
  int max_iterations = 25;
};

enum class Outcome { converged, infeasible, not_converged, singular };

struct NewtonResult {
  Outcome outcome{};
  int iterations = 0;
  double residual = 0;     ///< relative norm at the end
  int negative_pivots = 0; ///< of the tangent at the end, or at most one small step before it
};

/// CPU seconds of this process, by task.
struct Timings {
  double residual = 0, tangent = 0, factor = 0, solve = 0;
  int iterations = 0;
};

/// Finds states in which the internal forces balance the dead ones: Newton's method with backtracking on the
/// potential energy where the tangent is positive definite, on the residual where it is not.
class Equilibrium {
 public:
  /// `threads`: 0 uses every core. The model must outlive this.
  Equilibrium(const Model& model, int threads);

  /// Improves `state` until it converges. On any other outcome `state` is where the iteration stopped.
  NewtonResult solve(State& state, const NewtonOptions& options,
                     const std::function<void(const Iteration&)>& log = {});

  /// Internal forces (count() entries; reactions at the held equations, from free_count() on).
  Evaluation internal_force(const State& state, Eigen::VectorXd& force) {
    return assembler_.residual(state, force);
  }

  /// Norm of residuals that are only rounding of the positions, N.
  double round_off() const { return round_off_; }
  const Model& model() const { return model_; }
  Assembler& assembler() { return assembler_; }
  const Timings& timings() const { return timings_; }

 private:
  double weighted_norm(const Eigen::VectorXd& force, Eigen::Index count) const;
  double force_scale(const State& state) const;
  bool factor_tangent(const State& state);
  bool refresh_inertia(const State& state, NewtonResult& result);

  const Model& model_;
  Assembler assembler_;
  SymmetricSolver solver_;
  Eigen::VectorXd weight_; ///< 1 for forces, 1/length_scale for moments
  double round_off_ = 0;
  Timings timings_;
};

} // namespace dielast::fem
