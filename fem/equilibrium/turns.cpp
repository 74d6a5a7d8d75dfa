// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"
#include "fem/model/contact_block.hpp"

#include <array>

namespace dielast::fem {

namespace {

constexpr int most_turns = 40;           ///< between forces and sheets
constexpr std::size_t most_bounds = 120; ///< of friction that are tried: some converge slowly
constexpr double steady_bounds = 1e-7;   ///< change of bounds of friction, over the largest

/// By what bounds of friction are multiplied in the solutions after the first where something has just
/// touched: how much slides then is alike in the smallest increment.
constexpr std::array eased{4.0, 2.0, 1.4, 1.2, 1.1, 1.05, 1.02};

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
  const bool fresh = result.outcome == Outcome::converged && is_pressed_first(model_, state);
  for (std::size_t turn = 0; result.outcome == Outcome::converged; ++turn) {
    const bool eases = fresh && turn < eased.size();
    if (bound_friction(model_, state, true, eases ? eased[turn] : 1) <= steady_bounds && !eases) break;
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
