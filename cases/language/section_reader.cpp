// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/section_reader.hpp"

#include "cases/text/wave_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace dielast::cases {
namespace {

/// The selector's value cannot be told, so neither which keys exist.
const std::string undecided = "?";

/// The value of the section's selector; `started` says that a named thing has filled the object.
std::string selected_by(const Section& section, const Node& table, const void* object, bool started) {
  const Key& key = *section.find_key(section.selector, "");
  const auto known = [&](const std::string& word) {
    return std::any_of(key.choices.begin(), key.choices.end(),
                       [&](const Choice& c) { return c.word == word; });
  };
  if (const Node* node = table.find(key.name))
    return node->is(Node::Kind::text) && known(node->text) ? node->text : undecided;
  if (started) return section.selected_in(object);
  return key.fallback.value_or(undecided);
}

/// The sections that have the key, in brackets.
void add_homes(const std::string& key, const Section& section, const std::string& path,
               std::vector<std::string>& homes) {
  for (const Section& inner : section.sections) {
    const std::string inner_path = joined(path, inner.name);
    if (inner.find_key(key, "") || inner.find_section(key)) homes.push_back(inner.heading(inner_path));
    if (inner.shape != Section::Shape::named)
      add_homes(key, inner, inner_path, homes); // they are at the top, too
  }
}

/// Where else the key belongs: "; it belongs in [film]", or "" when no section has it.
std::string home_of(const std::string& key) {
  const Section& root = case_schema();
  if (root.find_key(key, "")) return "; it belongs at the top of the file, before the first [section]";
  if (root.find_section(key)) return fmt::format("; [{}] is a section of its own", key);
  std::vector<std::string> homes;
  add_homes(key, root, "", homes);
  std::string text;
  for (const std::string& home : homes) text += (text.empty() ? "; it belongs in " : " or ") + home;
  return text;
}

} // namespace

/// The table that stands in another file under the section's path, or at the file's top. Throws FileError and
/// CaseError.
Node SectionReader::table_of_file(const Node& name, const std::string& path) const {
  const auto file = surroundings_.folder / name.text;
  if (std::error_code failure; !std::filesystem::is_regular_file(file, failure))
    throw CaseError({{name.source, path,
                      fmt::format("found {}: no such file; the path starts at the case file's folder",
                                  toml_string(name.text))}});
  const Node tree = read_tree(file);
  const std::size_t last = path.rfind('.'),
                    outer = last == std::string::npos ? last : path.rfind('.', last - 1);
  const Node* around =
      last == std::string::npos ? &tree : tree.find(path.substr(outer + 1, last - outer - 1));
  if (!around) around = tree.find("film"); // of one of its layers
  const Node* inner = around && around->is(Node::Kind::table) ? around->find(path.substr(last + 1)) : nullptr;
  return inner && inner->is(Node::Kind::table) ? *inner : tree;
}

/// A named thing of a file, "material.toml", as the table in it, whose keys give way to those written beside
/// the name.
Node SectionReader::with_file(const Section& section, const Node& node, const std::string& path) {
  const Node* name = node.is(Node::Kind::text) ? &node : node.find("name");
  if (!section.names || !name || !name->is(Node::Kind::text) || !name->text.ends_with(".toml")) return node;
  try {
    Node table = table_of_file(*name, path);
    for (std::size_t i = 0; node.is(Node::Kind::table) && i < node.items.size(); ++i) {
      if (node.keys[i] == "name") continue;
      table.remove(node.keys[i]);
      for (const Key& key : section.keys) { // the other way to give it
        if (key.instead_of == node.keys[i]) table.remove(key.name);
        if (key.name == node.keys[i]) table.remove(key.instead_of);
      }
      table.add(node.keys[i], node.items[i]);
    }
    table.source = node.source;
    return table;
  } catch (const CaseError& error) {
    for (const Diagnostic& wrong : error.diagnostics()) diagnostics_.push_back(wrong);
  } catch (const FileError& error) {
    report(name->source, path, error.what());
  }
  ++unread_;
  return Node{};
}

void SectionReader::read_table(const Section& section, const Node& node, void* object,
                               const std::string& path) {
  const std::size_t errors_before = diagnostics_.size() + unread_;
  const std::string outer_geometry = geometry_;
  if (section.has_geometries() && surroundings_.geometry_of) geometry_ = surroundings_.geometry_of(node);
  const Node* name = section.start ? node.find("name") : nullptr;
  const bool started = name && name->is(Node::Kind::text) && section.start(object, name->text);
  const std::string brought = started ? section.selected_in(object) : "";
  std::string selected;
  if (section.selector == "geometry")
    selected = geometry_.empty() ? undecided : geometry_;
  else if (!section.selector.empty())
    selected = selected_by(section, node, object, started);

  for (const Key& key : section.keys)
    if (key.applies_to(selected))
      read_key(section, key, selected, node, object, path,
               started && (key.only_for.empty() || brought == selected));
  for (const Section& inner : section.sections)
    if (inner.presence != Section::Presence::separate) read_section(inner, node, object, path);
  report_unknown(section, node, selected, path);
  geometry_ = outer_geometry;

  if (section.check && diagnostics_.size() + unread_ == errors_before)
    if (const auto conflict = section.check(object)) {
      const Node* blamed = node.find(conflict->key);
      const Key* key = blamed ? nullptr : section.find_key(conflict->key, section.selected_in(object));
      report(blamed ? blamed->source : node.source, joined(path, conflict->key),
             blamed                 ? fmt::format("found {}: {}", text_of(*blamed), conflict->message)
             : key && key->fallback ? fmt::format("{} by default: {}", *key->fallback, conflict->message)
                                    : conflict->message);
    }
}

void SectionReader::read_key(const Section& section, const Key& key, const std::string& selected,
                             const Node& table, void* object, const std::string& path, bool kept) {
  const std::string full = joined(path, key.name);
  const Node* node = table.find(key.name);
  const auto other = std::find_if(section.keys.begin(), section.keys.end(), [&](const Key& one) {
    return one.instead_of == key.name && one.applies_to(selected);
  });
  const bool replaced = other != section.keys.end() && table.find(other->name);
  if (node && replaced) {
    report(node->key_source, full, fmt::format("given twice: write either {} or {}", key.name, other->name));
  } else if (node) {
    set(key, *node, table, object, full);
  } else if (replaced || kept) {
    return;
  } else if (key.fallback) {
    set(key, parse_value(*key.fallback, table.source), table, object, full);
  } else if (!key.fallback_key.empty()) {
    const Key* same = section.find_key(key.fallback_key, "");
    if (const Node* other_value = table.find(key.fallback_key))
      set(key, *other_value, table, object, full);
    else if (same && same->fallback)
      set(key, parse_value(*same->fallback, table.source), table, object, full);
  } else if (key.required) {
    report(table.source, full,
           fmt::format("missing; give {}{}", expectation(key, unit_of(key, table).value_or("")),
                       other == section.keys.end() ? "" : fmt::format(", or {}", other->name)));
  }
}

std::optional<std::string> SectionReader::unit_of(const Key& key, const Node& table) const {
  const bool of_quantity = key.type == Type::tolerance || (key.type == Type::measure && key.unit.empty());
  if (!of_quantity) return key.unit;
  const Node* quantity = table.find("quantity");
  return quantity ? surroundings_.unit_of_quantity(quantity->text) : std::nullopt;
}

void SectionReader::set(const Key& key, const Node& node, const Node& table, void* object,
                        const std::string& path) {
  const auto unit = unit_of(key, table);
  if (!unit) { // the check names no quantity, which is reported by itself
    ++unread_;
    return;
  }
  try {
    const Value value =
        convert(key, node, *unit, [&](const Node& inner) { return read_wave(key, inner, path); });
    key.binding.set(object, value);
    keys_[path] = node.source;
    if (const std::string doubt = doubt_of_unit(key, node); !doubt.empty() && node.source.is_written())
      warn(node.source, path, doubt);
    const std::string named = table.find(key.name) ? path : path + " (default)";
    for (const Scalar& scalar : value)
      if (key.refers != Reference::none) mentions_[key.refers].push_back({scalar.text, named, node.source});
  } catch (const Mismatch& wrong) {
    report(wrong.source, path, wrong.message);
  }
}

Waveform SectionReader::read_wave(const Key& key, const Node& table, const std::string& path) {
  Waveform wave;
  const std::size_t errors_before = diagnostics_.size();
  read_table(wave_section(key.unit), table, &wave, path);
  if (wave.kind == Waveform::Kind::file && diagnostics_.size() == errors_before)
    load_samples(wave, key.unit, surroundings_.folder, table, path, diagnostics_);
  if (!wave.constant() && diagnostics_.size() == errors_before) require_range(key, wave, table);
  if (!wave.constant()) waves_.push_back({wave, path, table.source});
  return wave;
}

void SectionReader::read_section(const Section& section, const Node& outer, void* parent,
                                 const std::string& path) {
  using Presence = Section::Presence;
  const std::string full = joined(path, section.name);
  const Node* node = outer.find(section.name);
  Node substitute;
  substitute.source = outer.source;
  if (!node) {
    if (section.needless && section.needless(outer)) return;
    if (section.presence == Presence::geometry || section.presence == Presence::list ||
        section.presence == Presence::optional)
      return;
    if (section.fallback) {
      substitute.kind = Node::Kind::text;
      substitute.text = *section.fallback;
    } else if (section.presence == Presence::required) {
      const std::string named = section.names ? fmt::format(", or {} = \"...\" with one of {}", section.name,
                                                            listed(section.names()))
                                              : "";
      report(outer.source, full, fmt::format("missing; add the section [{}]{}", full, named));
      return;
    }
    node = &substitute;
  }
  const std::size_t unread_before = unread_;
  const Node from_file = with_file(section, *node, full);
  if (unread_ > unread_before) return;
  node = &from_file;
  if (node->is(Node::Kind::text) && section.names) {
    const auto names = section.names();
    if (std::find(names.begin(), names.end(), node->text) == names.end()) {
      report(node->source, full,
             fmt::format("found {}, allowed a table, a file \"....toml\" or one of {}{}",
                         toml_string(node->text), listed(names), did_you_mean(node->text, names)));
      return;
    }
    Node table;
    table.source = node->source;
    table.add("name", *node);
    return read_table(section, table, section.access.enter(parent, ""), full);
  }
  if (section.shape == Section::Shape::list) return read_list(section, *node, parent, full);
  if (!node->is(Node::Kind::table)) {
    const bool doubled = node->is(Node::Kind::list);
    report(node->source, full,
           doubled ? fmt::format("there is only one: write [{}] with single brackets", full)
                   : fmt::format("found {}, allowed a section [{}]", text_of(*node), full));
  } else if (section.shape == Section::Shape::by_electrode) {
    read_by_electrode(section, *node, parent, full);
  } else if (section.shape == Section::Shape::named) {
    read_named(section, *node, parent, full);
  } else {
    read_table(section, *node, section.access.enter(parent, ""), full);
  }
}

void SectionReader::read_list(const Section& section, const Node& node, void* parent,
                              const std::string& path) {
  if (!node.is(Node::Kind::list)) {
    report(node.source, path, fmt::format("there can be several: write [[{}]] with double brackets", path));
    return;
  }
  if (node.items.empty())
    report(node.source, path, fmt::format("is empty; add a [[{}]] or leave it out", path));
  if (section.access.clear) section.access.clear(parent);
  std::map<std::string, std::set<std::string>> taken;
  int written = 0; // a user counts the items of the file, not those that the template brings
  for (const Node& item : node.items) {
    const std::string full = item.source.line > 0 ? fmt::format("{}[{}]", path, ++written) : path;
    if (!item.is(Node::Kind::table)) {
      report(item.source, full, fmt::format("found {}, allowed a section [[{}]]", text_of(item), path));
      continue;
    }
    void* object = section.access.enter(parent, "");
    read_table(section, item, object, full);
    for (const Key& key : section.keys) {
      if (!key.unique) continue;
      const auto value = key.binding.get(object);
      if (!value || taken[key.name].insert(value->at(0).text).second) continue;
      const Node* named = item.find(key.name);
      report(named ? named->source : item.source, joined(full, key.name),
             fmt::format("\"{}\" is taken; give each [[{}]] a {} of its own", value->at(0).text, path,
                         key.name));
    }
  }
}

void SectionReader::read_named(const Section& section, const Node& node, void* parent,
                               const std::string& path) {
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string& name = node.keys[i];
    const std::string full = joined(path, name);
    if (!is_name(name))
      report(node.items[i].key_source, full,
             fmt::format("allowed a name of at most {} letters, digits, \"_\" and \"-\"", longest_name));
    else if (!node.items[i].is(Node::Kind::table))
      report(node.items[i].source, full,
             fmt::format("found {}, allowed a section [{}.NAME]", text_of(node.items[i]), path));
    else
      read_table(section, node.items[i], section.access.enter(parent, name), full);
  }
}

void SectionReader::read_by_electrode(const Section& section, const Node& node, void* parent,
                                      const std::string& path) {
  const std::vector<std::string> electrodes = surroundings_.electrodes();
  const auto is_electrode = [&](const std::string& name) {
    return std::find(electrodes.begin(), electrodes.end(), name) != electrodes.end();
  };
  bool direct = false;
  Node rest = node; // what is not a section of an electrode
  rest.keys.clear(), rest.items.clear();
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const std::string& name = node.keys[i];
    if (section.find_key(name, "") || !node.items[i].is(Node::Kind::table)) {
      direct = true;
      rest.add(name, node.items[i]);
    } else if (!is_electrode(name)) {
      report(
          node.items[i].source, joined(path, name),
          fmt::format("no such electrode, allowed {}{}", listed(electrodes), did_you_mean(name, electrodes)));
    }
  }
  if (direct && electrodes.size() > 1) {
    report(node.source, path,
           fmt::format("there are several electrodes: drive each by its name, as in [{}.{}]", path,
                       electrodes[0]));
    return;
  }
  for (const std::string& electrode : electrodes) {
    const Node* own = node.find(electrode);
    const bool named = own && own->is(Node::Kind::table);
    if (!named && !node.items.empty() && !direct && section.presence == Section::Presence::optional)
      continue; // others have one
    if (direct && named)
      report(own->source, joined(path, electrode), fmt::format("given twice: here and in [{}]", path));
    read_table(section, named ? *own : rest, section.access.enter(parent, electrode),
               named ? joined(path, electrode) : path);
  }
}

void SectionReader::report_unknown(const Section& section, const Node& table, const std::string& selected,
                                   const std::string& path) {
  for (std::size_t i = 0; i < table.items.size(); ++i) {
    const std::string& name = table.keys[i];
    const Node& node = table.items[i];
    const std::string full = joined(path, name);
    if (section.find_section(name)) continue;
    if (const Key* key = section.find_key(name, selected)) {
      if (key->applies_to(selected) || selected == undecided) continue;
      const std::string of = section.selector.empty() ? "kind of file" : section.selector;
      std::vector<std::string> owners;
      for (const Key& same : section.keys)
        if (same.name == name) owners.insert(owners.end(), same.only_for.begin(), same.only_for.end());
      report(node.key_source, full,
             fmt::format("only for {} {}{}", of, listed(owners),
                         selected.empty() ? "" : fmt::format(", here it is \"{}\"", selected)));
      continue;
    }
    std::string advice;
    if (diagnostics_.size() < most_diagnostics) { // a walk through the table, for errors that are told
      const auto names = section.names_for(selected);
      advice = called_here(name, names);
      if (advice.empty()) advice = home_of(name);
      if (advice.empty()) advice = did_you_mean(name, names);
      constexpr std::size_t few = 12; // so that they are told although the key is another section's
      if (advice.empty() || (names.size() <= few && advice.find("belongs in") != std::string::npos))
        advice = ", allowed " + listed(names) + advice;
    }
    report(node.key_source, full, "unknown key" + advice);
  }
}

} // namespace dielast::cases
