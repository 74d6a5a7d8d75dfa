// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/beam_section.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace dielast::materials::beam_section_test {
namespace {

constexpr ElasticSolid tpu{.youngs_modulus = 78e6, .poisson_ratio = 0.36, .yield_strain = 0.55};
constexpr double G = 78e6 / (2 * 1.36);

TEST(RectangularSection, axial_shear_and_bending_stiffness) {
  const double w = 0.8e-3, h = 2e-3;
  const BeamSection s = rectangular_section(tpu, w, h);
  EXPECT_DOUBLE_EQ(s.EA, 78e6 * w * h);
  EXPECT_DOUBLE_EQ(s.GA2, 5.0 / 6 * G * w * h);
  EXPECT_DOUBLE_EQ(s.GA3, s.GA2);
  EXPECT_DOUBLE_EQ(s.EI2, 78e6 * w * h * h * h / 12); // out of the plane: the height counts
  EXPECT_DOUBLE_EQ(s.EI3, 78e6 * h * w * w * w / 12); // in the plane: the width counts
  EXPECT_DOUBLE_EQ(s.half_width, w / 2);
  EXPECT_DOUBLE_EQ(s.half_height, h / 2);
  EXPECT_DOUBLE_EQ(s.yield_strain, 0.55);
}

// Timoshenko & Goodier, Theory of Elasticity, art. 109: J = k1 (2a)^3 (2b) for b/a = 1, 1.2, 1.5, 2, 2.5, 3,
// 4, 5, 10.
TEST(RectangularSection, torsion_constant_matches_the_published_table) {
  constexpr std::array<std::array<double, 2>, 9> table{{{1, 0.1406},
                                                        {1.2, 0.166},
                                                        {1.5, 0.196},
                                                        {2, 0.229},
                                                        {2.5, 0.249},
                                                        {3, 0.263},
                                                        {4, 0.281},
                                                        {5, 0.291},
                                                        {10, 0.312}}};
  for (const auto& [ratio, k1] : table) {
    const double half_a_digit = ratio == 1 ? 0.5e-4 : 1e-3;
    const double wide = rectangular_section(tpu, ratio * 1e-3, 1e-3).GJ / (G * ratio * 1e-12);
    const double tall = rectangular_section(tpu, 1e-3, ratio * 1e-3).GJ / (G * ratio * 1e-12);
    EXPECT_NEAR(wide, k1, half_a_digit) << "ratio " << ratio;
    EXPECT_DOUBLE_EQ(wide, tall);
  }
}

TEST(RectangularSection, torsion_constant_converges_to_its_limits) {
  // Square: 0.14057701495515; thin strip: b t^3 / 3 (1 - 0.630249 t/b), both from the full series.
  EXPECT_NEAR(rectangular_section(tpu, 1e-3, 1e-3).GJ / (G * 1e-12), 0.14057701495515, 2e-7);
  const double strip = rectangular_section(tpu, 1e-3, 1.0).GJ / (G * 1e-9);
  EXPECT_NEAR(strip, (1 - 0.6302497 * 1e-3) / 3, 1e-9);
}

TEST(TwoFacedSection, bars_on_either_face_bend_as_one_and_twist_one_by_one) {
  const double w = 0.8e-3, h = 2e-3, gap = 0.1e-3;
  const BeamSection merged = rectangular_section(tpu, w, h), one = rectangular_section(tpu, w, h / 2),
                    both = two_faced_section(tpu, w, h, gap);
  EXPECT_DOUBLE_EQ(both.EA, merged.EA);
  EXPECT_DOUBLE_EQ(both.EI3, merged.EI3);
  EXPECT_DOUBLE_EQ(both.GJ, 2 * one.GJ);
  const double arm = (h / 2 + gap) / 2; // of a bar's axis
  EXPECT_NEAR(both.EI2, 2 * (one.EI2 + one.EA * arm * arm), 1e-12 * both.EI2);
  EXPECT_DOUBLE_EQ(both.half_height, (h + gap) / 2);
}

} // namespace
} // namespace dielast::materials::beam_section_test
