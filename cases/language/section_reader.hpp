// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/convert.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace dielast::cases {

/// What a section needs to know of the rest of the case.
struct Surroundings {
  /// Name of the geometry that a table has, "file" for a user's mesh; empty: none or several.
  std::function<std::string(const Node& table)> geometry_of;
  std::filesystem::path folder; ///< of the case file: relative names of files start there
  std::function<std::vector<std::string>()> electrodes; ///< names
  /// SI unit of a quantity; nothing when there is none of that name
  std::function<std::optional<std::string>(const std::string& quantity)> unit_of_quantity;
};

/// A wave that the case has, and where it was written.
struct WrittenWave {
  Waveform wave;
  std::string key;
  Source source;
};

/// Reads a tree into the objects that the schema binds, and gathers everything that is wrong with it.
class SectionReader {
 public:
  explicit SectionReader(Surroundings surroundings) : surroundings_(std::move(surroundings)) {}

  /// Keys and sections of `section` from the table `node` into `object`; `path` names the section in
  /// messages.
  void read_table(const Section& section, const Node& node, void* object, const std::string& path);

  void report(const Source& source, std::string key, std::string message) {
    diagnostics_.push_back({source, std::move(key), std::move(message)});
  }
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
  void warn(const Source& source, std::string key, std::string message) {
    warnings_.push_back({source, std::move(key), std::move(message), Severity::warning});
  }
  const std::vector<Diagnostic>& warnings() const { return warnings_; }
  /// Every name of that kind that the case mentions.
  const std::vector<Mention>& mentions(Reference kind) { return mentions_[kind]; }
  const std::vector<WrittenWave>& waves() const { return waves_; }
  /// Where the keys that were understood stand, by their paths.
  const std::map<std::string, Source>& keys() const { return keys_; }

 private:
  void read_key(const Section& section, const Key& key, const std::string& selected, const Node& table,
                void* object, const std::string& path, bool kept);
  Node table_of_file(const Node& name, const std::string& path) const;
  Node with_file(const Section& section, const Node& node, const std::string& path);
  void read_section(const Section& section, const Node& outer, void* parent, const std::string& path);
  void read_list(const Section& section, const Node& node, void* parent, const std::string& path);
  void read_by_electrode(const Section& section, const Node& node, void* parent, const std::string& path);
  void read_named(const Section& section, const Node& node, void* parent, const std::string& path);
  void report_unknown(const Section& section, const Node& table, const std::string& selected,
                      const std::string& path);
  void set(const Key& key, const Node& node, const Node& table, void* object, const std::string& path);
  Waveform read_wave(const Key& key, const Node& table, const std::string& path);
  std::optional<std::string> unit_of(const Key& key, const Node& table) const;

  Surroundings surroundings_;
  std::string geometry_; ///< of the table with geometries that is being read
  std::vector<Diagnostic> diagnostics_, warnings_;
  std::size_t unread_ = 0; ///< keys that could not be understood because of an error elsewhere
  std::map<Reference, std::vector<Mention>> mentions_;
  std::vector<WrittenWave> waves_;
  std::map<std::string, Source> keys_;
};

} // namespace dielast::cases
