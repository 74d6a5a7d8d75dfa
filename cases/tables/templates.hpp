// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/text/tree.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// A named place of a template's mesh.
struct PlaceName {
  std::string_view name;
  std::string_view meaning;
};

/// What a geometry brings besides its mesh, said in the language of the case files.
struct Template {
  std::string_view name; ///< of its section; "file" for a user's own mesh
  std::string_view meaning;
  std::vector<PlaceName> places;
  std::string_view defaults;   ///< TOML: electrodes, supports, steps of a case that has none
  std::string_view quantities; ///< TOML: standard quantities; steps are named by
                               ///< their kind: the first of it is meant
  std::string_view with{};     ///< another section that makes it this device; empty: none
  bool alone = false;          ///< a case of its own, never a part of one
};

std::span<const Template> templates();

/// The template that a case's top, or a part, asks for; null when there is none. With several, the first of
/// the table.
const Template* template_of(const Node& table);

/// Every geometry of a case's top or of a part: [honeycomb], ..., or the key mesh.file.
std::vector<const Node*> geometries_of(const Node& table);

/// Name of the only geometry of a case's top or of a part; empty: it has none or several.
std::string geometry_of(const Node& table);

/// Adds the electrodes, supports and steps of all templates of the case where it has none. Those of a part's
/// electrode are called after the part.
void add_defaults(Node& tree);

/// Steps that take time have inertia where something is heavy, as it is when all of the case is known.
void add_inertia(Node& tree);

/// Thick geometries are of solid; between the surfaces of a sphere there is a potential.
void add_solid_defaults(Node& tree);

/// Name of the last step before the first that changes a voltage or charge; empty: there is none.
std::string step_before_voltages(const Node& tree);

/// Standard quantities of a case whose top is that device (null: of none), with those of its parts.
std::vector<Node> standard_quantities(const Node& tree, const Template* device);

/// Puts the standard quantities in front of the user's; returns how many. Those of a part are called
/// "<part>_<name>". Quantities of the release step are left out of a case without one. What counts since the
/// release or the weight does so since step_before_voltages() where there is no such step, or from the mesh
/// as drawn.
int add_standard_quantities(Node& tree);

} // namespace dielast::cases
