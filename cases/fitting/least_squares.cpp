// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/least_squares.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

class Residuals final : public ceres::CostFunction {
 public:
  Residuals(const LeastSquares& problem, Eigen::Index coordinates) : problem_(problem), at_(coordinates) {
    set_num_residuals(problem.rows);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(coordinates));
  }
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(parameters[0], at_.size());
    if (!known_ || q != at_) {
      known_ = problem_.residuals(q);
      at_ = q;
    }
    if (!known_) return false;
    std::copy(known_->begin(), known_->end(), residuals);
    if (!jacobians || !jacobians[0]) return true;
    const Eigen::MatrixXd slope = problem_.jacobian(q, *known_);
    if (slope.size() == 0) return false;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobians[0], slope.rows(), slope.cols()) = slope;
    return true;
  }

 private:
  const LeastSquares& problem_;
  mutable Eigen::VectorXd at_; ///< Ceres asks for residuals, and then for them and the Jacobian
  mutable LeastSquares::Residuals known_;
};

/// Tells how the iteration goes on, and stops it.
class Follower final : public ceres::IterationCallback {
 public:
  explicit Follower(const LeastSquares& problem) : problem_(problem) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
    constexpr std::size_t steps = 10;
    if (now.iteration > 0) ++iterations;
    if (now.step_is_successful || now.iteration == 0) costs_.push_back(now.cost);
    const double cost = costs_.back();
    if (problem_.on_iteration && !problem_.on_iteration(iterations, std::sqrt(2 * cost / problem_.rows))) {
      stopped = true;
      return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    }
    const bool crawls =
        costs_.size() > steps && costs_[costs_.size() - 1 - steps] - cost <= problem_.crawl_tolerance * cost;
    if (crawls) {
      arrived = true;
      return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    }
    return ceres::SOLVER_CONTINUE;
  }

  int iterations = 0;
  bool stopped = false, arrived = false;

 private:
  const LeastSquares& problem_;
  std::vector<double> costs_; ///< at the start and after each step that was taken
};

} // namespace

LeastSquaresEnd minimise(const LeastSquares& problem, Eigen::VectorXd& q) {
  Residuals residuals(problem, q.size());
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem solved(ownership);
  solved.AddResidualBlock(&residuals, nullptr, q.data());
  for (Eigen::Index i = 0; i < problem.lower.size(); ++i) {
    solved.SetParameterLowerBound(q.data(), static_cast<int>(i), problem.lower[i]);
    solved.SetParameterUpperBound(q.data(), static_cast<int>(i), problem.upper[i]);
  }
  Follower follower(problem);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = problem.max_iterations;
  options.max_num_consecutive_invalid_steps = problem.max_invalid_steps;
  options.initial_trust_region_radius = problem.first_radius;
  options.function_tolerance = problem.function_tolerance;
  options.parameter_tolerance = problem.parameter_tolerance;
  options.gradient_tolerance = problem.gradient_tolerance;
  options.update_state_every_iteration = true; // the best so far survives an interrupt
  options.callbacks.push_back(&follower);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &solved, &summary);
  const bool converged = follower.arrived || summary.termination_type == ceres::CONVERGENCE;
  const FitEnding ending = follower.stopped ? FitEnding::interrupted
                           : converged      ? FitEnding::converged
                                            : FitEnding::gave_up;
  return {ending, follower.iterations, summary.final_cost};
}

Differences central_differences(
    const Eigen::VectorXd& q, const Eigen::VectorXd& r, double h,
    const std::function<std::vector<LeastSquares::Residuals>(const std::vector<Eigen::VectorXd>&)>&
        residuals) {
  std::vector<Eigen::VectorXd> points;
  for (Eigen::Index i = 0; i < q.size(); ++i)
    for (const double step : {h, -h}) {
      points.push_back(q);
      points.back()[i] += step;
    }
  const std::vector<LeastSquares::Residuals> all = residuals(points);
  Differences found{Eigen::MatrixXd(r.size(), q.size()), {}};
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const auto &ahead = all[static_cast<std::size_t>(2 * i)],
               &behind = all[static_cast<std::size_t>(2 * i + 1)];
    if (!ahead && !behind) return {{}, std::move(found.ends)};
    found.ends.push_back(!ahead || !behind);
    found.slope.col(i) =
        (ahead.value_or(r) - behind.value_or(r)) / (h * (ahead.has_value() + behind.has_value()));
  }
  return found;
}

} // namespace dielast::cases
