#include "materials/line.hpp"

#include <cmath>
#include <limits>

namespace dielast::materials {

namespace {

/// A function of l with two derivatives.
struct Along {
  double value, first, second;
};

struct Curve {
  Along trace, det;
};

/// tr C and det C in the plane along a test.
Curve curve(Mode mode, double l) {
  const double l2 = l * l;
  switch (mode) {
  case Mode::uniaxial:
    return {{l2 + 1 / l, 2 * l - 1 / l2, 2 + 2 / (l2 * l)}, {l, 1, 0}};
  case Mode::pure_shear:
    return {{l2 + 1, 2 * l, 2}, {l2, 2 * l, 2}};
  case Mode::equal_biaxial:
    break;
  }
  return {{2 * l2, 4 * l, 4}, {l2 * l2, 4 * l2 * l, 12 * l2}};
}

/// Powers of xi that the principal viscous stretches are.
std::array<double, 3> powers(Mode mode) {
  switch (mode) {
  case Mode::uniaxial:
    return {1, -0.5, -0.5};
  case Mode::pure_shear:
    return {1, 0, -1};
  case Mode::equal_biaxial:
    break;
  }
  return {1, 1, -2};
}

/// What the dashpot dissipates over a step, as a function of x = ln xi.
struct Dissipation {
  Dashpot dashpot;
  double weight;
  std::array<double, 3> powers; ///< log: of exp(-2 x); weights `h` of each
  std::array<double, 3> h;
  double a0 = 1; ///< nominal: weight (a0 xi - h[0])^2

  Along at(double x) const {
    if (dashpot == Dashpot::nominal) {
      const double xi = std::exp(x), step = a0 * xi - h[0];
      return {weight * step * step, 2 * weight * a0 * xi * step, 2 * weight * a0 * xi * (step + a0 * xi)};
    }
    Along sum{-3 * weight * std::cbrt(h[0] * h[1] * h[2]), 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      const double rate = -2 * powers[i], term = weight * h[i] * std::exp(rate * x);
      sum.value += term;
      sum.first += rate * term;
      sum.second += rate * rate * term;
    }
    return sum;
  }
};

Dissipation dissipation(const Branch& branch, Mode mode, const TimeScheme& scheme, double now,
                        double before) {
  const TimeScheme euler = TimeScheme::backward_euler(scheme.dt);
  const bool extrapolates = scheme.h2 != 0;
  Dissipation d{branch.dashpot, branch.viscosity / (2 * scheme.dt), powers(mode), {}};
  const auto fill = [&](const TimeScheme& s) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double power = d.dashpot == Dashpot::log ? 2 * d.powers[i] : 1;
      d.h[i] = s.h1 * std::pow(now, power) + (extrapolates ? s.h2 * std::pow(before, power) : 0);
    }
    return d.h[0] > 0 && d.h[1] > 0 && d.h[2] > 0;
  };
  const bool positive = fill(scheme);
  if (!positive) fill(euler);
  if (d.dashpot == Dashpot::nominal) {
    d.a0 = positive ? scheme.a0 : 1;
    d.weight *= (mode == Mode::equal_biaxial ? 2 : 1) / d.a0;
  }
  return d;
}

/// W_b(l exp(-x)) and the dissipation over the step, in l and x.
struct StepPotential {
  double value, l, x, ll, lx, xx;
};

StepPotential step_potential(const Branch& branch, Mode mode, const Dissipation& dissipation, double l,
                             double x) {
  const double shrink = std::exp(-x), elastic = l * shrink;
  const LinePotential w = line_potential(branch.law, mode, elastic);
  const Along d = dissipation.at(x);
  return {w.value + d.value,
          w.first * shrink,
          -w.first * elastic + d.first,
          w.second * shrink * shrink,
          -(w.second * elastic + w.first) * shrink,
          (w.second * elastic + w.first) * elastic + d.second};
}

struct Settled {
  StepPotential potential;
  double x;
};

/// Damped Newton for the x that minimises the step potential at l.
Settled settle(const Branch& branch, Mode mode, const Dissipation& dissipation, double l, double x) {
  StepPotential at = step_potential(branch, mode, dissipation, l, x);
  for (int iteration = 0; iteration < 60 && std::isfinite(at.value); ++iteration) {
    double step = -at.x / std::abs(at.xx);
    const bool last = at.xx > 0 && std::abs(step) <= 1e-8; // one more step reaches the last digits
    const double noise = 1e-14 * std::abs(at.xx);
    for (int halving = 0; halving < 40; ++halving, step /= 2) {
      const StepPotential trial = step_potential(branch, mode, dissipation, l, x + step);
      if (!(trial.value <= at.value + noise)) continue;
      x += step;
      at = trial;
      break;
    }
    if (last) return {at, x};
  }
  at.value = std::numeric_limits<double>::quiet_NaN();
  return {at, x};
}

/// From where the dashpot was, or, where the law cannot be there, from the relaxed state.
Settled settle(const Branch& branch, Mode mode, double l, const TimeScheme& scheme, double now,
               double before) {
  const Dissipation d = dissipation(branch, mode, scheme, now, before);
  const Settled settled = settle(branch, mode, d, l, std::log(now));
  return std::isfinite(settled.potential.value) ? settled : settle(branch, mode, d, l, std::log(l));
}

} // namespace

LinePotential line_potential(const ElasticLaw& law, Mode mode, double l) {
  if (const auto* solid = std::get_if<StVenantKirchhoff>(&law); solid && mode == Mode::uniaxial) {
    const double Y = solid->youngs_modulus, strain = (l * l - 1) / 2;
    return {Y / 2 * strain * strain, Y * strain * l, Y * (strain + l * l)};
  }
  const Curve along = curve(mode, l);
  const Along &T = along.trace, &D = along.det;
  const PlanarDerivatives<double> w =
      std::visit([&](const auto& one) { return planar(one, T.value, D.value); }, law);
  return {w.value, w.dT * T.first + w.dD * D.first,
          w.dT * T.second + w.dD * D.second + w.dTT * T.first * T.first + 2 * w.dTD * T.first * D.first +
              w.dDD * D.first * D.first};
}

LinePotential line_branch_potential(const Branch& branch, Mode mode, double l, const TimeScheme& scheme,
                                    double now, double before) {
  if (scheme.is_relaxed()) return {};
  if (scheme.is_frozen()) {
    const LinePotential w = line_potential(branch.law, mode, l / now);
    return {w.value, w.first / now, w.second / (now * now)};
  }
  const StepPotential at = settle(branch, mode, l, scheme, now, before).potential;
  return {at.value, at.l, at.ll - at.lx * at.lx / at.xx};
}

double line_branch_advance(const Branch& branch, Mode mode, double l, const TimeScheme& scheme, double now,
                           double before) {
  if (scheme.is_relaxed()) return l;
  if (scheme.is_frozen()) return now;
  return std::exp(settle(branch, mode, l, scheme, now, before).x);
}

} // namespace dielast::materials
