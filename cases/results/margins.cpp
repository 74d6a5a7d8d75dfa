// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/results/margins.hpp"

#include "cases/console/terminal.hpp"
#include "cases/language/conditions.hpp"
#include "cases/results/further_way.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

namespace dielast::cases {
namespace {

constexpr double unknown = Passed::unknown;

/// The value of a standard or written quantity of that kind; NaN where the case has none.
double extreme_of(const Case& one, const std::vector<double>& values, const char* field,
                  post::Extreme which) {
  for (std::size_t q = 0; q < one.quantities.size(); ++q) {
    const Quantity& quantity = one.quantities[q];
    if (quantity.kind->extreme && quantity.of == field && quantity.extreme == which && quantity.at.empty())
      return values[q];
  }
  return unknown;
}

/// Whether voltages, and nothing else, have led to a state.
bool is_led_by_voltages(const Case& one, const post::StepRecord& record) {
  const auto step = std::ranges::find(one.steps, record.step, &Step::name);
  return step != one.steps.end() && step->kind == StepKind::voltage;
}

/// What a run has passed on its way to its end: its last states with rising voltages, and nothing else that
/// changes but where they are zero. Film that may wrinkle is taut until an event says otherwise.
std::vector<Passed> way_of(const Case& one, const Journal& journal) {
  std::vector<Passed> way;
  const post::StepRecord& end = journal.records.back();
  for (std::size_t r = journal.records.size(); r-- > 0;) {
    const post::StepRecord& record = journal.records[r];
    const auto factor = factor_of(record.voltages, end);
    if (!factor || *factor < 0 || (!way.empty() && *factor >= way.back().factor)) break;
    const auto& values = journal.values[r];
    way.push_back({.factor = *factor,
                   .breakdown = extreme_of(one, values, "breakdown_ratio", post::Extreme::maximum),
                   .least_stress = extreme_of(one, values, "min_principal_stress", post::Extreme::minimum),
                   .yield = extreme_of(one, values, "yield_ratio", post::Extreme::maximum),
                   .slack = extreme_of(one, values, "tension_state", post::Extreme::maximum),
                   .record = record.index});
    if (*factor == 0 || !is_led_by_voltages(one, record)) break;
  }
  std::ranges::reverse(way);
  double slack = way.front().least_stress > 0 ? 0 : unknown;
  for (Passed& passed : way) {
    for (const post::Event& event : journal.records[static_cast<std::size_t>(passed.record)].events)
      if (event.kind == "loss of tension") slack = 1;
    if (std::isnan(passed.slack)) passed.slack = slack;
  }
  return way;
}

/// Where critical points were located to which voltages in proportion to those of the end have led.
std::vector<Critical> critical_points(const Case& one, const Journal& journal) {
  const post::StepRecord& end = journal.records.back();
  std::vector<Critical> all; // the last one first
  for (auto record = journal.records.rbegin(); record != journal.records.rend(); ++record) {
    const auto factor = factor_of(record->voltages, end);
    if (!factor || !is_led_by_voltages(one, *record)) break;
    for (auto event = record->events.rbegin(); event != record->events.rend(); ++event) {
      const auto at = event->before ? factor_of(event->before->voltages, end) : std::nullopt;
      if (is_critical(event->kind) && at && *at > 0) all.push_back({event->branches_off, *at});
    }
    if (*factor <= 0) break;
  }
  std::ranges::reverse(all);
  return all;
}

/// Whether limits that states tell are behind it.
bool is_beyond(const Passed& passed, bool wrinkles, double smallest) {
  return passed.breakdown >= 1 || passed.yield >= 1 ||
         (wrinkles ? passed.slack > 0 : passed.least_stress <= -smallest);
}

using Value = std::function<double(const Passed&)>;

/// Where a value passes zero between two states of a way, by states that are solved between them; nothing
/// where these are not on that way.
std::optional<double> root_between(const Passed& before, const Passed& after, const Value& value,
                                   FurtherWay& further) {
  std::uintmax_t states = 50;
  const double at_before = value(before), at_after = value(after), same = 1e-4 * (at_after - at_before);
  const auto is_on_the_way = [&](const Passed& known) {
    const std::optional<Passed> again = further.at(known.factor);
    return again && std::abs(value(*again) - value(known)) <= same;
  };
  if (!is_on_the_way(after) && !(further.begin_at(before) && is_on_the_way(after))) return std::nullopt;
  bool lost = false; // a state that is not reached ends the search
  const auto [low, high] = boost::math::tools::toms748_solve(
      [&](double factor) {
        const std::optional<Passed> state = lost ? std::nullopt : further.at(factor);
        lost = lost || !state || std::isnan(value(*state));
        return lost ? 0 : value(*state);
      },
      before.factor, after.factor, at_before, at_after,
      [](double from, double to) { return to - from <= margin_accuracy * to; }, states);
  if (lost || !is_on_the_way(before)) return std::nullopt;
  return (low + high) / 2;
}

/// Where a value passes zero from below.
Margin crossing(const std::vector<Passed>& way, const Value& value, FurtherWay& further) {
  if (std::ranges::all_of(way, [&](const Passed& passed) { return std::isnan(value(passed)); }))
    return {.remark = "not known: the case has no quantity of kind \"extreme\" that tells"};
  for (std::size_t i = 0; i < way.size(); ++i) {
    const double now = value(way[i]);
    if (!(now >= 0)) continue;
    if (i == 0 || std::isnan(value(way[i - 1])))
      return way[i].factor == 0
                 ? Margin{.factor = 0, .remark = "passed without voltage"}
                 : Margin{.remark =
                              fmt::format("not known: passed already at {:.4g} times the voltage of the end, "
                                          "the least of which the run tells",
                                          way[i].factor)};
    const std::string remark =
        way[i].on_the_way_back ? "on the way back to 0 V, with all other loads of the end" : "";
    if (const auto root = root_between(way[i - 1], way[i], value, further))
      return {.factor = *root, .remark = remark};
    const double before = value(way[i - 1]);
    return {.factor = std::lerp(way[i - 1].factor, way[i].factor, before / (before - now)),
            .remark = fmt::format("{}{}on a straight line between the states at {:.4g} and {:.4g}: more "
                                  "increments tell it better",
                                  remark, remark.empty() ? "" : "; ", way[i - 1].factor, way[i].factor)};
  }
  return {};
}

/// Why nothing is known of a limit; empty where something is. `branches`: a bifurcation was met.
std::string unknown_limit(const Case& one, const Simulation& run, const std::string& limit, bool branches) {
  const bool walls = run.device().mesh.walls() != nullptr, bears = run.device().bears_compression;
  if (limit == "loss of tension" && bears) return "shells and solids bear compression";
  if (limit == "wall yield" && !walls) return "there are no walls";
  if (limit == "buckling" && !branches && one.dimension != fem::Dimension::spatial && !walls)
    return "film does not leave its plane, or its meridian's, in this model";
  return "";
}

void add_remark(Margin& margin, const char* remark) {
  if (!margin.remark.empty()) margin.remark += ", ";
  margin.remark += remark;
}

} // namespace

std::vector<Margin> margins_of(const Case& one, const Simulation& simulation, const Journal& journal,
                               const Outcome& outcome, int threads) {
  std::vector<Margin> margins;
  std::string unknown_because;
  const double smallest =
      simulation.device().bears_compression ? std::numeric_limits<double>::infinity() : smallest_stress(one);
  const fem::State& state = simulation.state();
  if (one.electrodes.empty() || journal.records.empty() || journal.records.back().largest_voltage() == 0)
    unknown_because = "no voltage is applied at the end";
  else if (takes_time(one))
    unknown_because = "time passes: a run tells of its own course of the voltage only";
  else if (const auto found = std::ranges::find_if(state.supply, fem::is_isolated);
           found != state.supply.end())
    unknown_because = found - state.supply.begin() < std::ssize(one.electrodes)
                          ? "an electrode is isolated: its voltage follows"
                          : "the chamber is closed: its pressure follows";
  std::vector<Passed> way;
  std::vector<Critical> criticals;
  std::optional<FurtherWay> further;
  std::string stopped = outcome.kind;
  double up_to = 1;
  if (unknown_because.empty()) {
    further.emplace(one, simulation, journal.records.back(), threads);
    way = way_of(one, journal);
    criticals = critical_points(one, journal);
    const bool complete = outcome.ending == Ending::complete;
    // Something else than the voltages has led there, or they were not in proportion.
    if (complete && way.front().factor > 0 &&
        is_beyond(way.front(), simulation.device().tension_field, smallest)) {
      std::string unused;
      const double least = way.front().factor;
      for (Passed& passed : further->to(0, unused))
        if (passed.factor < least) {
          way.insert(way.begin(), std::move(passed));
          way[0].on_the_way_back = way[1].on_the_way_back = true;
        }
    }
    if (one.margins_up_to > 1 && complete) {
      std::ranges::move(further->to(one.margins_up_to, stopped), std::back_inserter(way));
      criticals.insert(criticals.end(), further->located().begin(), further->located().end());
      up_to = way.back().factor;
    }
  }
  const bool branches = std::ranges::any_of(criticals, &Critical::branches_off);
  if (is_critical(stopped) && !criticals.empty()) stopped = criticals.back().kind();
  const auto add = [&](const std::string& limit, const auto& find) {
    const std::string why_not =
        unknown_because.empty() ? unknown_limit(one, simulation, limit, branches) : unknown_because;
    Margin margin;
    if (why_not.empty()) {
      margin = find();
      if (interrupted()) margin = {.remark = "not known: interrupted before it was solved for"};
      if (!margin.factor && margin.remark.empty())
        margin.remark =
            fmt::format("not reached up to {:.6g} times the voltage of the end{}", up_to,
                        stopped.empty() ? "" : fmt::format(", where the path ends ({})", stopped));
      if (limit == "buckling" && one.dimension != fem::Dimension::spatial)
        add_remark(margin, one.dimension == fem::Dimension::planar
                               ? "in its plane: a planar model does not leave it"
                               : "of revolution: its model does not leave that symmetry");
    } else {
      margin.remark = "not known: " + why_not;
    }
    margin.limit = limit;
    margin.up_to = up_to;
    margins.push_back(std::move(margin));
  };
  const auto where = [&](const auto& value) { return crossing(way, value, *further); };
  add("breakdown", [&] { return where([](const Passed& p) { return p.breakdown - 1; }); });
  add("loss of tension", [&] {
    if (simulation.device().tension_field)
      return where([](const Passed& p) { return std::isnan(p.slack) ? unknown : p.slack > 0 ? 1 : -1; });
    Margin lost = where([&](const Passed& p) { return -smallest - p.least_stress; });
    // Film leaves its plane where its tension ends: the path ends there, and no state of it is beyond.
    if (!lost.factor && lost.remark.empty() && stopped == Critical{true}.kind() &&
        way.back().least_stress < no_tension * smallest &&
        std::ranges::any_of(way, [&](const Passed& p) { return p.least_stress > no_tension * smallest; }))
      lost.factor = way.back().factor;
    return lost;
  });
  const auto critical = [&](bool branches_off) {
    const auto first = std::ranges::find(criticals, branches_off, &Critical::branches_off);
    if (first != criticals.end()) return Margin{.factor = first->factor};
    return stopped == Critical{branches_off}.kind() ? Margin{.factor = way.back().factor}
                                                    : Margin{}; // an end that was not located
  };
  add("pull-in", [&] { return critical(false); });
  add("buckling", [&] { return critical(true); });
  add("wall yield", [&] { return where([](const Passed& p) { return p.yield - 1; }); });
  const double lost = simulation.device().tension_field ? unknown : factor_to("loss of tension", margins);
  for (Margin& margin : margins)
    if (margin.factor > lost && (margin.limit == "pull-in" || margin.limit == "buckling"))
      add_remark(margin, "behind the loss of tension: compressed film gives way in waves as short as its "
                         "elements, so it depends on the mesh");
  return margins;
}

double factor_to(const std::string& limit, const std::vector<Margin>& margins) {
  const auto margin = std::ranges::find(margins, limit, &Margin::limit);
  return margin != margins.end() ? margin->factor.value_or(unknown) : unknown;
}

} // namespace dielast::cases
