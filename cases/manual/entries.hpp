// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/schema.hpp"
#include "cases/manual/actuators.hpp"
#include "cases/tables/templates.hpp"
#include "materials/catalog.hpp"

#include <span>
#include <string>
#include <string_view>

namespace dielast::cases {

/// What may be written for a key, its range, its default and what it acts with.
std::string rules_text(const Key& key, const Section& section);

/// Two lines: the name with its meaning, then what may be written, range and default.
std::string key_text(const Key& key, const Section& section);

/// Heading, meaning and keys of a section and of the sections in it.
std::string section_text(const Section& section, const std::string& path);

/// The keys that only one value of the selector has.
std::string keys_for(const Section& section, const std::string& selected);

/// Source, validity and parameters of a named material.
std::string material_text(const materials::NamedFilm& named);
std::string material_text(const materials::NamedSolid& named);

/// A word of the field that messages and documents use.
struct Term {
  std::string_view name, meaning;
};
std::span<const Term> terms();

/// How a case says a device of the literature, and where the gallery has one.
std::string actuator_text(const Actuator& actuator);

/// A line for each section that a device brings, as TOML.
std::string defaults_text(const Node& defaults, std::string_view indent);

/// Keys, places, defaults and standard quantities of a device.
std::string device_text(const Template& device);

} // namespace dielast::cases
