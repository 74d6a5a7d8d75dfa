// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::cases {
namespace {

/// dt_before: 0 at the start.
materials::TimeScheme scheme_for(double dt, double dt_before) {
  return dt <= 2 * dt_before ? materials::TimeScheme::bdf2(dt, dt_before)
                             : materials::TimeScheme::backward_euler(dt);
}

/// Nominal stress of a dashpot beside the law (an incompressible Newtonian liquid, Cauchy stress 2 eta D -
/// p), times l^2 over its viscosity and the rate of the stretch.
double dashpot_factor(materials::Mode mode) {
  switch (mode) {
  case materials::Mode::uniaxial:
    return 3;
  case materials::Mode::pure_shear:
    return 4;
  case materials::Mode::equal_biaxial:
    break;
  }
  return 6;
}

/// Rates of the stretch at the rows, 1/s. Where the rows follow a curve, the mean of those before and after a
/// row, which is the curve's own up to second order (that before alone would be half an interval late: a part
/// of the dashpot would look like a spring); before the row where the rate jumps far more than at the rows
/// beside it. 0 where nothing comes before.
std::vector<double> rates_of(const StretchHistory& history) {
  constexpr double corner = 4; // a curve's changes of rate from row to row are alike
  const std::size_t rows = history.stretch.size();
  std::vector<double> before(rows, 0.0), jump(rows, 0.0);
  double time = std::min(0.0, history.time.front()), l = 1;
  for (std::size_t i = 0; i < rows; ++i) {
    const double dt = history.time[i] - time;
    if (dt > 0) before[i] = (history.stretch[i] - l) / dt;
    time = history.time[i], l = history.stretch[i];
  }
  for (std::size_t i = 1; i + 1 < rows; ++i) jump[i] = before[i + 1] - before[i];
  std::vector<double> rates = before;
  for (std::size_t i = 1; i + 1 < rows; ++i)
    if (std::abs(jump[i]) <= corner * std::max(std::abs(jump[i - 1]), std::abs(jump[i + 1])))
      rates[i] += jump[i] / 2;
  return rates;
}

/// Of law and branches, with steps of second order.
std::vector<double> stress_in_steps(const materials::Material& material, const StretchHistory& history,
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

} // namespace

std::vector<double> nominal_stress(const materials::Material& of, const StretchHistory& history, int steps) {
  materials::Material material = of;
  const double viscosity = std::exchange(material.viscosity, 0.0);
  const bool timed = !history.time.empty();
  std::vector<double> stress = stress_in_steps(material, history, steps);
  if (timed && !material.branches.empty()) { // Richardson: what is left is of third order
    const std::vector<double> fine = stress_in_steps(material, history, 2 * steps);
    for (std::size_t row = 0; row < stress.size(); ++row) stress[row] = (4 * fine[row] - stress[row]) / 3;
  }
  if (!timed || viscosity == 0) return stress;
  const std::vector<double> rate = rates_of(history);
  for (std::size_t row = 0; row < stress.size(); ++row)
    stress[row] +=
        dashpot_factor(history.mode) * viscosity * rate[row] / (history.stretch[row] * history.stretch[row]);
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
