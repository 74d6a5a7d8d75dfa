// SPDX-License-Identifier: GPL-3.0-or-later
// Small runs whose instructions are counted (instruction_counts_test.cpp): counted_runs
// patch|ring|meridian
#include "tests/bench/models.hpp"

#include <cmath>
#include <cstdio>
#include <map>
#include <string>

namespace dielast::bench {

namespace {

bool take(fem::Equilibrium& equilibrium, const fem::LoadPath& path, const fem::RampOptions& options,
          fem::State& state) {
  fem::RampProgress progress = fem::RampProgress::begin(state, equilibrium.model().dofs, options);
  const bool complete = fem::ramp(equilibrium, path, options, progress, {}).end == fem::RampEnd::complete;
  state = progress.points.back().state;
  return complete;
}

/// Where the result has gone, m; not a number where the ramp ends before.
double run(const Task& task, bool cycles) {
  fem::Equilibrium equilibrium(task.model, 1);
  fem::State state = begun(task, equilibrium);
  for (const auto& [target, increments] : task.steps) {
    const fem::LoadPath path =
        fem::linear_path(task.model.dofs, fem::Loads::of(state, task.model.dofs), target);
    if (!take(equilibrium, path, {.increments = increments, .instantaneous = cycles}, state)) return NAN;
  }
  constexpr int few = 100; // the first 12 s
  fem::LoadPath first = rolled_muscle_cycles();
  first.apply = [whole = first.apply](fem::State& at, double s) { whole(at, s / few); };
  if (cycles &&
      !take(equilibrium, first, {.increments = muscle_steps / few, .duration = muscle_duration / few}, state))
    return NAN;
  return state.displacement[static_cast<std::size_t>(task.node)][task.component];
}

} // namespace

} // namespace dielast::bench

int main(int count, char** words) {
  using namespace dielast::bench;
  const std::map<std::string, Task (*)()> tasks{
      {"patch", rolled_muscle}, {"ring", film_in_a_ring}, {"meridian", meridian_of_diaphragm}};
  const auto found = tasks.find(count == 2 ? words[1] : "");
  if (found == tasks.end()) return 1;
  const double moved = run(found->second(), found->first == "patch");
  std::printf("%.9g\n", moved);
  return std::isfinite(moved) ? 0 : 4;
}
