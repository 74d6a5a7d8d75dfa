// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/time_error.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr double typical_motion = 1e-2; ///< of the extent, to which errors of the motion are compared

} // namespace

double history_error(const History& past, const History& next) {
  if (past.step_before == 0) return 0;
  const double h = next.step, h1 = past.step, h2 = past.step_before;
  // Newton's polynomial through now, before, older at h after now
  const double scheme_error = h * h * (h + h1) * (h + h1) / (6 * (2 * h + h1));
  const double predictor_error = h * (h + h1) * (h + h1 + h2) / 6;
  const double share = scheme_error / (scheme_error + predictor_error);
  double largest = 0;
  for (std::size_t i = 0; i < next.now.size(); ++i) {
    const double slope = (past.now[i] - past.before[i]) / h1;
    const double slope_before = (past.before[i] - past.older[i]) / h2;
    const double curvature = (slope - slope_before) / (h1 + h2);
    const double predicted = past.now[i] + h * slope + h * (h + h1) * curvature;
    largest = std::max(largest, std::abs(next.now[i] - predicted) / std::max(1.0, std::abs(next.now[i])));
  }
  return share * largest;
}

double motion_error(const Model& model, const GeneralisedAlpha& scheme, const Motion& past,
                    const Motion& next) {
  const auto heavy = model.inertia().mass.diagonal().array() > 0;
  const bool starts = past.step == 0; // the whole acceleration is new to backward Euler
  const double factor = starts ? scheme.dt * scheme.dt / 2 : scheme.error_factor();
  const Eigen::VectorXd change = starts ? next.acceleration : next.acceleration - past.acceleration;
  return factor * heavy.select(change.array().abs(), 0).maxCoeff() / (typical_motion * model.extent);
}

} // namespace dielast::fem
