// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/machine/memory.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace dielast::fem::memory_test {
namespace {

TEST(Memory, what_there_is_not_is_told_with_how_much_it_takes) {
  EXPECT_NO_THROW(require_memory(1e9, "the factor", 2e9));
  try {
    require_memory(41.26e9, "the factor", 17.84e9);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "the factor takes 41.3 GB of memory, and 17.8 GB are free: use a coarser mesh");
  }
}

TEST(Memory, some_is_free_on_a_machine_that_runs_this) {
  EXPECT_GT(available_memory(), 1e7);
  EXPECT_LT(available_memory(), 1e14);
  EXPECT_THROW(require_memory(1e15, "more than any machine has"), std::runtime_error);
}

} // namespace
} // namespace dielast::fem::memory_test
