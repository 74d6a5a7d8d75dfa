// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/study_axes.hpp"

#include "cases/readers/case_tree.hpp"
#include "cases/text/expression.hpp"
#include "cases/text/overrides.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

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

/// { from, to, step } or { from, to, count }, perhaps with spacing = "logarithmic".
struct WrittenRange {
  WrittenMeasure from, to;
  std::optional<WrittenMeasure> step{};
  std::optional<double> count{};
  bool logarithmic = false;
};

std::optional<WrittenRange> written_range(const Node& node) {
  const auto from = measured(node.find("from")), to = measured(node.find("to"));
  const Node *count = node.find("count"), *step = node.find("step"), *spacing = node.find("spacing");
  if (!from || !to || (count != nullptr) == (step != nullptr)) return std::nullopt;
  if (node.items.size() != (spacing ? 4 : 3) || (spacing && (step || spacing->text != "logarithmic")))
    return std::nullopt;
  WrittenRange range{*from, *to, measured(step)};
  if (count && count->is(Node::Kind::integer)) range.count = count->number;
  range.logarithmic = spacing != nullptr;
  return range.step || range.count ? std::optional(range) : std::nullopt;
}

/// Values of a range, both ends included; every unit must be written alike. Empty after a report.
std::vector<std::string> range_values(SectionReader& reader, const Node& node, const std::string& path) {
  constexpr double most = 10000;
  const auto range = written_range(node);
  std::vector<std::string> values;
  if (!range) {
    reader.report(
        node.source, path,
        "a range is { from = ..., to = ..., step = ... } or { from = ..., to = ..., count = ... }, the "
        "latter perhaps with spacing = \"logarithmic\"; a key with a dot stands in quotes, as in "
        "\"honeycomb.angle\" = [...]");
    return values;
  }
  const auto& [from, to, step, written_count, logarithmic] = *range;
  const double count =
      step ? std::floor((to.number - from.number) / step->number + 1e-9) + 1 : *written_count;
  const std::string ends =
      fmt::format("from {} to {}", text_of(*node.find("from")), text_of(*node.find("to")));
  if (from.unit != to.unit || (step && from.unit != step->unit))
    reader.report(node.source, path, "from, to and step must have the same unit");
  else if (step && !(count >= 1 && count <= most))
    reader.report(node.source, path, fmt::format("step must lead {} in at most {} values", ends, most));
  else if (!step && !(count >= 2 && count <= most))
    reader.report(node.source, path, fmt::format("found count = {}, allowed 2 to {}", count, most));
  else if (logarithmic && !(from.number * to.number > 0))
    reader.report(node.source, path, fmt::format("no equal ratios lead {}", ends));
  else {
    const double last = step ? from.number + (count - 1) * step->number : to.number;
    if (std::abs(to.number - last) > 1e-9 * std::abs(step ? step->number : 1))
      reader.warn(node.source, path,
                  fmt::format("its steps do not lead to {}: the last value is {:.12g} {}",
                              text_of(*node.find("to")), last, from.unit));
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const double part = i / (count - 1);
      double value = step          ? from.number + i * step->number
                     : logarithmic ? from.number * std::pow(to.number / from.number, part)
                                   : from.number + part * (to.number - from.number);
      if (std::abs(value) < 1e-12 * std::max(std::abs(from.number), std::abs(to.number))) value = 0;
      const std::string number = fmt::format("{:.12g}", value);
      values.push_back(from.unit.empty() ? number : toml_string(fmt::format("{} {}", number, from.unit)));
    }
  }
  return values;
}

/// Tries values on the base case and reports what is wrong with them; `told` holds the messages of this axis
/// so far.
void try_values(SectionReader& reader, const Node& base, const Study& study,
                const std::vector<std::pair<std::string, std::string>>& values, const Source& source,
                const std::string& axis, std::set<std::string>& told) {
  try {
    Node tree = base;
    for (const auto& [key, value] : values) override_case(tree, key, value, source);
    interpret(std::move(tree), study.base);
  } catch (const CaseError& error) {
    for (const Diagnostic& wrong : error.diagnostics()) {
      const bool named = wrong.key.empty() || wrong.key == axis;
      const std::string message = named ? wrong.message : wrong.key + ": " + wrong.message;
      if (told.insert(message).second) reader.report(source, fmt::format("study.vary.\"{}\"", axis), message);
    }
  }
}

/// The table's key at a path, of which several choices may have one of that name; null where there is none.
const Key* key_at(const std::string& path) {
  static const Section waves = wave_section("V");
  const Section* section = &case_schema();
  const Key* key = nullptr;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string name = path.substr(begin, std::min(path.find('[', begin), end) - begin);
    key = section->find_key(name, "");
    if (const Section* inner = section->find_section(name))
      section = inner;
    else if (key && key->type == Type::wave)
      section = &waves;
    begin = end + 1;
  }
  return key;
}

bool takes_measures(const Key& key) {
  return key.type == Type::measure || key.type == Type::wave || key.type == Type::tolerance ||
         key.type == Type::integer;
}

/// Whether a value is written in rad/s.
bool is_angular(const std::string& value) {
  const auto written = written_measure(value);
  return written && written->unit == "rad/s";
}

/// Whether what is derived may be divided by 2 pi already.
bool has_pi(const DerivedKey& derived) {
  return std::ranges::any_of(derived.expressions, [](const std::string& expression) {
    return std::ranges::count(names_in(expression), "pi") > 0;
  });
}

/// Hz and rad/s stand for one another by 2 pi: columns and plots of an axis have one of them.
void require_one_kind(SectionReader& reader, const StudyAxis& axis, const Source& source) {
  std::optional<BasePowers> first;
  for (const std::string& value : axis.values) try {
      const auto written = written_measure(value);
      if (!written) continue;
      BasePowers powers = si_unit(written->unit).powers, of_first = first.value_or(powers);
      const bool differ = powers.back() != of_first.back();
      powers.back() = of_first.back(); // of rad
      if (differ && powers == of_first)
        return reader.report(
            source, fmt::format("study.vary.\"{}\"", axis.key),
            fmt::format("found {} beside {}, allowed units of one kind", value, axis.values[0]));
      if (!first) first = powers;
    } catch (const UnitError&) { // a file, or told where the value is tried
      return;
    }
}

/// Values of a key and where each is written.
struct WrittenAxis {
  StudyAxis axis;
  std::vector<Source> sources{};
};

WrittenAxis read_axis(SectionReader& reader, const std::string& key, const Node& node) {
  WrittenAxis read{{key, {}}};
  const std::string path = fmt::format("study.vary.\"{}\"", key);
  if (const Key* known = key_at(key)) read.axis.is_measure = takes_measures(*known);
  if (node.is(Node::Kind::list)) {
    if (node.items.empty()) reader.report(node.source, path, "is empty; give at least one value");
    for (const Node& item : node.items) {
      read.axis.values.push_back(text_of(item));
      read.sources.push_back(item.source);
    }
  } else if (node.is(Node::Kind::table)) {
    read.axis.values = range_values(reader, node, path);
    read.sources.assign(read.axis.values.size(), node.source);
  } else {
    reader.report(
        node.source, path,
        fmt::format("found {}, allowed a list of values or {{ from, to, step }}; is \"{}\" in quotes?",
                    text_of(node), key));
  }
  if (read.axis.is_measure) require_one_kind(reader, read.axis, node.source);
  return read;
}

/// No key is varied twice, nor within another.
void refuse_overlaps(SectionReader& reader, const Node& vary, const Node& base) {
  for (std::size_t i = 0; i < vary.items.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const std::string one = numbered_key(base, vary.keys[i]), other = numbered_key(base, vary.keys[j]);
      if (is_within(one, other) || is_within(other, one))
        reader.report(vary.items[i].key_source, fmt::format("study.vary.\"{}\"", vary.keys[i]),
                      fmt::format("is varied already, with {}", toml_string(vary.keys[j])));
    }
}

/// Of a pair either may have a value several times.
void warn_of_repetition(SectionReader& reader, const WrittenAxis& axis) {
  std::set<std::string> seen;
  for (std::size_t v = 0; v < axis.sources.size(); ++v)
    if (const std::string& value = axis.axis.values[v]; !seen.insert(value).second)
      reader.warn(axis.sources[v], fmt::format("study.vary.\"{}\"", axis.axis.key),
                  fmt::format("{} stands twice, and is computed twice", value));
}

/// A key's expressions: texts, or numbers that stand for themselves.
void read_derived(SectionReader& reader, const Node& section, const Node& base, Study& study) {
  const Node* derive = section.find("derive");
  if (!derive) return;
  if (!derive->is(Node::Kind::table)) {
    reader.report(derive->source, "study.derive",
                  "allowed a table, such as derive = { \"film.prestretch\" = [\"l1\", \"10 / l1\"] }");
    return;
  }
  for (std::size_t i = 0; i < derive->items.size(); ++i) {
    const Node& node = derive->items[i];
    DerivedKey& one = study.derived.emplace_back(DerivedKey{derive->keys[i], {}, node.is(Node::Kind::list)});
    const std::string path = fmt::format("study.derive.\"{}\"", one.key);
    const std::string key = numbered_key(base, one.key);
    if (std::ranges::any_of(study.axes, [&](const StudyAxis& axis) {
          const std::string varied = numbered_key(base, axis.key);
          return is_within(key, varied) || is_within(varied, key);
        }))
      reader.report(derive->items[i].key_source, path, "is varied already");
    for (const Node& item : one.is_list ? node.items : std::vector<Node>{node}) {
      const bool is_number = item.is(Node::Kind::integer) || item.is(Node::Kind::number);
      if (!is_number && !item.is(Node::Kind::text))
        reader.report(
            item.source, path,
            fmt::format("found {}, allowed an expression in quotes or a list of them; for one value at "
                        "all points use study.set",
                        text_of(item)));
      one.expressions.push_back(is_number ? text_of(item) : item.text);
    }
    if (one.expressions.empty()) reader.report(node.source, path, "is empty; give at least one expression");
  }
}

/// What varies and is no key of the case must be what an expression needs.
void find_parameters(SectionReader& reader, const Node& vary, Study& study) {
  std::set<std::string> used;
  for (const DerivedKey& one : study.derived)
    for (const std::string& expression : one.expressions)
      for (std::string& name : names_in(expression)) used.insert(std::move(name));
  for (const StudyAxis& axis : study.axes) {
    const Section& schema = case_schema();
    const bool is_plain = axis.key.find_first_of(".[\"") == std::string::npos;
    if (!is_plain || schema.find_key(axis.key, "") || schema.find_section(axis.key)) continue;
    study.parameters.push_back(axis.key);
    const Source& source = vary.find(axis.key)->source;
    const std::string path = fmt::format("study.vary.\"{}\"", axis.key);
    if (is_reserved_in_expressions(axis.key))
      reader.report(source, path, "is a unit or function of expressions; give the parameter another name");
    else if (!used.contains(axis.key))
      reader.report(source, path, "is no key of the case, and no expression of study.derive has it");
  }
}

void read_pair(SectionReader& reader, const Node& section, const Study& study) {
  const StudyAxis* first = nullptr;
  for (const std::string& name : study.pair) {
    const auto axis = std::ranges::find(study.axes, name, &StudyAxis::key);
    const Source& source = section.find("pair")->source;
    if (axis == study.axes.end())
      reader.report(source, "study.pair",
                    fmt::format("found {}, allowed keys of study.vary", toml_string(name)));
    else if (!first)
      first = &*axis;
    else if (axis->values.size() != first->values.size())
      reader.report(source, "study.pair",
                    fmt::format("{} has {} values and {} has {}; keys that go together have equally many",
                                first->key, first->values.size(), axis->key, axis->values.size()));
  }
}

/// Tries every value on the base case: of a pair and of what is derived together, with the first values of
/// the other axes where an expression needs them.
void try_axes(SectionReader& reader, const Node& base, const Study& study,
              const std::vector<WrittenAxis>& written) {
  std::vector<std::string> firsts;
  for (const StudyAxis& axis : study.axes) firsts.push_back(axis.values.front());
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    const StudyAxis& axis = study.axes[a];
    std::set<std::string> told;
    for (std::size_t v = 0; v < axis.values.size(); ++v) {
      std::vector<std::string> values = firsts;
      std::vector<std::pair<std::string, std::string>> tried;
      for (std::size_t b = 0; b < study.axes.size(); ++b) {
        const std::string& key = study.axes[b].key;
        const bool together = b == a || (study.goes_together(axis.key) && study.goes_together(key));
        if (together) values[b] = study.axes[b].values[v];
        if (together && !study.is_parameter(key))
          tried.insert(b == a ? tried.begin() : tried.end(), {key, values[b]});
      }
      try {
        const std::vector<std::string> derived = derived_values(study, values);
        for (std::size_t d = 0; d < derived.size(); ++d) {
          const std::string& key = study.derived[d].key;
          if (const Key* known = key_at(key); known && known->unit == "Hz" && is_angular(derived[d]) &&
                                              has_pi(study.derived[d]) && told.insert(key).second)
            reader.report(written[a].sources[v], fmt::format("study.derive.\"{}\"", key),
                          fmt::format("is {}, an angle per time, which would be divided by 2 pi once more; "
                                      "divide what is in rad/s by 2*pi*rad",
                                      derived[d]));
          tried.emplace_back(key, derived[d]);
        }
      } catch (const ExpressionError&) {
        continue; // told before
      }
      if (!tried.empty()) try_values(reader, base, study, tried, written[a].sources[v], axis.key, told);
    }
  }
}

} // namespace

void read_axes(SectionReader& reader, const Node& section, const Node& base, Study& study) {
  const Node* vary = section.find("vary");
  if (!vary || !vary->is(Node::Kind::table) || vary->items.empty()) {
    reader.report(
        vary ? vary->source : section.source, "study.vary",
        "what varies is missing, such as vary = { \"honeycomb.angle\" = [\"140 deg\", \"150 deg\"] }");
    return;
  }
  const std::size_t errors_before = reader.diagnostics().size();
  std::vector<WrittenAxis> written;
  for (std::size_t i = 0; i < vary->items.size(); ++i) {
    written.push_back(read_axis(reader, vary->keys[i], vary->items[i]));
    study.axes.push_back(written.back().axis);
    if (!study.goes_together(vary->keys[i])) warn_of_repetition(reader, written.back());
  }
  refuse_overlaps(reader, *vary, base);
  read_derived(reader, section, base, study);
  find_parameters(reader, *vary, study);
  read_pair(reader, section, study);
  double points = 1;
  bool paired = false;
  for (const StudyAxis& axis : study.axes)
    if (!study.goes_together(axis.key) || !std::exchange(paired, true))
      points *= static_cast<double>(axis.values.size());
  if (points > most_points || study.axes.size() > most_axes)
    reader.report(
        vary->source, "study.vary",
        fmt::format("makes a grid of {:.6g} points over {} keys, allowed {:.6g} points over {} keys", points,
                    study.axes.size(), most_points, most_axes));
  const Node* derive = section.find("derive");
  if (reader.diagnostics().size() > errors_before) return;
  try {
    for (const auto& values : grid_of(study)) derived_values(study, values);
  } catch (const ExpressionError& error) {
    reader.report(derive->source, "study.derive", error.what());
  }
  try_axes(reader, base, study, written);
}

} // namespace dielast::cases
