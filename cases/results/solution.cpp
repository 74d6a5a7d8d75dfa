// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/results/solution.hpp"

#include "cases/case/quantities.hpp"
#include "cases/console/terminal.hpp"
#include "post/engineering.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>

namespace dielast::cases {

namespace {

/// What the records of a run tell of it.
Solution told_by(std::span<const post::StepRecord> records) {
  constexpr std::array of_the_way{"limit point", "bifurcation", "jump", "instability"};
  Solution solution;
  for (const post::StepRecord& record : records)
    for (const post::Event& event : record.events)
      if (std::ranges::find(of_the_way, event.kind) != of_the_way.end())
        solution.way.push_back({event.kind, record.step});
      else
        solution.events.insert(event.kind);
  if (!records.empty()) solution.last = records.back();
  return solution;
}

std::string way_text(const Solution& solution) {
  std::vector<std::string> words;
  for (const Turn& turn : solution.way)
    words.push_back(fmt::format("{} in step \"{}\"", turn.kind, turn.step));
  return words.empty() ? "without critical point" : fmt::format("{}", fmt::join(words, ", "));
}

std::string end_text(const post::StepRecord& record) {
  const double volts = record.largest_voltage();
  return volts != 0 ? post::engineering(volts, "V", post::Ratio::plain, 5)
                    : fmt::format("load factor {:.4g} of step \"{}\"", record.load_factor, record.step);
}

} // namespace

Solution solution_of(const Simulation& run, const Outcome& outcome, std::span<const post::StepRecord> records,
                     std::vector<Margin> margins) {
  Solution solution = told_by(records);
  if (outcome.ending != Ending::complete) {
    solution.trouble = outcome.kind;
    return solution;
  }
  solution.values = run.results();
  solution.margins = std::move(margins);
  solution.time_steps = run.time_steps().count;
  solution.rises = run.rises();
  solution.farthest = run.farthest();
  return solution;
}

Solution solve(const Discretisation& discretisation, bool with_margins, int threads) {
  const Case& one = discretisation.one;
  Solution solution;
  Journal journal;
  try {
    Simulation simulation(one, threads);
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      journal.records.push_back(frame.record);
      journal.values.push_back(frame.values);
      return !interrupted();
    };
    observer.goes_on = [] { return !interrupted(); };
    const Outcome outcome = simulation.run(observer);
    std::vector<Margin> margins;
    if (with_margins && outcome.ending == Ending::complete)
      margins = margins_of(one, simulation, journal, outcome, threads);
    solution = solution_of(simulation, outcome, journal.records, std::move(margins));
  } catch (const std::exception& error) { // no mesh, a place that it lacks, no memory: the run itself is done
    solution = told_by(journal.records);
    solution.trouble = error.what();
  }
  solution.size = discretisation.size;
  return solution;
}

double on_its_side(double value, const Solution& own, double own_value) {
  constexpr double mirrored = 0.25;
  const bool leaves = own.passes("jump") || own.passes("bifurcation");
  return leaves && std::abs(value + own_value) < mirrored * std::abs(own_value) ? -value : value;
}

const Quantity& measured(const Quantity& quantity, const std::vector<Quantity>& all) {
  return quantity.kind->so_far ? *std::ranges::find(all, quantity.of, &Quantity::name) : quantity;
}

std::string size_text(double size) {
  if (size < 1)
    return size == 0.5 ? "elements half as large" : fmt::format("elements 1/{} as large", 1 / size);
  return fmt::format("elements and time steps {:.3g} times as large", size);
}

std::string why_not(const Solution& own, const Solution& other) {
  if (other.trouble != own.trouble) {
    const std::string with = "with " + size_text(other.size);
    if (other.trouble.empty()) return with + " the run reaches its end";
    if (own.trouble.empty())
      return fmt::format("{} the run does not reach its end ({})", with, other.trouble);
    return fmt::format("{} the run ends at {} ({})", with, end_text(other.last), other.trouble);
  }
  if (own.way == other.way) return "";
  return fmt::format("with {} the device takes another way ({}; here {})", size_text(other.size),
                     way_text(other), way_text(own));
}

} // namespace dielast::cases
