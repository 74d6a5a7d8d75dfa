// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <vector>

namespace dielast::cases {

enum class FitEnding { converged, gave_up, interrupted };

/// Residuals r (n numbers) of coordinates q (k numbers), whose squares are to become least.
struct LeastSquares {
  using Residuals = std::optional<Eigen::VectorXd>; ///< none where there is no model

  int rows = 0; ///< n
  std::function<Residuals(const Eigen::VectorXd& q)> residuals;
  /// dr/dq (n x k) where the residuals are r; empty where it is not known.
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& q, const Eigen::VectorXd& r)> jacobian;
  Eigen::VectorXd lower, upper; ///< bounds of q; empty: none
  int max_iterations = 0;
  int max_invalid_steps = 30; ///< one after another, to where there is no model
  double first_radius = 1e4;  ///< of the trust region
  double function_tolerance = 0, parameter_tolerance = 0, gradient_tolerance = 0;
  /// Converged, too, where ten steps one after another have lessened the squares by no more than this part,
  /// as along the floor of a valley.
  double crawl_tolerance = 0;
  /// After every iteration, with the rms of the residuals; false stops. May be left out.
  std::function<bool(int iteration, double rms)> on_iteration;
};

struct LeastSquaresEnd {
  FitEnding ending{};
  int iterations = 0;
  double cost = 0; ///< r.r/2; -1: the start has no model
};

/// Levenberg-Marquardt (Ceres) from `q`, which becomes the best that was found, also where it does not
/// converge.
LeastSquaresEnd minimise(const LeastSquares& problem, Eigen::VectorXd& q);

struct Differences {
  Eigen::MatrixXd slope;  ///< dr/dq; empty where one coordinate has residuals on neither side
  std::vector<bool> ends; ///< of the coordinates, up to such a one: there are residuals on one side only
};

/// Central differences over steps of +-h from q, where the residuals are r; one-sided where only one side has
/// residuals, which are asked for at all points at once.
Differences central_differences(
    const Eigen::VectorXd& q, const Eigen::VectorXd& r, double h,
    const std::function<std::vector<LeastSquares::Residuals>(const std::vector<Eigen::VectorXd>&)>&
        residuals);

} // namespace dielast::cases
