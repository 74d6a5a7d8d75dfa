// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/fit_reader.hpp"

#include "cases/language/section_reader.hpp"
#include "cases/readers/fit_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dielast::cases {
namespace {

constexpr std::array own_sections{"fit", "test"};

/// What belongs to a device is refused here, in words of its own.
Node without_device(SectionReader& reader, const Node& tree, const Section& schema) {
  Node own = tree;
  own.keys.clear(), own.items.clear();
  for (std::size_t i = 0; i < tree.items.size(); ++i) {
    const std::string& name = tree.keys[i];
    if (case_schema().find_section(name) && !schema.find_section(name))
      reader.report(tree.items[i].key_source, name,
                    "a fit has only \"title\", [film.material], [fit] and [[test]]");
    else
      own.add(name, tree.items[i]);
  }
  return own;
}

std::vector<std::string> names_of(const std::vector<FitParameter>& parameters) {
  std::vector<std::string> names;
  for (const FitParameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

void complete_parameters(SectionReader& reader, const Node& section, Fit& fit) {
  for (std::size_t b = 1; b <= fit.film.material.branches.size(); ++b) {
    const std::string branch = fmt::format("branch[{}].", b);
    const auto asked = [&](const char* key) {
      return std::ranges::find(fit.parameters, branch + key) != fit.parameters.end();
    };
    const bool given = reader.keys().contains("film.material." + branch + "viscosity");
    fit.keeps_viscosity.push_back(asked("viscosity") || (given && !asked("relaxation_time")));
  }
  const std::vector<std::string> known = names_of(fit_parameters(fit.film.material, fit.keeps_viscosity));
  if (fit.parameters.empty()) fit.parameters = known;
  const Node* list = section.find("parameters");
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const std::string& name = fit.parameters[i];
    const Source& source = list && list->is(Node::Kind::list) ? list->items[i].source : section.source;
    if (std::find(known.begin(), known.end(), name) == known.end())
      reader.report(source, "fit.parameters",
                    fmt::format("found {}: the material has no such parameter, allowed {}{}",
                                toml_string(name), listed(known), did_you_mean(name, known)));
    else if (std::find(fit.parameters.begin(), fit.parameters.begin() + static_cast<std::ptrdiff_t>(i),
                       name) != fit.parameters.begin() + static_cast<std::ptrdiff_t>(i))
      reader.report(source, "fit.parameters", fmt::format("found {} twice", toml_string(name)));
  }
}

void require_enough_rows(SectionReader& reader, const Node& section, const Fit& fit) {
  std::size_t rows = 0;
  for (const FitTest& test : fit.tests)
    if (!test.predict) rows += test.measured.stress.size();
  if (rows <= fit.parameters.size())
    reader.report(section.source, "fit",
                  fmt::format("found {} row{} to fit {} parameter{} to, allowed at least {}", rows,
                              rows == 1 ? "" : "s", fit.parameters.size(),
                              fit.parameters.size() == 1 ? "" : "s", fit.parameters.size() + 1));
}

/// The width of a film with a viscosity is known where the flow of its branches is isotropic.
void require_known_width(SectionReader& reader, const Node& tree, const Fit& fit) {
  const auto nominal = [](const materials::Branch& one) {
    return one.dashpot == materials::Dashpot::nominal;
  };
  if (fit.film.material.viscosity == 0 || std::ranges::none_of(fit.film.material.branches, nominal)) return;
  for (std::size_t t = 0; t < fit.tests.size(); ++t)
    if (fit.tests[t].kind == materials::Mode::uniaxial && !fit.tests[t].equilibrium)
      reader.report(
          tree.find("test")->items[t].source, fmt::format("test[{}].kind", t + 1),
          "a uniaxial test of a film with a viscosity and nominal dashpots cannot be fitted, as they "
          "resist its width by different rules: leave one of them out, or use a test in pure shear");
}

/// The start values must give a stress in every row that is fitted.
void require_finite_start(SectionReader& reader, const Node& tree, const Fit& fit) {
  for (std::size_t t = 0; t < fit.tests.size(); ++t) {
    const FitTest& test = fit.tests[t];
    if (test.predict) continue;
    const std::vector<double> stress = nominal_stress(fit.film.material, test.measured.history, 1);
    const auto row =
        std::find_if(stress.begin(), stress.end(), [](double one) { return !std::isfinite(one); }) -
        stress.begin();
    if (row == static_cast<std::ptrdiff_t>(stress.size())) continue;
    const auto r = static_cast<std::size_t>(row);
    reader.report(tree.find("film")->source, "film.material",
                  fmt::format("the start values do not reach the stretch {:.4g} of {}, line {}: start with a "
                              "larger limit",
                              test.measured.history.stretch[r], test.file.string(), test.lines[r]));
  }
}

} // namespace

Section fit_schema() {
  Section root;
  root.access = same_object();
  root.keys = {text("title", to(&Fit::title), "title of the report").optional()};
  Section film = *case_schema().find_section("film");
  film.access = member(&Fit::film);
  film.check = {};
  for (Key& key : film.keys) key.required = false;
  for (Section& section : film.sections)
    for (Key& key : section.keys)
      if (key.only_for.empty()) key.required = false;
  root.sections.push_back(std::move(film));
  for (const char* name : own_sections) {
    root.sections.push_back(*case_schema().find_section(name));
    Section& section = root.sections.back();
    section.presence =
        section.shape == Section::Shape::list ? Section::Presence::list : Section::Presence::required;
  }
  return root;
}

void refuse_fit(const Node& tree) {
  const auto refuse = [&](const char* name, const char* message) {
    for (std::size_t i = 0; i < tree.keys.size(); ++i)
      if (tree.keys[i] == name) throw CaseError({{tree.items[i].key_source, name, message}});
  };
  for (const char* name : own_sections) refuse(name, "this file is a fit of a material: use `dielast fit`");
  refuse("identify", "this file identifies a device: use `dielast fit`");
  refuse("rational", "this file fits measured responses: use `dielast fit`");
}

Fit read_fit(const std::filesystem::path& path) {
  const Node tree = read_tree(path);
  const Node* section = tree.find("fit");
  if (!section)
    throw CaseError({{tree.source, "fit",
                      "missing; add the section [fit], or use `dielast run` for the case of a device"}});
  Fit fit;
  fit.source = path;
  fit.title = path.stem().string();
  SectionReader reader({.folder = path.parent_path()});
  const Section schema = fit_schema();
  reader.read_table(schema, without_device(reader, tree, schema), &fit, "");
  const Node* tests = tree.find("test");
  if (!tests) reader.report(tree.source, "test", "missing; add a [[test]] with the file of a measured table");
  if (!reader.diagnostics().empty()) throw CaseError(reader.diagnostics());

  std::vector<Diagnostic> wrong;
  for (std::size_t i = 0; i < fit.tests.size(); ++i)
    load_test(fit.tests[i], path.parent_path(), !materials::with_dashpot(fit.film.material).branches.empty(),
              tests->items[i], fmt::format("test[{}]", i + 1), wrong);
  complete_parameters(reader, *section, fit);
  if (wrong.empty() && reader.diagnostics().empty()) {
    require_enough_rows(reader, *section, fit);
    require_known_width(reader, tree, fit);
    require_finite_start(reader, tree, fit);
  }
  wrong.insert(wrong.end(), reader.diagnostics().begin(), reader.diagnostics().end());
  if (!wrong.empty()) throw CaseError(wrong);
  return fit;
}

FitTask fit_task(const Fit& fit) {
  FitTask task{.start = fit.film.material, .range = fit.range, .max_iterations = fit.max_iterations};
  const std::vector<FitParameter> all = fit_parameters(fit.film.material, fit.keeps_viscosity);
  for (const std::string& name : fit.parameters)
    task.parameters.push_back(
        *std::find_if(all.begin(), all.end(), [&](const FitParameter& one) { return one.name == name; }));
  for (const FitTest& test : fit.tests) task.tests.push_back(test.measured);
  return task;
}

} // namespace dielast::cases
