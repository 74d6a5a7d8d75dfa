// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/planar.hpp"

#include "materials/laws/power_sum.hpp"

#include <cmath>

namespace dielast::materials {

PlanarDerivatives<double> planar(const Ogden& law, double T, double D) {
  const double m = T / 2;
  const double rest = D / (m * m), y = 1 - rest;
  const double y_T = 2 * rest / T, y_D = -4 / (T * T); // rest = 4D/T^2
  const double y_TT = -3 * y_T / T, y_TD = -2 * y_D / T;
  PlanarDerivatives<double> W{};
  for (std::size_t i = 0; i < law.moduli.size(); ++i) {
    const double p = law.exponents[i] / 2;
    const double factor = law.moduli[i] / law.exponents[i];
    const PowerSum E = power_sum(p, y, rest);
    const double scale = factor * std::pow(m, p);
    const double scale_T = scale * p / T, scale_TT = scale_T * (p - 1) / T;
    const double thickness = factor * std::pow(D, -p); // c3^p
    W.value += scale * E.value + thickness - 3 * factor;
    W.dT += scale_T * E.value + scale * E.first * y_T;
    W.dD += scale * E.first * y_D - p * thickness / D;
    W.dTT +=
        scale_TT * E.value + 2 * scale_T * E.first * y_T + scale * (E.second * y_T * y_T + E.first * y_TT);
    W.dTD += scale_T * E.first * y_D + scale * (E.second * y_T * y_D + E.first * y_TD);
    W.dDD += scale * E.second * y_D * y_D + p * (p + 1) * thickness / (D * D);
  }
  return W;
}

} // namespace dielast::materials
