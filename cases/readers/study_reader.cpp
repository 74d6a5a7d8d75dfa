// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/study_reader.hpp"

#include "cases/case/quantities.hpp"
#include "cases/language/section_reader.hpp"
#include "cases/readers/case_tree.hpp"
#include "cases/readers/fit_reader.hpp"
#include "cases/text/overrides.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace dielast::cases {
namespace {

/// A number of { from, to, step }, with the unit as written.
std::optional<WrittenMeasure> measured(const Node* node) {
  if (!node) return std::nullopt;
  if (node->is(Node::Kind::integer) || node->is(Node::Kind::number)) return WrittenMeasure{node->number, ""};
  if (!node->is(Node::Kind::text)) return std::nullopt;
  try {
    return split_measure(node->text);
  } catch (const UnitError&) {
    return std::nullopt;
  }
}

constexpr double most_points = 1e5;
constexpr std::size_t most_axes = 20;

/// Values of { from, to, step }, both ends included; every unit must be written alike. Empty after a report.
std::vector<std::string> range_values(SectionReader& reader, const Node& node, const std::string& path) {
  constexpr double most = 10000;
  const auto from = measured(node.find("from")), to = measured(node.find("to")),
             step = measured(node.find("step"));
  if (!from || !to || !step || node.items.size() != 3) {
    reader.report(node.source, path,
                  "a range is { from = ..., to = ..., step = ... }; a key with a dot stands in quotes, as in "
                  "\"honeycomb.angle\" = [...]");
    return {};
  }
  const double count = std::floor((to->number - from->number) / step->number + 1e-9) + 1;
  if (from->unit != to->unit || from->unit != step->unit)
    reader.report(node.source, path, "from, to and step must have the same unit");
  else if (!(count >= 1 && count <= most))
    reader.report(node.source, path,
                  fmt::format("step must lead from {} to {} in at most {} values",
                              text_of(*node.find("from")), text_of(*node.find("to")), most));
  else {
    std::vector<std::string> values;
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const std::string number = fmt::format("{:.12g}", from->number + i * step->number);
      values.push_back(from->unit.empty() ? number : toml_string(fmt::format("{} {}", number, from->unit)));
    }
    return values;
  }
  return {};
}

/// Tries a value on the base case and reports what is wrong with it; `told` holds the messages of this axis
/// so far.
void try_value(SectionReader& reader, const Node& base, const Study& study, const std::string& key,
               const std::string& value, const Source& source, std::set<std::string>& told) {
  try {
    Node tree = base;
    apply_override(tree, key, value, source);
    interpret(std::move(tree), study.base);
  } catch (const CaseError& error) {
    for (const Diagnostic& wrong : error.diagnostics()) {
      const std::string message =
          wrong.key == key || wrong.key.empty() ? wrong.message : wrong.key + ": " + wrong.message;
      if (told.insert(message).second) reader.report(source, fmt::format("study.vary.\"{}\"", key), message);
    }
  }
}

void read_axes(SectionReader& reader, const Node& section, const Node& base, Study& study) {
  const Node* vary = section.find("vary");
  if (!vary || !vary->is(Node::Kind::table) || vary->items.empty()) {
    reader.report(
        vary ? vary->source : section.source, "study.vary",
        "what varies is missing, such as vary = { \"honeycomb.angle\" = [\"140 deg\", \"150 deg\"] }");
    return;
  }
  std::vector<std::vector<Source>> sources; // of each axis' values
  for (std::size_t i = 0; i < vary->items.size(); ++i) {
    const Node& node = vary->items[i];
    StudyAxis& axis = study.axes.emplace_back(StudyAxis{vary->keys[i], {}});
    std::vector<Source>& written = sources.emplace_back();
    const std::string path = fmt::format("study.vary.\"{}\"", axis.key);
    if (node.is(Node::Kind::list)) {
      if (node.items.empty()) reader.report(node.source, path, "is empty; give at least one value");
      for (const Node& item : node.items) {
        axis.values.push_back(text_of(item));
        written.push_back(item.source);
      }
    } else if (node.is(Node::Kind::table)) {
      axis.values = range_values(reader, node, path);
      written.assign(axis.values.size(), node.source);
    } else {
      reader.report(
          node.source, path,
          fmt::format("found {}, allowed a list of values or {{ from, to, step }}; is \"{}\" in quotes?",
                      text_of(node), axis.key));
    }
  }
  double points = 1;
  for (const StudyAxis& axis : study.axes) points *= static_cast<double>(axis.values.size());
  if (points > most_points || study.axes.size() > most_axes) {
    reader.report(
        vary->source, "study.vary",
        fmt::format("makes a grid of {:.6g} points over {} keys, allowed {:.6g} points over {} keys", points,
                    study.axes.size(), most_points, most_axes));
    return;
  }
  for (std::size_t a = 0; a < sources.size(); ++a) {
    std::set<std::string> told;
    for (std::size_t v = 0; v < sources[a].size(); ++v)
      try_value(reader, base, study, study.axes[a].key, study.axes[a].values[v], sources[a][v], told);
  }
}

void require_one_of(SectionReader& reader, const Source& source, const std::string& key,
                    const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) == known.end())
    reader.report(
        source, key,
        fmt::format("found {}, allowed {}{}", toml_string(name), listed(known), did_you_mean(name, known)));
}

/// Quantities and axes that the study names must exist.
void check_names(SectionReader& reader, const Node& section, const Study& study, const Case& base) {
  std::vector<std::string> quantities, axes;
  for (const Quantity& quantity : base.quantities) quantities.push_back(quantity.name);
  for (const StudyAxis& axis : study.axes) axes.push_back(axis.key);
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
}

/// A target needs one key whose values are numbers of one unit.
void check_targets(SectionReader& reader, const Node& section, const Study& study, const Case& base) {
  std::vector<std::string> quantities;
  for (const Quantity& quantity : base.quantities) quantities.push_back(quantity.name);
  const Node* targets = section.find("target");
  for (std::size_t i = 0; targets && i < targets->items.size(); ++i) {
    const Node& item = targets->items[i];
    const std::string path = fmt::format("study.target[{}]", i + 1);
    if (const Node* name = item.find("quantity"); name && name->is(Node::Kind::text))
      require_one_of(reader, item.source, path + ".quantity", name->text, quantities);
    if (study.axes.size() != 1 || study.axes[0].values.size() < 2 ||
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
  for (const StudyPlot& plot : study.plots) {
    add(plot.x);
    for (const std::string& y : plot.y) add(y);
  }
}

/// A file with `case` holds nothing but the study.
void require_only_study(SectionReader& reader, const Node& tree) {
  for (std::size_t i = 0; i < tree.items.size(); ++i)
    if (const std::string& key = tree.keys[i]; key != "title" && key != "case" && key != "study")
      reader.report(
          tree.items[i].key_source, key,
          "a study of another case has only \"title\", \"case\" and [study]; this belongs in that case");
}

} // namespace

Study read_study(const std::filesystem::path& path) {
  const Node tree = read_tree(path);
  refuse_fit(tree);
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
  const Node base = read_case_file(study.base);
  base_case = interpret(base, study.base); // its own errors come first: nothing can be varied without it
  reader.read_table(*case_schema().find_section("study"), *section, &study, "study");
  read_axes(reader, *section, base, study);
  check_names(reader, *section, study, base_case);
  check_targets(reader, *section, study, base_case);
  complete_collection(study, base_case);
  if (!reader.diagnostics().empty()) throw CaseError(reader.diagnostics());
  return study;
}

} // namespace dielast::cases
