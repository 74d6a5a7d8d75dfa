// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/fitting/fit_model.hpp"
#include "cases/fitting/fit_parameters.hpp"
#include "cases/fitting/least_squares.hpp"

#include <Eigen/Core>

namespace dielast::cases {

/// A test and the nominal stress that was measured in every row, Pa.
struct MeasuredTest {
  StretchHistory history;
  std::vector<double> stress;
  double weight = 1;
  bool predict = false; ///< kept out of the fit

  double largest_stress() const;
};

struct FitTask {
  materials::Material start;
  std::vector<FitParameter> parameters; ///< the ones to change
  std::vector<MeasuredTest> tests;
  double range = 0; ///< largest factor between start value and result; of numbers of any sign: multiple of
                    ///< the start value (of the shear modulus where that is 0)
  int max_iterations = 0;
  /// After every iteration, with the rms of the residuals; false stops.
  std::function<bool(int iteration, double misfit)> on_iteration;
};

struct FittedParameter {
  double start = 0, value = 0;
  double low = 0, high = 0; ///< 95 % interval; not finite where the tests do not determine the parameter
  bool at_bound = false;    ///< of `range` or of the law; then without an interval
  bool ends_model = false;  ///< at_bound: beyond, a measured stretch has no stress

  bool determined() const;
};

struct FitOutcome {
  FitEnding ending{};
  int iterations = 0;
  materials::Material material;
  std::vector<FittedParameter> parameters;
  Eigen::MatrixXd correlation;
  double deviation = 0;                    ///< s of the weighted residuals
  std::vector<std::vector<double>> stress; ///< of the model, Pa, for each test
  std::vector<int> steps;                  ///< of time between two rows, for each test
};

/// Nonlinear least squares over all rows f, i of the tests that are not kept out:
///   min sum r^2,  r_fi = weight_f (P_model - P_measured)_fi / max_i |P_measured|_f,
/// by Levenberg-Marquardt (Ceres) in q = ln(p - lower limit) of parameters with one and q = p / |start| of
/// others, derivatives by central differences. Steps of time are so fine that halving them changes no row by
/// more than 2e-4 of the largest stress; they are verified at the solution, and the fit goes on with finer
/// ones where needed. When it does not converge, or only
/// at a bound, or has relaxation times or exponents, it is tried again from stiffnesses scaled to the data
/// and relaxation times spread over the times of the tests; with several sequences of exponents, and with
/// limits near the largest stretch where one has come to its bound. The best is kept. Intervals and
/// correlations: see fit_statistics.hpp, those of q carried over to p. The start must give finite stresses.
FitOutcome solve_fit(const FitTask& task);

} // namespace dielast::cases
