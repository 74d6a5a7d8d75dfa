// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::post {

/// Another process writes to a folder of results.
struct FolderInUse : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A folder of results, which no other process can own while this lives, and its manifest: the list of what
/// belongs to the results. What the manifest does not list is foreign and is never removed or
/// overwritten.
///
/// manifest.txt has a line for the command whose results they are, then one line per file or inner folder of
/// results, written before it is made, so that a command killed at any moment leaves nothing unlisted, and,
/// last of all, `complete <exit code>`. The manifest is also what is locked (flock).
class ResultsFolder {
 public:
  /// Makes the folder with its parents. `command` is the one that writes ("run"). Throws std::runtime_error
  /// when the folder cannot be made or written to, when it holds results of another command, or a manifest
  /// that cannot be read; FolderInUse when another process owns it.
  ResultsFolder(std::filesystem::path path, std::string_view command);
  ~ResultsFolder();
  ResultsFolder(const ResultsFolder&) = delete;
  ResultsFolder& operator=(const ResultsFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

  /// Names in the order in which they were listed.
  const std::vector<std::string>& names() const { return names_; }
  /// Exit code of the complete results; nothing while they are not.
  std::optional<int> complete() const { return exit_code_; }

  /// Begins results, or goes on with them: removes everything that is listed but not in `kept`, inner folders
  /// with what their own manifests list.
  void begin(std::vector<std::string> kept = {});
  /// The manifest was lost: files that have names of results are results.
  void adopt() { is_adopted_ = true; }
  /// Lists a name that is about to be made; listing it again does nothing. Throws WriteError, and
  /// std::runtime_error where a foreign file has the name.
  void add(const std::string& name);
  /// Lists a file and writes it atomically. Throws WriteError.
  void write(const std::string& name, std::string_view bytes);
  /// The results are complete. Throws WriteError.
  void set_complete(int exit_code);

 private:
  std::filesystem::path path_;
  std::string head_;  ///< first line of the manifest
  int manifest_ = -1; ///< its descriptor, locked
  std::vector<std::string> names_;
  std::set<std::string> listed_; ///< the same names
  std::optional<int> exit_code_;
  bool is_adopted_ = false;
};

} // namespace dielast::post
