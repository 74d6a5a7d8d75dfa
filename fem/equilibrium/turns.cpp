// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"
#include "fem/model/contact_block.hpp"

namespace dielast::fem {

namespace {

constexpr int most_turns = 40;         ///< between forces and sheets
constexpr int most_bounds = 30;        ///< of friction that are tried
constexpr double steady_bounds = 1e-7; ///< change of bounds of friction, over the largest

} // namespace

NewtonResult Equilibrium::solve(State& state, const NewtonOptions& options,
                                const std::function<void(const Iteration&)>& log) {
  int iterations = 0;
  const auto balanced = [&] {
    NewtonResult result =
        conduction_ ? balance_sheets(state, options, log) : balance_forces(state, options, log);
    result.iterations = iterations += result.iterations;
    return result;
  };
  NewtonResult result = balanced();
  if (!has_friction(model_) || state.scheme.is_frozen()) return result;
  for (int turn = 0; result.outcome == Outcome::converged; ++turn) {
    if (bound_friction(model_, state) <= steady_bounds) break;
    if (turn == most_bounds)
      result.outcome = Outcome::not_converged;
    else
      result = balanced();
  }
  return result;
}

NewtonResult Equilibrium::balance_sheets(State& state, const NewtonOptions& options,
                                         const std::function<void(const Iteration&)>& log) {
  conduction_->solve(state);
  int iterations = 0;
  double part = 1; // of the change of drops that is taken
  Eigen::VectorXd change = Eigen::VectorXd::Zero(state.sheet_drop.size());
  for (int turn = 0;; ++turn) {
    NewtonResult result = balance_forces(state, options, log);
    result.iterations = iterations += result.iterations;
    if (result.outcome != Outcome::converged) return result;
    const Eigen::VectorXd drop = state.sheet_drop;
    if (conduction_->solve(state) <= options.tolerance) return result;
    if (turn == most_turns) {
      result.outcome = Outcome::not_converged;
      return result;
    }
    const Eigen::VectorXd next = state.sheet_drop - drop;
    if (const double bend = (next - change).squaredNorm(); turn > 0 && bend > 0)
      part *= -change.dot(next - change) / bend;
    change = next;
    state.sheet_drop = drop + part * change;
  }
}

} // namespace dielast::fem
