// SPDX-License-Identifier: GPL-3.0-or-later
// Whole ramps of the benchmark tasks. Counters, in ms of CPU per Newton iteration: residual, tangent, factor,
// solve, all; overhead = all / (factor + solve) of the same matrices in the same run; mesh_s and analysis_s =
// CPU for the model and for orders and places of its tangent; whole_s = CPU from the mesh to the last step,
// wall_s the time that it takes. The second argument is the number of threads;
// peak_mb = memory of the process until then, so that only the largest task of a run tells.
//   build/bin/dielast_bench --benchmark_filter=disc --benchmark_out=FILE --benchmark_out_format=json

#include "fem/machine/memory.hpp"
#include "tests/bench/models.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <ctime>
#include <sys/resource.h>

namespace dielast::bench {

namespace {

[[maybe_unused]] const bool as_the_program = (fem::keep_pages(), true);

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void run(benchmark::State& bench, Task (*make_task)(int)) {
  const int threads = static_cast<int>(bench.range(1));
  for (auto _ : bench) {
    const auto clock = std::chrono::steady_clock::now();
    const double begin = cpu_seconds();
    const Task task = make_task(static_cast<int>(bench.range(0)));
    const double meshed = cpu_seconds();
    fem::Equilibrium equilibrium(task.model, threads);
    const double start = cpu_seconds();
    fem::State state = task.model.initial_state();
    for (const auto& [target, increments] : task.steps) {
      const fem::RampOptions options{.increments = increments};
      fem::RampProgress progress = fem::RampProgress::begin(state, task.model.dofs, options);
      const auto path = fem::linear_path(task.model.dofs, progress.start, target);
      const auto result = fem::ramp(equilibrium, path, options, progress, {});
      if (result.end != fem::RampEnd::complete) return bench.SkipWithError("the ramp did not converge");
      state = progress.points.back().state;
    }
    const double all = cpu_seconds() - start;
    bench.counters["whole_s"] = cpu_seconds() - begin;
    bench.counters["wall_s"] =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
    bench.counters["mesh_s"] = meshed - begin;
    bench.counters["analysis_s"] = start - meshed;
    bench.counters["peak_mb"] = peak_megabytes();
    const fem::Timings& t = equilibrium.timings();
    const double per_iteration = 1e3 / t.iterations;
    bench.counters["residual_ms"] = t.residual * per_iteration;
    bench.counters["tangent_ms"] = t.tangent * per_iteration;
    bench.counters["factor_ms"] = t.factor * per_iteration;
    bench.counters["solve_ms"] = t.solve * per_iteration;
    bench.counters["all_ms"] = all * per_iteration;
    bench.counters["iterations"] = t.iterations;
    bench.counters["overhead"] = all / (t.factor + t.solve);
    bench.counters["factors"] = equilibrium.tangent().work().factorisations;
    bench.counters["solves"] = equilibrium.tangent().work().solves;
    bench.counters["unknowns"] = task.model.dofs.count();
    bench.counters["result_mm"] =
        1e3 * state.displacement[static_cast<std::size_t>(task.node)][task.component];
  }
}

void disc(benchmark::State& bench) { run(bench, partial_electrode_disc); }
void diaphragm(benchmark::State& bench) { run(bench, plate_diaphragm); }
void diaphragm_shell(benchmark::State& bench) { run(bench, plate_diaphragm_shell); }
void stack(benchmark::State& bench) { run(bench, stack_on_table); }

void muscle(benchmark::State& bench) {
  constexpr int threads = 1;
  for (auto _ : bench) {
    const Task task = rolled_muscle();
    const fem::DofMap& dofs = task.model.dofs;
    fem::Equilibrium equilibrium(task.model, threads);
    fem::State state = begun(task, equilibrium);
    const auto take = [&](const fem::LoadPath& path, const fem::RampOptions& options) {
      fem::RampProgress progress = fem::RampProgress::begin(state, dofs, options);
      const bool complete = fem::ramp(equilibrium, path, options, progress, {}).end == fem::RampEnd::complete;
      state = progress.points.back().state;
      return complete;
    };
    const auto& [free, increments] = task.steps.front();
    const bool let_go = take(fem::linear_path(dofs, fem::Loads::of(state, dofs), free),
                             {.increments = increments, .instantaneous = true});
    const double start = cpu_seconds();
    if (!let_go || !take(rolled_muscle_cycles(), {.increments = muscle_steps, .duration = muscle_duration}))
      return bench.SkipWithError("the ramp did not converge");
    const double moved = state.displacement[static_cast<std::size_t>(task.node)][task.component];
    bench.counters["cycles_s"] = cpu_seconds() - start;
    bench.counters["iterations"] = equilibrium.timings().iterations;
    bench.counters["stretch"] = muscle_prestretch + moved / muscle_length;
  }
}

BENCHMARK(disc)->ArgsProduct({{21, 66, 129}, {1, 2, 4}})->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(diaphragm)->ArgsProduct({{1, 2, 4}, {1, 2, 4}})->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(diaphragm_shell)->ArgsProduct({{1, 2, 4}, {1}})->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(muscle)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(stack)->ArgsProduct({{3, 4}, {1, 2, 4}})->Unit(benchmark::kMillisecond)->Iterations(1);

} // namespace

} // namespace dielast::bench
