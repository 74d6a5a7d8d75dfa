// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/tree.hpp"

#include "cases/text/input_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

namespace dielast::cases {
namespace {

Source source_of(const toml::source_region& region, const FileName& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Node node_of(const toml::node& from, const FileName& file) {
  Node node;
  node.source = source_of(from.source(), file);
  if (const auto* table = from.as_table()) {
    // toml++ sorts by name; messages and outputs follow the file
    std::vector<std::pair<const toml::key*, const toml::node*>> entries;
    for (auto&& [key, value] : *table) entries.emplace_back(&key, &value);
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
      const auto &p = a.first->source().begin, &q = b.first->source().begin;
      return std::tie(p.line, p.column) < std::tie(q.line, q.column);
    });
    for (const auto& [key, value] : entries)
      node.add(std::string(key->str()), node_of(*value, file)).key_source = source_of(key->source(), file);
  } else if (const auto* array = from.as_array()) {
    node.kind = Node::Kind::list;
    for (const toml::node& item : *array) node.items.push_back(node_of(item, file));
  } else if (const auto* flag = from.as_boolean()) {
    node.kind = Node::Kind::flag;
    node.flag = flag->get();
  } else if (const auto* integer = from.as_integer()) {
    node.kind = Node::Kind::integer;
    node.integer = integer->get();
    node.number = static_cast<double>(node.integer);
  } else if (const auto* number = from.as_floating_point()) {
    node.kind = Node::Kind::number;
    node.number = number->get();
  } else if (const auto* text = from.as_string()) {
    node.kind = Node::Kind::text;
    node.text = text->get();
  } else {
    node.kind = Node::Kind::date;
    std::ostringstream stream;
    from.visit([&](const auto& value) {
      if constexpr (toml::is_chronological<decltype(value)>) stream << value.get();
    });
    node.text = stream.str();
  }
  return node;
}

/// Position behind the string that begins at `i` with a quote; a string of one line ends with its line.
std::size_t behind_string(std::string_view toml, std::size_t i) {
  const char quote = toml[i];
  const std::string_view all(toml.data() + i, std::min<std::size_t>(3, toml.size() - i));
  const bool lines = all.size() == 3 && all[1] == quote && all[2] == quote;
  const std::string_view end = lines ? all : all.substr(0, 1);
  for (i += end.size(); i < toml.size(); ++i) {
    if (toml.substr(i).starts_with(end)) return i + end.size();
    if (!lines && toml[i] == '\n') return i;
    if (quote == '"' && toml[i] == '\\') ++i;
  }
  return toml.size();
}

/// A key with many dots makes as many tables, one in the other, and everything that goes down into tables
/// would overflow the stack. The parser itself limits the depth of values only.
void require_shallow(std::string_view toml, const FileName& file) {
  constexpr int most_dots = 20;
  int dots = 0, line = 1;
  for (std::size_t i = 0; i < toml.size(); ++i) {
    switch (toml[i]) {
    case '#':
      i = std::min(toml.find('\n', i), toml.size()) - 1;
      break;
    case '"':
    case '\'': {
      const std::size_t end = behind_string(toml, i);
      line += static_cast<int>(std::count(toml.begin() + i, toml.begin() + end, '\n'));
      i = end - 1;
      break;
    }
    case '.':
      if (++dots > most_dots)
        throw CaseError({{{file, line, 1}, "", fmt::format("a key has more than {} dots", most_dots)}});
      break;
    case '\n':
      ++line;
      [[fallthrough]];
    case '=':
    case ',':
    case '[':
    case '{':
      dots = 0;
      break;
    default:
      break;
    }
  }
}

} // namespace

void Node::relocate(const Source& new_source) {
  source = key_source = new_source;
  for (Node& item : items) item.relocate(new_source);
}

const Node* Node::find(std::string_view key) const {
  const auto found = std::find(keys.begin(), keys.end(), key);
  return found == keys.end() ? nullptr : &items[static_cast<std::size_t>(found - keys.begin())];
}

Node* Node::find(std::string_view key) { return const_cast<Node*>(std::as_const(*this).find(key)); }

std::string text_at(const Node& table, std::string_view key) {
  const Node* node = table.find(key);
  return node && node->is(Node::Kind::text) ? node->text : "";
}

Node& Node::add(std::string key, Node value) {
  keys.push_back(std::move(key));
  return items.emplace_back(std::move(value));
}

void Node::remove(std::string_view key) {
  const auto found = std::find(keys.begin(), keys.end(), key);
  if (found == keys.end()) return;
  items.erase(items.begin() + (found - keys.begin()));
  keys.erase(found);
}

Node parse_tree(std::string_view toml, const FileName& file) {
  try {
    require_shallow(toml, file);
    return node_of(toml::parse(toml, std::string_view(file.text())), file);
  } catch (const toml::parse_error& error) {
    std::string message(error.description());
    if (message.find("expected a comment or whitespace") != std::string::npos)
      message += "; a quantity with a unit is a text: \"1 mm\"";
    if (message.find("invalid utf-8") != std::string::npos) message += "; save the file as UTF-8";
    if (message.find("could not determine value type") != std::string::npos)
      message += "; a text stands in quotes: \"text\"";
    if (message.find("unescaped control characters") != std::string::npos)
      message += "; does a text end without its quotation mark?";
    if (message.find("end-of-file") != std::string::npos) message += "; is the file complete?";
    throw CaseError({{source_of(error.source(), file), "", message}});
  }
}

Node read_tree(const std::filesystem::path& path) {
  constexpr std::size_t largest = 4u << 20;
  return parse_tree(read_input(path, "a case file", largest), path.string());
}

Node parse_value(std::string_view text, const Source& source) {
  Node value;
  const auto parses = [&](const std::string& toml) {
    try {
      const Node tree = parse_tree(toml, source.file);
      if (tree.items.size() != 1) return false;
      value = tree.items[0];
      return true;
    } catch (const CaseError&) {
      return false;
    }
  };
  // A literal string takes every character but control characters and broken UTF-8.
  if (!parses(fmt::format("value = {}\n", text)) && !parses(fmt::format("value = '''{}'''", text)))
    throw CaseError({{source, "", "the value is not readable text (UTF-8 without control characters)"}});
  if (value.is(Node::Kind::date)) value.kind = Node::Kind::text;
  value.relocate(source);
  return value;
}

std::string toml_string(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string text_of(const Node& node) {
  switch (node.kind) {
  case Node::Kind::flag:
    return node.flag ? "true" : "false";
  case Node::Kind::integer:
    return fmt::format("{}", node.integer);
  case Node::Kind::number:
    return fmt::format("{}", node.number);
  case Node::Kind::text:
    return toml_string(node.text);
  case Node::Kind::date:
    return node.text;
  case Node::Kind::list:
  case Node::Kind::table:
    break;
  }
  const bool table = node.is(Node::Kind::table);
  std::string inside;
  for (std::size_t i = 0; i < node.items.size(); ++i)
    inside += (i == 0 ? "" : ", ") + (table ? node.keys[i] + " = " : "") + text_of(node.items[i]);
  return table ? fmt::format("{{ {} }}", inside) : fmt::format("[{}]", inside);
}

} // namespace dielast::cases
