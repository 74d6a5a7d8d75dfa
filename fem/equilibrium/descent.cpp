// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"

#include "fem/model/contact_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace dielast::fem {

namespace {

constexpr double first_damping = 1e-4; ///< over the stiffness as drawn
constexpr double least_damping = 1e-12, most_damping = 1e8;
constexpr double less = 1.0 / 5, more = 6;  ///< factors of the damping
constexpr double well = 0.75, badly = 0.25; ///< decrease of the energy over the one that was foretold
constexpr double rounded = 1e-12;           ///< of the energy: smaller changes are not told
constexpr int most_steps = 400;             ///< with wrinkles
constexpr int most_times = 2;               ///< with friction alone: times the iterations of Newton's method

constexpr double next_to_nothing = 1e-9; ///< of the film's stiffness: tension that is none
/// Part of a film's unknowns, the stiffest last, up to which none but it resists: the others may be held by
/// springs or bars, too.
constexpr double of_film_alone = 0.9;

} // namespace

/// N/m, of film that may be slack, as drawn.
double Equilibrium::film_stiffness() const {
  std::vector<double> all;
  for (const auto& block : model_.blocks) {
    if (!block->may_be_slack()) continue;
    std::vector<int> equations(static_cast<std::size_t>(block->dofs_per_element()));
    for (int e = 0; e < block->element_count(); ++e) {
      block->element_equations(e, model_.dofs, equations);
      for (const int equation : equations)
        if (equation >= 0 && equation < stiffness_.size()) all.push_back(stiffness_[equation]);
    }
  }
  if (all.empty()) return stiffness_.size() > 0 ? stiffness_.maxCoeff() : 0; // its nodes are tied to others
  const auto there =
      all.begin() + static_cast<std::ptrdiff_t>(of_film_alone * static_cast<double>(all.size()));
  std::ranges::nth_element(all, there);
  return *there;
}

std::vector<char> Equilibrium::moved_by(bool film) const {
  const DofMap& dofs = model_.dofs;
  std::map<int, int> carried; // tied equations and the nodes that carry them
  for (const Tie& tie : dofs.ties())
    for (int c = 0; c < 3; ++c) carried[dofs.equation(tie.node, c)] = tie.master;
  std::vector<char> moved(static_cast<std::size_t>(stiffness_.size()), 0);
  const auto mark = [&](int equation) {
    if (dofs.is_free(equation)) moved[static_cast<std::size_t>(equation)] = 1;
  };
  const State drawn = film ? State() : model_.initial_state();
  for (const auto& block : model_.blocks) {
    if (block->may_be_slack() != film) continue;
    Samples samples; // of bars, shells and solids, not of chambers and contact
    if (!film) block->sample(drawn, samples);
    if (!film && samples.film.empty() && samples.walls.empty()) continue;
    std::vector<int> equations(static_cast<std::size_t>(block->dofs_per_element()));
    for (int e = 0; e < block->element_count(); ++e) {
      block->element_equations(e, dofs, equations);
      for (const int equation : equations) {
        mark(equation);
        const auto carrier = carried.find(equation);
        if (equation < 0 || carrier == carried.end()) continue;
        for (int c = 0; c < 3; ++c) mark(dofs.equation(carrier->second, c));
        for (const int turn : dofs.turns(carrier->second)) mark(turn);
      }
    }
  }
  return moved;
}

std::vector<char> Equilibrium::moved_by_film_alone() const {
  std::vector<char> moved = moved_by_film();
  const std::vector<char> others = moved_by(false);
  for (std::size_t e = 0; e < moved.size(); ++e)
    if (others[e]) moved[e] = 0;
  return moved;
}

bool Equilibrium::is_slack(const State& state) const {
  Samples samples;
  for (const auto& block : model_.blocks)
    if (block->may_be_slack()) block->sample(state, samples);
  return !samples.film.empty() && std::ranges::all_of(samples.film, [this](const MembraneSample& sample) {
    return sample.voltage == 0 && sample.S.norm() * sample.thickness <= next_to_nothing * film_stiffness_;
  });
}

bool Equilibrium::is_neutral(const State& state, int unstable_modes, const NewtonOptions& options) {
  constexpr double rounding = 1e-10, several = 10; // over the stiffness as drawn, and what keeps it regular
  const auto film = model_.sample(state).film;
  const bool wrinkles =
      options.wrinkles && std::ranges::count(film, materials::Tension::slack, &MembraneSample::tension) > 0;
  if (!wrinkles && !is_slack(state)) return false;
  const std::vector<char> moved = moved_by_film();
  double left = 0;
  for (const auto& block : model_.blocks) left = std::max(left, block->left_where_wrinkled());
  Eigen::VectorXd added = Eigen::VectorXd::Zero(stiffness_.size()); // what film does not move is what it is
  for (Eigen::Index e = 0; e < added.size(); ++e)
    if (moved[static_cast<std::size_t>(e)])
      added[e] = (wrinkles ? several * left : rounding) *
                 std::min(stiffness_[e], film_stiffness_ / (weight_[e] * weight_[e]));
  return factor(state, nullptr, &added) && tangent_.unstable_modes() <= unstable_modes;
}

/// Levenberg-Marquardt: (K + c D) du = -R, D = stiffness(), with as much c as it takes for the energy to fall
/// as it was foretold. Where wrinkles come and go, or what is pressed sticks and slides, the energy is smooth
/// by parts only, and slack film has hardly any stiffness: Newton's steps are much too long there. With
/// scalars an equilibrium is a saddle of the energy: these are not damped, and the forces are to fall.
NewtonResult Equilibrium::descend(State& state, const NewtonOptions& options,
                                  const std::function<void(const Iteration&)>& log) {
  const Eigen::Index free = model_.dofs.free_count();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  NewtonResult result{.outcome = Outcome::not_converged};
  double damping = first_damping, previous_norm = infinity, length = 0;
  Balance current, there;
  Eigen::VectorXd step;
  balance(state, current, Pressure::is_unknown);
  const auto chamber = model_.ports.closed_chamber(state);
  const int most = options.wrinkles ? most_steps : most_times * options.max_iterations;
  for (; result.iterations < most && damping < most_damping; ++result.iterations) {
    if (!current.feasible) return result;
    result.residual = current.scale > 0 ? current.norm / current.scale : 0;
    if (log) log({result.iterations, result.residual, length, result.negative_pivots});
    // How far a damped step goes tells nothing of how near the equilibrium is.
    const double admitted = admitted_correction(current, options.tolerance, previous_norm, infinity);
    if (admitted > 0) {
      if (!factor(state)) return result;
      tangent_.solve(-current.force.head(free), step);
      if (step_size(step) <= admitted) {
        result.negative_pivots = tangent_.negative_pivots();
        result.unstable_modes = tangent_.unstable_modes();
        result.outcome = Outcome::converged;
        return result;
      }
    }
    Eigen::VectorXd added = damping * stiffness_;
    for (int s = 0; s < model_.dofs.scalar_count(); ++s)
      if (const int e = model_.dofs.scalar_equation(s); model_.dofs.is_free(e)) added[e] = 0;
    if (!factor(state, nullptr, &added) || tangent_.unstable_modes() > 0) {
      damping *= more;
      continue;
    }
    tangent_.solve(-current.force.head(free), step);
    const double foretold = current.force.head(free).dot(step) / 2; // without damping it would be this
    State trial = state;
    model_.dofs.advance(trial, step, 1);
    const double dead_work =
        state.dead_force.head(free).dot(step) + model_.dofs.work_on_tied(state.dead_force, state, trial);
    bool feasible = free_way(model_, state, trial) == 1;
    if (feasible && chamber) {
      trial.voltage[*chamber] += tangent_.voltage_step(*chamber);
      feasible = model_.fill(trial, tangent_.response(*chamber));
    }
    if (feasible) balance(trial, there, Pressure::is_unknown);
    const double change = there.energy - current.energy - dead_work;
    const double noise = rounded * (std::abs(there.energy) + std::abs(current.energy) + std::abs(dead_work));
    const bool tells = model_.dofs.scalar_count() == 0 && -foretold > noise;
    const bool falls = tells ? change < 0 : there.norm < current.norm;
    if (!feasible || !there.feasible || !falls) {
      damping *= more;
      length = 0;
      continue;
    }
    const double share = tells ? change / foretold : 1;
    if (share > well) damping = std::max(least_damping, damping * less);
    if (share < badly) damping *= more;
    previous_norm = current.norm;
    length = 1;
    state = std::move(trial);
    std::swap(current, there);
  }
  return result;
}

} // namespace dielast::fem
