// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/films/triangle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace dielast::fem::triangle_test {
namespace {

constexpr std::array<std::array<double, 2>, 6> places{
    {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}};

template<int Nodes>
Eigen::Vector<double, Nodes> shape_values(double xi, double eta);

template<>
Eigen::Vector<double, 3> shape_values<3>(double xi, double eta) {
  return {1 - xi - eta, xi, eta};
}

template<>
Eigen::Vector<double, 6> shape_values<6>(double xi, double eta) {
  const double zeta = 1 - xi - eta;
  Eigen::Vector<double, 6> values;
  values << zeta * (2 * zeta - 1), xi * (2 * xi - 1), eta * (2 * eta - 1), 4 * zeta * xi, 4 * xi * eta,
      4 * eta * zeta;
  return values;
}

double factorial(int n) { return std::tgamma(n + 1.0); }

// int xi^p eta^q over the triangle = p! q! / (p + q + 2)!
TEST(TriangleRule, integrates_polynomials_of_its_degree_exactly) {
  for (const auto& [points, degree] : {std::pair{1, 1}, {3, 2}, {6, 4}})
    for (int p = 0; p <= degree; ++p)
      for (int q = 0; p + q <= degree; ++q) {
        double sum = 0;
        for (const TrianglePoint& at : triangle_rule(points))
          sum += at.weight * std::pow(at.xi, p) * std::pow(at.eta, q);
        EXPECT_NEAR(sum, factorial(p) * factorial(q) / factorial(p + q + 2), 1e-15)
            << points << " points, xi^" << p << " eta^" << q;
      }
  EXPECT_EQ(triangle_rule(6).size(), 6U);
  EXPECT_THROW(triangle_rule(4), std::invalid_argument);
}

template<int Nodes>
void expect_interpolation() {
  for (int a = 0; a < Nodes; ++a)
    for (int b = 0; b < Nodes; ++b)
      EXPECT_NEAR(shape_values<Nodes>(places[b][0], places[b][1])[a], a == b, 1e-15);
  const double h = 1e-3, xi = 0.23, eta = 0.41; // central differences of quadratics are exact
  const auto gradients = shape_gradients<Nodes>(xi, eta);
  EXPECT_LT(
      (gradients.col(0) - (shape_values<Nodes>(xi + h, eta) - shape_values<Nodes>(xi - h, eta)) / (2 * h))
          .norm(),
      1e-12);
  EXPECT_LT(
      (gradients.col(1) - (shape_values<Nodes>(xi, eta + h) - shape_values<Nodes>(xi, eta - h)) / (2 * h))
          .norm(),
      1e-12);
  EXPECT_LT(gradients.colwise().sum().norm(), 1e-14);
}

TEST(ShapeFunctions, are_one_at_their_node_and_gradients_are_their_derivatives) {
  expect_interpolation<3>();
  expect_interpolation<6>();
}

} // namespace
} // namespace dielast::fem::triangle_test
