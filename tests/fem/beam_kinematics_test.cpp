// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/beam_kinematics.hpp"

#include "materials/laws/dual.hpp"
#include "tests/fem/beam_oracle.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::beam_kinematics_test {
namespace {

using Dual11 = materials::Dual<11>;

std::array<Dual11, 6> oracle(const BeamKinematics::Vector11& y) {
  std::array<Dual11, 11> d;
  for (int i = 0; i < 11; ++i) d[i] = Dual11::variable(y[i], i);
  return test::BeamOracle<Dual11>::strain({d[0], d[1], d[2]}, {d[3], d[4], d[5], d[6]},
                                          {d[7], d[8], d[9], d[10]});
}

Eigen::Matrix<double, 6, 11> whole(const BeamKinematics::Gradient& blocks) {
  Eigen::Matrix<double, 6, 11> gradient = Eigen::Matrix<double, 6, 11>::Zero();
  gradient.block<3, 3>(0, BeamKinematics::slope) = blocks.stretch_slope;
  gradient.block<3, 4>(0, BeamKinematics::quaternion) = blocks.stretch_quaternion;
  gradient.block<3, 4>(3, BeamKinematics::quaternion) = blocks.turn_quaternion;
  gradient.block<3, 4>(3, BeamKinematics::quaternion_slope) = blocks.turn_quaternion_slope;
  return gradient;
}

Eigen::Matrix<double, 11, 11> whole(const BeamKinematics::Hessian& blocks) {
  Eigen::Matrix<double, 11, 11> hessian = Eigen::Matrix<double, 11, 11>::Zero();
  hessian.block<3, 4>(BeamKinematics::slope, BeamKinematics::quaternion) = blocks.slope_quaternion;
  hessian.block<4, 4>(BeamKinematics::quaternion, BeamKinematics::quaternion_slope) =
      blocks.quaternion_quaternion_slope;
  hessian += hessian.transpose().eval();
  hessian.block<4, 4>(BeamKinematics::quaternion, BeamKinematics::quaternion) = blocks.quaternion;
  return hessian;
}

TEST(BeamKinematics, strain_gradient_and_hessian_are_those_of_the_definition) {
  std::mt19937 random(11);
  for (int sample = 0; sample < 200; ++sample) {
    BeamKinematics::Vector11 y = test::random_vector(random, 11);
    while (y.segment<4>(BeamKinematics::quaternion).squaredNorm() < 0.2) y = test::random_vector(random, 11);
    const Eigen::Vector<double, 6> stress = test::random_vector(random, 6);
    const BeamKinematics kinematics(y);
    const auto expected = oracle(y);
    const Eigen::Matrix<double, 6, 11> gradient = whole(kinematics.gradient());
    Dual11 power;
    for (int i = 0; i < 6; ++i) {
      const double scale = 1 + expected[i].gradient.norm();
      EXPECT_NEAR(kinematics.strain()[i], expected[i].value, 1e-13 * scale);
      EXPECT_LT((gradient.row(i).transpose() - expected[i].gradient).norm(), 1e-13 * scale);
      power += stress[i] * expected[i];
    }
    EXPECT_LT((kinematics.power_gradient(stress) - power.gradient).norm(),
              1e-13 * (1 + power.gradient.norm()));
    EXPECT_LT((whole(kinematics.power_hessian(stress)) - power.hessian).norm(),
              1e-12 * (1 + power.hessian.norm()));
    EXPECT_DOUBLE_EQ(kinematics.N, y.segment<4>(BeamKinematics::quaternion).squaredNorm());
  }
}

TEST(BeamKinematics, strain_does_not_depend_on_the_length_of_the_quaternion) {
  std::mt19937 random(12);
  BeamKinematics::Vector11 y = test::random_vector(random, 11);
  const auto strain = BeamKinematics(y).strain();
  y.tail<8>() *= -3.7;
  EXPECT_LT((BeamKinematics(y).strain() - strain).norm(), 1e-14);
}

// A circular arc in the xy plane: x' is the tangent, the triad turns by 1/radius per length about z.
TEST(BeamKinematics, circular_arc_has_its_curvature) {
  const double kappa = 0.8, angle = 0.6;
  const Eigen::Quaterniond q = rotation_of({0, 0, angle});
  BeamKinematics::Vector11 y;
  y << std::cos(angle), std::sin(angle), 0, q.w(), 0, 0, q.z(), -q.z() * kappa / 2, 0, 0, q.w() * kappa / 2;
  Eigen::Vector<double, 6> expected;
  expected << 1, 0, 0, 0, 0, kappa;
  EXPECT_LT((BeamKinematics(y).strain() - expected).norm(), 1e-15);
}

} // namespace
} // namespace dielast::fem::beam_kinematics_test
