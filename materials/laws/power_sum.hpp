// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace dielast::materials {

/// E_p(y) = (1 + sqrt y)^p + (1 - sqrt y)^p and its derivatives in y. Two principal values m (1 +- sqrt y)
/// have the power sum m^p E_p(y), and E_p is analytic in y: nothing singular happens where they are equal (y
/// = 0).
struct PowerSum {
  double value, first, second;
};

/// 0 <= y < 1 up to rounding; `rest`: 1 - y, given apart because the smaller value depends on it where y
/// nears
/// 1. Relative accuracy about 1e-14.
PowerSum power_sum(double exponent, double y, double rest);

} // namespace dielast::materials
