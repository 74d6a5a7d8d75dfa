// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

namespace dielast::cases {

/// Where a path ends: at a load factor below 1, at its first greatest load, or at 1.
struct End {
  double load_factor = 0, stretch = 0;
};

/// Random numbers that are alike with every standard library.
class Dice {
 public:
  explicit Dice(unsigned seed) : bits_(seed) {}
  double between(double low, double high) { return low + (high - low) * (bits_() / 4294967296.0); }
  int below(int n) { return static_cast<int>(between(0, n)); }
  double by_ratio(double low, double high) { return low * std::pow(high / low, between(0, 1)); }

 private:
  std::mt19937 bits_;
};

inline std::string random_law(Dice& dice) {
  const double mu = dice.between(10, 200);
  switch (dice.below(7)) {
  case 0:
    return fmt::format("law = \"neo-hookean\"\nshear_modulus = \"{} kPa\"\n", mu);
  case 1:
    return fmt::format("law = \"mooney-rivlin\"\nc1 = \"{} kPa\"\nc2 = \"{} kPa\"\n", mu / 2,
                       mu * dice.between(0, 0.1));
  case 2:
    return fmt::format("law = \"yeoh\"\nc1 = \"{} kPa\"\nc2 = \"{} kPa\"\nc3 = \"{} kPa\"\n", mu / 2,
                       -mu * dice.between(0, 0.01), mu * dice.by_ratio(1e-5, 1e-3));
  case 3:
    return fmt::format("law = \"ogden\"\nmoduli = [\"{} kPa\", \"{} kPa\"]\nexponents = [{}, {}]\n", mu,
                       mu * dice.by_ratio(1e-3, 1e-1), dice.between(1.2, 2.2), dice.between(4, 7));
  case 4:
    return fmt::format("law = \"gent\"\nshear_modulus = \"{} kPa\"\nstretch_limit = {}\n", mu,
                       dice.by_ratio(8, 200));
  case 5:
    return fmt::format("law = \"arruda-boyce\"\nshear_modulus = \"{} kPa\"\nlocking_stretch = {}\n", mu,
                       dice.by_ratio(2, 8));
  default:
    return fmt::format("law = \"st-venant-kirchhoff\"\nyoungs_modulus = \"{} kPa\"\npoisson_ratio = {}\n",
                       3 * mu, dice.between(0.2, 0.45));
  }
}

/// Walks along the stretch from `start`, where the load factor is 0, to where it is 1 or falls again; not far
/// enough to find out: 0.
template<class LoadFactor>
End walk(const LoadFactor& load_factor, double start) {
  constexpr double step = 1e-4;
  double l = start, s = load_factor(l);
  while (l < 30) {
    const double next = l + step, there = load_factor(next);
    if (!std::isfinite(there) || (there < s && there < -1)) return {}; // beyond the law's last stretch
    if (there >= 1) {
      double low = l, high = next;
      for (int i = 0; i < 60; ++i) (load_factor((low + high) / 2) < 1 ? low : high) = (low + high) / 2;
      return {1, low};
    }
    if (!(there > s)) { // the greatest load lies between the neighbours: golden section
      double low = l - step, high = next;
      constexpr double golden = 0.6180339887498949;
      for (int i = 0; i < 80; ++i) {
        const double a = high - golden * (high - low), b = low + golden * (high - low);
        (load_factor(a) > load_factor(b) ? high : low) = load_factor(a) > load_factor(b) ? b : a;
      }
      return {load_factor(low), low};
    }
    l = next, s = there;
  }
  return {};
}

} // namespace dielast::cases
