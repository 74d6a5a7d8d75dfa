// SPDX-License-Identifier: GPL-3.0-or-later
// The benchmark tasks at their smallest size: results that three codes agree on, and how many factorisations,
// solves and iterations they take, so that a regression by a factor is seen without a clock.
#include "tests/bench/models.hpp"

#include <gtest/gtest.h>

namespace dielast::bench::counts_test {
namespace {

struct Outcome {
  double result = 0; ///< mm
  fem::SymmetricSolver::Work work;
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
          equilibrium.tangent().work(), equilibrium.timings().iterations};
}

// With plain Newton's method these ramps take 23 and 29 iterations, each with a factorisation.
TEST(Benchmarks, disc_agrees_with_other_codes_and_keeps_its_factor) {
  const Outcome disc = ramp(partial_electrode_disc(21));
  EXPECT_NEAR(disc.result + 30, 33.795338054887, 33.8 * 1e-9);
  EXPECT_LE(disc.iterations, 16);
  EXPECT_LE(disc.work.factorisations, 2);
  EXPECT_LE(disc.work.solves, 60);
}

TEST(Benchmarks, diaphragm_agrees_with_other_codes_and_keeps_its_factor) {
  const Outcome diaphragm = ramp(plate_diaphragm(1));
  EXPECT_NEAR(diaphragm.result, 6.5415, 3e-4);
  EXPECT_LE(diaphragm.iterations, 20);
  EXPECT_LE(diaphragm.work.factorisations, 3);
  EXPECT_LE(diaphragm.work.solves, 90);
}

// A hundredth of a millimetre of film on elements of 3 mm bends as if it did not resist bending, at every
// load in one go: with all of the transverse shear's stiffness directors would buckle against each other (61
// iterations, some states unstable).
TEST(Benchmarks, a_shell_next_to_a_membrane_goes_its_way) {
  const Outcome membrane = ramp(plate_diaphragm(1)), shell = ramp(plate_diaphragm_shell(1));
  EXPECT_NEAR(shell.result, membrane.result, 1e-5 * membrane.result);
  EXPECT_LE(shell.iterations, 20);
  EXPECT_LE(shell.work.factorisations, 25);
}

} // namespace
} // namespace dielast::bench::counts_test
