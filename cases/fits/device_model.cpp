// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/device_model.hpp"

#include "cases/case/fastest_rate.hpp"
#include "cases/case/quantities.hpp"
#include "cases/fits/course.hpp"
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dielast::cases {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr double same_place = 2e-9;   ///< in load factors
constexpr double beside = 0.2;        ///< of a place where something was measured, in increments of a step
constexpr double close_enough = 1e-5; ///< of a row to what was measured, over its range
constexpr int most_runs = 4;          ///< to get there

/// What a run has recorded: the history, and the responses by the names of their steps.
struct Recorded {
  std::vector<RecordedRow> rows;
  std::map<std::string, Analysis> responses;
};

Recorded record(const Case& one, bool with_rows, bool with_response) {
  Recorded recorded;
  Simulation simulation(one, 1);
  SimulationObserver observer;
  if (with_rows)
    observer.on_accept = [&](const Frame& frame) {
      std::vector<double> row{frame.record.load_factor, frame.record.time};
      row.insert(row.end(), frame.record.voltages.begin(), frame.record.voltages.end());
      row.insert(row.end(), frame.values.begin(), frame.values.end());
      const auto step = std::ranges::find(one.steps, frame.record.step, &Step::name);
      recorded.rows.push_back({.values = std::move(row),
                               .step = frame.record.step,
                               .jumped = frame.record.jumped ||
                                         std::ranges::count(frame.record.events, "jump", &post::Event::kind),
                               .at_once = step != one.steps.end() && !step->duration &&
                                          step->response == Response::instantaneous});
      return true;
    };
  if (with_response)
    observer.on_analysis = [&](const Analysis& analysis, const fem::State&) {
      if (analysis.kind == StepKind::harmonic) recorded.responses.emplace(analysis.step, analysis);
    };
  const Outcome outcome = simulation.run(observer);
  if (outcome.ending != Ending::complete) throw std::runtime_error(outcome.message);
  return recorded;
}

std::size_t column_of(const std::vector<post::Column>& columns, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(columns, name, &post::Column::name) - columns.begin());
}

using Stops = std::map<std::string, std::vector<double>>; ///< load factors of steps, by their names

/// Whether one of these is there, to round-off.
bool contains(const std::vector<double>& all, double s) {
  return std::ranges::any_of(all, [s](double other) { return std::abs(other - s) < same_place; });
}

void set_stops(Case& one, Stops stops, bool with_increments) {
  for (Step& step : one.steps) {
    std::vector<double> wanted = std::move(stops[step.name]);
    std::erase_if(wanted, [](double s) { return !(s > same_place && s < 1 - same_place); });
    std::ranges::sort(wanted);
    step.stops.clear();
    for (const double s : wanted)
      if (step.stops.empty() || s - step.stops.back() > same_place) step.stops.push_back(s);
    if (!with_increments || step.stops.empty()) continue;
    const std::vector<double> measured = step.stops; // short time steps beside them are of no use
    for (int i = 1; i < step.increments; ++i) {
      const double s = static_cast<double>(i) / step.increments;
      const auto near = [&](double other) { return std::abs(other - s) < beside / step.increments; };
      if (std::ranges::none_of(measured, near)) step.stops.push_back(s);
    }
    std::ranges::sort(step.stops);
  }
}

/// Where in the case's steps it is that a test was measured against time.
void add_times(const Case& one, const std::vector<double>& times, Stops& stops) {
  double start = 0;
  for (const Step& step : one.steps) {
    if (!step.duration) continue;
    for (const double t : times) stops[step.name].push_back((t - start) / *step.duration);
    start += *step.duration;
  }
}

std::complex<double> polar(const std::vector<double>& row, std::size_t magnitude) {
  return std::polar(row[magnitude], row[magnitude + 1] * degree);
}

/// The response in the analysis' row of the test's frequency, see analyse().
std::complex<double> response(const DeviceTest& test, const Analysis& analysis,
                              const std::vector<double>& row) {
  const std::size_t admittance = 3 + 2 * analysis.driven.size();
  if (test.response == MeasuredResponse::admittance) return polar(row, admittance);
  if (test.response == MeasuredResponse::impedance) return polar(row, admittance + 2);
  if (row.size() == admittance + 4)
    throw std::runtime_error("there is no response per squared volt about 0 V; give [drive] a voltage");
  return std::copysign(1.0, analysis.bias) * std::polar(row.back(), row[2] * degree);
}

} // namespace

DeviceModel::DeviceModel(const Identification& asked) : asked_(asked) {
  for (std::size_t t = 0; t < asked.tests.size(); ++t) {
    const auto alike = std::ranges::find_if(groups_, [&](const auto& group) {
      return asked.tests[group.front()].settings == asked.tests[t].settings;
    });
    if (alike == groups_.end())
      groups_.push_back({t});
    else
      alike->push_back(t);
  }
}

std::vector<double> DeviceModel::run(std::size_t run, const std::vector<double>& values) const {
  const std::vector<std::size_t>& group = groups_[run];
  std::vector<std::string> overrides = asked_.tests[group.front()].settings;
  for (std::size_t i = 0; i < values.size(); ++i)
    overrides.push_back(asked_.unknowns[i].assignment(values[i]));
  Case one = read_case(asked_.base, overrides);
  std::vector<double> hertz;
  for (const std::size_t t : group)
    if (asked_.tests[t].is_response())
      hertz.insert(hertz.end(), asked_.tests[t].x.begin(), asked_.tests[t].x.end());
  std::ranges::sort(hertz);
  hertz.erase(std::unique(hertz.begin(), hertz.end()), hertz.end());
  for (Step& step : one.steps) {
    step.record.reset(); // what was measured may lie between the rows that somebody wants to read
    if (step.kind == StepKind::harmonic) step.sweep.at = hertz;
  }
  tell_fastest_rate(one);
  const bool all_responses =
      std::ranges::all_of(group, [&](std::size_t t) { return asked_.tests[t].is_response(); });
  // Quantities that nobody asks for need not be evaluated along the way.
  const std::vector<post::Column> columns = history_columns(one);
  const auto course = [&](const DeviceTest& test, const Recorded& recorded) {
    return Course(test, recorded.rows, column_of(columns, test.against), column_of(columns, test.quantity));
  };
  Stops times;
  for (const std::size_t t : group)
    if (asked_.tests[t].against == "time") add_times(one, asked_.tests[t].x, times);
  set_stops(one, times, false);
  Recorded recorded = record(one, !all_responses, !hertz.empty());
  const std::map<std::string, Analysis> responses = std::move(recorded.responses);
  for (int runs = 1; runs < most_runs; ++runs) { // those that follow stop where something was measured
    Stops stops;
    bool farther = false;
    for (const std::size_t t : group) {
      const DeviceTest& test = asked_.tests[t];
      if (test.is_response()) continue;
      const Course rows = course(test, recorded);
      const double range = test.x.size() > 1 ? test.x.back() - test.x.front() : std::abs(test.x.front());
      for (const double x : test.x)
        for (const auto& [name, s, is_row] : rows.stops(x, close_enough * range)) {
          stops[name].push_back(s);
          const auto step = std::ranges::find(one.steps, name, &Step::name);
          farther = farther || (!is_row && step != one.steps.end() && !contains(step->stops, s));
        }
    }
    if (!farther) break;
    set_stops(one, std::move(stops), true);
    recorded = record(one, true, false);
  }
  std::vector<double> model;
  for (const std::size_t t : group) {
    const DeviceTest& test = asked_.tests[t];
    if (!test.is_response()) {
      const Course rows = course(test, recorded);
      for (const double x : test.x) model.push_back(rows.at(x));
      if (test.at_jump != AtJump::unsaid &&
          std::ranges::none_of(test.x, [&](double x) { return rows.has_jump_at(x); }))
        throw std::runtime_error(test.name() + ": at_jump has no effect: nothing jumps at any of its rows");
      continue;
    }
    const Analysis& asked = test.step.empty() ? responses.begin()->second : responses.at(test.step);
    for (const double frequency : test.x) {
      const auto place = std::ranges::lower_bound(hertz, frequency) - hertz.begin();
      const std::complex<double> found = response(test, asked, asked.rows[static_cast<std::size_t>(place)]);
      model.insert(model.end(), {found.real(), found.imag()});
    }
  }
  return model;
}

} // namespace dielast::cases
