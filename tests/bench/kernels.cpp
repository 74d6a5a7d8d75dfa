// SPDX-License-Identifier: GPL-3.0-or-later
// Assembly alone: time per element of residual and tangent, planar and in space, of films and of tetrahedra,
// with one and two threads.

#include "tests/bench/models.hpp"

#include <benchmark/benchmark.h>

namespace dielast::bench {

namespace {

enum class What { residual, tangent };

void assemble(benchmark::State& bench, const Task& task, What what) {
  fem::Assembler assembler(task.model, static_cast<int>(bench.range(0)));
  const fem::State state = task.model.initial_state();
  Eigen::VectorXd force;
  for (auto _ : bench) {
    if (what == What::residual)
      assembler.residual(state, force);
    else
      assembler.tangent(state);
  }
  const double elements = task.mesh.blocks.front().size();
  bench.counters["per_element"] = benchmark::Counter(elements, benchmark::Counter::kIsIterationInvariantRate |
                                                                   benchmark::Counter::kInvert);
}

void planar_residual(benchmark::State& bench) { assemble(bench, partial_electrode_disc(66), What::residual); }
void planar_tangent(benchmark::State& bench) { assemble(bench, partial_electrode_disc(66), What::tangent); }
void spatial_residual(benchmark::State& bench) { assemble(bench, plate_diaphragm(3), What::residual); }
void spatial_tangent(benchmark::State& bench) { assemble(bench, plate_diaphragm(3), What::tangent); }
void shell_residual(benchmark::State& bench) { assemble(bench, plate_diaphragm_shell(3), What::residual); }
void shell_tangent(benchmark::State& bench) { assemble(bench, plate_diaphragm_shell(3), What::tangent); }
void solid_residual(benchmark::State& bench) { assemble(bench, stack_on_table(3), What::residual); }
void solid_tangent(benchmark::State& bench) { assemble(bench, stack_on_table(3), What::tangent); }

BENCHMARK(planar_residual)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(planar_tangent)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(spatial_residual)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(spatial_tangent)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(shell_residual)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(shell_tangent)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(solid_residual)->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(solid_tangent)->Arg(1)->Arg(2)->UseRealTime();

} // namespace

} // namespace dielast::bench
