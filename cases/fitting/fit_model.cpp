// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::cases {
namespace {

/// dt_before: 0 at the start.
materials::TimeScheme scheme_for(double dt, double dt_before) {
  return dt <= 2 * dt_before ? materials::TimeScheme::bdf2(dt, dt_before)
                             : materials::TimeScheme::backward_euler(dt);
}

} // namespace

std::vector<double> nominal_stress(const materials::Material& material, const StretchHistory& history,
                                   int steps) {
  const bool timed = !history.time.empty();
  const bool flows = timed && !material.branches.empty();
  materials::MaterialPoint point(material, history.mode);
  std::vector<double> stress;
  double time = timed ? std::min(0.0, history.time.front()) : 0, dt_before = 0, l = 1;
  for (std::size_t row = 0; row < history.stretch.size(); ++row) {
    const double goal = history.stretch[row];
    const double dt = flows ? (history.time[row] - time) / steps : 0;
    if (dt > 0) {
      for (int step = 1; step <= steps; ++step) {
        point.accept(l + (goal - l) * step / steps, scheme_for(dt, dt_before));
        dt_before = dt;
      }
      time = history.time[row];
    }
    l = goal;
    stress.push_back(
        point.stress(l, timed ? materials::TimeScheme::frozen() : materials::TimeScheme::relaxed()));
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
