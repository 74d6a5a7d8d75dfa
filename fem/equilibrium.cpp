#include "fem/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

namespace dielast::fem {

namespace {

/// Adds the CPU time of its own life to a counter.
class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total), start_(std::clock()) {}
  ~Stopwatch() { total_ += static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& total_;
  std::clock_t start_;
};

constexpr double sufficient_decrease = 1e-4;
constexpr int most_halvings = 12;
/// Relative residual below which one more step leaves the tangent's inertia as it is.
constexpr double near = 1e-3;
constexpr int patience = 10; ///< iterations after which the residual must be smaller than at the start
constexpr int most_indefinite =
    6; ///< tangents in a row: by then the iteration wanders between unstable states

} // namespace

Equilibrium::Equilibrium(const Model& model, int threads)
    : model_(model), assembler_(model, threads), solver_(assembler_.matrix()) {
  weight_ = Eigen::VectorXd::Ones(model.dofs.count());
  for (int n = 0; n < model.dofs.node_count(); ++n)
    for (int c = 3; c < DofMap::components; ++c)
      if (const int e = model.dofs.equation(n, c); e != DofMap::absent) weight_[e] = 1 / model.length_scale;
  // Positions are known to a rounding of the extent; the stiffest unknowns turn it into force.
  assembler_.tangent(model.initial_state());
  const SparseSymmetric& K = assembler_.matrix();
  double stiffest = 0;
  for (int c = 0; c < K.size; ++c) {
    const auto diagonal = static_cast<std::size_t>(K.column_start[static_cast<std::size_t>(c)]);
    stiffest = std::max(stiffest, std::abs(K.values[diagonal]) * weight_[c] * weight_[c]);
  }
  round_off_ = std::numeric_limits<double>::epsilon() * stiffest * model.extent *
               std::sqrt(static_cast<double>(K.size));
}

double Equilibrium::weighted_norm(const Eigen::VectorXd& force, Eigen::Index count) const {
  return force.head(count).cwiseProduct(weight_.head(count)).norm();
}

double Equilibrium::force_scale(const State& state) const {
  double scale = weighted_norm(state.dead_force, state.dead_force.size());
  for (const auto& block : assembler_.block_residuals())
    scale = std::max(scale, weighted_norm(block, block.size()));
  return scale;
}

bool Equilibrium::factor_tangent(const State& state) {
  {
    const Stopwatch watch(timings_.tangent);
    assembler_.tangent(state);
  }
  const Stopwatch watch(timings_.factor);
  return solver_.factor();
}

bool Equilibrium::refresh_inertia(const State& state, NewtonResult& result) {
  const bool regular = factor_tangent(state);
  if (regular) result.negative_pivots = solver_.negative_pivots();
  return regular;
}

NewtonResult Equilibrium::solve(State& state, const NewtonOptions& options,
                                const std::function<void(const Iteration&)>& log) {
  const Eigen::Index free = model_.dofs.free_count();
  NewtonResult result;
  Eigen::VectorXd force, trial_force, step;
  const auto evaluate = [&](const State& at, Eigen::VectorXd& unbalanced) {
    const Stopwatch watch(timings_.residual);
    const Evaluation evaluation = assembler_.residual(at, unbalanced);
    unbalanced -= at.dead_force;
    return evaluation;
  };
  Evaluation current = evaluate(state, force);
  double norm = weighted_norm(force, free);
  double scale = force_scale(state);
  const double first_norm = norm;
  double previous_norm = std::numeric_limits<double>::infinity();
  double step_length = 0;
  int indefinite = 0;
  double stale_tangent =
      std::numeric_limits<double>::infinity(); // residual at which the last tangent was taken
  for (result.iterations = 0;; ++result.iterations) {
    if (!current.feasible || !std::isfinite(norm)) {
      result.outcome = Outcome::infeasible;
      return result;
    }
    result.residual = scale > 0 ? norm / scale : 0;
    if (log) log({result.iterations, result.residual, step_length, result.negative_pivots});
    const bool stagnates = norm <= round_off_ && norm > 0.3 * previous_norm;
    if (norm <= options.tolerance * scale || stagnates) {
      result.outcome = Outcome::converged;
      if (stale_tangent > near && !refresh_inertia(state, result)) result.outcome = Outcome::singular;
      return result;
    }
    if (result.iterations >= options.max_iterations || (result.iterations >= patience && norm > first_norm) ||
        indefinite >= most_indefinite) {
      result.outcome = Outcome::not_converged;
      return result;
    }
    previous_norm = norm;
    ++timings_.iterations;
    stale_tangent = result.residual;
    const bool regular = factor_tangent(state);
    if (!regular) {
      result.outcome = Outcome::singular;
      return result;
    }
    result.negative_pivots = solver_.negative_pivots();
    indefinite = result.negative_pivots > 0 ? indefinite + 1 : 0;
    {
      const Stopwatch watch(timings_.solve);
      solver_.solve(-force.head(free), step);
    }
    const double slope = force.head(free).dot(step);
    const double dead_work = state.dead_force.head(free).dot(step);
    bool accepted = false;
    step_length = 1;
    for (int halving = 0; halving <= most_halvings && !accepted;
         ++halving, step_length *= accepted ? 1 : 0.5) {
      State trial = state;
      model_.dofs.advance(trial, step, step_length);
      const Evaluation there = evaluate(trial, trial_force);
      const double trial_norm = weighted_norm(trial_force, free);
      if (!there.feasible || !std::isfinite(trial_norm)) continue;
      const double energy_change = there.energy - current.energy - step_length * dead_work;
      const bool descends =
          result.negative_pivots == 0 && energy_change <= sufficient_decrease * step_length * slope;
      accepted = descends || trial_norm < norm;
      if (accepted) {
        state = std::move(trial);
        force.swap(trial_force);
        current = there;
        norm = trial_norm;
        scale = force_scale(state);
      }
    }
    if (!accepted) { // round-off knows no descent
      result.outcome = norm <= round_off_ ? Outcome::converged : Outcome::not_converged;
      return result;
    }
  }
}

} // namespace dielast::fem
