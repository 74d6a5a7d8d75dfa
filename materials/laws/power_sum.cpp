// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/power_sum.hpp"

#include <cmath>

namespace dielast::materials {

namespace {

/// 2 sum_k binom(p, 2k) y^k
PowerSum series(double p, double y) {
  PowerSum sum{2, p * (p - 1), 0};
  double coefficient = p * (p - 1); // 2 binom(p, 2k), here k = 1
  double power = 1;                 // y^(k - 2) from k = 2 on
  sum.value += coefficient * y;
  for (int k = 2; k < 60; ++k) {
    coefficient *= (p - 2 * k + 2) * (p - 2 * k + 1) / ((2.0 * k) * (2.0 * k - 1));
    const double term = coefficient * power;
    sum.value += term * y * y;
    sum.first += k * term * y;
    sum.second += k * (k - 1) * term;
    power *= y;
    if (std::abs(term) * k * k <= 1e-18 * std::abs(sum.second)) break;
  }
  return sum;
}

} // namespace

PowerSum power_sum(double p, double y, double rest) {
  if (y < 0.05) return series(p, y);
  const double s = std::sqrt(y);
  const double large = 1 + s, small = rest / large;
  const double large_p = std::pow(large, p), small_p = std::pow(small, p);
  PowerSum sum{};
  sum.value = large_p + small_p;
  sum.first = p / (2 * s) * (large_p / large - small_p / small);
  sum.second =
      (p * (p - 1) * (large_p / (large * large) + small_p / (small * small)) - 2 * sum.first) / (4 * y);
  return sum;
}

} // namespace dielast::materials
