// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/text/tree.hpp"

#include <string>
#include <string_view>

namespace dielast::cases {

/// Applies one `--set key=value` to the tree. The key is a path: "honeycomb.angle", "step.voltage.increments"
/// (an item by its name, kind, quantity or place) or "step[2].increments" (by its number, from 1); parts with
/// a dot are quoted. The value is TOML where it parses, a text otherwise: `film.prestretch=[3, 3]`,
/// `drive.voltage=7.5 kV`. Nothing
/// behind the "=" removes the key, or the item. The new nodes' source is `source`. Throws CaseError.
void apply_override(Node& tree, std::string_view key, std::string_view value, const Source& source);

/// Whether the user has given a node, or anything within it.
bool is_changed(const Node& node);

/// Takes out of a tree what a device has brought: lists and words at its top that the user has not given
/// whole.
Node take_brought(Node& tree);

/// What a device brings anew, with all that overrides have changed of what it had brought before: in lists of
/// items that had one name, kind and place; items that it brings no more stand behind.
Node with_changes(Node fresh, const Node& before);

/// What stands at the path of a key; an empty table where nothing does. Throws CaseError as apply_override.
Node value_at(Node tree, std::string_view key);

/// The key with the numbers of items in place of their names: two keys of one thing are one. As it is written
/// where nothing stands there.
std::string numbered_key(Node tree, const std::string& key);

/// Whether a key is another, or stands within it.
bool is_within(std::string_view key, std::string_view other);

/// Splits "key=value" and applies it; its source is "--set key=value".
void apply_override(Node& tree, std::string_view assignment);

} // namespace dielast::cases
