// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/rational.hpp"

#include "cases/fitting/fit_statistics.hpp"
#include "cases/fitting/least_squares.hpp"
#include "fem/algebra/dense_algebra.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace dielast::cases {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

/// A response at i omega and its derivatives in the coordinates.
struct Response {
  Complex value;
  VectorXcd slope;
};
using ResponseModel = std::function<Response(Complex s, const VectorXd& q)>;

/// The solution in the coordinates, their covariance, and what of the outcome does not depend on the model.
struct Solution {
  VectorXd q;
  MatrixXd covariance; ///< times t^2: the square roots of its diagonal are the half widths of 95 % intervals
  RationalOutcome outcome;
};

/// Relative errors as residuals, real and imaginary parts by turns. `unit`: rad/s, by which s is divided for
/// the model.
Solution solve(const FrequencyTable& table, const ResponseModel& model, double unit, VectorXd q,
               int max_iterations) {
  const auto response = [&](std::size_t i, const VectorXd& at) {
    return model(Complex(0, 2 * std::numbers::pi * table.hertz[i] / unit), at);
  };
  const LeastSquares problem{.rows = 2 * static_cast<int>(table.hertz.size()),
                             .residuals = [&](const VectorXd& at) -> LeastSquares::Residuals {
                               VectorXd r(2 * std::ssize(table.hertz));
                               for (std::size_t i = 0; i < table.hertz.size(); ++i) {
                                 const Complex error =
                                     (response(i, at).value - table.value[i]) / std::abs(table.value[i]);
                                 r.segment<2>(static_cast<Index>(2 * i)) =
                                     Eigen::Vector2d(error.real(), error.imag());
                               }
                               return r.allFinite() ? std::optional(r) : std::nullopt;
                             },
                             .jacobian =
                                 [&](const VectorXd& at, const VectorXd& r) {
                                   MatrixXd J(r.size(), at.size());
                                   for (std::size_t i = 0; i < table.hertz.size(); ++i) {
                                     const VectorXcd slope = response(i, at).slope / std::abs(table.value[i]);
                                     J.row(static_cast<Index>(2 * i)) = slope.real().transpose();
                                     J.row(static_cast<Index>(2 * i + 1)) = slope.imag().transpose();
                                   }
                                   return J;
                                 },
                             .max_iterations = max_iterations,
                             .max_invalid_steps = 5,
                             .function_tolerance = 1e-14,
                             .parameter_tolerance = 1e-12,
                             .gradient_tolerance = 1e-14};
  const LeastSquaresEnd end = minimise(problem, q);

  Solution found{q, {}, {}};
  RationalOutcome& outcome = found.outcome;
  outcome.ending = end.ending;
  outcome.iterations = end.iterations;
  const LeastSquares::Residuals residuals = problem.residuals(q);
  const VectorXd r = residuals.value_or(VectorXd::Constant(problem.rows, NAN));
  const MatrixXd J = residuals ? problem.jacobian(q, r) : MatrixXd::Zero(r.size(), q.size());
  const FitStatistics statistics = fit_statistics(J, r);
  outcome.deviation = statistics.deviation;
  outcome.error = std::sqrt(r.squaredNorm() / static_cast<double>(table.hertz.size()));
  const VectorXd& half = statistics.half_widths;
  found.covariance = half.asDiagonal() * statistics.correlation * half.asDiagonal();
  for (Index i = 0; i < q.size(); ++i) found.covariance(i, i) = half[i] * half[i];
  for (std::size_t i = 0; i < table.hertz.size(); ++i) outcome.model.push_back(response(i, q).value);
  return found;
}

/// A function of the coordinates with its interval to first order.
FittedNumber number(std::string name, std::string unit, double value, const VectorXd& slope,
                    const MatrixXd& covariance) {
  const double half = std::sqrt(slope.dot(covariance * slope));
  return {std::move(name), std::move(unit), {.value = value, .low = value - half, .high = value + half}};
}

/// c_0 + c_1 x + ...
Complex polynomial(const VectorXd& c, Complex x) {
  Complex sum = 0;
  for (Index i = c.size(); i-- > 0;) sum = sum * x + c[i];
  return sum;
}

std::vector<Complex> roots(const VectorXd& c) {
  const Index n = c.size() - 1;
  if (n < 1) return {};
  MatrixXd companion = MatrixXd::Zero(n, n);
  companion.diagonal(-1).setOnes();
  companion.col(n - 1) = -c.head(n) / c[n];
  const VectorXcd values = fem::eigenvalues(companion);
  std::vector<Complex> all(values.begin(), values.end());
  std::ranges::sort(all, {}, [](const Complex& z) { return std::pair(std::abs(z), z.imag()); });
  return all;
}

/// Frequencies of the roots of c_0 + c_1 x + ..., x in `unit`, rad/s, pairs once; damping ratios of those
/// that are not real and negative: below 0 in the right half plane. The coefficients that were fitted begin
/// at `first` among the coordinates.
void append_roots(std::vector<FittedNumber>& numbers, const char* kind, const VectorXd& c, double unit,
                  Index first, Index fitted, const MatrixXd& covariance) {
  const std::vector<Complex> all = roots(c);
  constexpr double real = 1e-9; // an imaginary part that is rounding
  int count = 0;
  for (const Complex& root : all) {
    if (root.imag() < -real * std::abs(root)) continue; // its twin is told
    Complex slope_at = 0;                               // of the polynomial in x
    for (Index i = c.size(); i-- > 1;) slope_at = slope_at * root + static_cast<double>(i) * c[i];
    const double size = std::abs(root);
    VectorXd frequency = VectorXd::Zero(covariance.rows()), damping = frequency;
    Complex power = 1;
    for (Index i = 0; i < fitted; ++i, power *= root) {
      const Complex moves = -power / slope_at; // per coefficient
      const double grows = (std::conj(root) * moves).real() / size;
      frequency[first + i] = grows * unit / (2 * std::numbers::pi);
      damping[first + i] = (-moves.real() + root.real() / size * grows) / size;
    }
    const std::string name = fmt::format("{} {}", kind, ++count);
    numbers.push_back(
        number(name + ", frequency", "Hz", size * unit / (2 * std::numbers::pi), frequency, covariance));
    if (std::abs(root.imag()) > real * size || root.real() > 0)
      numbers.push_back(number(name + ", damping ratio", "1", -root.real() / size, damping, covariance));
  }
}

/// Linear least squares for the coefficients, weighted by the denominator of the iteration before.
VectorXd rational_start(const FrequencyTable& table, const RationalOrder& order, double unit) {
  const auto rows = static_cast<Index>(table.hertz.size());
  const Index numerator = order.zeros + 1, count = numerator + order.poles;
  VectorXd q;
  VectorXd weight(rows);
  for (Index i = 0; i < rows; ++i)
    weight[i] =
        std::pow(1 + 2 * std::numbers::pi * table.hertz[static_cast<std::size_t>(i)] / unit, order.poles);
  constexpr int iterations = 30;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    MatrixXd A(2 * rows, count);
    VectorXd b(2 * rows);
    for (Index i = 0; i < rows; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Complex x(0, 2 * std::numbers::pi * table.hertz[at] / unit);
      const double scale = 1 / (std::abs(table.value[at]) * weight[i]);
      const auto put = [&](Index column, Complex value) {
        A(2 * i, column) = scale * value.real();
        A(2 * i + 1, column) = scale * value.imag();
      };
      Complex power = 1;
      for (Index j = 0; j < std::max(numerator, static_cast<Index>(order.poles) + 1); ++j, power *= x) {
        if (j < numerator) put(j, power);
        if (j < order.poles) put(numerator + j, -table.value[at] * power);
        if (j == order.poles) {
          const Complex right = scale * table.value[at] * power;
          b.segment<2>(2 * i) = Eigen::Vector2d(right.real(), right.imag());
        }
      }
    }
    const VectorXd size = A.colwise().norm().transpose().cwiseMax(std::numeric_limits<double>::min());
    q = fem::least_squares(A * size.cwiseInverse().asDiagonal(), b).cwiseQuotient(size);
    VectorXd denominator(order.poles + 1);
    denominator << q.tail(order.poles), 1;
    for (Index i = 0; i < rows; ++i)
      weight[i] = std::max(
          1e-12,
          std::abs(polynomial(denominator, Complex(0, 2 * std::numbers::pi *
                                                          table.hertz[static_cast<std::size_t>(i)] / unit))));
  }
  return q;
}

/// In powers of s, the highest first, of a polynomial in s/unit.
std::vector<double> in_powers_of_s(const VectorXd& c, double unit, double factor) {
  std::vector<double> all;
  for (Index i = c.size(); i-- > 0;) all.push_back(factor * c[i] / std::pow(unit, static_cast<double>(i)));
  return all;
}

/// A pole so much slower than what was measured is none but an integrator's, at zero: nothing is at rest
/// then.
constexpr double integrator = 1e-6;

} // namespace

RationalOutcome fit_rational(const FrequencyTable& measured, const RationalOrder& order, int max_iterations) {
  const auto [low, high] = std::ranges::minmax(measured.hertz);
  const double unit = 2 * std::numbers::pi * std::sqrt(low * high);
  const Index numerator = order.zeros + 1, poles = order.poles;
  const auto split = [&](const VectorXd& q) {
    VectorXd denominator(poles + 1);
    denominator << q.tail(poles), 1;
    return std::pair<VectorXd, VectorXd>(q.head(numerator), denominator);
  };
  const ResponseModel model = [&](Complex x, const VectorXd& q) {
    const auto [n, d] = split(q);
    const Complex below = polynomial(d, x), value = polynomial(n, x) / below;
    Response at{value, VectorXcd(q.size())};
    Complex power = 1;
    for (Index j = 0; j < numerator; ++j, power *= x) at.slope[j] = power / below;
    power = 1;
    for (Index j = 0; j < poles; ++j, power *= x) at.slope[numerator + j] = -value * power / below;
    return at;
  };
  Solution found = solve(measured, model, unit, rational_start(measured, order, unit), max_iterations);
  RationalOutcome& outcome = found.outcome;
  const auto [n, d] = split(found.q);
  const double slowest = integrator * 2 * std::numbers::pi * low / unit;
  const std::vector<Complex> all_poles = roots(d);
  if (std::ranges::none_of(all_poles, [&](const Complex& pole) { return std::abs(pole) < slowest; })) {
    const double rest = n[0] / d[0];
    VectorXd slope = VectorXd::Zero(found.q.size());
    slope[0] = 1 / d[0];
    if (poles > 0) slope[numerator] = -rest / d[0];
    outcome.numbers.push_back(number("at rest", "", rest, slope, found.covariance));
  }
  append_roots(outcome.numbers, "pole", d, unit, numerator, poles, found.covariance);
  append_roots(outcome.numbers, "zero", n, unit, 0, numerator, found.covariance);
  const double highest = std::pow(unit, static_cast<double>(poles)); // of the denominator's power 1
  outcome.numerator = in_powers_of_s(n, unit, highest);
  outcome.denominator = in_powers_of_s(d, unit, highest);
  outcome.stable = std::ranges::all_of(
      all_poles, [&](const Complex& pole) { return pole.real() < 0 || std::abs(pole) < slowest; });
  return std::move(outcome);
}

RationalOutcome fit_circuit(const FrequencyTable& measured, const FilmCircuit& circuit, int max_iterations) {
  constexpr std::array names{"resistance", "leakage_resistance", "capacitance"};
  constexpr std::array units{"Ohm", "Ohm", "F"};
  constexpr double none = -1;
  std::array<Index, 3> place{};
  Index count = 0;
  for (std::size_t e = 0; e < 3; ++e) place[e] = circuit.elements[e] ? count++ : static_cast<Index>(none);
  const auto at = [&](CircuitElement element) { return place[static_cast<std::size_t>(element)]; };
  const Index series = at(CircuitElement::resistance), leak = at(CircuitElement::leakage_resistance),
              plates = at(CircuitElement::capacitance);
  const ResponseModel model = [&](Complex s, const VectorXd& q) {
    Response response{0, VectorXcd::Zero(count)};
    Complex beside = s * std::exp(q[plates]); // admittance of what lies beside one another
    if (leak >= 0) beside += std::exp(-q[leak]);
    response.value = 1.0 / beside;
    response.slope[plates] = -s * std::exp(q[plates]) / (beside * beside);
    if (leak >= 0) response.slope[leak] = std::exp(-q[leak]) / (beside * beside);
    if (series >= 0) {
      response.slope[series] = std::exp(q[series]);
      response.value += response.slope[series];
    }
    if (circuit.admittance) {
      response.slope /= -response.value * response.value;
      response.value = 1.0 / response.value;
    }
    return response;
  };
  // Where the phase is nearest to -90 degrees the capacitance speaks alone, the resistances at the ends.
  VectorXd start(count);
  double nearest = -1, least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t i = 0; i < measured.hertz.size(); ++i) {
    const Complex Z = circuit.admittance ? 1.0 / measured.value[i] : measured.value[i];
    if (const double part = -Z.imag() / std::abs(Z); part > nearest) {
      nearest = part;
      start[plates] = -std::log(2 * std::numbers::pi * measured.hertz[i] * std::abs(Z));
    }
    least = std::min(least, std::abs(Z));
    most = std::max(most, std::abs(Z));
  }
  if (series >= 0) start[series] = std::log(least / 2);
  if (leak >= 0) start[leak] = std::log(2 * most);
  Solution found = solve(measured, model, 1, start, max_iterations);
  RationalOutcome& outcome = found.outcome;
  std::array<double, 3> value{0, std::numeric_limits<double>::infinity(), 0};
  for (std::size_t e = 0; e < 3; ++e) {
    if (place[e] < 0) continue;
    const double q = found.q[place[e]], half = std::sqrt(found.covariance(place[e], place[e]));
    value[e] = std::exp(q);
    outcome.numbers.push_back(
        {names[e], units[e], {.value = value[e], .low = std::exp(q - half), .high = std::exp(q + half)}});
  }
  const auto [Rs, Rp, C] = value;
  outcome.numerator = {Rs * C, Rs / Rp + 1};
  outcome.denominator = {C, 1 / Rp};
  if (circuit.admittance) std::swap(outcome.numerator, outcome.denominator);
  return std::move(outcome);
}

} // namespace dielast::cases
