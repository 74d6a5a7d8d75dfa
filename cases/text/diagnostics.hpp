// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// Name of a file, held once by everything that stands in the file.
class FileName {
 public:
  FileName() = default;
  FileName(std::string name) : name_(std::make_shared<const std::string>(std::move(name))) {}
  FileName(const char* name) : FileName(std::string(name)) {}
  const std::string& text() const;

 private:
  std::shared_ptr<const std::string> name_; ///< null: ""
};

/// Where a setting was written: a line of a file, or an option of the command line (then line is 0).
struct Source {
  FileName file;
  int line = 0, column = 0;

  /// By the user, in the file or after --set; otherwise a template has brought it.
  bool is_written() const { return line > 0 || file.text().starts_with("--set"); }
};

enum class Severity {
  error,   ///< the case is refused
  warning, ///< the case runs, and its results repeat the message
};

/// One thing wrong with a case.
struct Diagnostic {
  Source source;
  std::string key; ///< path of the key, e.g. "film.thickness"; empty: the file as a whole
  std::string message;
  Severity severity = Severity::error;

  /// "file:line:column: error: key: message", or "... warning: ..."
  std::string text() const;
};

/// A name written in a case that must exist somewhere, and where it was written.
struct Mention {
  std::string name;
  std::string key;
  Source source;
};

/// More errors than these are counted, not told.
constexpr std::size_t most_diagnostics = 50;

/// The user's input is wrong: what is wrong with it, in the order of the file.
class CaseError : public std::runtime_error {
 public:
  /// `more`: the number of errors that `diagnostics` has left out.
  explicit CaseError(std::vector<Diagnostic> diagnostics, std::size_t more = 0);
  /// The first ones, most_diagnostics at most.
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }
  /// Number of the others.
  std::size_t more() const { return more_; }

 private:
  std::vector<Diagnostic> diagnostics_;
  std::size_t more_;
};

/// A file cannot be read.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `; here it is "x"` with that of the names by which goes here what textbooks and other programs call
/// `word`, or "" when there is none.
std::string called_here(std::string_view word, const std::vector<std::string>& names);

/// `; did you mean "x"?` with the name closest to `word`, or "" when none is close.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

/// `"a", "b"`; long lists are cut short.
std::string listed(const std::vector<std::string>& names);

} // namespace dielast::cases
