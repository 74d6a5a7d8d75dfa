// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/results/results.hpp"

#include "cases/analyses/analysis_report.hpp"
#include "cases/case/quantities.hpp"
#include "cases/readers/resolved.hpp"
#include "cases/results/curves.hpp"
#include "meshing/quality.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::cases {

using nlohmann::json;

namespace {

const char* word(Ending ending) {
  switch (ending) {
  case Ending::complete:
    return "complete";
  case Ending::gave_up:
    return "not converged";
  case Ending::interrupted:
    return "interrupted";
  }
  return "";
}

std::string meshing_summary(const Device& device) {
  return meshing::format(meshing::quality(device.mesh)) + fmt::format("unknowns: {} free, {} held\n",
                                                                      device.model.dofs.free_count(),
                                                                      device.model.dofs.held_count());
}

/// Numbers worth seeing first: the user's own before the standard ones; none that is 0, round-off or all
/// error.
std::vector<post::Highlight> highlights(const Case& one, const Results& results, const Journal& journal) {
  constexpr std::size_t most = 6;
  const auto sizes = sizes_of_units(one, journal);
  std::vector<post::Highlight> shown;
  for (const std::size_t q : users_first(one)) {
    const post::QuantityRow& row = results.quantities[q];
    const auto size = sizes.find(row.unit);
    const double least = std::max(row.error.value_or(0), size == sizes.end() ? 0 : round_off * size->second);
    if (!(std::abs(row.value) > least) || shown.size() == most) continue;
    shown.push_back({row.name, post::engineering(row.value, row.unit, row.ratio), post::error_note(row)});
  }
  return shown;
}

/// What is known of the errors of margins, added to them.
std::vector<Margin> with_estimates(std::vector<Margin> margins, const std::vector<ErrorEstimate>& estimates) {
  for (std::size_t m = 0; m < std::min(margins.size(), estimates.size()); ++m) {
    margins[m].error = estimates[m].error;
    if (estimates[m].remark.empty()) continue;
    if (!margins[m].remark.empty()) margins[m].remark += "; ";
    margins[m].remark += estimates[m].remark;
  }
  return margins;
}

post::Section margin_section(const std::vector<Margin>& margins) {
  post::Table table{{"limit", "factor on the voltage", ""}, {}};
  for (const Margin& margin : margins) {
    const post::QuantityRow row{.name = margin.limit,
                                .value = margin.factor.value_or(0),
                                .unit = "1",
                                .error = margin.error,
                                .meaning = ""};
    table.rows.push_back({margin.limit, margin.factor ? post::with_error(row) : "-", margin.remark});
  }
  return {"Margins", {std::move(table)}};
}

std::string error_paragraph(const Results& results) {
  if (!results.no_errors_because.empty())
    return fmt::format("No estimate of the errors: {}.", results.no_errors_because);
  return "Errors are estimates of what elements and time steps leave: from solutions with both about two and "
         "four times as large (or smaller elements), by the order of convergence that is seen, with a "
         "safety factor; for extremes of fields at least what the field changes over one element there.";
}

/// Where one turn of a body in space is fixed, and not all that hold it change: no step spins it about that
/// axis, but spins about the other two leave a rotation about it, as turns do not commute. That rotation,
/// rad.
double drift_of_fixed_turn(const Case& one, const Body& body, const Device& device, const fem::State& state) {
  std::array<bool, 6> fixed = body.fixed;
  for (const Support& support : one.supports) {
    if (support.place != body.name) continue;
    if (!support.from.empty() || !support.until.empty()) return 0;
    for (std::size_t c = 0; c < fixed.size(); ++c) fixed[c] = fixed[c] || support.fixed[c];
  }
  if (one.dimension != fem::Dimension::spatial || fixed[3] + fixed[4] + fixed[5] != 1) return 0;
  const int axis = fixed[3] ? 0 : fixed[4] ? 1 : 2;
  return state.angle[static_cast<std::size_t>(device.mesh.node_sets.at(body.name).front())][axis];
}

} // namespace

Journal with_remarks(Journal journal, const std::vector<EventRemark>& remarks) {
  for (const auto& [kind, remark] : remarks) {
    bool told = false;
    for (auto record = journal.records.rbegin(); record != journal.records.rend(); ++record)
      for (auto event = record->events.rbegin(); event != record->events.rend(); ++event) {
        if (event->kind != kind || (told && is_critical(kind))) continue;
        event->message += fmt::format("; this {}", remark);
        told = true;
      }
  }
  return journal;
}

bool Results::checks_passed() const {
  return std::all_of(checks.begin(), checks.end(), [](const post::CheckRow& check) { return check.passed; });
}

Results collect_results(const Case& one, const Simulation& simulation, const Outcome& outcome,
                        const Journal& journal, const Estimates& estimates, std::vector<Margin> margins) {
  Results results{.outcome = outcome,
                  .warnings = simulation.warnings(),
                  .no_errors_because = estimates.reason,
                  .event_remarks = estimates.events,
                  .time_error = simulation.time_steps().error,
                  .taken = simulation.taken(),
                  .margins = with_estimates(std::move(margins), estimates.margins)};
  constexpr double poor_time_error = 0.02;
  if (results.time_error > poor_time_error)
    results.warnings.push_back(
        fmt::format("time steps: their errors of internal variables and motion may add up to {:.2g}, "
                    "relative: give the steps more increments or [solver] a smaller time_tolerance, or let "
                    "loads set out smoothly",
                    results.time_error));
  for (std::size_t q = 0; q < one.quantities.size(); ++q) {
    const Quantity& quantity = one.quantities[q];
    post::QuantityRow row{.name = quantity.name,
                          .value = simulation.results()[q],
                          .unit = unit_of(quantity, one.quantities),
                          .ratio = ratio_of(quantity),
                          .meaning = meaning_of(quantity),
                          .peak = peak_of(one, q, simulation.peaks(), journal)};
    if (q < estimates.quantities.size()) {
      row.error = estimates.quantities[q].error;
      row.error_remark = estimates.quantities[q].remark;
    }
    const auto margin = std::ranges::find(results.margins, quantity.of, &Margin::limit);
    if (quantity.kind->of_run && margin != results.margins.end()) {
      row.value = factor_to(quantity.of, results.margins);
      row.error = margin->error;
      row.error_remark = margin->remark;
    }
    if (!std::isfinite(row.value) && row.error_remark.empty() && outcome.ending == Ending::complete)
      row.error_remark = quantity.kind->vibrates
                             ? "no value: too little has a mass, or modes lie too close to one another"
                             : "no value in this state";
    results.quantities.push_back(std::move(row));
  }
  for (const Check& check : one.checks) {
    const auto row = std::find_if(results.quantities.begin(), results.quantities.end(),
                                  [&](const post::QuantityRow& r) { return r.name == check.quantity; });
    // What is read at the end has no value in a run that did not get there.
    const std::string& at = one.quantities[static_cast<std::size_t>(row - results.quantities.begin())].at;
    const bool reached = outcome.ending == Ending::complete || !at.empty();
    const double value = reached ? row->value : std::numeric_limits<double>::quiet_NaN();
    results.checks.push_back({check.quantity, value, check.value, check.tolerance, row->unit, row->ratio,
                              check.source, std::abs(value - check.value) <= check.tolerance});
  }
  if (const auto energy = simulation.energy().worst(); energy.is_poor())
    results.checks.push_back({"energy error", energy.told, 0, 0.01 * energy.exchanged, "J",
                              post::Ratio::plain,
                              fmt::format("every run: 1 % of the energy that was exchanged (up to row {} of "
                                          "history.csv)",
                                          energy.row),
                              false});
  constexpr double notable_drift = 1e-3; // rad
  for (const Body& body : one.bodies)
    if (const double drift = drift_of_fixed_turn(one, body, simulation.device(), simulation.state());
        std::abs(drift) > notable_drift)
      results.checks.push_back(
          {fmt::format("fixed turn of {}", body.name), drift, 0, notable_drift, "rad", post::Ratio::plain,
           "every run: a body of which one turn alone is fixed turns far about the others, and "
           "this one with them, by how much depends on the increments: fix two, or none",
           false});
  return results;
}

std::vector<std::optional<ProfileTable>> profiles_of(const Case& one, const Device& device,
                                                     const Outcome& outcome, const Journal& journal) {
  const auto& snapshots = journal.snapshots;
  std::vector<std::optional<ProfileTable>> tables;
  for (const Profile& profile : one.profiles) {
    const auto since = profile.since.empty() ? snapshots.begin()
                                             : std::ranges::find(snapshots, profile.since, &Snapshot::title);
    const bool under_way = outcome.ending != Ending::complete && since + 1 == snapshots.end();
    if (since == snapshots.end() || under_way)
      tables.emplace_back();
    else
      tables.push_back(profile_table(device, profile, since->displacement, snapshots.back().displacement));
  }
  return tables;
}

json summary_json(const Case& one, const Device& device, const Results& results, const Journal& journal) {
  const auto number = [](double value) { return std::isfinite(value) ? json(value) : json(nullptr); };
  nlohmann::ordered_json summary{{"program", "dielast " DIELAST_VERSION},
                                 {"title", one.title},
                                 {"status", word(results.outcome.ending)},
                                 {"message", results.outcome.message}};
  nlohmann::ordered_json quantities = nlohmann::ordered_json::object();
  for (const auto& row : results.quantities)
    quantities[row.name] = {{"value", number(row.value)},
                            {"unit", row.unit},
                            {"error_estimate", row.error ? number(*row.error) : json(nullptr)},
                            {"error_remark", row.error_remark},
                            {"meaning", row.meaning}};
  for (const auto& row : results.quantities)
    if (row.peak) quantities[row.name]["peak"] = {{"value", row.peak->value}, {"time", row.peak->time}};
  summary["quantities"] = quantities;
  summary["no_error_estimate_because"] = results.no_errors_because;
  json checks = json::array();
  for (const auto& check : results.checks)
    checks.push_back({{"quantity", check.quantity},
                      {"value", number(check.value)},
                      {"expected", check.expected},
                      {"tolerance", check.tolerance},
                      {"passed", check.passed},
                      {"source", check.source}});
  summary["checks"] = checks;
  nlohmann::ordered_json margins = nlohmann::ordered_json::object();
  for (const Margin& margin : results.margins)
    margins[margin.limit] = {{"factor", margin.factor ? number(*margin.factor) : json(nullptr)},
                             {"error_estimate", margin.error ? number(*margin.error) : json(nullptr)},
                             {"up_to", margin.up_to},
                             {"remark", margin.remark}};
  summary["margins"] = margins;
  if (results.time_error > 0) summary["time_error"] = results.time_error;
  json events = json::array();
  for (const auto& record : journal.records)
    for (const auto& event : record.events)
      events.push_back({{"kind", event.kind},
                        {"step", record.step},
                        {"record", record.index},
                        {"load_factor", event.before ? event.before->load_factor : record.load_factor},
                        {"time", event.before ? event.before->time : record.time},
                        {"voltages", event.before ? event.before->voltages : record.voltages},
                        {"place", event.place},
                        {"message", event.message}});
  // The bifurcation at which a run ends as at a limit point is told by the event that located it.
  const auto tells = [&](const post::Event& event) {
    return event.kind == results.outcome.kind ||
           (is_critical(event.kind) && is_critical(results.outcome.kind));
  };
  if (!results.outcome.kind.empty() && !journal.records.empty() &&
      std::ranges::none_of(journal.records.back().events, tells)) {
    const auto& last = journal.records.back();
    events.push_back({{"kind", results.outcome.kind},
                      {"step", last.step},
                      {"record", last.index},
                      {"load_factor", last.load_factor},
                      {"time", last.time},
                      {"voltages", last.voltages},
                      {"place", ""},
                      {"message", results.outcome.message}});
  }
  summary["events"] = events;
  summary["warnings"] = results.warnings;
  json remarks = json::array();
  for (const EventRemark& event : results.event_remarks)
    remarks.push_back({{"kind", event.kind}, {"remark", event.remark}});
  summary["event_remarks"] = remarks;
  json analyses = json::array();
  for (const Analysis& analysis : journal.analyses)
    analyses.push_back({{"step", analysis.step}, {"columns", analysis.columns}, {"rows", analysis.rows}});
  summary["analyses"] = analyses;
  summary["steps"] = {{"accepted", results.taken.states},
                      {"recorded", journal.records.size()},
                      {"newton_iterations", results.taken.iterations}};
  const auto quality = meshing::quality(device.mesh);
  summary["mesh"] = {{"nodes", quality.nodes},
                     {"triangles", quality.triangles},
                     {"tetrahedra", quality.tetrahedra},
                     {"beams", quality.lines},
                     {"unknowns", device.model.dofs.free_count()},
                     {"smallest_angle_deg", quality.smallest_angle}};
  return summary;
}

post::Report run_report(const Case& one, const Device& device, const Results& results, const Journal& journal,
                        const std::string& log) {
  post::Report report{
      .title = one.title, .subtitle = one.source.filename().string(), .footer = "dielast " DIELAST_VERSION};
  const bool converged = results.outcome.ending == Ending::complete;
  const bool quiet = std::all_of(journal.records.begin(), journal.records.end(),
                                 [](const post::StepRecord& record) { return record.events.empty(); });
  report.status = {std::string(word(results.outcome.ending)) + (quiet ? "" : ", see the events"),
                   converged && quiet && results.checks_passed() ? post::Tone::good : post::Tone::warning};
  report.highlights = highlights(one, results, journal);
  if (!results.outcome.message.empty())
    report.sections.push_back({"How it ended", {post::Paragraph{results.outcome.message}}});

  if (!results.warnings.empty()) {
    report.sections.push_back({"Warnings", {}});
    for (const std::string& warning : results.warnings)
      report.sections.back().blocks.push_back(post::Paragraph{warning});
  }
  for (post::Section& section : picture_sections(one, device, journal))
    report.sections.push_back(std::move(section));

  std::vector<post::Plot> profile_plots;
  for (std::size_t p = 0; p < one.profiles.size(); ++p)
    if (results.profiles[p]) profile_plots.push_back(results.profiles[p]->plot(one.profiles[p]));
  report.add("Profiles", post::draw(profile_plots));

  for (const Analysis& analysis : journal.analyses) report.sections.push_back(analysis_section(analysis));

  post::Section plots{"Curves", {}};
  std::vector<std::string> left_out;
  const std::vector<post::Plot> drawn = curves(one, journal, left_out);
  plots.add(post::draw(drawn));
  if (plots.blocks.empty() && !drawn.empty())
    plots.blocks.push_back(post::Paragraph{"No plots: gnuplot is not installed."});
  if (!left_out.empty())
    plots.blocks.push_back(post::Paragraph{
        fmt::format("Without a curve, as they do not change or have no value along the way: {}.",
                    fmt::join(left_out, ", "))});
  report.sections.push_back(std::move(plots));
  report.sections.push_back(
      {"Quantities", {post::quantity_table(results.quantities), post::Paragraph{error_paragraph(results)}}});
  report.sections.push_back(margin_section(results.margins));
  if (!results.checks.empty()) report.sections.push_back({"Checks", {post::check_table(results.checks)}});
  if (post::Table events = post::event_table(journal.records); !events.rows.empty())
    report.sections.push_back({"Events", {std::move(events)}});
  if (!results.event_remarks.empty()) {
    post::Section section{"Events that depend on the mesh", {}};
    for (const EventRemark& event : results.event_remarks)
      section.blocks.push_back(post::Paragraph{fmt::format("{}: {}.", event.kind, event.remark)});
    report.sections.push_back(std::move(section));
  }
  report.sections.push_back({"Increments", {post::increment_table(journal.records)}});
  report.sections.push_back({"Mesh", {post::Listing{meshing_summary(device)}}});
  report.sections.push_back({"Case, with every default", {post::Listing{resolved_text(one)}}});
  if (!log.empty()) report.sections.push_back({"Log", {post::Listing{log}}});
  return report;
}

} // namespace dielast::cases
