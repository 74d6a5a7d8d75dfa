// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/fit_starts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dielast::cases {
namespace {

bool is_limit(const FitParameter& parameter) {
  return parameter.unit == "1" && std::isfinite(parameter.above);
}

class OtherStarts {
 public:
  OtherStarts(const FitTask& task, const std::vector<Coordinate>& coordinates, const std::vector<int>& steps)
      : task_(task), coordinates_(coordinates), misfit_(task, coordinates, steps), steps_(steps) {}

  std::vector<FitStart> from(Eigen::VectorXd q, const Eigen::VectorXd& ended) const {
    constexpr std::array<std::array<double, 2>, 3> ladders{{{1.3, 3}, {2, 2.5}, {2, -1}}};
    bool exponents = false, limits = false;
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      exponents = exponents || is_exponent(task_.parameters[i]);
      limits = limits || has_run_away(task_.parameters[i], coordinates_[i],
                                      ended[static_cast<Eigen::Index>(i)], q[static_cast<Eigen::Index>(i)]);
    }
    spread_times(q);
    std::vector<FitStart> starts{{q}};
    for (std::size_t i = 0; i < (exponents ? ladders.size() : limits ? 1 : 0); ++i) {
      starts.push_back({q});
      near_limits(starts.back().q);
      set_exponents(starts.back(), ladders[i][0], ladders[i][1]);
    }
    for (FitStart& start : starts) scale_moduli(start.q);
    return starts;
  }

 private:
  void set(Eigen::VectorXd& q, std::size_t i, double p) const {
    const Coordinate& c = coordinates_[i];
    q[static_cast<Eigen::Index>(i)] = std::clamp(c.q(p), c.lower, c.upper);
  }

  void spread_times(Eigen::VectorXd& q) const {
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (const MeasuredTest& test : task_.tests)
      for (std::size_t i = 1; !test.predict && i < test.history.time.size(); ++i) {
        shortest = std::min(shortest, test.history.time[i] - test.history.time[i - 1]);
        longest = std::max(longest, test.history.time[i] - test.history.time[0]);
      }
    std::vector<std::size_t> times;
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      if (task_.parameters[i].unit == "s") times.push_back(i);
    for (std::size_t n = 0; n < times.size() && longest > 0; ++n) {
      const double part = static_cast<double>(n + 1) / static_cast<double>(times.size() + 1);
      set(q, times[n], shortest * std::pow(longest / shortest, part));
    }
  }

  void near_limits(Eigen::VectorXd& q) const {
    constexpr double above_least = 1.3;
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      if (!is_limit(task_.parameters[i])) continue;
      Eigen::VectorXd at = q;
      double& one = at[static_cast<Eigen::Index>(i)];
      double never = coordinates_[i].lower, stands = one;
      one = never;
      if (misfit_.residuals(at)) continue; // no limit
      for (int half = 0; half < 20; ++half) {
        one = (never + stands) / 2;
        (misfit_.residuals(at) ? stands : never) = one;
      }
      set(q, i, above_least * coordinates_[i].p(stands));
    }
  }

  /// Terms that bear alike at the largest stretch of the tests, their moduli as logarithms: terms against one
  /// another lead to two alike.
  void set_exponents(FitStart& start, double first, double rise) const {
    double largest = 1;
    for (const MeasuredTest& test : task_.tests)
      for (const double l : test.history.stretch)
        if (!test.predict) largest = std::max(largest, l);
    std::map<std::string, double> next; // exponent of each law
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      if (!is_exponent(task_.parameters[i])) continue;
      const std::string& name = task_.parameters[i].name;
      const std::size_t list = name.rfind("exponents[");
      const std::string law = name.substr(0, list), term = name.substr(name.find('[', list));
      double& exponent = next.try_emplace(law, first).first->second;
      set(start.q, i, exponent);
      for (std::size_t m = 0; m < coordinates_.size(); ++m)
        if (task_.parameters[m].name == law + "moduli" + term) {
          set(start.q, m,
              std::copysign(materials::initial_shear_modulus(task_.start.law), exponent) *
                  std::pow(largest, first - std::abs(exponent)));
          start.signs[m] = exponent;
        }
      exponent = rise > 0 ? exponent + rise : rise * exponent;
    }
  }

  void scale_moduli(Eigen::VectorXd& q) const {
    double measured = 0, model = 0;
    const materials::Material here = misfit_.material(q);
    for (std::size_t f = 0; f < task_.tests.size(); ++f) {
      const MeasuredTest& test = task_.tests[f];
      if (test.predict) continue;
      const std::vector<double> stress = nominal_stress(here, test.history, steps_[f]);
      const double scale = test.weight / test.largest_stress();
      for (std::size_t i = 0; i < stress.size(); ++i) {
        measured += scale * scale * stress[i] * test.stress[i];
        model += scale * scale * stress[i] * stress[i];
      }
    }
    if (measured <= 0 || !std::isfinite(model)) return;
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      if (task_.parameters[i].unit.starts_with("Pa"))
        set(q, i, coordinates_[i].p(q[static_cast<Eigen::Index>(i)]) * measured / model);
  }

  const FitTask& task_;
  const std::vector<Coordinate>& coordinates_;
  Misfit misfit_;
  const std::vector<int>& steps_;
};

} // namespace

bool is_exponent(const FitParameter& parameter) {
  return parameter.unit == "1" && !std::isfinite(parameter.above);
}

bool has_run_away(const FitParameter& parameter, const Coordinate& coordinate, double q, double start) {
  constexpr double far = 10;
  return is_limit(parameter) && (coordinate.at_bound(q) || coordinate.p(q) > far * coordinate.p(start));
}

std::vector<FitStart> other_starts(const FitTask& task, const std::vector<Coordinate>& coordinates,
                                   const std::vector<int>& steps, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& ended) {
  return OtherStarts(task, coordinates, steps).from(q, ended);
}

} // namespace dielast::cases
