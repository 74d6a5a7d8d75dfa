// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/beam_section.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::materials {

BeamSection rectangular_section(const ElasticSolid& solid, double width, double height) {
  const double E = solid.youngs_modulus;
  const double G = E / (2 * (1 + solid.poisson_ratio));
  const double area = width * height;
  const auto [shorter, longer] = std::minmax(width, height);
  double series = 0;
  for (int n = 1; n < 20; n += 2)
    series += std::tanh(n * std::numbers::pi * longer / (2 * shorter)) / std::pow(n, 5);
  const double torsion = longer * std::pow(shorter, 3) *
                         (1.0 / 3 - 64 / std::pow(std::numbers::pi, 5) * shorter / longer * series);
  return {.EA = E * area,
          .GA2 = 5.0 / 6 * G * area,
          .GA3 = 5.0 / 6 * G * area,
          .GJ = G * torsion,
          .EI2 = E * width * std::pow(height, 3) / 12,
          .EI3 = E * height * std::pow(width, 3) / 12,
          .half_width = width / 2,
          .half_height = height / 2,
          .yield_strain = solid.yield_strain,
          .line_density = solid.density * area,
          .rotary2 = solid.density * width * std::pow(height, 3) / 12,
          .rotary3 = solid.density * height * std::pow(width, 3) / 12};
}

BeamSection two_faced_section(const ElasticSolid& solid, double width, double height, double gap) {
  BeamSection section = rectangular_section(solid, width, height);
  const double E = solid.youngs_modulus;
  section.GJ = 2 * rectangular_section(solid, width, height / 2).GJ;
  const double second_moment = width * (std::pow(height + gap, 3) - std::pow(gap, 3)) / 12;
  section.EI2 = E * second_moment;
  section.rotary2 = solid.density * second_moment;
  section.half_height = (height + gap) / 2;
  return section;
}

} // namespace dielast::materials
