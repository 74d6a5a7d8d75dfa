// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/command/command_line.hpp"

#include "cases/text/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// The first of the words that looks like an option and is none of the command's; empty: there is none.
std::string unknown_option(const CLI::App& command, const std::vector<std::string>& words,
                           std::vector<std::string>& known) {
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    for (const std::string& name : option->get_snames()) known.push_back("-" + name);
  }
  for (const std::string& word : words) {
    if (word == "--") break;
    const std::string name = word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
    const bool is_option = name.size() > 1 && name[0] == '-' && (name[1] < '0' || name[1] > '9');
    if (is_option && std::ranges::find(known, name) == known.end()) return name;
  }
  return "";
}

} // namespace

void add_commands(CLI::App& app, Arguments& arguments) {
  app.name("dielast");
  app.description("dielast: finite elements for dielectric elastomer actuators");
  arguments.app = &app;
  app.footer(
      "Examples:\n"
      "  dielast run case.toml                               results in case-results/\n"
      "  dielast run case.toml --set drive.voltage=\"6 kV\" -o six\n"
      "  dielast study figure5.toml --resume                 results in figure5-study/\n"
      "  dielast fit tests.toml                              results in tests-fit/\n"
      "  dielast linearise step.toml                         A, B, C, D in step-linear/\n"
      "  dielast info devices                                templates, their keys and places\n"
      "Exit codes: 0 ok, 1 usage or file, 2 invalid case, 3 mesh, 4 not converged (results kept), 5 a check\n"
      "failed, a study's target or best point does not exist, or works and heat are not resolved to 1 %,\n"
      "130 interrupted (go on with --resume).");
  app.set_version_flag("--version", "dielast " DIELAST_VERSION);
  app.require_subcommand(1);

  const auto add = [&](const char* name, const char* meaning) { return app.add_subcommand(name, meaning); };
  const auto takes_case = [&](CLI::App* command) {
    command->add_option("case", arguments.case_file, "the case file (TOML)")->required();
    return command;
  };
  const auto takes_overrides = [&](CLI::App* command) {
    command
        ->add_option("--set", arguments.overrides,
                     "override a key: --set honeycomb.angle=\"140 deg\"; without a value it is removed")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
  };
  const auto takes_directory = [&](CLI::App* command) {
    command
        ->add_option(
            "-o,--output", arguments.directory,
            "directory of the results [<case>-results, -study, -fit, -linear, -mesh: one for each command]")
        ->type_name("DIR")
        ->check([](const std::string& directory) {
          return directory.empty() ? "needs the name of a directory, found \"\"" : "";
        });
  };
  const auto takes_threads = [&](CLI::App* command, const char* meaning) {
    command->add_option("-j,--threads", arguments.threads, meaning)->check(CLI::Range(0, 1024));
  };
  const auto may_be_quiet = [&](CLI::App* command) {
    command->add_flag("-q,--quiet", arguments.quiet, "nothing on the terminal but errors");
  };

  auto* run_command = takes_case(add("run", "run a case: history, ParaView series, summary, report"));
  takes_overrides(run_command);
  takes_directory(run_command);
  takes_threads(run_command, "threads [every core]; the results do not depend on it");
  run_command->add_flag("--resume", arguments.resume, "go on where an interrupted run stopped");
  may_be_quiet(run_command);

  auto* check_command = takes_case(add("check", "validate a case and mesh it, without running"));
  takes_overrides(check_command);
  takes_threads(check_command, "threads [every core]");
  check_command->add_flag("--tangent", arguments.tangent,
                          "compare residual and tangent with differences of the energy");

  auto* mesh_command =
      takes_case(add("mesh", "write the mesh for ParaView, list its places and its quality"));
  takes_overrides(mesh_command);
  takes_directory(mesh_command);

  auto* study_command = takes_case(add("study", "run a case over grids of its keys, in parallel"));
  takes_overrides(study_command);
  takes_directory(study_command);
  takes_threads(study_command, "points at a time [every core]");
  study_command->add_flag("--resume", arguments.resume,
                          "keep the points that are done, go on with the others");
  may_be_quiet(study_command);
  study_command->add_flag("--dry-run", arguments.dry_run,
                          "list the points and try one, for an estimate of time and disk");
  study_command->add_option("--slurm", arguments.slurm,
                            "run the points as a job array, with these options of sbatch: "
                            "--slurm=\"--partition=main --time=1:00:00\"");
  study_command->add_option("--batch", arguments.batch, "points of one task of the job array [1]")
      ->check(CLI::Range(1, 1000000))
      ->needs("--slurm");
  study_command->add_option(
      "--points", arguments.points,
      "run these points only, such as 1-20,25, and make no table: what one job of a cluster does");

  auto* linearise_command =
      takes_case(add("linearise", "make a small linear model about the state at the end of a case's steps"));
  takes_overrides(linearise_command);
  takes_directory(linearise_command);
  takes_threads(linearise_command, "threads [every core]");
  may_be_quiet(linearise_command);

  auto* fit_command = takes_case(
      add("fit", "fit a material to measured tests, or keys of a case to what was measured on the device"));
  takes_directory(fit_command);
  fit_command->add_flag("--resume", arguments.resume,
                        "do nothing where the fit of a material has run to its end");
  may_be_quiet(fit_command);

  auto* info_command =
      add("info", "explain a topic, or any device, law, quantity, step, section or key by its name");
  info_command->add_option("topic", arguments.topic,
                           "a topic, or a name such as disc, gent, film.thickness [overview]");
  add("schema", "print the JSON Schema of case files, for completion in an editor");
  add("man", "print the manual page, for `man -l`");
  add("completion", "print what a shell needs to complete commands: bash, zsh or fish")
      ->add_option("shell", arguments.shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember(known_shells));
}

std::string explanation(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& words) {
  const std::vector<std::string> names = command_names(app);
  const std::string usage =
      fmt::format("dielast COMMAND ..., with one of {}; more with --help", fmt::join(names, ", "));
  if (words.empty()) return "error: there is no command: write " + usage;
  const std::string& first = words.front();
  if (!first.starts_with('-') && std::ranges::find(names, first) == names.end()) {
    if (first.ends_with(".toml"))
      return fmt::format("error: \"{0}\" is no command: did you mean \"dielast run {0}\"?", first);
    const std::string advice = did_you_mean(first, names);
    return fmt::format("error: \"{}\" is no command{}", first, advice.empty() ? ": write " + usage : advice);
  }
  const CLI::App* command = first.starts_with('-') ? &app : app.get_subcommand(first);
  std::vector<std::string> known;
  std::string message = error.what();
  if (const std::string option = unknown_option(*command, words, known); !option.empty())
    message = fmt::format("\"{}\" is no option{}", option, did_you_mean(option, known));
  else if (std::ranges::find(words, "--set") != words.end() &&
           error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))
    message +=
        "\nEvery --set takes one setting; one with blanks stands in quotes: --set \"drive.voltage=5 kV\"";
  return fmt::format("error: {}\nMore with: dielast {}--help", message,
                     first.starts_with('-') ? "" : first + " ");
}

} // namespace dielast::cases
