// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/fit_files.hpp"

#include "cases/language/convert.hpp"
#include "cases/text/units.hpp"
#include "post/files/history.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>

namespace dielast::cases {

using Json = nlohmann::ordered_json;

namespace {

std::string cell(double value) { return std::isfinite(value) ? fmt::format(",{}", value) : ","; }

double rounded(double value) { return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr); }

/// Keys and values of a section, but not a branch's relaxation time or viscosity; a permittivity of 0 was not
/// given.
std::string keys_text(const Section& section, const void* object) {
  const std::string selected = section.selected_in(object);
  std::string text;
  for (const Key& key : section.keys) {
    if (!key.applies_to(selected) || key.instead_of == "relaxation_time") continue;
    const auto value = key.binding.get(object);
    if (value && !(key.name == "permittivity" && value->at(0).number == 0))
      text += fmt::format("{} = {}\n", key.name, toml_text(key, *value));
  }
  return text;
}

} // namespace

Json finite_json(double value) { return std::isfinite(value) ? Json(value) : Json(); }

const char* word(FitEnding ending) {
  switch (ending) {
  case FitEnding::converged:
    return "converged";
  case FitEnding::gave_up:
    return "not converged";
  case FitEnding::interrupted:
    break;
  }
  return "interrupted";
}

void append_value(Json& named, const FittedParameter& one) {
  const bool known = one.determined();
  named["value"] = one.value;
  named["low_95"] = known ? Json(one.low) : Json();
  named["high_95"] = known ? Json(one.high) : Json();
  named["start"] = one.start;
  named["at_bound"] = one.at_bound;
}

Json correlation_json(const Eigen::MatrixXd& correlation) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < correlation.rows(); ++i) {
    Json row = Json::array();
    for (const double r : correlation.row(i)) row.push_back(finite_json(r));
    rows.push_back(std::move(row));
  }
  return rows;
}

void add_warnings(post::Report& report, const std::vector<std::string>& warnings) {
  if (warnings.empty()) return;
  post::Table table{{"warning"}, {}};
  for (const std::string& warning : warnings)
    table.rows.push_back({post::Cell{warning, post::Tone::warning}});
  report.sections.push_back({"Warnings", {std::move(table)}});
}

Json fit_json(const FitResults& results) {
  const FitOutcome& outcome = results.outcome;
  Json json{{"title", results.fit.title},
            {"status", word(outcome.ending)},
            {"iterations", outcome.iterations},
            {"deviation", finite_json(outcome.deviation)},
            {"parameters", Json::array()},
            {"correlation", correlation_json(outcome.correlation)},
            {"tests", Json::array()}};
  for (std::size_t i = 0; i < outcome.parameters.size(); ++i) {
    const FitParameter& asked = results.task.parameters[i];
    append_value(json["parameters"].emplace_back(Json{{"name", asked.name}, {"unit", asked.unit}}),
                 outcome.parameters[i]);
  }
  for (std::size_t t = 0; t < results.errors.size(); ++t) {
    const FitTest& test = results.fit.tests[t];
    json["tests"].push_back({{"file", test.file.string()},
                             {"use", test.predict ? "predict" : "fit"},
                             {"rows", test.lines.size()},
                             {"weight", test.weight},
                             {"largest_stress", test.measured.largest_stress()},
                             {"rms_error", finite_json(results.errors[t].rms)},
                             {"largest_error", finite_json(results.errors[t].largest)},
                             {"steps_between_rows", outcome.steps[t]}});
  }
  json["warnings"] = results.warnings();
  json["version"] = DIELAST_VERSION;
  return json;
}

std::string fit_table(const FitResults& results) {
  std::string table = "test,use,time[s],stretch[1],measured[Pa],model[Pa]\n";
  for (std::size_t t = 0; t < results.task.tests.size(); ++t) {
    const FitTest& test = results.fit.tests[t];
    const StretchHistory& history = test.measured.history;
    for (std::size_t i = 0; i < history.stretch.size(); ++i)
      table += post::csv_cell(test.name()) + (test.predict ? ",predict" : ",fit") +
               cell(history.time.empty() ? std::nan("") : history.time[i]) + cell(history.stretch[i]) +
               cell(test.measured.stress[i]) + cell(results.outcome.stress[t][i]) + "\n";
  }
  return table;
}

std::string material_toml(const FitResults& results) {
  Film film;
  film.material = results.outcome.material;
  for (const FitParameter& parameter : results.task.parameters)
    parameter.set(film.material, rounded(parameter.get(film.material)));
  const Section& material = *case_schema().find_section("film")->find_section("material");
  const Section& branch = *material.find_section("branch");

  std::string text = fmt::format("# {}: {}\n", results.fit.title, results.ending());
  if (film.material.dielectric.permittivity == 0)
    text += "# a case needs its relative_permittivity as well\n";
  text += "[film.material]\n" + keys_text(material, &film);
  for (std::size_t b = 0; b < film.material.branches.size(); ++b) {
    const materials::Branch& one = film.material.branches[b];
    text += "\n[[film.material.branch]]\n" + keys_text(branch, &one);
    const double tau = one.viscosity / materials::initial_shear_modulus(one.law);
    text += results.fit.keeps_viscosity[b]
                ? fmt::format("viscosity = \"{}\"\n", format_measure(rounded(one.viscosity), "Pa s"))
                : fmt::format("relaxation_time = \"{}\"\n", format_measure(rounded(tau), "s"));
  }
  return text;
}

} // namespace dielast::cases
