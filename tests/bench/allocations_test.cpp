// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method keeps its workspace: after the first iteration of a solution it asks for no memory.
#include "tests/bench/models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>

namespace {

std::atomic<long> allocations = 0;

} // namespace

extern "C" void* __libc_malloc(std::size_t size);
/// What the program and its libraries allocate, vectors and matrices among it, comes through here.
extern "C" void* malloc(std::size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}

namespace dielast::bench::allocations_test {
namespace {

struct Asked {
  long at_first = 0; ///< in the first iteration of the first solution
  long later = 0;    ///< the most in any iteration but the first of a solution
};

Asked allocations_of(const Task& task) {
  fem::Equilibrium equilibrium(task.model, 1);
  fem::State state = task.model.initial_state();
  const auto path =
      fem::linear_path(task.model.dofs, fem::Loads::of(state, task.model.dofs), task.steps.front().first);
  Asked asked;
  for (const double s : {0.5, 1.0}) {
    path.apply(state, s);
    long before = allocations;
    const auto result = equilibrium.solve(state, {}, [&](const fem::Iteration& iteration) {
      const long now = allocations - before;
      if (iteration.number == 1 && asked.at_first == 0) asked.at_first = now;
      if (iteration.number > 1) asked.later = std::max(asked.later, now);
      before = allocations;
    });
    EXPECT_EQ(result.outcome, fem::Outcome::converged);
    EXPECT_GE(result.iterations, 2);
  }
  return asked;
}

TEST(Allocations, none_after_newtons_first_iteration) {
  for (const int rings : {21, 6}) { // with a kept factor, with one of its own for every iteration
    const Asked asked = allocations_of(partial_electrode_disc(rings));
    EXPECT_GT(asked.at_first, 0) << "or nothing is counted";
    EXPECT_EQ(asked.later, 0) << rings;
  }
}

} // namespace
} // namespace dielast::bench::allocations_test
