#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// Where a setting was written: a line of a file, or an option of the command line (then line is 0).
struct Source {
  std::string file;
  int line = 0, column = 0;
};

/// One thing wrong with a case.
struct Diagnostic {
  Source source;
  std::string key; ///< path of the key, e.g. "film.thickness"; empty: the file as a whole
  std::string message;

  /// "file:line:column: error: key: message"
  std::string text() const;
};

/// A name written in a case that must exist somewhere, and where it was written.
struct Mention {
  std::string name;
  std::string key;
  Source source;
};

/// The user's input is wrong: everything that is wrong with it, in the order of the file.
class CaseError : public std::runtime_error {
 public:
  explicit CaseError(std::vector<Diagnostic> diagnostics);
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};

/// A file cannot be read.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `; did you mean "x"?` with the name closest to `word`, or "" when none is close.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

/// `"a", "b"`; long lists are cut short.
std::string listed(const std::vector<std::string>& names);

} // namespace dielast::cases
