// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/console/terminal.hpp"
#include "cases/devices/device.hpp"
#include "cases/fits/fit.hpp"
#include "cases/manual/describe.hpp"
#include "cases/manual/json_schema.hpp"
#include "cases/readers/fit_reader.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/study_reader.hpp"
#include "cases/runs/linearise.hpp"
#include "cases/runs/run.hpp"
#include "cases/studies/study.hpp"
#include "fem/equilibrium/tangent_check.hpp"
#include "meshing/gmsh/gmsh_text.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/quality.hpp"
#include "post/files/vtk_series.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <malloc.h>

using namespace dielast;
using cases::ExitCode;

namespace {

struct Arguments {
  std::string case_file;
  std::vector<std::string> overrides;
  std::string directory;
  std::string topic = "overview";
  int threads = 0;
  bool resume = false, quiet = false, tangent = false;

  /// Where results go unless the user says so: beside where the command was given, named after the case.
  std::filesystem::path output(const std::string& suffix) const {
    return directory.empty() ? std::filesystem::path(case_file).stem().string() + suffix : directory;
  }
};

ExitCode run(const Arguments& arguments) {
  return run_case(cases::read_case(arguments.case_file, arguments.overrides),
                  {arguments.output("-results"), arguments.threads, arguments.resume, arguments.quiet});
}

ExitCode check(const Arguments& arguments) {
  const cases::Case one = cases::read_case(arguments.case_file, arguments.overrides);
  const cases::Device device = cases::build_device(one);
  const auto quality = meshing::quality(device.mesh);
  for (const cases::Diagnostic& warning : one.warnings) cases::say(stderr, "{}\n", warning.text());
  for (const std::string& warning : device.warnings) cases::say(stderr, "{}\n", warning);
  cases::say("{}: valid\n{}unknowns: {} free, {} held{}\n", arguments.case_file, meshing::format(quality),
             device.model.dofs.free_count(), device.model.dofs.held_count(),
             device.free_body ? " (a free body, pinned against rigid motion)" : "");
  if (!arguments.tangent) return ExitCode::ok;
  fem::Equilibrium equilibrium(device.model, arguments.threads);
  fem::State state = device.model.initial_state();
  for (std::size_t e = 0; e < one.electrodes.size(); ++e)
    if (const auto drive = one.drives.find(one.electrodes[e].name);
        drive != one.drives.end() && drive->second.voltage)
      state.voltage[e] = drive->second.voltage->at(0);
  constexpr double tolerance = 1e-6;
  const auto found = fem::check_tangent(equilibrium, state, 0.02 * device.model.length_scale, 5);
  const bool passed = found.residual < tolerance && found.tangent < tolerance;
  cases::say(
      "derivatives against differences of the energy in {} directions: residual {:.1e}, tangent {:.1e}: {}\n",
      found.directions, found.residual, found.tangent, passed ? "passed" : "FAILED");
  return passed ? ExitCode::ok : ExitCode::check_failed;
}

ExitCode mesh(const Arguments& arguments) {
  const cases::Case one = cases::read_case(arguments.case_file, arguments.overrides);
  const cases::Device device = cases::build_device(one);
  post::ResultsFolder folder(arguments.output("-mesh"), "mesh");
  folder.begin();
  const fem::State drawn = device.model.initial_state();
  post::VtkSeries(folder, one.source.stem().string() + "-mesh", device.mesh)
      .write({0, "drawn"}, drawn.displacement, device.model.sample(drawn));
  const bool of_revolution = one.dimension == fem::Dimension::axisymmetric;
  const std::string gmsh_name = one.source.stem().string() + ".msh";
  if (!of_revolution) folder.write(gmsh_name, meshing::gmsh_text(device.mesh));
  folder.set_complete(static_cast<int>(ExitCode::ok));
  cases::say("{}places:\n", meshing::format(meshing::quality(device.mesh)));
  for (const auto& [name, nodes] : device.mesh.node_sets) {
    const auto cells = device.mesh.cell_sets.find(name);
    cases::say(
        "  {:<16} {:>6} nodes{}\n", name, nodes.size(),
        cells == device.mesh.cell_sets.end() ? "" : fmt::format(" {:>6} cells", cells->second.cells.size()));
  }
  cases::say("written to {}\n", (folder / (one.source.stem().string() + "-mesh.pvd")).string());
  if (!of_revolution) cases::say("and, for gmsh and [mesh] file, to {}\n", (folder / gmsh_name).string());
  return ExitCode::ok;
}

ExitCode study(const Arguments& arguments) {
  return run_study(cases::read_study(arguments.case_file, arguments.overrides),
                   {arguments.output("-study"), arguments.threads, arguments.resume});
}

ExitCode fit(const Arguments& arguments) {
  return run_fit(cases::read_fit(arguments.case_file), {arguments.output("-fit"), arguments.resume});
}

ExitCode linearise(const Arguments& arguments) {
  return linearise_case(cases::read_case(arguments.case_file, arguments.overrides),
                        {arguments.output("-linear"), arguments.threads});
}

ExitCode info(const Arguments& arguments) {
  cases::say("{}", cases::describe(arguments.topic));
  return ExitCode::ok;
}

ExitCode schema(const Arguments& /*none*/) {
  cases::say("{}\n", cases::json_schema());
  return ExitCode::ok;
}

ExitCode fail(ExitCode code, std::string_view message) {
  cases::say(stderr, "error: {}\n", message);
  return code;
}

/// The only place where exceptions become exit codes.
ExitCode guarded(ExitCode (*command)(const Arguments&), const Arguments& arguments) {
  try {
    return command(arguments);
  } catch (const cases::CaseError& error) {
    cases::say(stderr, "{}\n", error.what());
    return ExitCode::invalid_case;
  } catch (const meshing::MeshError& error) {
    return fail(ExitCode::mesh, error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::usage_or_file,
                "out of memory: use a coarser mesh, fewer rows, or points of a study");
  } catch (const std::exception& error) { // files that cannot be read or written, unknown topics
    return fail(ExitCode::usage_or_file, error.what());
  }
}

} // namespace

int main(int argc, char** argv) {
  // Workspaces that come and go with every factorisation keep their pages: faulting them in again costs a
  // tenth of a run.
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  cases::open_standard_streams();
  cases::catch_signals();

  CLI::App app{"dielast: finite elements for dielectric elastomer actuators"};
  app.footer(
      "Examples:\n"
      "  dielast run case.toml                               results in case-results/\n"
      "  dielast run case.toml --set drive.voltage=\"6 kV\" -o six\n"
      "  dielast study figure5.toml --resume                 results in figure5-study/\n"
      "  dielast fit tests.toml                              results in tests-fit/\n"
      "  dielast linearise step.toml                         A, B, C, D in step-linear/\n"
      "  dielast info devices                                templates, their keys and places\n"
      "Exit codes: 0 ok, 1 usage or file, 2 invalid case, 3 mesh, 4 not converged (results kept), 5 a check\n"
      "failed or works and heat are not resolved to 1 %, 130 interrupted (go on with --resume).");
  app.set_version_flag("--version", "dielast " DIELAST_VERSION);
  app.require_subcommand(1);

  Arguments arguments;
  struct Command {
    CLI::App* app;
    ExitCode (*function)(const Arguments&);
  };
  std::vector<Command> commands;
  const auto add = [&](const char* name, const char* meaning, ExitCode (*function)(const Arguments&)) {
    commands.push_back({app.add_subcommand(name, meaning), function});
    return commands.back().app;
  };
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
        ->type_name("DIR");
  };
  const auto takes_threads = [&](CLI::App* command, const char* meaning) {
    command->add_option("-j,--threads", arguments.threads, meaning)->check(CLI::Range(0, 1024));
  };

  auto* run_command = takes_case(add("run", "run a case: history, ParaView series, summary, report", run));
  takes_overrides(run_command);
  takes_directory(run_command);
  takes_threads(run_command, "threads [every core]; the results do not depend on it");
  run_command->add_flag("--resume", arguments.resume, "go on where an interrupted run stopped");
  run_command->add_flag("-q,--quiet", arguments.quiet, "nothing on the terminal but errors");

  auto* check_command = takes_case(add("check", "validate a case and mesh it, without running", check));
  takes_overrides(check_command);
  takes_threads(check_command, "threads [every core]");
  check_command->add_flag("--tangent", arguments.tangent,
                          "compare residual and tangent with differences of the energy");

  auto* mesh_command =
      takes_case(add("mesh", "write the mesh for ParaView, list its places and its quality", mesh));
  takes_overrides(mesh_command);
  takes_directory(mesh_command);

  auto* study_command = takes_case(add("study", "run a case over grids of its keys, in parallel", study));
  takes_overrides(study_command);
  takes_directory(study_command);
  takes_threads(study_command, "points at a time [every core]");
  study_command->add_flag("--resume", arguments.resume,
                          "keep the points that are done, go on with the others");

  auto* linearise_command = takes_case(
      add("linearise", "make a small linear model about the state at the end of a case's steps", linearise));
  takes_overrides(linearise_command);
  takes_directory(linearise_command);
  takes_threads(linearise_command, "threads [every core]");

  auto* fit_command =
      takes_case(add("fit", "fit a material to measured tests: parameters, intervals, report", fit));
  takes_directory(fit_command);
  fit_command->add_flag("--resume", arguments.resume, "do nothing where the fit has run to its end");

  auto* info_command = add("info", "explain materials, laws, devices, quantities, steps, keys, units", info);
  info_command->add_option("topic", arguments.topic, "what to explain [overview]");
  add("schema", "print the JSON Schema of case files, for completion in an editor", schema);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return static_cast<int>(finish_output(app.exit(error) == 0 ? ExitCode::ok : ExitCode::usage_or_file));
  }
  for (const auto& [command, function] : commands)
    if (command->parsed()) return static_cast<int>(finish_output(guarded(function, arguments)));
  return static_cast<int>(ExitCode::usage_or_file);
}
