// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/rational.hpp"

#include "cases/console/terminal.hpp"
#include "cases/fits/fit_files.hpp"
#include "post/engineering.hpp"
#include "post/files/history.hpp"
#include "post/files/report_files.hpp"
#include "post/files/results_folder.hpp"
#include "post/pictures/bode.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace dielast::cases {
namespace {

using Json = nlohmann::ordered_json;
using post::Cell, post::Tone;

constexpr int max_iterations = 500;

std::string unit_of(const RationalFit& fit, const FittedNumber& one) {
  return one.unit.empty() ? unit_of(fit.response) : one.unit;
}

std::string with_unit(double value, const std::string& unit) {
  return unit == "1" ? fmt::format("{:.6g}", value) : fmt::format("{:.6g} {}", value, unit);
}

std::string polynomial(const std::vector<double>& highest_first) {
  std::string text;
  for (std::size_t i = 0; i < highest_first.size(); ++i) {
    const std::size_t power = highest_first.size() - 1 - i;
    text += fmt::format("{}{:.6g}{}", i > 0 ? " + " : "", highest_first[i],
                        power == 0   ? ""
                        : power == 1 ? " s"
                                     : fmt::format(" s^{}", power));
  }
  return text;
}

post::Table number_table(const RationalFit& fit, const RationalOutcome& outcome) {
  post::Table table{{fit.name(), "value", "95 % interval"}, {}};
  for (const FittedNumber& one : outcome.numbers) {
    const std::string unit = unit_of(fit, one);
    table.rows.push_back({Cell{one.name}, Cell{with_unit(one.number.value, unit)},
                          Cell{one.number.determined() ? fmt::format("{:.6g} to {}", one.number.low,
                                                                     with_unit(one.number.high, unit))
                                                       : "not identifiable"}});
  }
  table.rows.push_back({Cell{"rms error"}, Cell{fmt::format("{:.3g} %", 100 * outcome.error)}, Cell{""}});
  return table;
}

std::vector<std::string> warnings_of(const RationalFit& fit, const RationalOutcome& outcome) {
  std::vector<std::string> all;
  if (outcome.ending != FitEnding::converged)
    all.push_back(fmt::format("{}: not converged after {} iterations", fit.name(), outcome.iterations));
  if (!outcome.stable)
    all.push_back(
        fmt::format("{}: a pole in the right half plane: nothing at rest has such a response", fit.name()));
  if (outcome.error > poor_fit)
    all.push_back(fmt::format("{}: the function misses what was measured by {:.0f} % (rms): columns, their "
                              "units, or the sign of the phase (below 0 where the response lags behind) may "
                              "not be those of the test",
                              fit.name(), 100 * outcome.error));
  for (const FittedNumber& one : outcome.numbers)
    if (!one.number.determined())
      all.push_back(
          fmt::format("{}: {} is not identifiable: fewer poles and zeros, or elements, say the same",
                      fit.name(), one.name));
  return all;
}

Json json_of(const RationalFit& fit, const RationalOutcome& outcome) {
  Json json{{"file", fit.file.string()},      {"converged", outcome.ending == FitEnding::converged},
            {"stable", outcome.stable},       {"rms_error", finite_json(outcome.error)},
            {"numerator", outcome.numerator}, {"denominator", outcome.denominator},
            {"numbers", Json::array()},       {"warnings", warnings_of(fit, outcome)}};
  for (const FittedNumber& one : outcome.numbers) {
    const bool known = one.number.determined();
    json["numbers"].push_back({{"name", one.name},
                               {"unit", unit_of(fit, one)},
                               {"value", finite_json(one.number.value)},
                               {"low_95", known ? Json(one.number.low) : Json()},
                               {"high_95", known ? Json(one.number.high) : Json()}});
  }
  return json;
}

post::Report report_of(const RationalFits& asked, const std::vector<RationalOutcome>& outcomes) {
  const bool converged = std::ranges::all_of(
      outcomes, [](const RationalOutcome& one) { return one.ending == FitEnding::converged; });
  post::Report report{
      .title = asked.title,
      .subtitle = "Rational functions of s fitted to measured responses",
      .status = {converged ? "converged" : "not converged", converged ? Tone::good : Tone::warning},
      .footer = "dielast " DIELAST_VERSION};
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    using Style = post::Series::Style;
    const RationalFit& fit = asked.fits[i];
    const FrequencyTable& table = fit.measured;
    const std::array both{post::FrequencyResponse{"measured", table.hertz, table.value, Style::points},
                          post::FrequencyResponse{"fitted", table.hertz, outcomes[i].model, Style::line}};
    post::Section section{fit.name(), {}};
    section.add(
        post::draw(post::bode(fit.name(), fmt::format("magnitude ({})", unit_of(fit.response)), both)));
    section.blocks.push_back(number_table(fit, outcomes[i]));
    section.blocks.push_back(post::Paragraph{
        fmt::format("({}) / ({})", polynomial(outcomes[i].numerator), polynomial(outcomes[i].denominator))});
    for (const std::string& warning : warnings_of(fit, outcomes[i]))
      section.blocks.push_back(post::Paragraph{"Warning: " + warning});
    report.sections.push_back(std::move(section));
  }
  return report;
}

std::string table_of(const RationalFits& asked, const std::vector<RationalOutcome>& outcomes) {
  std::string text = "fit,frequency[Hz],measured_real,measured_imaginary,model_real,model_imaginary\n";
  for (std::size_t f = 0; f < outcomes.size(); ++f) {
    const FrequencyTable& table = asked.fits[f].measured;
    for (std::size_t i = 0; i < table.hertz.size(); ++i)
      text += post::csv_cell(asked.fits[f].name()) +
              fmt::format(",{},{},{},{},{}\n", table.hertz[i], table.value[i].real(), table.value[i].imag(),
                          outcomes[f].model[i].real(), outcomes[f].model[i].imag());
  }
  return text;
}

} // namespace

std::vector<RationalOutcome> solve_rational_fits(const RationalFits& asked) {
  std::vector<RationalOutcome> outcomes;
  for (const RationalFit& fit : asked.fits)
    outcomes.push_back(fit.is_circuit()
                           ? fit_circuit(fit.measured,
                                         {fit.elements, fit.response == MeasuredResponse::admittance},
                                         max_iterations)
                           : fit_rational(fit.measured, fit.order, max_iterations));
  return outcomes;
}

ExitCode run_rational_fits(const RationalFits& asked, const std::filesystem::path& directory) {
  post::ResultsFolder folder(directory, "fit");
  folder.begin();
  const std::vector<RationalOutcome> outcomes = solve_rational_fits(asked);
  Json json{{"title", asked.title}, {"fits", Json::array()}, {"version", DIELAST_VERSION}};
  ExitCode code = ExitCode::ok;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const RationalFit& fit = asked.fits[i];
    json["fits"].push_back(json_of(fit, outcomes[i]));
    say("{}\n", fit.name());
    for (const auto& row : number_table(fit, outcomes[i]).rows)
      say("  {:<26}  {:<20}  {}\n", row[0].text, row[1].text, row[2].text);
    for (const std::string& warning : warnings_of(fit, outcomes[i])) say(stderr, "warning: {}\n", warning);
    if (outcomes[i].ending != FitEnding::converged) code = ExitCode::not_converged;
  }
  folder.write("rational.csv", table_of(asked, outcomes));
  post::write_report(folder, report_of(asked, outcomes));
  folder.write("rational.json", json.dump(2) + "\n");
  say("results in {}: report.html, rational.csv, rational.json\n", directory.string());
  folder.set_complete(static_cast<int>(code));
  return code;
}

} // namespace dielast::cases
