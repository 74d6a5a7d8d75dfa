// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/fitting/fit_solver.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::cases {

/// A parameter as the solver sees it: unbounded in scale.
class Coordinate {
 public:
  Coordinate(const FitParameter& parameter, double start, double modulus, double range)
      : logarithmic_(std::isfinite(parameter.above)) {
    if (logarithmic_) {
      origin_ = parameter.above;
      lower = q(start) - std::log(range), upper = q(start) + std::log(range);
      if (std::isfinite(parameter.below)) upper = std::min(upper, q(parameter.below));
    } else {
      scale_ = start != 0 ? std::abs(start) : parameter.unit == "Pa" ? modulus : 1;
      lower = -range, upper = range;
    }
  }
  /// One of any sign as a logarithm, of the sign of `sign`.
  Coordinate of_sign(double sign) const {
    Coordinate signed_one = *this;
    signed_one.logarithmic_ = true;
    signed_one.scale_ = std::copysign(1, sign);
    signed_one.upper = std::log(upper * scale_);
    signed_one.lower = 2 * std::log(scale_) - signed_one.upper;
    return signed_one;
  }
  double q(double p) const { return logarithmic_ ? std::log((p - origin_) / scale_) : p / scale_; }
  double p(double q) const { return logarithmic_ ? origin_ + scale_ * std::exp(q) : scale_ * q; }
  bool at_bound(double q) const {
    const double near = 1e-6 * (upper - lower);
    return q <= lower + near || q >= upper - near;
  }

  double lower = 0, upper = 0;

 private:
  bool logarithmic_;
  double origin_ = 0, scale_ = 1;
};

/// The residuals as a function of the coordinates.
class Misfit {
 public:
  Misfit(const FitTask& task, const std::vector<Coordinate>& coordinates, const std::vector<int>& steps)
      : task_(task), coordinates_(coordinates), steps_(steps) {}

  int rows() const {
    int all = 0;
    for (const MeasuredTest& test : task_.tests)
      if (!test.predict) all += static_cast<int>(test.stress.size());
    return all;
  }
  materials::Material material(const Eigen::VectorXd& q) const {
    materials::Material changed = task_.start;
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      task_.parameters[i].set(changed, coordinates_[i].p(q[static_cast<Eigen::Index>(i)]));
    return changed;
  }
  LeastSquares::Residuals residuals(const Eigen::VectorXd& q) const {
    Eigen::VectorXd r(rows());
    const materials::Material changed = material(q);
    Eigen::Index row = 0;
    for (std::size_t f = 0; f < task_.tests.size(); ++f) {
      const MeasuredTest& test = task_.tests[f];
      if (test.predict) continue;
      const std::vector<double> model = nominal_stress(changed, test.history, steps_[f]);
      const double scale = test.weight / test.largest_stress();
      for (std::size_t i = 0; i < model.size(); ++i) r[row++] = scale * (model[i] - test.stress[i]);
    }
    return r.allFinite() ? std::optional(r) : std::nullopt;
  }
  Differences differences(const Eigen::VectorXd& q, const Eigen::VectorXd& r) const {
    return central_differences(q, r, 1e-4, [&](const std::vector<Eigen::VectorXd>& points) {
      std::vector<LeastSquares::Residuals> all;
      for (const Eigen::VectorXd& point : points) all.push_back(residuals(point));
      return all;
    });
  }

 private:
  const FitTask& task_;
  const std::vector<Coordinate>& coordinates_;
  const std::vector<int>& steps_;
};

} // namespace dielast::cases
