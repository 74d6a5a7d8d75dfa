// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace dielast::cases {

/// What a user says behind a command.
struct Arguments {
  std::string case_file;
  std::vector<std::string> overrides;
  std::string directory;
  std::string topic = "overview";
  int threads = 0;
  std::string shell;
  std::optional<std::string> slurm, points;
  int batch = 1;
  const CLI::App* app = nullptr; ///< all commands
  char** words = nullptr;        ///< of the command line, the program's first
  bool resume = false, quiet = false, tangent = false, dry_run = false;

  /// Where results go unless the user says so: beside where the command was given, named after the case.
  std::filesystem::path output(const std::string& suffix) const {
    return directory.empty() ? std::filesystem::path(case_file).stem().string() + suffix : directory;
  }
};

/// The commands with their options, bound to `arguments`: `--help`, the manual page and completion in shells
/// are made from it.
void add_commands(CLI::App& app, Arguments& arguments);

/// What to tell of a command line that is not understood: what is wrong with it and what may be meant.
std::string explanation(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& words);

/// The manual page, in the language of man(7).
std::string manual_page(const CLI::App& app);

/// The shells that `completion_script` knows.
inline const std::vector<std::string> known_shells{"bash", "zsh", "fish"};

/// What a shell is told to complete commands, options, case files and topics.
std::string completion_script(const CLI::App& app, const std::string& shell);

} // namespace dielast::cases
