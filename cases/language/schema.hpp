// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/case/study_spec.hpp"
#include "cases/text/tree.hpp"

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace dielast::cases {

/// One element of a converted value: SI number (flag: 0 or 1; word: the value that it stands for), text or
/// wave.
struct Scalar {
  double number = 0;
  std::string text;
  std::optional<Waveform> wave{}; ///< of a quantity that a wave drives
};
using Value = std::vector<Scalar>;

/// How a key reaches the member it stands for. `get` gives nothing when there is nothing to write.
struct Binding {
  std::function<void(void* object, const Value&)> set;
  std::function<std::optional<Value>(const void* object)> get;
};

enum class Type {
  measure,   ///< quantity with a unit; unit "" is the unit of the quantity that a check names
  wave,      ///< a measure, or a table that says how it goes with time
  tolerance, ///< a measure, or "1 %" of the check's value
  integer,
  flag,
  word, ///< one of `choices`
  name, ///< letters, digits, _ and -
  text,
};

/// Letters of a name, and of a case file's: results are called after both.
constexpr std::size_t longest_name = 100;

/// What a text refers to, checked once everything is read (places: once the mesh exists).
enum class Reference { none, place, supported_place, body, fin, electrode, step, quantity };

/// A word that a user may write, and the value that it stands for: an enumerator, a number or a flag. Without
/// one the word itself is the value, of a text.
struct Choice {
  std::string word;
  std::string meaning;
  std::optional<double> value{};

  Choice(std::string written, std::string means) : word(std::move(written)), meaning(std::move(means)) {}
  template<class V>
  requires std::is_enum_v<V> || std::is_arithmetic_v<V> Choice(std::string written, std::string means,
                                                               V stands_for)
      : word(std::move(written)), meaning(std::move(means)), value(static_cast<double>(stands_for)) {}
};

struct Range {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
};

/// When a key, or a section, does something: a question to the whole case and to the object of the section.
/// Empty: always.
struct Condition {
  std::string needs; ///< in words: "a step with a duration"
  std::function<bool(const Case&, const void* object)> met{};
};

/// One key: everything that is known about it, once. Made by the functions below; `with...` members refine
/// it.
struct Key {
  std::string name;
  Type type = Type::text;
  std::string unit; ///< SI, of a measure
  std::string meaning;
  Binding binding;
  Range range;
  std::vector<Choice> choices;
  std::string hint;                    ///< reason of the range, appended to its message
  std::optional<std::string> fallback; ///< default in the user's notation
  std::string fallback_key;            ///< default: the value of this key of the same section
  bool required = true;
  std::size_t least = 1, most = 1; ///< number of values; a list unless both are 1
  bool spreads = false;            ///< a single value stands for all of the list
  bool is_stretch = false;         ///< a length over a length, which "50 %" may mean in two ways
  std::vector<std::string>
      only_for;           ///< values of the section's selector for which the key exists; empty: all
  std::string instead_of; ///< another way to give this key: exactly one of the two
  bool unique = false;    ///< no two entries of the section's list may share the value
  Reference refers = Reference::none;
  Condition acts; ///< otherwise it is read and does nothing, which the user is told
  std::function<std::string(const Value&)> check; ///< says what is wrong, "" if nothing

  bool is_list() const { return most > 1; }
  bool applies_to(const std::string& selected) const;
  /// The word that stands in `value`, for a key of type word.
  const std::string& word_of(const Scalar& value) const;

  Key above(double low) &&;
  Key at_least(double low) &&;
  Key below(double high) &&;
  Key at_most(double high) &&;
  Key because(std::string reason) &&;
  Key otherwise(std::string value) &&;        ///< default
  Key otherwise_as(std::string other_key) &&; ///< default: the value of another key
  Key optional() &&;
  Key values(std::size_t fewest, std::size_t largest) &&;
  Key or_one_for_all() &&;
  Key of_stretch() &&;
  Key only(std::vector<std::string> selected) &&;
  Key replacing(std::string other_key) &&;
  Key distinct() &&;
  Key refers_to(Reference what) &&;
  Key only_with(Condition condition) &&;
  Key checked(std::function<std::string(const Value&)> rule) &&;
};

/// Adds what a word of the section's selector has, each behind others of its name; what several words have in
/// the same way is one key.
void add_keys_of(const std::string& selected, std::vector<Key> more, std::vector<Key>& keys);

/// How a section reaches the object that its keys are bound to.
struct Access {
  struct Entry {
    std::string name; ///< of a by-electrode section
    const void* object;
  };
  std::function<void*(void* parent, const std::string& name)> enter; ///< creates or finds the object
  std::function<std::vector<Entry>(const void* parent)> entries;     ///< the objects that exist
  /// Of a list: forgets the items that a named thing has brought, before those that are written instead.
  std::function<void(void* parent)> clear{};
};

/// A rule between the keys of a section that have all been read: the key to blame and what is wrong with it.
struct Conflict {
  std::string key;
  std::string message;
};

struct Section {
  enum class Shape {
    table,
    list,
    by_electrode,
    named, ///< [section.NAME], any names
  };
  enum class Presence {
    required,
    defaulted, ///< read as an empty table when it is absent
    optional,  ///< left out when it is absent
    geometry,  ///< one of the geometries
    list,      ///< any number
    separate,  ///< read by another reader
  };

  std::string name;
  std::string meaning;
  Shape shape = Shape::table;
  Presence presence = Presence::defaulted;
  Access access;
  std::string selector; ///< key whose word decides which keys exist, or "geometry"
  std::vector<Key> keys;
  std::vector<Section> sections;
  std::optional<std::string> fallback; ///< the named thing that stands for an absent section
  std::function<std::vector<std::string>()>
      names; ///< named things that a text may stand for, instead of a table
  /// Fills the object with a named thing; false when there is none of that name.
  std::function<bool(void* object, const std::string& name)> start;
  std::function<std::optional<Conflict>(const void* object)> check;
  Condition acts{}; ///< of all its keys
  /// When it may be left out although it is required or has defaults, by what stands around it.
  std::function<bool(const Node& outer)> needless{};

  /// "[path]" or "[[path]]"
  std::string heading(const std::string& path) const;
  /// The value of the selector as the object has it, "" without a selector of its own.
  std::string selected_in(const void* object) const;
  const Section* find_section(std::string_view wanted) const;
  /// The key of that name that exists for `selected`; otherwise any of that name; null when there is none.
  const Key* find_key(std::string_view wanted, const std::string& selected) const;
  /// Whether a geometry is among its sections.
  bool has_geometries() const;
  /// Names of the keys that exist for `selected`, and of the sections.
  std::vector<std::string> names_for(const std::string& selected) const;
};

/// What may stand in the place of a quantity of this SI unit: { wave = "...", ... }. Its object is a
/// Waveform.
Section wave_section(std::string_view unit);

/// THE table: reading, validation, defaults, `info`, the JSON schema and resolved.toml are made from it.
/// Its objects are Case; those of the section "study" are Study, those of "fit" and "test" are Fit,
/// that of "identify" an Identification.
const Section& case_schema();

// --- bindings
// ------------------------------------------------------------------------------------------------------

template<class M>
void assign(M& member, const Value& value) {
  if constexpr (std::is_same_v<M, std::string> || std::is_same_v<M, std::filesystem::path>)
    member = value.at(0).text;
  else if constexpr (std::is_same_v<M, Waveform>)
    member = value.at(0).wave.value_or(Waveform::constant_at(value.at(0).number));
  else if constexpr (std::is_arithmetic_v<M> || std::is_enum_v<M>)
    member = static_cast<M>(value.at(0).number);
  else if constexpr (requires { member.emplace(); })
    assign(member.emplace(), value);
  else {
    if constexpr (requires { member.resize(1); }) member.resize(value.size());
    for (std::size_t i = 0; i < member.size(); ++i) assign(member[i], {value.at(i)});
  }
}

template<class M>
std::optional<Value> value_of(const M& member) {
  if constexpr (std::is_same_v<M, std::string>)
    return member.empty() ? std::nullopt : std::optional(Value{{0, member}});
  else if constexpr (std::is_same_v<M, std::filesystem::path>)
    return value_of(member.string());
  else if constexpr (std::is_same_v<M, Waveform>)
    return member.constant() ? value_of(member.to) : Value{{0, "", member}};
  else if constexpr (std::is_arithmetic_v<M> || std::is_enum_v<M>)
    return Value{{static_cast<double>(member), ""}};
  else if constexpr (requires { member.has_value(); })
    return member ? value_of(*member) : std::nullopt;
  else {
    Value all;
    for (const auto& item : member)
      if (const auto value = value_of(item)) all.push_back(value->at(0));
    return all.empty() ? std::nullopt : std::optional(all);
  }
}

template<class T, class M>
Binding to(M T::*member) {
  return {[member](void* object, const Value& value) { assign(static_cast<T*>(object)->*member, value); },
          [member](const void* object) { return value_of(static_cast<const T*>(object)->*member); }};
}

/// A binding to the member that `part(object)` returns a reference to.
template<class T, class Part>
Binding to_part(Part part) {
  return {[part](void* object, const Value& value) { assign(part(*static_cast<T*>(object)), value); },
          [part](const void* object) { return value_of(part(*static_cast<const T*>(object))); }};
}

template<class T, class M>
Access member(M T::*part) {
  return {[part](void* parent, const std::string&) -> void* { return &(static_cast<T*>(parent)->*part); },
          [part](const void* parent) {
            return std::vector<Access::Entry>{{"", &(static_cast<const T*>(parent)->*part)}};
          }};
}

template<class T, class M>
Access present(std::optional<M> T::*part) {
  return {[part](void* parent, const std::string&) -> void* {
            return &(static_cast<T*>(parent)->*part).emplace();
          },
          [part](const void* parent) {
            const auto& one = static_cast<const T*>(parent)->*part;
            return one ? std::vector<Access::Entry>{{"", &*one}} : std::vector<Access::Entry>{};
          }};
}

/// The items of a list. Those that a template has brought come back with it: they are no entries.
template<class T, class M>
Access each(std::vector<M> T::*list) {
  return {[list](void* parent, const std::string&) -> void* {
            return &(static_cast<T*>(parent)->*list).emplace_back();
          },
          [list](const void* parent) {
            std::vector<Access::Entry> entries;
            for (const M& item : static_cast<const T*>(parent)->*list) {
              if constexpr (requires { item.standard; })
                if (item.standard) continue;
              entries.push_back({"", &item});
            }
            return entries;
          }};
}

/// The section's keys are bound to the object of the section around it.
Access same_object();

/// [[name]], any number of them, without keys yet.
Section list_section(std::string name, std::string meaning, Access access);

// --- keys
// ----------------------------------------------------------------------------------------------------------

Key measure(std::string name, std::string_view unit, Binding binding, std::string meaning);
Key number(std::string name, Binding binding, std::string meaning);
Key wave(std::string name, std::string_view unit, Binding binding, std::string meaning);
Key integer(std::string name, Binding binding, std::string meaning);
Key flag(std::string name, Binding binding, std::string meaning);
Key word(std::string name, std::vector<Choice> choices, Binding binding, std::string meaning);
Key text(std::string name, Binding binding, std::string meaning);

/// x, y and z: 0, 1 and 2.
inline std::vector<Choice> axes() { return {{"x", "", 0}, {"y", "", 1}, {"z", "", 2}}; }

/// The path of a key in the section of a path; empty: at the top.
inline std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

// --- the parts of the table, one file each
// -------------------------------------------------------------------------

Section film_section();                       ///< of a Part
std::vector<Section> geometry_sections();     ///< of a Part
Section mesh_section();                       ///< of a Part
Section beam_section();                       ///< of a Part
Section rod_section();                        ///< of a Part
Section weight_section();                     ///< what hangs from a strip
std::vector<Section> leaf_sections();         ///< of a Part with antagonistic rolls
std::vector<Section> unnamed_part_sections(); ///< film, the geometries, mesh
std::vector<Section> region_sections();       ///< region, sectors, of a Part
std::vector<Section> part_sections();         ///< part, tie
Section body_section();
Section fin_section();
Section pivot_section();
std::vector<Section> action_sections(); ///< electrode, support, load, spring, linkage, drive
Section step_section();
std::vector<Section> result_sections(); ///< quantity, check, solver, output, linearise, study
Section study_section();
std::vector<Section> fit_sections(); ///< fit, test
Section identify_section();          ///< what fits a whole device
Section rational_section();          ///< of RationalFits

} // namespace dielast::cases
