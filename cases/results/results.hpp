// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/analyses/profile.hpp"
#include "cases/results/error_estimate.hpp"
#include "post/pictures/report_tables.hpp"

#include <nlohmann/json_fwd.hpp>

namespace dielast::cases {

/// Everything that a finished run says of itself.
struct Results {
  Outcome outcome;
  std::vector<post::QuantityRow> quantities; ///< in the case's order
  std::vector<post::CheckRow> checks;
  std::vector<std::string> warnings{}; ///< before the run: keys without effect, a film of odd size
  std::string no_errors_because;       ///< why no quantity has an error estimate; empty otherwise
  std::vector<EventRemark> event_remarks;
  double time_error = 0; ///< see TimeSteps
  Taken taken{};
  std::vector<Margin> margins;
  std::vector<std::optional<ProfileTable>> profiles{}; ///< see profiles_of()

  bool checks_passed() const;
};

/// Values and checks of a run.
Results collect_results(const Case& one, const Simulation& simulation, const Outcome& outcome,
                        const Journal& journal, const Estimates& estimates, std::vector<Margin> margins = {});

/// The case's profiles in the last state; none where the run ended before the step since which one is taken.
std::vector<std::optional<ProfileTable>> profiles_of(const Case& one, const Device& device,
                                                     const Outcome& outcome, const Journal& journal);

/// Events with whether they depend on the mesh; of critical points that at which the run ends.
Journal with_remarks(Journal journal, const std::vector<EventRemark>& remarks);

/// summary.json: status, quantities.<name>.{value, unit, error_estimate, error_remark, peak}, checks, events,
/// warnings, mesh.
/// Nothing in it depends on the machine or the time.
nlohmann::json summary_json(const Case& one, const Device& device, const Results& results,
                            const Journal& journal);

/// Pictures of the shape before and after the last step, of modes, of the field that drives the film, and of
/// the places that the case names.
std::vector<post::Section> picture_sections(const Case& one, const Device& device, const Journal& journal);

/// report.html: what a person wants to see of a run.
post::Report run_report(const Case& one, const Device& device, const Results& results, const Journal& journal,
                        const std::string& log);

} // namespace dielast::cases
