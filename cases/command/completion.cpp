// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/command/command_line.hpp"
#include "cases/manual/describe.hpp"

#include <fmt/format.h>

namespace dielast::cases {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) { return app.get_subcommands({}); }

/// Options as they are written, "--set" and the like.
std::vector<std::string> words_of(const CLI::Option& option) {
  std::vector<std::string> words;
  for (const std::string& letter : option.get_snames()) words.push_back("-" + letter);
  for (const std::string& name : option.get_lnames()) words.push_back("--" + name);
  return words;
}

bool takes_value(const CLI::Option& option) { return option.get_expected_max() > 0; }
bool is_directory(const CLI::Option& option) { return option.get_type_name() == "DIR"; }
bool takes_case(const CLI::App& command) { return command.get_option_no_throw("case") != nullptr; }

/// What may stand behind a command that takes no case file.
std::vector<std::string> answers(const CLI::App& command) {
  if (command.get_option_no_throw("topic")) return topics();
  if (command.get_option_no_throw("shell")) return known_shells;
  return {};
}

std::string escaped(std::string text, const std::string& special) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (special.find(text[i]) != std::string::npos) text.insert(i++, 1, '\\');
  return text;
}

/// Within single quotes of zsh, which end where the text has one.
std::string zsh_quoted(const std::string& text, const std::string& special) {
  std::string result;
  for (const char c : escaped(text, special)) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result;
}

std::string for_bash(const CLI::App& app) {
  std::string commands, cases_of, directories;
  std::string with_case;
  for (const CLI::App* command : commands_of(app)) {
    commands += command->get_name() + " ";
    std::vector<std::string> words = answers(*command);
    for (const CLI::Option* option :
         command->get_options([](const CLI::Option* o) { return o->nonpositional(); }))
      for (const std::string& word : words_of(*option)) words.push_back(word);
    cases_of += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), fmt::join(words, " "));
    if (takes_case(*command)) with_case += (with_case.empty() ? "" : "|") + command->get_name();
  }
  return fmt::format(R"(# Completion of dielast in bash: source it, or put it into bash-completion's folder.
_dielast() {{
  local current="${{COMP_WORDS[COMP_CWORD]}}" previous="${{COMP_WORDS[COMP_CWORD-1]}}" words=""
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "{0}--help --version" -- "$current"))
    return
  fi
  case "$previous" in
    -o|--output) local IFS=$'\n'; COMPREPLY=($(compgen -d -- "$current")); return ;;
    --set|-j|--threads) return ;;
  esac
  case "${{COMP_WORDS[1]}}" in
{1}  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
  case "${{COMP_WORDS[1]}}" in
    {2}) local IFS=$'\n' # names may have spaces
      [[ $current == -* ]] || COMPREPLY+=($(compgen -f -X '!*.toml' -- "$current") $(compgen -d -- "$current")) ;;
  esac
}}
complete -o filenames -F _dielast dielast
)",
                     commands, cases_of, with_case);
}

std::string for_zsh(const CLI::App& app) {
  std::string commands, cases_of;
  for (const CLI::App* command : commands_of(app)) {
    commands +=
        fmt::format("    '{}:{}'\n", command->get_name(), zsh_quoted(command->get_description(), ":"));
    cases_of += fmt::format("  {}) _arguments", command->get_name());
    for (const CLI::Option* option :
         command->get_options([](const CLI::Option* o) { return o->nonpositional(); }))
      for (const std::string& word : words_of(*option))
        cases_of += fmt::format(" \\\n    '{}{}[{}]{}'", word == "--set" ? "*" : "", word,
                                zsh_quoted(option->get_description(), "[]:\\"),
                                !takes_value(*option)   ? ""
                                : is_directory(*option) ? ":directory:_directories"
                                                        : ":value: ");
    if (takes_case(*command)) cases_of += " \\\n    '1:case:_files -g \"*.toml\"'";
    if (const auto words = answers(*command); !words.empty())
      cases_of += fmt::format(" \\\n    '1:what:({})'", fmt::join(words, " "));
    cases_of += " ;;\n";
  }
  return fmt::format(R"(#compdef dielast
# Completion of dielast in zsh: put it as _dielast into a folder of $fpath.
local -a commands=(
{0})
if ((CURRENT == 2)); then
  _describe command commands
  return
fi
local command=$words[2]
shift words
((CURRENT--))
case $command in
{1}esac
)",
                     commands, cases_of);
}

std::string for_fish(const CLI::App& app) {
  std::string text =
      "# Completion of dielast in fish: put it into ~/.config/fish/completions.\ncomplete -c dielast -f\n";
  for (const CLI::App* command : commands_of(app)) {
    const std::string& name = command->get_name();
    text += fmt::format("complete -c dielast -n __fish_use_subcommand -a {} -d '{}'\n", name,
                        escaped(command->get_description(), "'\\"));
    const std::string here = fmt::format("complete -c dielast -n '__fish_seen_subcommand_from {}'", name);
    for (const CLI::Option* option :
         command->get_options([](const CLI::Option* o) { return o->nonpositional(); })) {
      text += here;
      for (const std::string& letter : option->get_snames()) text += " -s " + letter;
      for (const std::string& word : option->get_lnames()) text += " -l " + word;
      text += fmt::format("{} -d '{}'\n",
                          !takes_value(*option)   ? ""
                          : is_directory(*option) ? " -x -a '(__fish_complete_directories)'"
                                                  : " -x",
                          escaped(option->get_description(), "'\\"));
    }
    if (takes_case(*command)) text += here + " -k -a '(__fish_complete_suffix .toml)'\n";
    if (const auto words = answers(*command); !words.empty())
      text += here + fmt::format(" -a '{}'\n", fmt::join(words, " "));
  }
  return text;
}

/// What man(7) would take for requests.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '-') {
      result += "\\-";
    } else if (c == '\\') {
      result += "\\e";
    } else {
      if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += "\\&";
      result += c;
    }
  }
  return result;
}

} // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  return shell == "bash" ? for_bash(app) : shell == "zsh" ? for_zsh(app) : for_fish(app);
}

std::string manual_page(const CLI::App& app) {
  const std::string description = app.get_description();
  std::string text =
      fmt::format(".TH DIELAST 1 \"\" \"dielast " DIELAST_VERSION "\"\n.SH NAME\ndielast \\- {}\n"
                  ".SH SYNOPSIS\n.B dielast\n.I COMMAND\n[...]\n.SH COMMANDS\n",
                  roff(description.substr(description.find(": ") + 2)));
  for (const CLI::App* command : commands_of(app)) {
    text += fmt::format(".SS dielast {}", roff(command->get_name()));
    for (const CLI::Option* option :
         command->get_options([](const CLI::Option* o) { return o->get_positional(); }))
      text += (option->get_required() ? " " : " [") + roff(option->get_name(true)) +
              (option->get_required() ? "" : "]");
    text += fmt::format("\n{}\n", roff(command->get_description()));
    for (const CLI::Option* option : command->get_options()) {
      const bool positional = option->get_positional();
      text += fmt::format(
          ".TP\n.B {}{}\n{}\n",
          roff(positional ? option->get_name(true) : fmt::format("{}", fmt::join(words_of(*option), ", "))),
          takes_value(*option) && !positional ? " " + roff(option->get_type_name()) : "",
          roff(option->get_description()));
    }
  }
  return text + ".SH EXAMPLES AND EXIT CODES\n.nf\n" + roff(app.get_footer()) + "\n.fi\n";
}

} // namespace dielast::cases
