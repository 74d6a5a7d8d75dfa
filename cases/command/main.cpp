// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/command/command_line.hpp"
#include "cases/console/as_warning.hpp"
#include "cases/console/terminal.hpp"
#include "cases/devices/device.hpp"
#include "cases/fits/fit.hpp"
#include "cases/fits/identify.hpp"
#include "cases/fits/rational.hpp"
#include "cases/manual/describe.hpp"
#include "cases/manual/json_schema.hpp"
#include "cases/quantities/measurement.hpp"
#include "cases/readers/fit_reader.hpp"
#include "cases/readers/identify_reader.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/study_reader.hpp"
#include "cases/results/run.hpp"
#include "cases/runs/linearise.hpp"
#include "cases/runs/phases.hpp"
#include "cases/runs/recorder.hpp"
#include "cases/studies/study.hpp"
#include "fem/equilibrium/tangent_check.hpp"
#include "fem/machine/blas_kernels.hpp"
#include "fem/machine/memory.hpp"
#include "meshing/gmsh/gmsh_text.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/quality.hpp"
#include "post/files/vtk_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <stdexcept>
#include <unistd.h>

using namespace dielast;
using cases::Arguments;
using cases::ExitCode;

namespace {

/// Starts the program once more where solids would be solved by kernels of the BLAS that do not suit the
/// processor: it chooses them while it is loaded. Where that is not possible the program goes on with them.
void take_better_blas_kernels(const cases::Case& one, const Arguments& arguments) {
  const char* const kernels = fem::better_blas_kernels();
  if (!kernels || !one.any_film(std::mem_fn(&cases::Film::is_solid))) return;
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  setenv(fem::blas_kernels_variable, kernels, 1);
  execv(program.c_str(), arguments.words);
}

ExitCode run(const Arguments& arguments) {
  cases::Case one = cases::read_case(arguments.case_file, arguments.overrides);
  if (auto idle = cases::study_of_one_run(arguments.case_file)) one.warnings.push_back(*std::move(idle));
  take_better_blas_kernels(one, arguments);
  return run_case(one, {arguments.output("-results"), arguments.threads, arguments.resume, arguments.quiet});
}

ExitCode check(const Arguments& arguments) {
  const cases::Case one = cases::read_case(arguments.case_file, arguments.overrides);
  const cases::Device device = cases::build_device(one);
  cases::require_one_motion(one, device.mesh, device.model.dofs);
  const cases::Measurement measurable(one, device); // or says what is not
  const auto quality = meshing::quality(device.mesh);
  for (const cases::Diagnostic& warning : one.warnings) cases::say(stderr, "{}\n", warning.text());
  for (const std::string& warning : device.warnings) cases::say(stderr, "{}\n", cases::as_warning(warning));
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
  const auto passes = [&](const fem::TangentCheck& check) {
    return check.residual < tolerance && check.tangent < tolerance;
  };
  // Differences may reach through thin elements, or a barrier of contact: shorter ones tell whether they do.
  double amplitude = 0.02 * device.model.length_scale;
  fem::TangentCheck found = fem::check_tangent(equilibrium, state, amplitude, 5);
  for (int shorter = 0; shorter < 4 && !passes(found); ++shorter)
    found = fem::check_tangent(equilibrium, state, amplitude /= 8, 5);
  const bool passed = passes(found);
  cases::say("derivatives against differences in {} directions: residual {:.1e}, tangent {:.1e}: {}\n",
             found.directions, found.residual, found.tangent, passed ? "passed" : "FAILED");
  return passed ? ExitCode::ok : ExitCode::check_failed;
}

ExitCode mesh(const Arguments& arguments) {
  const cases::Case one = cases::read_case(arguments.case_file, arguments.overrides);
  const cases::Device device = cases::build_device(one);
  post::ResultsFolder folder(arguments.output("-mesh"), "mesh");
  folder.begin();
  const fem::State drawn = device.model.initial_state();
  const fem::Samples samples = device.model.sample(drawn);
  post::VtkSeries(folder, one.source.stem().string() + "-mesh", cases::series_model(one, device))
      .write({0, "drawn"}, {drawn.displacement, drawn.rotation, samples});
  const bool of_revolution = one.dimension == fem::Dimension::axisymmetric;
  const std::string gmsh_name = one.source.stem().string() + ".msh";
  // Bars beside their lines are linked to them by what no mesh file can say: there they are the lines.
  if (!of_revolution) folder.write(gmsh_name, meshing::gmsh_text(cases::build_mesh(one)));
  folder.set_complete(static_cast<int>(ExitCode::ok));
  cases::say("{}places:\n", meshing::format(meshing::quality(device.mesh)));
  for (const auto& [name, nodes] : device.mesh.node_sets) {
    const auto cells = device.mesh.cell_sets.find(name);
    cases::say(
        "  {:<16} {:>6} nodes{}\n", name, nodes.size(),
        cells == device.mesh.cell_sets.end() ? "" : fmt::format(" {:>6} cells", cells->second.cells.size()));
  }
  cases::say("written to {}\n", (folder / (one.source.stem().string() + "-mesh.pvd")).string());
  const bool set_off = std::ranges::any_of(one.parts, [](const cases::Part& part) {
    const auto* lattice = std::get_if<cases::Honeycomb>(&part.geometry);
    return (lattice && lattice->print == cases::WallPrint::one_face) || (part.beam && part.beam->offset != 0);
  });
  if (!of_revolution)
    cases::say("and, for gmsh and [mesh] file, to {}{}\n", (folder / gmsh_name).string(),
               set_off
                   ? "; bars above or below the film are lines of it there: a [beam] of them needs its offset"
                   : "");
  return ExitCode::ok;
}

/// Jobs find program, case and folder from wherever they start.
cases::Cluster cluster(const Arguments& arguments, const std::filesystem::path& directory) {
  cases::Cluster cluster{*arguments.slurm, arguments.batch, {}};
  cluster.command = {std::filesystem::read_symlink("/proc/self/exe"), "study",
                     std::filesystem::absolute(arguments.case_file)};
  for (const std::string& setting : arguments.overrides)
    cluster.command.insert(cluster.command.end(), {"--set", setting});
  cluster.command.insert(cluster.command.end(), {"-o", std::filesystem::absolute(directory)});
  return cluster;
}

ExitCode study(const Arguments& arguments) {
  if (arguments.points && (arguments.dry_run || arguments.slurm))
    throw std::invalid_argument(
        fmt::format("--points runs them here: leave out {}", arguments.dry_run ? "--dry-run" : "--slurm"));
  const cases::Study asked = cases::read_study(arguments.case_file, arguments.overrides);
  if (fem::better_blas_kernels())
    take_better_blas_kernels(cases::read_case(asked.base, asked.settings), arguments);
  cases::StudySettings settings{arguments.output("-study"), arguments.threads, arguments.resume};
  if (arguments.points) return run_points(asked, settings, cases::list_of(*arguments.points));
  if (arguments.slurm) settings.cluster = cluster(arguments, settings.directory);
  return arguments.dry_run ? plan_study(asked, settings) : run_study(asked, settings);
}

ExitCode fit(const Arguments& arguments) {
  const bool is_rational = cases::is_rational_fit(arguments.case_file);
  if (arguments.resume && (is_rational || cases::is_identification(arguments.case_file)))
    throw std::invalid_argument("--resume is for fits of materials: leave it out, and this one starts over");
  if (is_rational)
    return run_rational_fits(cases::read_rational_fits(arguments.case_file), arguments.output("-fit"));
  if (cases::is_identification(arguments.case_file))
    return run_identification(cases::read_identification(arguments.case_file), arguments.output("-fit"),
                              arguments.threads);
  return run_fit(cases::read_fit(arguments.case_file), {arguments.output("-fit"), arguments.resume});
}

ExitCode linearise(const Arguments& arguments) {
  const cases::Case one = cases::read_case_to_linearise(arguments.case_file, arguments.overrides);
  take_better_blas_kernels(one, arguments);
  return linearise_case(one, {arguments.output("-linear"), arguments.threads});
}

ExitCode info(const Arguments& arguments) {
  cases::show(cases::describe(arguments.topic));
  return ExitCode::ok;
}

ExitCode schema(const Arguments& /*none*/) {
  cases::say("{}\n", cases::json_schema());
  return ExitCode::ok;
}

ExitCode man(const Arguments& arguments) {
  cases::say("{}", cases::manual_page(*arguments.app));
  return ExitCode::ok;
}

ExitCode completion(const Arguments& arguments) {
  cases::say("{}", cases::completion_script(*arguments.app, arguments.shell));
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
  fem::keep_pages();
  cases::open_standard_streams();
  cases::catch_signals();

  CLI::App app;
  Arguments arguments{.words = argv};
  cases::add_commands(app, arguments);
  const std::map<std::string, ExitCode (*)(const Arguments&)> functions{
      {"run", run}, {"check", check}, {"mesh", mesh},     {"study", study}, {"linearise", linearise},
      {"fit", fit}, {"info", info},   {"schema", schema}, {"man", man},     {"completion", completion}};
  std::vector<std::string> words{argv + 1, argv + argc};
  if (!words.empty() && words.front() == "help") { // dielast help run: dielast run --help
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend())); // the last word first
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) { // --help, --version
      app.exit(error);
      return static_cast<int>(finish_output(ExitCode::ok));
    }
    cases::say(stderr, "{}\n", cases::explanation(app, error, words));
    return static_cast<int>(ExitCode::usage_or_file);
  }
  if (arguments.quiet) cases::close_standard_output();
  const std::string name = app.get_subcommands().front()->get_name();
  return static_cast<int>(finish_output(guarded(functions.at(name), arguments)));
}
