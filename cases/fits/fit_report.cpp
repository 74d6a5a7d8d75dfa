// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/fit_report.hpp"

#include "cases/fits/fit_files.hpp"
#include "post/engineering.hpp"
#include "post/pictures/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

using post::Cell, post::Tone;

std::string percent(double part) { return post::engineering(part, "1", post::Ratio::percent, 3); }

std::string interval(const FittedParameter& one, const std::string& unit) {
  if (one.at_bound) return "at its bound";
  if (!one.determined()) return "not identifiable";
  const auto scaled = post::scaled_unit(one.value, unit);
  return fmt::format("{} to {}{}{}", post::significant(one.low * scaled.factor),
                     post::significant(one.high * scaled.factor), scaled.unit.empty() ? "" : " ",
                     scaled.unit);
}

post::Table parameter_table(const FitResults& results) {
  post::Table table{{"parameter", "value", "95 % interval", "start"}, {}};
  for (std::size_t i = 0; i < results.outcome.parameters.size(); ++i) {
    const FittedParameter& one = results.outcome.parameters[i];
    const FitParameter& parameter = results.task.parameters[i];
    table.rows.push_back({Cell{parameter.name}, Cell{post::engineering(one.value, parameter.unit)},
                          Cell{interval(one, parameter.unit), one.determined() ? Tone::plain : Tone::warning},
                          Cell{post::engineering(one.start, parameter.unit)}});
  }
  return table;
}

post::Table correlation_table(const FitResults& results) {
  post::Table table{{""}, {}};
  for (Eigen::Index i = 0; i < results.outcome.correlation.rows(); ++i) {
    const std::string& name = results.task.parameters[static_cast<std::size_t>(i)].name;
    table.header.push_back(name);
    std::vector<Cell> row{name};
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double r = results.outcome.correlation(i, j);
      row.emplace_back(std::isnan(r) ? "-" : fmt::format("{:.2f}", r),
                       i != j && std::abs(r) > dependent ? Tone::warning : Tone::plain);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

post::Table test_table(const FitResults& results) {
  post::Table table{
      {"test", "use", "rows", "stretch", "weight", "largest stress", "rms error", "largest error"}, {}};
  for (std::size_t t = 0; t < results.errors.size(); ++t) {
    const FitTest& test = results.fit.tests[t];
    const auto [least, most] = std::ranges::minmax_element(test.measured.history.stretch);
    table.rows.push_back({Cell{test.name()}, Cell{test.predict ? "prediction" : "fit"},
                          Cell{std::to_string(test.lines.size())},
                          Cell{fmt::format("{} to {}", post::significant(*least), post::significant(*most))},
                          Cell{post::significant(test.weight)},
                          Cell{post::engineering(test.measured.largest_stress(), "Pa")},
                          Cell{percent(results.errors[t].rms)}, Cell{percent(results.errors[t].largest)}});
  }
  return table;
}

/// The film is held for more than half of the time: what is seen happens in time.
bool is_relaxation(const StretchHistory& history) {
  double held = 0;
  for (std::size_t i = 1; i < history.time.size(); ++i)
    if (std::abs(history.stretch[i] - history.stretch[i - 1]) < 1e-6 * history.stretch[i])
      held += history.time[i] - history.time[i - 1];
  return !history.time.empty() && held > (history.time.back() - history.time.front()) / 2;
}

post::Plot plot_of(const FitTest& test, const std::vector<double>& model, const FitError& error) {
  const StretchHistory& history = test.measured.history;
  const bool in_time = is_relaxation(history);
  const auto scale = post::scaled_unit(test.measured.largest_stress(), "Pa");
  const auto scaled = [&](std::vector<double> stress) {
    for (double& one : stress) one *= scale.factor;
    return stress;
  };
  const std::vector<double>& x = in_time ? history.time : history.stretch;
  post::Plot plot{fmt::format("{}: {}, rms error {}", test.name(), test.predict ? "predicted" : "fitted",
                              percent(error.rms)),
                  in_time ? "time [s]" : "stretch",
                  fmt::format("nominal stress [{}]", scale.unit),
                  {}};
  plot.series.push_back({"measured", x, scaled(test.measured.stress), post::Series::Style::points});
  plot.series.push_back({"model", x, scaled(model), post::Series::Style::line});
  return plot;
}

std::string lines_of(const post::Table& table) {
  std::vector<std::size_t> widths(table.header.size());
  for (std::size_t c = 0; c < widths.size(); ++c) {
    widths[c] = table.header[c].size();
    for (const auto& row : table.rows) widths[c] = std::max(widths[c], row[c].text.size());
  }
  std::string text;
  const auto add = [&](std::size_t c, const std::string& cell) {
    text += fmt::format("  {:<{}}", cell, widths[c]);
    if (c + 1 == widths.size()) text.erase(text.find_last_not_of(' ') + 1).push_back('\n');
  };
  for (std::size_t c = 0; c < widths.size(); ++c) add(c, table.header[c]);
  for (const auto& row : table.rows)
    for (std::size_t c = 0; c < widths.size(); ++c) add(c, row[c].text);
  return text;
}

} // namespace

std::string fit_summary(const FitResults& results) {
  return lines_of(parameter_table(results)) + "\n" + lines_of(test_table(results));
}

post::Report fit_report(const FitResults& results) {
  const FitOutcome& outcome = results.outcome;
  std::size_t rows = 0;
  for (const FitTest& test : results.fit.tests) rows += test.predict ? 0 : test.lines.size();
  post::Report report{
      .title = results.fit.title,
      .subtitle = fmt::format("fit of {} parameters to {} rows of {} tests", outcome.parameters.size(), rows,
                              results.fit.tests.size()),
      .status = {results.ending(), outcome.ending == FitEnding::converged ? Tone::good : Tone::warning},
      .footer = "dielast " DIELAST_VERSION};
  for (std::size_t i = 0; i < std::min<std::size_t>(outcome.parameters.size(), 6); ++i) {
    const FittedParameter& one = outcome.parameters[i];
    report.highlights.push_back({results.task.parameters[i].name,
                                 post::engineering(one.value, results.task.parameters[i].unit),
                                 interval(one, results.task.parameters[i].unit)});
  }
  add_warnings(report, results.warnings());
  std::vector<post::Plot> plots;
  for (std::size_t t = 0; t < results.errors.size(); ++t)
    plots.push_back(plot_of(results.fit.tests[t], outcome.stress[t], results.errors[t]));
  report.add("Measured and modelled", post::draw(plots));
  report.sections.push_back(
      {"Parameters",
       {parameter_table(results),
        post::Paragraph{
            "Intervals are of each parameter by itself, from the Jacobian at the solution and the "
            "variance of the residuals. They hold for errors that are independent from row to row and "
            "of one size after weighting: each row's error over the largest stress of its test, times "
            "the test's weight."}}});
  report.sections.push_back(
      {"Tests",
       {test_table(results), post::Paragraph{"Errors are of the nominal stress, relative to the "
                                             "largest that was measured in the test."}}});
  report.sections.push_back({"Correlation of the parameters", {correlation_table(results)}});
  return report;
}

} // namespace dielast::cases
