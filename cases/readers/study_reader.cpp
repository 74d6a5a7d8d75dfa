// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/study_reader.hpp"

#include "cases/case/quantities.hpp"
#include "cases/language/section_reader.hpp"
#include "cases/readers/case_tree.hpp"
#include "cases/readers/fit_reader.hpp"
#include "cases/readers/study_axes.hpp"
#include "cases/text/overrides.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

/// What all points have is part of the base case from here on.
void read_settings(SectionReader& reader, const Node& section, Node& base, Study& study) {
  const Node* set = section.find("set");
  if (!set) return;
  if (!set->is(Node::Kind::table)) {
    reader.report(set->source, "study.set", "allowed a table, such as set = { \"output.fields\" = false }");
    return;
  }
  for (std::size_t i = 0; i < set->items.size(); ++i) {
    const std::string value = text_of(set->items[i]);
    override_case(base, set->keys[i], value, set->items[i].source);
    study.settings.push_back(set->keys[i] + "=" + value);
  }
}

void require_one_of(SectionReader& reader, const Source& source, const std::string& key,
                    const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end())
    reader.report(
        source, key,
        fmt::format("found {}, allowed {}{}", toml_string(name), listed(known), did_you_mean(name, known)));
}

/// The key of "key=value".
std::string_view key_of(std::string_view assignment) {
  std::string_view key = assignment.substr(0, assignment.find('='));
  while (key.ends_with(' ')) key.remove_suffix(1);
  while (key.starts_with(' ')) key.remove_prefix(1);
  return key;
}

/// What varies, or is computed, takes the place of what all points are to have.
void check_settings(SectionReader& reader, const Node& section, const Study& study, const Node& base,
                    const std::vector<std::string>& overrides) {
  const auto check = [&](const Source& source, const std::string& key) {
    for (const std::string& varied : study.varied())
      if (is_within(numbered_key(base, key), numbered_key(base, varied)))
        reader.report(source, key,
                      fmt::format("has no effect: the study gives {} a value at each of its points",
                                  toml_string(varied)));
  };
  if (const Node* set = section.find("set"); set && set->is(Node::Kind::table))
    for (std::size_t i = 0; i < set->items.size(); ++i) check(set->items[i].key_source, set->keys[i]);
  for (const std::string& assignment : overrides)
    check({"--set " + assignment}, std::string(key_of(assignment)));
}

/// Quantities and axes that the study names must exist.
void check_names(SectionReader& reader, const Node& section, const Study& study, const Case& base) {
  std::vector<std::string> quantities, axes = study.varied();
  for (const Quantity& quantity : base.quantities) quantities.push_back(quantity.name);
  std::vector<std::string> both = axes;
  both.insert(both.end(), quantities.begin(), quantities.end());

  if (const Node* collect = section.find("collect"))
    for (const std::string& name : study.collect)
      require_one_of(reader, collect->source, "study.collect", name, quantities);
  for (std::size_t i = 0; i < study.plots.size(); ++i) {
    const StudyPlot& plot = study.plots[i];
    const Source& source = section.find("plot")->items[i].source;
    const std::string path = fmt::format("study.plot[{}]", i + 1);
    if (!plot.x.empty()) require_one_of(reader, source, path + ".x", plot.x, both);
    for (const std::string& name : plot.y) require_one_of(reader, source, path + ".y", name, quantities);
    if (!plot.group.empty()) require_one_of(reader, source, path + ".group", plot.group, axes);
  }
  for (std::size_t i = 0; i < study.best.size(); ++i) {
    const Node& item = section.find("best")->items[i];
    const std::string path = fmt::format("study.best[{}]", i + 1);
    if (const std::string& name = study.best[i].quantity(); !name.empty())
      require_one_of(reader, item.source, path + (study.best[i].largest.empty() ? ".smallest" : ".largest"),
                     name, quantities);
    for (const StudyBound& bound : study.best[i].where)
      require_one_of(reader, item.source, path + ".where", bound.quantity, quantities);
  }
}

/// A target needs one key whose values are numbers of one unit, where the axes are without errors.
void check_targets(SectionReader& reader, const Node& section, const Study& study, const Case& base,
                   bool knows_axes) {
  std::vector<std::string> quantities;
  for (const Quantity& quantity : base.quantities) quantities.push_back(quantity.name);
  const Node* targets = section.find("target");
  for (std::size_t i = 0; targets && i < targets->items.size(); ++i) {
    const Node& item = targets->items[i];
    const std::string path = fmt::format("study.target[{}]", i + 1);
    if (const Node* name = item.find("quantity"); name && name->is(Node::Kind::text))
      require_one_of(reader, item.source, path + ".quantity", name->text, quantities);
    if (!knows_axes) continue;
    if (study.axes.size() != 1 || study.axes[0].values.size() < 2 || !study.axes[0].is_measure ||
        !std::ranges::all_of(study.axes[0].values,
                             [](const auto& v) { return written_measure(v).has_value(); }))
      reader.report(item.source, path, "a target needs a study of one key with two or more numbers");
    else if (const std::string unit = written_measure(study.axes[0].values[0])->unit; !std::ranges::all_of(
                 study.axes[0].values, [&](const auto& v) { return written_measure(v)->unit == unit; }))
      reader.report(item.source, path, "a target needs values of the key that are all written in one unit");
  }
}

/// Without `collect` every quantity is collected; what the plots show always is.
void complete_collection(Study& study, const Case& base) {
  const auto add = [&](const std::string& name) {
    const bool known = std::any_of(base.quantities.begin(), base.quantities.end(),
                                   [&](const Quantity& quantity) { return quantity.name == name; });
    if (known && std::find(study.collect.begin(), study.collect.end(), name) == study.collect.end())
      study.collect.push_back(name);
  };
  if (study.collect.empty())
    for (const Quantity& quantity : base.quantities) add(quantity.name);
  for (const StudyTarget& target : study.targets) add(target.quantity);
  for (const StudyBest& best : study.best) {
    add(best.quantity());
    for (const StudyBound& bound : best.where) add(bound.quantity);
  }
  for (const StudyPlot& plot : study.plots) {
    add(plot.x);
    for (const std::string& y : plot.y) add(y);
  }
}

/// A file with `case` holds nothing but the study.
void require_only_study(SectionReader& reader, const Node& tree) {
  for (std::size_t i = 0; i < tree.items.size(); ++i)
    if (const std::string& key = tree.keys[i]; key != "title" && key != "case" && key != "study")
      reader.report(tree.items[i].key_source, key,
                    "a study of another case has only \"title\", \"case\" and [study]; this belongs in that "
                    "case, or in "
                    "study.set");
}

} // namespace

Study read_study(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  Node tree = read_tree(path);
  refuse_fit(tree);
  for (const std::string& assignment : overrides)
    if (tree.find("study") && is_within(key_of(assignment), "study")) apply_override(tree, assignment);
  Study study;
  study.source = study.base = path;
  study.title = path.stem().string();
  if (const Node* title = tree.find("title"); title && title->is(Node::Kind::text)) study.title = title->text;
  const Node* section = tree.find("study");
  Case base_case;
  SectionReader reader({.unit_of_quantity = [&](const std::string& name) -> std::optional<std::string> {
    for (const Quantity& quantity : base_case.quantities)
      if (quantity.name == name) return unit_of(quantity, base_case.quantities);
    return std::nullopt;
  }});
  if (!section || !section->is(Node::Kind::table))
    throw CaseError({{tree.source, "study", "missing; add the section [study]"}});
  const Node* base_name = tree.find("case");
  if (base_name) {
    require_only_study(reader, tree);
    study.base = path.parent_path() / base_name->text;
    if (std::error_code failure; !std::filesystem::is_regular_file(study.base, failure))
      throw CaseError({{base_name->source, "case",
                        fmt::format("found {}: no such file; the path starts at this file's folder",
                                    text_of(*base_name))}});
  }
  Node base = read_case_file(study.base);
  if (base_name && base.find("case"))
    throw CaseError(
        {{base_name->source, "case",
          fmt::format("found {}, which is a study of another case: name that", text_of(*base_name))}});
  if (const Node* output = base.find("output"); !output || !output->find("states")) {
    study.settings.emplace_back("output.states=\"last\""); // a grid of whole series fills disks
    override_case(base, study.settings.back());
  }
  read_settings(reader, *section, base, study);
  for (const std::string& assignment : overrides) {
    if (is_within(key_of(assignment), "study")) continue; // is in the tree of this file
    override_case(base, assignment);
    study.settings.push_back(assignment);
  }
  base_case = interpret(base, study.base); // its own errors come first: nothing can be varied without it
  reader.read_table(*case_schema().find_section("study"), *section, &study, "study");
  const std::size_t errors_before = reader.diagnostics().size();
  read_axes(reader, *section, base, study);
  const bool knows_axes = reader.diagnostics().size() == errors_before;
  check_settings(reader, *section, study, base, overrides);
  check_names(reader, *section, study, base_case);
  check_targets(reader, *section, study, base_case, knows_axes);
  complete_collection(study, base_case);
  for (const Quantity& quantity : base_case.quantities)
    if (quantity.kind->relative) study.relative.insert(quantity.name);
  if (!reader.diagnostics().empty()) throw CaseError(reader.diagnostics());
  study.warnings = reader.warnings();
  return study;
}

std::optional<Diagnostic> study_of_one_run(const std::filesystem::path& path) {
  const Node tree = read_tree(path);
  const Node* section = tree.find("study");
  if (!section) return std::nullopt;
  return Diagnostic{
      section->key_source, "study",
      fmt::format("has no effect here: its points are run by `dielast study {}`", path.string()),
      Severity::warning};
}

} // namespace dielast::cases
