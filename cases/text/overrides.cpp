// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/overrides.hpp"

#include <boost/algorithm/string/trim.hpp>
#include <fmt/format.h>

#include <charconv>
#include <utility>

namespace dielast::cases {
namespace {

/// One part of a path: a name, or a number in brackets.
struct Part {
  std::string name;
  std::size_t number = 0; ///< from 1; 0: by name
};

[[noreturn]] void fail(const Source& source, std::string_view key, std::string message) {
  throw CaseError({{source, std::string(key), std::move(message)}});
}

std::vector<Part> parts_of(std::string_view key, const Source& source) {
  std::vector<Part> parts;
  std::size_t i = 0;
  const auto until = [&](std::string_view stops) {
    const std::size_t begin = i;
    i = std::min(key.find_first_of(stops, i), key.size());
    return key.substr(begin, i - begin);
  };
  while (i < key.size()) {
    if (key[i] == '.') {
      ++i;
      if (parts.empty() || i == key.size() || key[i] == '.' || key[i] == '[')
        fail(source, key, "between dots, and in front of the first, stands the name of a table or key");
    } else if (key[i] == '"') {
      ++i;
      parts.push_back({std::string(until("\""))});
      if (i++ == key.size()) fail(source, key, "a quote is not closed");
    } else if (key[i] == '[') {
      ++i;
      const std::string_view digits = until("]");
      std::size_t number = 0;
      const char* end = digits.data() + digits.size();
      if (std::from_chars(digits.data(), end, number).ptr != end || number == 0 || i++ == key.size())
        fail(source, key, "in brackets stands the number of an item, from 1");
      parts.push_back({"", number});
    } else {
      parts.push_back({boost::trim_copy(std::string(until(".[\"")))}); // blanks are none of it, as in TOML
    }
  }
  constexpr std::size_t most_parts = 20; // what goes down into the tables recurses
  if (parts.size() > most_parts) fail(source, "", fmt::format("a key has more than {} parts", most_parts));
  if (parts.empty()) fail(source, key, "write --set key=value, such as --set drive.voltage=\"5 kV\"");
  return parts;
}

/// The name by which an item of a list goes.
std::string item_name(const Node& item) {
  for (const char* key : {"name", "kind", "quantity", "place"})
    if (const Node* node = item.find(key); node && node->is(Node::Kind::text)) return node->text;
  return "";
}

Node& list_item(Node& list, const Part& part, std::string_view key, const Source& source) {
  if (part.number > 0 && part.number <= list.items.size()) return list.items[part.number - 1];
  std::vector<std::string> names;
  Node* found = nullptr;
  for (Node& item : list.items) {
    const std::string name = item_name(item);
    if (part.number == 0 && name == part.name && std::exchange(found, &item))
      fail(source, key,
           fmt::format("several items go by \"{}\"; give the number of one, [1] to [{}]", name,
                       list.items.size()));
    if (!name.empty()) names.push_back(name);
  }
  if (found) return *found;
  if (part.number > 0)
    fail(source, key, fmt::format("there is no item {}, only {}", part.number, list.items.size()));
  if (names.empty() && !list.items.empty() && list.items.front().is(Node::Kind::table))
    fail(source, key,
         fmt::format("there is no \"{}\": items of this list go by their numbers, [1] to [{}]", part.name,
                     list.items.size()));
  if (names.empty())
    fail(source, key, fmt::format("there is no \"{}\" in a list of plain values", part.name));
  fail(source, key,
       fmt::format("there is no \"{}\", allowed {}{}", part.name, listed(names),
                   did_you_mean(part.name, names)));
}

/// The node of the part; made when it does not exist.
Node& descend(Node& node, const Part& part, std::string_view key, const Source& source) {
  if (node.is(Node::Kind::list)) return list_item(node, part, key, source);
  if (node.is(Node::Kind::text)) { // a named thing becomes a table that starts from it
    Node table;
    table.source = node.source;
    table.key_source = node.key_source;
    table.add("name", node);
    node = std::move(table);
  }
  if (!node.is(Node::Kind::table) || part.number > 0) fail(source, key, "there is no such key");
  if (Node* entry = node.find(part.name)) return *entry;
  Node made;
  made.source = made.key_source = source;
  return node.add(part.name, std::move(made));
}

/// Whether an item that a device brings is the one that overrides have changed.
bool is_same_item(const Node& fresh, const Node& changed) {
  for (const char* key : {"name", "kind", "place"}) {
    const Node* node = changed.find(key);
    if (!(node && is_changed(*node)) && text_at(fresh, key) != text_at(changed, key)) return false;
  }
  return true;
}

void remove(Node& tree, const std::vector<Part>& parts, std::string_view key, const Source& source) {
  Node* table = &tree;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i)
    if (table)
      table = table->is(Node::Kind::list) ? &list_item(*table, parts[i], key, source)
                                          : table->find(parts[i].name);
  const auto require_written = [&](const Node& node) {
    if (!node.source.is_written())
      fail(source, key,
           "the device brings it, whatever is removed: write what there shall be in its place in the file");
  };
  if (table && table->is(Node::Kind::list)) {
    const Node& item = list_item(*table, parts.back(), key, source);
    require_written(item);
    table->items.erase(table->items.begin() + (&item - table->items.data()));
    return;
  }
  const std::string& name = parts.back().name;
  if (!table || !table->find(name)) fail(source, key, "there is no such key to remove");
  require_written(*table->find(name));
  table->remove(name);
}

} // namespace

void apply_override(Node& tree, std::string_view key, std::string_view value, const Source& source) {
  const std::vector<Part> parts = parts_of(key, source);
  if (value.find_first_not_of(' ') == std::string_view::npos) return remove(tree, parts, key, source);
  Node* node = &tree;
  for (const Part& part : parts) node = &descend(*node, part, key, source);
  *node = parse_value(value, source);
}

bool is_changed(const Node& node) {
  return node.source.is_written() || std::ranges::any_of(node.items, is_changed);
}

Node take_brought(Node& tree) {
  Node brought;
  for (std::size_t i = tree.items.size(); i-- > 0;) {
    const Node& node = tree.items[i];
    if (node.source.is_written() || node.is(Node::Kind::table)) continue;
    brought.add(tree.keys[i], node);
    tree.remove(brought.keys.back());
  }
  return brought;
}

Node with_changes(Node fresh, const Node& before) {
  std::vector<bool> taken(fresh.items.size());
  const bool alike = fresh.items.size() == before.items.size();
  for (std::size_t number = 0; number < before.items.size(); ++number) {
    const Node& changed = before.items[number];
    if (!is_changed(changed)) continue;
    // By its number where the device brings as many as before: what is changed may be what it goes by.
    std::size_t i = alike && !taken[number] && is_same_item(fresh.items[number], changed) ? number : 0;
    while (i < taken.size() && (taken[i] || !is_same_item(fresh.items[i], changed))) ++i;
    if (i == taken.size()) {
      fresh.items.push_back(changed);
      continue;
    }
    taken[i] = true;
    for (std::size_t k = 0; k < changed.items.size(); ++k) {
      if (!is_changed(changed.items[k])) continue;
      fresh.items[i].remove(changed.keys[k]);
      fresh.items[i].add(changed.keys[k], changed.items[k]);
    }
  }
  return fresh;
}

Node value_at(Node tree, std::string_view key) {
  const Source source{std::string(key)};
  Node* node = &tree;
  for (const Part& part : parts_of(key, source)) node = &descend(*node, part, key, source);
  return *node;
}

std::string numbered_key(Node tree, const std::string& key) try {
  const Source source{key};
  std::string numbered;
  Node* node = &tree;
  for (const Part& part : parts_of(key, source)) {
    Node& next = descend(*node, part, key, source);
    if (node->is(Node::Kind::list))
      numbered += fmt::format("[{}]", &next - node->items.data() + 1);
    else
      numbered += (numbered.empty() ? "" : ".") + part.name;
    node = &next;
  }
  return numbered;
} catch (const CaseError&) {
  return key;
}

bool is_within(std::string_view key, std::string_view other) {
  return key.starts_with(other) &&
         (key.size() == other.size() || key[other.size()] == '.' || key[other.size()] == '[');
}

void apply_override(Node& tree, std::string_view assignment) {
  const Source source{fmt::format("--set {}", assignment)};
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) fail(source, "", "no \"=\"; write --set key=value");
  std::string_view key = assignment.substr(0, equals);
  while (key.ends_with(' ')) key.remove_suffix(1);
  apply_override(tree, key, assignment.substr(equals + 1), source);
}

} // namespace dielast::cases
