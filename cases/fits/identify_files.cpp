// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/fit_files.hpp"
#include "cases/fits/identify.hpp"

#include "post/engineering.hpp"
#include "post/files/history.hpp"
#include "post/pictures/bode.hpp"
#include "post/pictures/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace dielast::cases {
namespace {

using Json = nlohmann::ordered_json;
using post::Cell, post::Tone;

std::string ending(const IdentifyOutcome& outcome) {
  return fmt::format("{} after {} iterations", word(outcome.ending), outcome.iterations);
}

std::string in_unit(double value, const Unknown& unknown) {
  return fmt::format("{:.6g}{}{}", value, unknown.unit.empty() ? "" : " ", unknown.unit);
}

/// Of one that was interrupted nobody knows: it is what the last step leads to.
std::string interval(const FittedParameter& one, const Unknown& unknown, FitEnding ending) {
  if (ending == FitEnding::interrupted) return "interrupted";
  if (one.at_bound) return "at its bound";
  if (!one.determined()) return "not identifiable";
  return fmt::format("{:.6g} to {}", one.low, in_unit(one.high, unknown));
}

post::Table unknown_table(const Identification& asked, const IdentifyOutcome& outcome) {
  post::Table table{{"unknown", "value", "95 % interval", "start"}, {}};
  for (std::size_t i = 0; i < asked.unknowns.size(); ++i) {
    const FittedParameter& one = outcome.unknowns[i];
    table.rows.push_back({Cell{asked.unknowns[i].key}, Cell{in_unit(one.value, asked.unknowns[i])},
                          Cell{interval(one, asked.unknowns[i], outcome.ending),
                               one.determined() ? Tone::plain : Tone::warning},
                          Cell{in_unit(one.start, asked.unknowns[i])}});
  }
  return table;
}

post::Table test_table(const Identification& asked, const IdentifyOutcome& outcome) {
  post::Table table{{"test", "use", "rows", "rms error"}, {}};
  for (std::size_t t = 0; t < asked.tests.size(); ++t)
    table.rows.push_back({Cell{asked.tests[t].name()}, Cell{asked.tests[t].predict ? "prediction" : "fit"},
                          Cell{std::to_string(asked.tests[t].x.size())},
                          Cell{post::engineering(outcome.errors[t], "1", post::Ratio::percent, 3)}});
  return table;
}

void append_plots(std::vector<post::Plot>& plots, const DeviceTest& test,
                  const std::vector<std::complex<double>>& model) {
  using Style = post::Series::Style;
  if (test.is_response()) {
    const std::array both{post::FrequencyResponse{"measured", test.x, test.measured, Style::points},
                          post::FrequencyResponse{"model", test.x, model, Style::line}};
    for (post::Plot& plot : post::bode(test.name(), "magnitude", both)) plots.push_back(std::move(plot));
    return;
  }
  const auto real = [](const std::vector<std::complex<double>>& values) {
    std::vector<double> all;
    for (const auto& value : values) all.push_back(value.real());
    return all;
  };
  plots.push_back({test.name(),
                   test.against,
                   test.quantity,
                   {{"measured", test.x, real(test.measured), Style::points},
                    {"model", test.x, real(model), Style::line}}});
}

} // namespace

std::vector<std::string> identify_warnings(const Identification& asked, const IdentifyOutcome& outcome) {
  std::vector<std::string> all;
  if (outcome.ending == FitEnding::interrupted) return all; // nothing is known of it yet
  for (std::size_t i = 0; i < outcome.unknowns.size(); ++i) {
    const std::string& key = asked.unknowns[i].key;
    if (outcome.unknowns[i].at_bound)
      all.push_back(
          fmt::format("{} is at its bound: the tests do not tell it, or would have it beyond what "
                      "the key or the range of unknowns allows, or where the case still reaches its end",
                      key));
    else if (!outcome.unknowns[i].determined())
      all.push_back(
          fmt::format("{} is not identifiable: the fitted tests tell only its combination with others", key));
    for (std::size_t j = 0; j < i; ++j)
      if (const double r = outcome.correlation(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
          std::abs(r) > dependent)
        all.push_back(fmt::format("{} and {} can hardly be told apart: correlation {:.3f}",
                                  asked.unknowns[j].key, key, r));
  }
  for (const DeviceTest& test : asked.tests)
    if (!test.bare.empty())
      all.push_back(
          fmt::format("{}: columns without a unit are taken in SI: {}; write the unit behind the name, as "
                      "in \"voltage[kV]\"",
                      test.name(), fmt::join(test.bare, ", ")));
  for (std::size_t t = 0; t < outcome.errors.size(); ++t)
    if (outcome.errors[t] > poor_fit)
      all.push_back(fmt::format("{}: the model misses what was measured by {:.0f} % (rms): columns, their "
                                "units, or the case may not be those of the test",
                                asked.tests[t].name(), 100 * outcome.errors[t]));
  return all;
}

std::string identify_json(const Identification& asked, const IdentifyOutcome& outcome) {
  Json json{{"title", asked.title},
            {"status", ending(outcome)},
            {"converged", outcome.ending == FitEnding::converged},
            {"deviation", finite_json(outcome.deviation)},
            {"unknowns", Json::array()},
            {"correlation", correlation_json(outcome.correlation)},
            {"tests", Json::array()}};
  for (std::size_t i = 0; i < asked.unknowns.size(); ++i) {
    const Unknown& unknown = asked.unknowns[i];
    append_value(json["unknowns"].emplace_back(Json{{"key", unknown.key}, {"unit", unknown.unit}}),
                 outcome.unknowns[i]);
  }
  for (std::size_t t = 0; t < asked.tests.size(); ++t)
    json["tests"].push_back({{"file", asked.tests[t].file.string()},
                             {"use", asked.tests[t].predict ? "predict" : "fit"},
                             {"rows", asked.tests[t].x.size()},
                             {"rms_error", finite_json(outcome.errors[t])}});
  json["warnings"] = identify_warnings(asked, outcome);
  json["version"] = DIELAST_VERSION;
  return json.dump(2) + "\n";
}

std::string identify_table(const Identification& asked, const IdentifyOutcome& outcome) {
  std::string table = "test,use,x,measured_real,measured_imaginary,model_real,model_imaginary\n";
  for (std::size_t t = 0; t < asked.tests.size(); ++t)
    for (std::size_t i = 0; i < outcome.model[t].size(); ++i) {
      const DeviceTest& test = asked.tests[t];
      table += post::csv_cell(test.name()) +
               fmt::format(",{},{},{},{},{},{}\n", test.predict ? "predict" : "fit", test.x[i],
                           test.measured[i].real(), test.measured[i].imag(), outcome.model[t][i].real(),
                           outcome.model[t][i].imag());
    }
  return table;
}

std::string identify_summary(const Identification& asked, const IdentifyOutcome& outcome) {
  std::string text = ending(outcome) + "\n";
  const auto add = [&](const auto& row, const auto& text_of) {
    for (const auto& cell : row) text += fmt::format("  {:<38}", text_of(cell));
    text.erase(text.find_last_not_of(' ') + 1).push_back('\n');
  };
  for (const post::Table& table : {unknown_table(asked, outcome), test_table(asked, outcome)}) {
    add(table.header, [](const std::string& name) { return name; });
    for (const auto& row : table.rows) add(row, [](const Cell& cell) { return cell.text; });
  }
  return text;
}

post::Report identify_report(const Identification& asked, const IdentifyOutcome& outcome) {
  post::Report report{
      .title = asked.title,
      .subtitle =
          fmt::format("{} unknowns of {} identified", asked.unknowns.size(), asked.base.filename().string()),
      .status = {ending(outcome), outcome.ending == FitEnding::converged ? Tone::good : Tone::warning},
      .footer = "dielast " DIELAST_VERSION};
  add_warnings(report, identify_warnings(asked, outcome));
  std::vector<post::Plot> plots;
  for (std::size_t t = 0; t < asked.tests.size(); ++t)
    if (!outcome.model[t].empty()) append_plots(plots, asked.tests[t], outcome.model[t]);
  report.add("Measured and modelled", post::draw(plots));
  report.sections.push_back({"Unknowns", {unknown_table(asked, outcome)}});
  report.sections.push_back({"Tests", {test_table(asked, outcome)}});
  return report;
}

} // namespace dielast::cases
