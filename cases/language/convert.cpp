// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/convert.hpp"

#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

namespace dielast::cases {
namespace {

/// The value as a message quotes it: long ones are cut.
std::string shown_text(const Node& node) {
  constexpr std::size_t longest = 60;
  std::string text = text_of(node);
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
    --end; // not inside a UTF-8 character
  return text.substr(0, end) + "...";
}

[[noreturn]] void mismatch(const Node& node, const std::string& reason, const std::string& allowed) {
  throw Mismatch{fmt::format("found {}{}, allowed {}", shown_text(node), reason, allowed), node.source};
}

bool is_measure(const Key& key) { return key.type == Type::measure || key.type == Type::wave; }

/// 300 % is no stretch: some mean a length that is three times as long, others four times.
void require_no_percent(const Key& key, const Node& node) {
  if (key.is_stretch && node.is(Node::Kind::text) && node.text.find('%') != std::string::npos)
    throw Mismatch{fmt::format("found {}: a stretch is a length over a length, without %; 3 is three times "
                               "as long",
                               shown_text(node)),
                   node.source};
}

std::vector<std::string> words_of(const Key& key) {
  std::vector<std::string> words;
  for (const Choice& choice : key.choices) words.push_back(choice.word);
  return words;
}

std::vector<std::string> split(std::string_view words) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    parts.emplace_back(words.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string measure_expectation(std::string_view unit) {
  if (unit.empty()) return "a number or a measure in the quantity's unit";
  return unit == "1" ? "a number"
                     : fmt::format("{} such as \"{}\"", dimension(unit).noun, dimension(unit).example);
}

/// What one item of the key may be.
std::string item_expectation(const Key& key, std::string_view unit) {
  switch (key.type) {
  case Type::measure:
    return measure_expectation(unit);
  case Type::wave:
    return measure_expectation(unit) + ", or a wave such as { wave = \"sine\", ... }";
  case Type::tolerance:
    return "a part of the value such as \"1 %\", or a difference in the quantity's unit";
  case Type::integer:
    return "a whole number";
  case Type::flag:
    return "true or false";
  case Type::word:
    return "one of " + listed(words_of(key));
  case Type::name:
    return fmt::format("a name of at most {} letters, digits, \"_\" and \"-\"", longest_name);
  case Type::text:
    return "a text in quotes";
  }
  return "";
}

bool is_inside(const Range& range, double value) {
  return (range.low_open ? value > range.low : value >= range.low) &&
         (range.high_open ? value < range.high : value <= range.high);
}

void require_range(const Key& key, const Node& node, double value, const std::string& shown, bool bare) {
  if (is_inside(key.range, value)) return;
  std::string allowed = range_text(key, shown);
  if (!key.hint.empty()) allowed += ": " + key.hint;
  const bool has_unit = bare && key.unit != "1" && is_measure(key);
  mismatch(node, has_unit ? fmt::format(" (a number without a unit is in {})", key.unit) : "", allowed);
}

Scalar convert_measure(const Key& key, const Node& node, std::string_view unit) {
  const std::string allowed =
      key.type == Type::tolerance ? item_expectation(key, unit) : measure_expectation(unit);
  if (node.is(Node::Kind::integer) || node.is(Node::Kind::number)) {
    if (!std::isfinite(node.number)) mismatch(node, "", allowed);
    require_range(key, node, node.number, unit.empty() ? "" : std::string(dimension(unit).shown), true);
    return {node.number, ""};
  }
  if (!node.is(Node::Kind::text)) mismatch(node, "", allowed);
  require_no_percent(key, node);
  try {
    if (key.type == Type::tolerance && node.text.ends_with('%')) {
      const Measure part = parse_measure(node.text, "1");
      require_range(key, node, part.value, "%", false);
      return {part.value, "%"};
    }
    const Measure measure = parse_measure(node.text, unit);
    // a number in quotes without a unit can only be meant for a pure number: factor_to_si has refused the
    // rest
    const bool bare = measure.unit.empty() && !unit.empty();
    require_range(key, node, measure.value, bare ? std::string(dimension(unit).shown) : measure.unit, bare);
    return {measure.value, ""};
  } catch (const UnitError& error) {
    const std::string meant =
        error.unknown_unit().empty() ? "" : did_you_mean(error.unknown_unit(), split(dimension(unit).usual));
    mismatch(node, fmt::format(", {}", error.what()), allowed + meant);
  }
}

/// Also "drive.csv", which stands for { wave = "file", file = "drive.csv" }; nothing where it is neither.
std::optional<Node> wave_table(const Node& node) {
  if (node.is(Node::Kind::table)) return node;
  if (!node.is(Node::Kind::text) || !node.text.ends_with(".csv")) return std::nullopt;
  Node table{.kind = Node::Kind::table, .source = node.source, .key_source = node.key_source};
  Node word = node;
  word.text = "file";
  table.add("wave", std::move(word));
  table.add("file", node);
  return table;
}

Scalar convert_item(const Key& key, const Node& node, std::string_view unit, const WaveReader& read_wave) {
  const std::string allowed = item_expectation(key, unit);
  const bool text = node.is(Node::Kind::text);
  switch (key.type) {
  case Type::wave:
    if (const auto table = read_wave ? wave_table(node) : std::nullopt) {
      for (const char* level : {"from", "to", "mean"})
        if (const Node* written = table->find(level)) require_no_percent(key, *written);
      Scalar driven{0, "", read_wave(*table)};
      if (const Node* to = table->find("to");
          to && driven.wave->constant()) // resolved.toml has it as a number
        require_range(key, *to, driven.wave->to, std::string(dimension(unit).shown), false);
      return driven;
    }
    if (!text && !node.is(Node::Kind::integer) && !node.is(Node::Kind::number)) mismatch(node, "", allowed);
    return convert_measure(key, node, unit);
  case Type::measure:
  case Type::tolerance:
    return convert_measure(key, node, unit);
  case Type::integer: {
    const bool whole = node.is(Node::Kind::number) && node.number == std::floor(node.number) &&
                       std::abs(node.number) < 1e15; // "1e3" is a whole number to an engineer
    if (!whole && !node.is(Node::Kind::integer)) mismatch(node, "", allowed);
    require_range(key, node, node.number, "", true);
    return {node.number, ""};
  }
  case Type::flag:
    if (!node.is(Node::Kind::flag)) mismatch(node, "", allowed);
    return {node.flag ? 1.0 : 0.0, ""};
  case Type::word:
    if (const auto found = std::ranges::find(key.choices, node.text, &Choice::word);
        text && found != key.choices.end())
      return {found->value.value_or(0), node.text};
    mismatch(node, "", allowed + (text ? did_you_mean(node.text, words_of(key)) : ""));
  case Type::name:
    if (!text || !is_name(node.text)) mismatch(node, "", allowed);
    return {0, node.text};
  case Type::text:
    break;
  }
  if (!text) mismatch(node, "", allowed);
  if (node.text.find_first_not_of(" \t\r\n") == std::string::npos)
    mismatch(node, "", "a text that is not empty");
  return {0, node.text};
}

std::string wave_text(const Key& key, const Waveform& wave) {
  const Section section = wave_section(key.unit);
  const std::string kind = section.selected_in(&wave);
  std::string text;
  for (const Key& part : section.keys)
    if (part.applies_to(kind))
      if (const auto value = part.binding.get(&wave))
        text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", part.name, toml_text(part, *value));
  return fmt::format("{{ {} }}", text);
}

} // namespace

std::string doubt_of_unit(const Key& key, const Node& node) {
  struct Doubt {
    std::string_view unit;
    double below, from; ///< magnitudes that are doubted, but for 0
    const char* meant;
  };
  static constexpr double never = std::numeric_limits<double>::infinity();
  static constexpr std::array doubts{Doubt{"V", 100, never, "kV"}, Doubt{"Pa", 100, never, "kPa"},
                                     Doubt{"kg", 0, 1, "g"}, Doubt{"kg/m^3", 100, never, "g/cm^3"}};
  if (node.is(Node::Kind::list))
    for (const Node& item : node.items)
      if (const std::string doubt = doubt_of_unit(key, item); !doubt.empty()) return doubt;
  if ((!node.is(Node::Kind::integer) && !node.is(Node::Kind::number)) || node.number == 0) return "";
  const auto found = std::ranges::find(doubts, key.unit, &Doubt::unit);
  const double size = std::abs(node.number);
  if (found == doubts.end() || !is_measure(key) || (size >= found->below && size < found->from)) return "";
  return fmt::format(
      "{0:g} without a unit is {0:g} {1}: write \"{0:g} {1}\", or \"{0:g} {2}\" if that is meant",
      node.number, found->unit, found->meant);
}

Value convert(const Key& key, const Node& node, std::string_view unit, const WaveReader& read_wave) {
  Value value;
  if (!key.is_list()) {
    value.push_back(convert_item(key, node, unit, read_wave));
  } else if (key.spreads && !node.is(Node::Kind::list)) {
    if (node.is(Node::Kind::table) || node.is(Node::Kind::flag)) mismatch(node, "", expectation(key, unit));
    value.assign(key.most, convert_item(key, node, unit, read_wave));
  } else {
    if (!node.is(Node::Kind::list)) mismatch(node, "", expectation(key, unit));
    if (node.items.size() < key.least || node.items.size() > key.most)
      mismatch(node, fmt::format(", a list of {}", node.items.size()), expectation(key, unit));
    for (const Node& item : node.items) value.push_back(convert_item(key, item, unit, read_wave));
  }
  for (Scalar& scalar : value) scalar.number += 0.0; // -0 is written, and read, as 0
  if (key.check)
    if (const std::string wrong = key.check(value); !wrong.empty()) throw Mismatch{wrong, node.source};
  return value;
}

std::string toml_text(const Key& key, const Value& value) {
  const auto item = [&](const Scalar& scalar) -> std::string {
    switch (key.type) {
    case Type::wave:
      if (scalar.wave) return wave_text(key, *scalar.wave);
      [[fallthrough]];
    case Type::measure:
      if (key.unit.empty() || key.unit == "1") return fmt::format("{}", scalar.number);
      return toml_string(format_measure(scalar.number, key.unit));
    case Type::tolerance:
    case Type::integer:
      return fmt::format("{}", scalar.number);
    case Type::flag:
      return scalar.number != 0 ? "true" : "false";
    case Type::word:
      return toml_string(key.word_of(scalar));
    case Type::name:
    case Type::text:
      break;
    }
    return toml_string(scalar.text);
  };
  if (!key.is_list()) return item(value.at(0));
  std::string items;
  for (const Scalar& scalar : value) items += (items.empty() ? "" : ", ") + item(scalar);
  return fmt::format("[{}]", items);
}

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= longest_name && std::ranges::all_of(text, [](unsigned char letter) {
    return letter <= 127 && (std::isalnum(letter) || letter == '_' || letter == '-');
  });
}

std::string expectation(const Key& key, std::string_view unit) {
  const std::string item = item_expectation(key, unit);
  if (!key.is_list()) return item;
  const std::string count =
      key.least == key.most ? fmt::format("{}", key.most) : fmt::format("{} to {}", key.least, key.most);
  return fmt::format("{}a list of {}, each {}", key.spreads ? item + " or " : "", count, item);
}

void require_range(const Key& key, const Waveform& wave, const Node& table) {
  const std::string shown(dimension(key.unit).shown);
  for (const double extreme : wave.extremes())
    if (!is_inside(key.range, extreme))
      mismatch(table,
               fmt::format(", which goes to {}", in_unit(extreme, shown == "1" ? "" : shown, key.unit)),
               range_text(key, shown));
}

std::string range_text(const Key& key, const std::string& shown) {
  const Range& range = key.range;
  const auto number = [&](double value) {
    return is_measure(key) && !key.unit.empty() ? in_unit(value, shown == "1" ? "" : shown, key.unit)
                                                : fmt::format("{:.6g}", value);
  };
  std::string text;
  if (std::isfinite(range.low)) text = (range.low_open ? "above " : "at least ") + number(range.low);
  if (std::isfinite(range.high))
    text += (text.empty() ? "" : " and ") + std::string(range.high_open ? "below " : "at most ") +
            number(range.high);
  return text;
}

} // namespace dielast::cases
