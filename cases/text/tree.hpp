// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/text/diagnostics.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// A value of a case file and where it stands: the file as written, before the schema gives it a meaning.
struct Node {
  enum class Kind { flag, integer, number, text, date, list, table };

  Kind kind = Kind::table;
  bool flag = false;
  std::int64_t integer = 0;
  double number = 0;             ///< of an integer, too
  std::string text;              ///< of a text or a date
  std::vector<std::string> keys; ///< of a table, in the order of the file, one for each item
  std::vector<Node> items;       ///< of a list or a table
  Source source;                 ///< of the value
  Source key_source;             ///< of the key in front of it

  bool is(Kind which) const { return kind == which; }
  /// Entry of a table; null when there is none.
  const Node* find(std::string_view key) const;
  Node* find(std::string_view key);
  /// Gives this node and all below it one source.
  void relocate(const Source& source);
  /// Adds an entry; returns it.
  Node& add(std::string key, Node value);
  /// Takes an entry of a table out; nothing happens where there is none.
  void remove(std::string_view key);
};

/// The text of an entry of a table; empty where there is none, or none that is a text.
std::string text_at(const Node& table, std::string_view key);

/// Reads a TOML file. Throws FileError (missing, no file, larger than 4 MB, not readable) or CaseError
/// (syntax, encoding, keys with more than 20 dots).
Node read_tree(const std::filesystem::path& path);

/// Parses TOML text; every node gets the line and column in it, and `file` as the name in messages. Throws
/// CaseError.
Node parse_tree(std::string_view toml, const FileName& file);

/// A value as a user types it after "key=": TOML when it is that, otherwise a text. Every node gets `source`.
/// Throws CaseError for bad UTF-8 and control characters.
Node parse_value(std::string_view text, const Source& source);

/// TOML text of a value, on one line.
std::string text_of(const Node& node);

/// A TOML string with its quotes.
std::string toml_string(std::string_view text);

} // namespace dielast::cases
