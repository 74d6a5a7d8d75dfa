// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/results/results.hpp"
#include "cases/runs/simulation.hpp"

#include <map>
#include <string>

namespace dielast::test {

/// Runs a case, however it ends; the margins by what they are of.
inline std::map<std::string, cases::Margin> margins_at_end(const cases::Case& one) {
  cases::Simulation simulation(one, 1);
  cases::Journal journal;
  cases::SimulationObserver observer;
  observer.on_accept = [&](const cases::Frame& frame) {
    journal.records.push_back(frame.record);
    journal.values.push_back(frame.values);
    return true;
  };
  const cases::Outcome outcome = simulation.run(observer);
  std::map<std::string, cases::Margin> found;
  for (cases::Margin& margin : cases::margins_of(one, simulation, journal, outcome, 1))
    found[margin.limit] = margin;
  return found;
}

} // namespace dielast::test
