// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/text/waveform.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

namespace dielast::test {

/// Works and heat of a run, J.
struct Account {
  double electrical = 0, mechanical = 0, dissipated = 0, resistance = 0, leak = 0;
};

/// A homogeneous neo-Hookean film with branches, integrated by the classical Runge-Kutta method in steps far
/// below its relaxation times, works by the trapezoidal rule along them. Knows nothing of the solver.
class PatchOracle {
 public:
  struct Branch {
    double modulus = 0, time = 0; ///< Pa, s
    bool nominal = false;
  };
  /// What is prescribed at a moment: per axis its stretch or its nominal stress; at the electrode its
  /// voltage, its charge or the voltage of its source.
  struct Loads {
    std::array<double, 2> along{};
    double electrode = 0;
  };
  enum class Supply { voltage, charge, circuit };

  double modulus = 0, permittivity = 0, thickness = 1e-3, volume = 1e-7;
  std::vector<Branch> branches;
  std::array<bool, 2> held{}; ///< whether the stretch of an axis is given
  bool alike = false;         ///< both axes have one stretch
  Supply supply = Supply::voltage;
  double resistance = 0, leakage = 0, current_limit = 1e300;

  Account account;

  PatchOracle() = default;
  /// To be called when everything is set: the film as drawn, without loads.
  void begin() { viscous_ = Eigen::VectorXd::Ones(2 * std::ssize(branches)); }

  /// Loads change at once, straight, while nothing flows.
  void jump(const Loads& from, const Loads& to) {
    constexpr int parts = 400;
    const auto between = [&](double s) {
      Loads loads;
      for (std::size_t i = 0; i < 2; ++i) loads.along[i] = (1 - s) * from.along[i] + s * to.along[i];
      loads.electrode = (1 - s) * from.electrode + s * to.electrode;
      return loads;
    };
    Film now = film(between(0), viscous_, charge_);
    for (int part = 1; part <= parts; ++part) {
      const Film next = film(between(static_cast<double>(part) / parts), viscous_, charge_);
      add_works(now, next);
      now = next;
    }
  }
  /// Time passes from t0 to t1 in equal steps.
  void pass(const std::function<Loads(double)>& loads, double t0, double t1, int steps) {
    const double h = (t1 - t0) / steps;
    Film now = film(loads(t0), viscous_, charge_);
    for (int step = 0; step < steps; ++step) {
      const double t = t0 + step * h;
      const Rates k1 = rates(now), k2 = rates(moved(loads(t + h / 2), k1, h / 2)),
                  k3 = rates(moved(loads(t + h / 2), k2, h / 2)), k4 = rates(moved(loads(t + h), k3, h));
      const auto mean = [h](const auto& a, const auto& b, const auto& c, const auto& d) {
        return (h / 6 * (a + 2 * b + 2 * c + d));
      };
      viscous_ += mean(k1.viscous, k2.viscous, k3.viscous, k4.viscous).eval();
      charge_ += mean(k1.charge, k2.charge, k3.charge, k4.charge);
      account.dissipated += mean(k1.heat, k2.heat, k3.heat, k4.heat);
      account.resistance += mean(k1.resistance, k2.resistance, k3.resistance, k4.resistance);
      account.leak += mean(k1.leak, k2.leak, k3.leak, k4.leak);
      const Film next = film(loads(t + h), viscous_, charge_);
      add_works(now, next);
      now = next;
    }
  }

 private:
  struct Film {
    std::array<double, 2> stretch{1, 1}, stress{}; ///< nominal, Pa
    double voltage = 0, charge = 0, source = 0;
    Eigen::VectorXd viscous;
  };
  struct Rates {
    Eigen::VectorXd viscous;
    double charge = 0, heat = 0, resistance = 0, leak = 0;
  };

  double capacitance(const std::array<double, 2>& l) const {
    return permittivity * volume / (thickness * thickness) * l[0] * l[0] * l[1] * l[1];
  }
  /// Adds slope and curvature of a spring's energy per volume.
  static void add_spring(double modulus, const std::array<double, 2>& l, double x, double y,
                         Eigen::Vector2d& slope, Eigen::Matrix2d& curvature) {
    const double a = l[0] / x, b = l[1] / y, ab = 1 / (a * a * b * b);
    slope += modulus * Eigen::Vector2d((a - ab / a) / x, (b - ab / b) / y);
    curvature += modulus * Eigen::Matrix2d{{(1 + 3 * ab / (a * a)) / (x * x), 2 * ab / (a * b) / (x * y)},
                                           {2 * ab / (a * b) / (x * y), (1 + 3 * ab / (b * b)) / (y * y)}};
  }
  /// Equilibrium with these internal variables.
  Film film(const Loads& loads, const Eigen::VectorXd& viscous, double charge) const {
    Film film{.stretch = guess_, .viscous = viscous};
    const bool given = supply == Supply::voltage;
    film.charge = supply == Supply::charge ? loads.electrode : charge;
    film.source = loads.electrode;
    for (std::size_t i = 0; i < 2; ++i)
      if (held[i]) film.stretch[i] = loads.along[i];
    auto& l = film.stretch;
    for (int iteration = 0;; ++iteration) {
      Eigen::Vector2d slope = Eigen::Vector2d::Zero();
      Eigen::Matrix2d curvature = Eigen::Matrix2d::Zero();
      add_spring(modulus, l, 1, 1, slope, curvature);
      for (std::size_t b = 0; b < branches.size(); ++b)
        add_spring(branches[b].modulus, l, viscous[2 * static_cast<Eigen::Index>(b)],
                   viscous[2 * static_cast<Eigen::Index>(b) + 1], slope, curvature);
      film.voltage = given ? loads.electrode : film.charge / capacitance(l);
      const double field = film.voltage / thickness, k = permittivity * field * field, u = l[0], v = l[1];
      slope -= k * Eigen::Vector2d(u * v * v, u * u * v);
      curvature += given ? Eigen::Matrix2d{{-k * v * v, -2 * k * u * v}, {-2 * k * u * v, -k * u * u}}
                         : Eigen::Matrix2d{{3 * k * v * v, 2 * k * u * v}, {2 * k * u * v, 3 * k * u * u}};
      film.stress = {slope[0], slope[1]};
      Eigen::Vector2d step = Eigen::Vector2d::Zero();
      const auto lack = [&](int i) { return loads.along[static_cast<std::size_t>(i)] - slope[i]; };
      if (alike)
        step.setConstant((lack(0) + lack(1)) / curvature.sum());
      else if (!held[0] && !held[1])
        step = curvature.inverse() * Eigen::Vector2d(lack(0), lack(1));
      else
        for (int i = 0; i < 2; ++i)
          if (!held[static_cast<std::size_t>(i)]) step[i] = lack(i) / curvature(i, i);
      l[0] += step[0];
      l[1] += step[1];
      if (step.norm() < 1e-13 || iteration == 60) break;
    }
    if (given) film.charge = film.voltage * capacitance(l);
    for (std::size_t i = 0; i < 2; ++i)
      if (!held[i]) film.stress[i] = loads.along[i];
    guess_ = l;
    return film;
  }
  Rates rates(const Film& film) const {
    Rates rates{.viscous = Eigen::VectorXd::Zero(film.viscous.size())};
    for (std::size_t b = 0; b < branches.size(); ++b) {
      const auto at = 2 * static_cast<Eigen::Index>(b);
      const Branch& branch = branches[b];
      const double x = film.viscous[at], y = film.viscous[at + 1];
      const double u = film.stretch[0] / x, v = film.stretch[1] / y, w = 1 / (u * v);
      if (branch.nominal) {
        const double viscosity = branch.modulus * branch.time;
        rates.viscous[at] = branch.modulus * (u * u - w * w) / x / viscosity;
        rates.viscous[at + 1] = branch.modulus * (v * v - w * w) / y / viscosity;
        rates.heat += volume * viscosity * rates.viscous.segment<2>(at).squaredNorm();
      } else {
        const double mean = (u * u + v * v + w * w) / 3;
        const Eigen::Vector3d drive = Eigen::Vector3d(u * u, v * v, w * w).array() - mean;
        rates.viscous[at] = x * drive[0] / (2 * branch.time);
        rates.viscous[at + 1] = y * drive[1] / (2 * branch.time);
        rates.heat += volume * branch.modulus / (2 * branch.time) * drive.squaredNorm();
      }
    }
    if (supply == Supply::circuit) {
      const double drop = film.source - film.voltage;
      const double current = std::clamp(drop / resistance, -current_limit, current_limit);
      rates.charge = current - leakage * film.voltage;
      rates.resistance = drop * current;
      rates.leak = leakage * film.voltage * film.voltage;
    }
    return rates;
  }
  Film moved(const Loads& loads, const Rates& rates, double h) const {
    return film(loads, viscous_ + h * rates.viscous, charge_ + h * rates.charge);
  }
  void add_works(const Film& from, const Film& to) {
    account.electrical += (from.voltage + to.voltage) / 2 * (to.charge - from.charge);
    for (std::size_t i = 0; i < 2; ++i)
      account.mechanical += volume * (from.stress[i] + to.stress[i]) / 2 * (to.stretch[i] - from.stretch[i]);
  }

  Eigen::VectorXd viscous_;
  double charge_ = 0; ///< behind a circuit, C
  mutable std::array<double, 2> guess_{1, 1};
};

} // namespace dielast::test
