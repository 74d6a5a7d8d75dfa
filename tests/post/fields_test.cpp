// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/fields.hpp"

#include "tests/post/samples.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace dielast::post::fields_test {
namespace {

/// A field's values by name.
std::vector<double> value(std::string_view name, const fem::MembraneSample& sample) {
  const auto fields = film_fields();
  const auto field =
      std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; });
  std::vector<double> values(static_cast<std::size_t>(field->width()));
  field->evaluate(FilmPoint(sample), values.data());
  return values;
}

void expect_near(const std::vector<double>& actual, const std::vector<double>& expected, double tolerance) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i)
    EXPECT_NEAR(actual[i], expected[i], tolerance) << "component " << i;
}

TEST(FilmFields, Equibiaxial) {
  auto sample = film_sample(stretched(3, 3), 1e4 * Eigen::Matrix2d::Identity());
  sample.voltage = -5000;
  expect_near(value("principal_stretches", sample), {3, 3, 1.0 / 9}, 1e-14);
  expect_near(value("log_strain", sample), {std::log(3), std::log(3), -2 * std::log(3), 0, 0, 0}, 1e-14);
  expect_near(value("green_lagrange_strain", sample), {4, 4, -40.0 / 81, 0, 0, 0}, 1e-14);
  expect_near(value("cauchy_stress", sample), {9e4, 9e4, 0, 0, 0, 0}, 1e-9);
  expect_near(value("thickness", sample), {1e-3 / 9}, 1e-18);
  expect_near(value("electric_field", sample), {45e6}, 1e-6);
  expect_near(value("breakdown_ratio", sample), {0.45}, 1e-14);
  expect_near(value("voltage", sample), {-5000}, 0);
  expect_near(value("tension_state", sample), {0}, 0);
}

TEST(FilmFields, UniaxialAlongY) {
  const double lambda = 2;
  auto sample = film_sample(stretched(1 / std::sqrt(lambda), lambda));
  sample.S << -10, 0, 0, 30;
  sample.tension = materials::Tension::wrinkled;
  expect_near(value("principal_stretches", sample), {2, std::sqrt(0.5), std::sqrt(0.5)}, 1e-15);
  expect_near(value("cauchy_stress", sample), {-5, 120, 0, 0, 0, 0}, 1e-13);
  expect_near(value("max_principal_stress", sample), {120}, 1e-13);
  expect_near(value("min_principal_stress", sample), {-5}, 1e-13);
  expect_near(value("tension_state", sample), {1}, 0);
  sample.S << -10, 0, 0, -30;
  sample.tension = materials::Tension::slack;
  expect_near(value("tension_state", sample), {2}, 0);
  sample.widening = 1 + 1e-12; // a side without load
  expect_near(value("tension_state", sample), {0}, 0);
  sample.widening = 1 + 1e-6;
  expect_near(value("tension_state", sample), {2}, 0);
}

TEST(FilmFields, SimpleShear) {
  // x = X + g Y: the larger stretch is (g + sqrt(g^2 + 4))/2, along 1/2 atan2(2, g) from x; plane strain
  // keeps h = H.
  const double g = 1.5;
  Eigen::Matrix<double, 3, 2> F;
  F << 1, g, 0, 1, 0, 0;
  Eigen::Matrix2d S;
  S << 2, 1, 1, 3;
  const auto sample = film_sample(F, S);
  const double lambda = (g + std::sqrt(g * g + 4)) / 2, angle = std::atan2(2, g) / 2;
  expect_near(value("principal_stretches", sample), {lambda, 1 / lambda, 1}, 1e-14);
  const double cc = std::pow(std::cos(angle), 2), ss = 1 - cc, cs = std::cos(angle) * std::sin(angle);
  const double e = std::log(lambda);
  expect_near(value("log_strain", sample), {e * (cc - ss), e * (ss - cc), 0, 2 * e * cs, 0, 0}, 1e-14);
  expect_near(value("green_lagrange_strain", sample), {0, g * g / 2, 0, g / 2, 0, 0}, 1e-15);
  // F S F^T by hand
  const double xx = 2 + 2 * g + 3 * g * g, yy = 3, xy = 1 + 3 * g;
  expect_near(value("cauchy_stress", sample), {xx, yy, 0, xy, 0, 0}, 1e-13);
  const double mean = (xx + yy) / 2, radius = std::hypot((xx - yy) / 2, xy);
  expect_near(value("max_principal_stress", sample), {mean + radius}, 1e-13);
  expect_near(value("min_principal_stress", sample), {mean - radius}, 1e-13);
}

TEST(FilmFields, TurnWithTheFilmInSpace) {
  Eigen::Matrix<double, 3, 2> F;
  F << 2, 0.3, -0.1, 1.5, 0, 0;
  Eigen::Matrix2d S;
  S << 5, 1, 1, -2;
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const auto flat = film_sample(F, S), turned = film_sample(R * F, S);

  for (const char* name : {"principal_stretches", "green_lagrange_strain", "min_principal_stress",
                           "max_principal_stress", "thickness", "tension_state"})
    expect_near(value(name, turned), value(name, flat), 1e-13);
  for (const char* name : {"log_strain", "cauchy_stress"}) {
    const auto tensor = [](const std::vector<double>& v) {
      Eigen::Matrix3d t;
      t << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
      return t;
    };
    const Eigen::Matrix3d expected = R * tensor(value(name, flat)) * R.transpose();
    EXPECT_LT((tensor(value(name, turned)) - expected).norm(), 1e-12) << name;
  }
}

TEST(FilmFields, SlopeIsThatOfThePlaneWhicheverSideIsUp) {
  for (const double angle : {0.0, 1e-9, 0.3, 1.5}) {
    const Eigen::Matrix3d tilt = Eigen::AngleAxisd(angle, Eigen::Vector3d(0.6, 0.8, 0)).toRotationMatrix();
    const auto tilted = film_sample(tilt * stretched(3, 2));
    expect_near(value("slope", tilted), {angle}, 1e-15);
    Eigen::Matrix<double, 3, 2> turned_over = tilted.F;
    turned_over.col(0) *= -1;
    expect_near(value("slope", film_sample(turned_over)), {angle}, 1e-15);
  }
}

TEST(FilmFields, UnknownLimitsGiveZeroRatios) {
  auto sample = film_sample(stretched(1, 1));
  sample.breakdown_field = 0;
  expect_near(value("breakdown_ratio", sample), {0}, 0);
}

TEST(WallFields, ReadTheSample) {
  std::vector<double> all;
  for (const WallField& field : wall_fields()) {
    std::vector<double> values(static_cast<std::size_t>(field.width()));
    field.evaluate(wall_sample(0, 1, 1), values.data());
    all.insert(all.end(), values.begin(), values.end());
  }
  expect_near(all, {1, 2, 3, 4, 5, 6, 7, 8, 9, 0.1, 0.11, 0.2}, 1e-15);
}

} // namespace
} // namespace dielast::post::fields_test
