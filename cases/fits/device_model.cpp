// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/device_model.hpp"

#include "cases/case/quantities.hpp"
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dielast::cases {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// What a run has recorded: rows of the history, and its first response.
struct Recorded {
  std::vector<std::vector<double>> rows;
  std::optional<Analysis> response;
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
      recorded.rows.push_back(std::move(row));
      return true;
    };
  if (with_response)
    observer.on_analysis = [&](const Analysis& analysis, const fem::State&) {
      if (analysis.kind == StepKind::harmonic && !recorded.response) recorded.response = analysis;
    };
  const Outcome outcome = simulation.run(observer);
  if (outcome.ending != Ending::complete) throw std::runtime_error(outcome.message);
  return recorded;
}

std::size_t column_of(const std::vector<post::Column>& columns, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(columns, name, &post::Column::name) - columns.begin());
}

/// A column of the history against another, which grows, at these places: between rows along straight lines.
std::vector<double> interpolated(const std::vector<std::vector<double>>& rows, std::size_t x, std::size_t y,
                                 const std::vector<double>& at, const std::string& name) {
  std::vector<std::pair<double, double>> curve;
  for (const auto& row : rows) {
    if (!std::isfinite(row[y])) continue;
    while (!curve.empty() && curve.back().first >= row[x]) curve.pop_back(); // the last way is meant
    curve.emplace_back(row[x], row[y]);
  }
  std::vector<double> values;
  for (const double place : at) {
    const auto after = std::ranges::lower_bound(curve, place, {}, &std::pair<double, double>::first);
    const double slack = curve.empty() ? 0 : 1e-9 * std::abs(curve.back().first);
    if (after == curve.end() && !curve.empty() && place <= curve.back().first + slack) {
      values.push_back(curve.back().second);
      continue;
    }
    if (after == curve.end() || (after == curve.begin() && place < after->first - slack))
      throw std::runtime_error(fmt::format("{}: the run does not come to {:.6g}", name, place));
    if (after == curve.begin()) {
      values.push_back(after->second);
      continue;
    }
    const auto before = std::prev(after);
    const double part = (place - before->first) / (after->first - before->first);
    values.push_back(std::lerp(before->second, after->second, part));
  }
  return values;
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
  return std::polar(row.back(), row[2] * degree);
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
  const bool all_responses =
      std::ranges::all_of(group, [&](std::size_t t) { return asked_.tests[t].is_response(); });
  // Quantities that nobody asks for need not be evaluated along the way.
  const std::vector<post::Column> columns = history_columns(one);
  const Recorded recorded = record(one, !all_responses, !hertz.empty());
  std::vector<double> model;
  for (const std::size_t t : group) {
    const DeviceTest& test = asked_.tests[t];
    if (!test.is_response()) {
      const std::vector<double> found = interpolated(recorded.rows, column_of(columns, test.against),
                                                     column_of(columns, test.quantity), test.x, test.name());
      model.insert(model.end(), found.begin(), found.end());
      continue;
    }
    for (const double frequency : test.x) {
      const auto place = std::ranges::lower_bound(hertz, frequency) - hertz.begin();
      const std::complex<double> found =
          response(test, *recorded.response, recorded.response->rows[static_cast<std::size_t>(place)]);
      model.insert(model.end(), {found.real(), found.imag()});
    }
  }
  return model;
}

} // namespace dielast::cases
