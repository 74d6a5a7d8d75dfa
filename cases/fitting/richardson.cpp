// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/richardson.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace dielast::cases {

namespace {

constexpr double safety = 1.25;
/// What is singular grows, from one mesh to the next, by more than this part of its value,
constexpr double notable = 0.05;
/// not by less than this part of how it grew before,
constexpr double as_before = 0.7;
/// and its field's rise over one element stays or grows up to twofold, where a regular field's halves. (A
/// rise that grows by more belongs to a mesh that did not see the place at all.)
constexpr double least_rise = 0.7, most_rise = 2.5;

/// The last two solutions' difference, and the one before: by how much the values change, and by which factor
/// the elements.
struct Difference {
  double value = 0; ///< finer less coarser
  double ratio = 1; ///< of the elements' sizes, > 1

  /// Error of the finer value at an order of convergence.
  double error(double order) const { return std::abs(value) / (std::pow(ratio, order) - 1); }
};

Difference difference(const Sampled& fine, const Sampled& coarse) {
  return {fine.value - coarse.value, coarse.size / fine.size};
}

/// Error of the finest of three values from the differences of the first two and of the last two.
double error_of_three(const Difference& near, const Difference& far, OrderRange orders) {
  const auto error_by_far = [&](double order) { return far.error(order) / std::pow(near.ratio, order); };
  if (near.value * far.value <= 0) return std::max(std::abs(near.value), error_by_far(1));
  // At the observed order both differences tell one error; at a lower one the nearer tells more.
  double low = orders.least, high = orders.most;
  if (near.error(low) >= error_by_far(low)) return near.error(low);
  if (near.error(high) <= error_by_far(high)) return error_by_far(high);
  for (int i = 0; i < 40; ++i) {
    const double order = (low + high) / 2;
    (near.error(order) < error_by_far(order) ? low : high) = order;
  }
  return near.error(low);
}

/// Whether an extreme grows with the mesh. `solutions`: two or more, from the finest to the coarsest.
bool is_singular(std::span<const Sampled> solutions, int direction, double rounding) {
  double last_growth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < solutions.size(); ++i) {
    const Sampled &fine = solutions[i], &coarse = solutions[i + 1];
    const double growth = direction * (fine.value - coarse.value);
    if (growth <= (i == 0 ? std::max(notable * std::abs(fine.value), rounding) : 0) ||
        last_growth < as_before * growth || fine.rise < least_rise * coarse.rise ||
        fine.rise > most_rise * coarse.rise)
      return false;
    last_growth = growth;
  }
  return true;
}

} // namespace

ErrorEstimate estimate_error(const Sampled& own, std::span<const Sampled> others, OrderRange orders,
                             int direction, double rounding) {
  ErrorEstimate estimate;
  if (others.empty() || !std::isfinite(own.value) || !std::isfinite(others.front().value)) return estimate;
  const Sampled& next = others.front();
  std::vector<Sampled> solutions{own, next};
  if (next.size < own.size) { // the difference to a finer solution is most of the error
    std::swap(solutions[0], solutions[1]);
    const Difference step = difference(next, own);
    estimate.error = safety * (std::abs(step.value) + step.error(orders.least));
    if (others.size() > 1 && std::isfinite(others[1].value)) { // what both of them do not resolve yet
      estimate.error =
          std::max(*estimate.error,
                   safety * difference(own, others[1]).error(orders.of_larger.value_or(orders.least)));
      solutions.push_back(others[1]);
    }
  } else {
    const Difference near = difference(own, next);
    estimate.error = safety * near.error(orders.least);
    if (others.size() > 1 && std::isfinite(others[1].value)) {
      estimate.error = safety * error_of_three(near, difference(next, others[1]), orders);
      solutions.push_back(others[1]);
    }
  }
  estimate.error = std::max(*estimate.error, own.rise);
  if (is_singular(solutions, direction, rounding)) {
    estimate.singular = true;
    estimate.error.reset();
    estimate.remark = "grows as the mesh is refined: no converged value";
  }
  return estimate;
}

} // namespace dielast::cases
