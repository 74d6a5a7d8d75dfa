// SPDX-License-Identifier: GPL-3.0-or-later
// B3: `dielast run` of the gallery's honeycomb as a user starts it, with mesh, error estimate, series and
// report, on one thread. Counters: run_s = CPU of that process; cholmod_ms = CPU of CHOLMOD's supernodal
// factor of its tangent as drawn in the same run, on one thread; target_s = what the run may take at that
// speed of the machine, 1 s where CHOLMOD takes 35 ms.

#include "cases/devices/device.hpp"
#include "cases/readers/reader.hpp"
#include "fem/algebra/cholmod_session.hpp"
#include "fem/machine/one_thread.hpp"
#include "fem/model/assembler.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dielast::bench {

namespace {

const std::filesystem::path honeycomb_case =
    std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/honeycomb/case.toml";

/// CPU of the whole process, in which OpenMP threads would count, too; the least of some, s.
double seconds_of_cholmod(const fem::SparseSymmetric& matrix) {
  constexpr int times = 20;
  const fem::OneThread one_thread;
  fem::CholmodSession session;
  session.common.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse K = fem::cholmod_pattern(matrix.column_start, matrix.rows);
  K.xtype = CHOLMOD_REAL;
  K.x = const_cast<double*>(matrix.values.data());
  cholmod_factor* L = cholmod_analyze(&K, &session.common);
  double least = INFINITY;
  for (int i = 0; i < times; ++i) {
    const std::clock_t begin = std::clock();
    if (!cholmod_factorize(&K, L, &session.common) || session.common.status != CHOLMOD_OK)
      throw std::runtime_error("CHOLMOD does not factor the honeycomb's tangent");
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  cholmod_free_factor(&L, &session.common);
  return least;
}

/// CPU of the program, user and system, s.
double run_program() {
  const auto results = std::filesystem::temp_directory_path() / ("dielast_bench_" + std::to_string(getpid()));
  const pid_t process = fork();
  if (process == 0) {
    execl(DIELAST_PROGRAM, DIELAST_PROGRAM, "run", honeycomb_case.c_str(), "-q", "-j1", "-o", results.c_str(),
          nullptr);
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  wait4(process, &status, 0, &usage);
  std::filesystem::remove_all(results);
  if (status != 0) throw std::runtime_error("dielast run of the honeycomb failed");
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * t.tv_usec; };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void honeycomb(benchmark::State& bench) {
  constexpr double of_target = 35e-3; // CHOLMOD's factor where the run may take 1 s
  const cases::Device device = cases::build_device(cases::read_case(honeycomb_case));
  fem::Assembler assembler(device.model, 1);
  assembler.tangent(device.model.initial_state());
  for (auto _ : bench) {
    bench.counters["run_s"] = run_program();
    const double factor = seconds_of_cholmod(assembler.matrix());
    bench.counters["cholmod_ms"] = 1e3 * factor;
    bench.counters["target_s"] = factor / of_target;
    bench.counters["unknowns"] = assembler.matrix().size;
  }
}

BENCHMARK(honeycomb)->Unit(benchmark::kMillisecond)->Iterations(1);

} // namespace

} // namespace dielast::bench
