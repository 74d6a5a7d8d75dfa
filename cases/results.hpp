#pragma once

#include "cases/recorder.hpp"
#include "post/report_tables.hpp"

#include <nlohmann/json.hpp>

namespace dielast::cases {

/// Everything that a finished run says of itself.
struct Results {
  Outcome outcome;
  std::vector<post::QuantityRow> quantities; ///< in the case's order
  std::vector<post::CheckRow> checks;
  std::vector<std::string> warnings{}; ///< before the run: keys without effect, a film of odd size

  bool checks_passed() const;
};

/// Values and checks of a run. `errors`: estimated discretisation error of each quantity, NaN where unknown;
/// may be empty.
Results collect_results(const Case& one, const Simulation& simulation, const Outcome& outcome,
                        const std::vector<double>& errors);

/// summary.json: status, quantities.<name>.{value, unit, error_estimate}, checks, events, warnings, mesh.
/// Nothing in it depends on the machine or the time.
nlohmann::json summary_json(const Case& one, const Device& device, const Results& results,
                            const Journal& journal);

/// report.html: what a person wants to see of a run.
post::Report run_report(const Case& one, const Device& device, const Results& results, const Journal& journal,
                        const std::string& log);

} // namespace dielast::cases
