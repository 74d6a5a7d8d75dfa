// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/idle_keys.hpp"

#include "cases/language/convert.hpp"
#include "cases/readers/resolved.hpp"

#include <fmt/format.h>

namespace dielast::cases {
namespace {

class IdleKeys {
 public:
  explicit IdleKeys(const Case& one) : case_(one) {}

  void check(const Section& section, const Node& table, const void* object, const std::string& path) {
    if (!table.is(Node::Kind::table)) return; // a named thing
    if (is_idle(section.acts, object) && table.source.is_written()) {
      warn(table.source, path, section.acts);
      return;
    }
    const std::string selected = section.selector == "geometry"
                                     ? geometry_name(*static_cast<const Part*>(object))
                                     : section.selected_in(object);
    for (const Key& key : section.keys) {
      const Node* node = key.applies_to(selected) ? table.find(key.name) : nullptr;
      if (node && node->source.is_written() && is_idle(key.acts, object) && // a wave may begin with 0
          (node->is(Node::Kind::table) || !is_default(key, object)))
        warn(node->source, joined(path, key.name), key.acts);
    }
    for (const Section& inner : section.sections)
      if (const Node* node = table.find(inner.name); node && inner.presence != Section::Presence::separate)
        check_entries(inner, *node, object, joined(path, inner.name));
  }

  std::vector<Diagnostic> take() { return std::move(found_); }

 private:
  bool is_idle(const Condition& acts, const void* object) const {
    return acts.met && !acts.met(case_, object);
  }
  /// Or a zero of a measure that has no default.
  static bool is_default(const Key& key, const void* object) {
    const auto value = key.binding.get(object);
    if (!value) return false;
    if (!key.fallback)
      return !key.unit.empty() &&
             std::ranges::all_of(*value, [](const Scalar& one) { return one.number == 0; });
    Value fallback = convert(key, parse_value(*key.fallback, {}), key.unit, {});
    if (key.spreads && fallback.size() == 1) fallback.assign(value->size(), fallback[0]);
    return std::ranges::equal(*value, fallback, {}, &Scalar::number, &Scalar::number);
  }

  void check_entries(const Section& section, const Node& node, const void* parent, const std::string& path) {
    const std::vector<Access::Entry> entries = section.access.entries(parent);
    if (section.shape == Section::Shape::list) {
      // What a template has brought stands in front, and is no entry where it is not an object of the case.
      const std::size_t count = std::min(entries.size(), node.items.size());
      const std::size_t brought = node.items.size() - count;
      for (std::size_t i = 0; i < count; ++i)
        check(section, node.items[brought + i], entries[entries.size() - count + i].object,
              fmt::format("{}[{}]", path, i + 1));
    } else if (section.shape == Section::Shape::named) {
      for (const Access::Entry& entry : entries)
        if (const Node* own = node.find(entry.name))
          check(section, *own, entry.object, joined(path, entry.name));
    } else if (section.shape == Section::Shape::by_electrode) {
      for (const Access::Entry& entry : entries) {
        const Node* own = node.find(entry.name);
        const bool named = own && own->is(Node::Kind::table);
        check(section, named ? *own : node, entry.object, named ? joined(path, entry.name) : path);
      }
    } else if (!entries.empty()) {
      check(section, node, entries.front().object, path);
    }
  }

  void warn(const Source& source, std::string key, const Condition& acts) {
    found_.push_back(
        {source, std::move(key), "has no effect here: it acts only with " + acts.needs, Severity::warning});
  }

  const Case& case_;
  std::vector<Diagnostic> found_;
};

} // namespace

std::vector<Diagnostic> idle_keys(const Node& tree, const Case& one) {
  IdleKeys walk(one);
  walk.check(case_schema(), tree, &one, "");
  return walk.take();
}

} // namespace dielast::cases
