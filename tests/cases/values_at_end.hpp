// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/runs/simulation.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace dielast::test {

/// Values of the quantities at the end of a run that must end well, SI.
inline std::map<std::string, double> values_at_end(const cases::Case& one) {
  cases::Simulation simulation(one, 1);
  const cases::Outcome outcome = simulation.run({});
  EXPECT_EQ(outcome.ending, cases::Ending::complete) << outcome.message;
  std::map<std::string, double> values;
  for (std::size_t q = 0; q < one.quantities.size(); ++q)
    values[one.quantities[q].name] = simulation.results()[q];
  return values;
}

} // namespace dielast::test
