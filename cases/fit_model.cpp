#include "cases/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::cases {
namespace {

/// Viscous stretch of a branch at the last two times.
struct Memory {
  double now = 1, before = 1;
};

/// dt_before: 0 at the start.
materials::TimeScheme scheme_for(double dt, double dt_before) {
  return dt <= 2 * dt_before ? materials::TimeScheme::bdf2(dt, dt_before)
                             : materials::TimeScheme::backward_euler(dt);
}

/// Nominal stress of the law and of the branches at their viscous stretches. Beyond the limit of a law the
/// energy is not a number, but its derivative may be one.
double pulled(const materials::Material& material, materials::Mode mode, double l,
              const std::vector<Memory>& memory) {
  materials::LinePotential sum = line_potential(material.law, mode, l);
  for (std::size_t b = 0; b < memory.size(); ++b) {
    const materials::LinePotential branch = line_branch_potential(
        material.branches[b], mode, l, materials::TimeScheme::frozen(), memory[b].now, memory[b].before);
    sum.value += branch.value, sum.first += branch.first;
  }
  if (!std::isfinite(sum.value)) return std::numeric_limits<double>::quiet_NaN();
  return mode == materials::Mode::equal_biaxial ? sum.first / 2 : sum.first;
}

} // namespace

std::vector<double> nominal_stress(const materials::Material& material, const StretchHistory& history,
                                   int steps) {
  const bool timed = !history.time.empty();
  std::vector<Memory> memory(timed ? material.branches.size() : 0);
  std::vector<double> stress;
  double time = timed ? std::min(0.0, history.time.front()) : 0, dt_before = 0, l = 1;
  for (std::size_t row = 0; row < history.stretch.size(); ++row) {
    const double goal = history.stretch[row];
    const double dt = timed ? (history.time[row] - time) / steps : 0;
    if (dt > 0) {
      for (int step = 1; step <= steps; ++step) {
        const materials::TimeScheme scheme = scheme_for(dt, dt_before);
        const double here = l + (goal - l) * step / steps;
        for (std::size_t b = 0; b < memory.size(); ++b) {
          const double next = line_branch_advance(material.branches[b], history.mode, here, scheme,
                                                  memory[b].now, memory[b].before);
          memory[b] = {next, memory[b].now};
        }
        dt_before = dt;
      }
      time = history.time[row];
    }
    l = goal;
    stress.push_back(pulled(material, history.mode, l, memory));
  }
  return stress;
}

int steps_needed(const materials::Material& material, const StretchHistory& history, double tolerance,
                 int at_least) {
  constexpr int most = 1024;
  if (history.time.empty() || material.branches.empty()) return at_least;
  std::vector<double> coarse = nominal_stress(material, history, at_least);
  for (int steps = at_least; steps < most; steps *= 2) {
    std::vector<double> fine = nominal_stress(material, history, 2 * steps);
    double change = 0, largest = 0;
    for (std::size_t row = 0; row < fine.size(); ++row) {
      if (!std::isfinite(fine[row])) continue;
      change = std::max(change, std::abs(fine[row] - coarse[row]));
      largest = std::max(largest, std::abs(fine[row]));
    }
    if (change <= tolerance * largest) return steps;
    coarse = std::move(fine);
  }
  return most;
}

} // namespace dielast::cases
