// SPDX-License-Identifier: GPL-3.0-or-later
// The benchmark tasks at their smallest size: results that three codes agree on, and how many of Newton's
// iterations, each with a factorisation, they take: a regression is seen without a clock.
#include "tests/bench/models.hpp"

#include <gtest/gtest.h>

namespace dielast::bench {
namespace {

struct Outcome {
  double result = 0; ///< mm
  int iterations = 0;
};

Outcome ramp(const Task& task) {
  fem::Equilibrium equilibrium(task.model, 1);
  fem::State state = task.model.initial_state();
  for (const auto& [target, increments] : task.steps) {
    const fem::RampOptions options{.increments = increments};
    fem::RampProgress progress = fem::RampProgress::begin(state, task.model.dofs, options);
    const auto path = fem::linear_path(task.model.dofs, progress.start, target);
    EXPECT_EQ(fem::ramp(equilibrium, path, options, progress, {}).end, fem::RampEnd::complete);
    state = progress.points.back().state;
  }
  return {1e3 * state.displacement[static_cast<std::size_t>(task.node)][task.component],
          equilibrium.timings().iterations};
}

// With plain Newton's method these ramps take 23 and 29 iterations.
TEST(Benchmarks, disc_agrees_with_other_codes_in_few_iterations) {
  const Outcome disc = ramp(partial_electrode_disc(21));
  EXPECT_NEAR(disc.result + 30, 33.795338054887, 33.8 * 1e-9);
  EXPECT_LE(disc.iterations, 16);
}

TEST(Benchmarks, diaphragm_agrees_with_other_codes_in_few_iterations) {
  const Outcome diaphragm = ramp(plate_diaphragm(1));
  EXPECT_NEAR(diaphragm.result, 6.5415, 3e-4);
  EXPECT_LE(diaphragm.iterations, 20);
}

} // namespace
} // namespace dielast::bench
