// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/results/results.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/case_test.hpp"

namespace dielast::cases {

/// Cases of which a test looks at the rows of one quantity and at how the run ended.
class Paths : public test::CaseTest {
 protected:
  struct Row {
    double load_factor, time, voltage, value;
    int unstable_modes;
  };
  struct Run {
    Outcome outcome;
    std::vector<Row> rows;
    std::vector<post::Event> events;
    Results results;
  };
  /// Rows carry the quantity of this name.
  Run run(const std::string& text, const std::string& name) {
    const Case one = read(text);
    std::size_t q = 0;
    while (one.quantities.at(q).name != name) ++q;
    Simulation simulation(one, 1);
    Run result;
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      const post::StepRecord& record = frame.record;
      result.rows.push_back({record.load_factor, record.time, record.largest_voltage(), frame.values[q],
                             record.unstable_modes});
      result.events.insert(result.events.end(), record.events.begin(), record.events.end());
      return true;
    };
    result.outcome = simulation.run(observer);
    result.results = collect_results(one, simulation, result.outcome, {}, {});
    return result;
  }
  static std::string steps(const std::string& drive, const std::string& last) {
    return "[drive]\nvoltage = " + drive + "\n[[step]]\nkind = \"force\"\n[[step]]\n" + last;
  }
};

} // namespace dielast::cases
