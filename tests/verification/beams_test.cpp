// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/ramp.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::beams_test {
namespace {

using Curve = Eigen::Vector3d (*)(double);

/// Cantilever along a curve from its clamped first node; the tip carries a dead load.
class Cantilever {
 public:
  Cantilever(Curve curve, int elements, int order, bool planar, const materials::BeamSection& section)
      : mesh_(test::line(elements, order, curve)),
        model_(test::unnumbered_model(mesh_.node_count(), planar,
                                      make_beam_block(mesh_, mesh_.blocks[0], section))) {
    for (int c = 0; c < DofMap::components; ++c) model_->dofs.hold(0, c);
    model_->dofs.number();
    model_->length_scale = (mesh_.nodes[1] - mesh_.nodes[0]).norm();
    model_->extent = (mesh_.nodes.back() - mesh_.nodes.front()).norm();
    state_ = model_->initial_state();
  }

  void load(int component, double value, int increments) {
    Equilibrium equilibrium(*model_, 1);
    Loads target = Loads::of(state_, model_->dofs);
    target.dead_force.setZero();
    target.dead_force[model_->dofs.equation(mesh_.node_count() - 1, component)] = value;
    const RampOptions options{.newton = {.tolerance = 1e-10, .max_iterations = 25}, .increments = increments};
    RampProgress progress = RampProgress::begin(state_, model_->dofs, options);
    ASSERT_EQ(ramp(equilibrium, linear_path(model_->dofs, progress.start, target), options, progress, {}).end,
              RampEnd::complete);
    state_ = progress.points.back().state;
  }
  const Eigen::Vector3d& tip_displacement() const { return state_.displacement.back(); }
  const Eigen::Quaterniond& tip_rotation() const { return state_.rotation.back(); }

 private:
  meshing::Mesh mesh_;
  std::unique_ptr<Model> model_;
  State state_;
};

/// Orders log2(error / error on twice as many elements) between neighbouring meshes.
std::vector<double> orders(const std::vector<double>& errors) {
  std::vector<double> result;
  for (std::size_t i = 0; i + 1 < errors.size(); ++i) result.push_back(std::log2(errors[i] / errors[i + 1]));
  return result;
}

Eigen::Vector3d straight(double s) { return {s, 0, 0}; }
Eigen::Vector3d arc_of_45_degrees(double s) {
  const double angle = s * std::numbers::pi / 4;
  return {100 * std::sin(angle), 100 * (1 - std::cos(angle)), 0};
}

/// Displacement of the tip of the bend of Bathe & Bolourchi (1979), Int. J. Numer. Meth. Eng. 14, 961: radius
/// 100, section 1 x 1, dead tip load 600 normal to its plane, rounded stiffnesses.
Eigen::Vector3d bend(Curve curve, int elements, int order) {
  Cantilever beam(curve, elements, order, false,
                  {.EA = 1e7, .GA2 = 4166670, .GA3 = 4166670, .GJ = 833300, .EI2 = 833300, .EI3 = 833300});
  beam.load(2, 600, 6);
  return beam.tip_displacement();
}

double bend_error(int elements, int order) {
  // The same boundary-value problem by shooting (Runge-Kutta of order 4, 4000 steps, all digits converged).
  const Eigen::Vector3d reference(-23.56129678671, -13.60502300964, 53.47610814028);
  return (bend(arc_of_45_degrees, elements, order) - reference).norm();
}

TEST(BatheBolourchiBend, two_node_elements_converge_with_order_2) {
  std::vector<double> errors;
  for (const int n : {8, 16, 32, 64}) errors.push_back(bend_error(n, 1));
  for (const double order : orders(errors)) EXPECT_NEAR(order, 2, 0.1);
  EXPECT_LT(errors.back(), 0.03);
}

TEST(BatheBolourchiBend, three_node_elements_converge_with_order_4) {
  std::vector<double> errors;
  for (const int n : {8, 16, 32, 64}) errors.push_back(bend_error(n, 2));
  for (const double order : orders(errors)) EXPECT_NEAR(order, 4, 0.1);
  EXPECT_LT(errors.back(), 1e-6);
}

// Kynema's documentation has 14 digits for "the" bend, but its centreline is the parabola through three
// points of the arc, which moves the tip by 0.18.
TEST(BatheBolourchiBend, equals_a_spectral_element_on_its_own_centreline) {
  const Curve parabola = [](double s) {
    constexpr double middle = 38.2683, end = 70.7107, y_middle = 7.61205, y_end = 29.2893;
    const double x = s * end;
    return Eigen::Vector3d(x,
                           y_middle * x * (x - end) / (middle * (middle - end)) +
                               y_end * x * (x - middle) / (end * (end - middle)),
                           0);
  };
  const Eigen::Vector3d reference(-23.6459716009047, -13.7208006040058, 53.5776450626987);
  const double error_32 = (bend(parabola, 32, 2) - reference).norm(),
               error_64 = (bend(parabola, 64, 2) - reference).norm();
  EXPECT_LT(error_64, 1e-6);
  EXPECT_NEAR(std::log2(error_32 / error_64), 4, 0.1);
}

struct ElasticaRow {
  double load, deflection, shortening, slope; // P L^2/EI, w/L, u/L, rad
};

// Inextensible, shear-rigid cantilever under a dead end load: elliptic integrals, agreeing with Mattiasson
// (1981), Int. J. Numer. Meth. Eng. 17, 145. Ours stretches and shears by P/EA = 1e-8 P L^2/EI.
TEST(Elastica, matches_the_closed_form) {
  constexpr std::array<ElasticaRow, 9> table{{
      {0.2, 0.06636448214483281, 0.002646548340523802, 0.09963616303740166},
      {0.5, 0.1621435756583698, 0.015918962470837683, 0.2445336471332182},
      {1, 0.30172077379981355, 0.05643323628337715, 0.46135194971187865},
      {2, 0.4934574803967118, 0.16064172082516714, 0.7817498315565432},
      {3, 0.6032534411299775, 0.25442018456418725, 0.9860169467113538},
      {4, 0.6699641812776667, 0.32894124224684596, 1.1212393474875761},
      {5, 0.7137915236119129, 0.38762836072442985, 1.2153681176116817},
      {7, 0.7673690997404633, 0.47292742838633695, 1.3349598574718555},
      {10, 0.8106090248802966, 0.5549955977537513, 1.4302855388038584},
  }};
  Cantilever beam(straight, 32, 2, true, {.EA = 1e8, .GA2 = 1e8, .GA3 = 1e8, .GJ = 1, .EI2 = 1, .EI3 = 1});
  for (const ElasticaRow& row : table) {
    beam.load(1, row.load, 2);
    EXPECT_NEAR(beam.tip_displacement().y(), row.deflection, 1e-6) << row.load;
    EXPECT_NEAR(-beam.tip_displacement().x(), row.shortening, 1e-6) << row.load;
    EXPECT_NEAR(spin_of(beam.tip_rotation()).z(), row.slope, 1e-6) << row.load;
  }
}

/// Tip position error of a cantilever rolled up by the moment 2 pi EI/L to a circle: the tip returns to the
/// root. Stiff against torsion and lateral bending, or it would buckle out of the plane.
double roll_up_error(int elements, int order, bool planar) {
  Cantilever beam(straight, elements, order, planar,
                  {.EA = 1e6, .GA2 = 1e6, .GA3 = 1e6, .GJ = 100, .EI2 = 100, .EI3 = 1});
  beam.load(5, 2 * std::numbers::pi, 10);
  return (beam.tip_displacement() + Eigen::Vector3d::UnitX()).norm();
}

TEST(RollUp, to_a_full_circle_converges_with_the_order_of_the_element) {
  std::vector<double> linear, quadratic;
  for (const int n : {16, 32, 64}) {
    linear.push_back(roll_up_error(n, 1, true));
    quadratic.push_back(roll_up_error(n, 2, true));
  }
  for (const double order : orders(linear)) EXPECT_NEAR(order, 2, 0.1);
  for (const double order : orders(quadratic)) EXPECT_NEAR(order, 4, 0.2);
  EXPECT_LT(linear.back(), 1e-2);
  EXPECT_LT(quadratic.back(), 1e-5);
  EXPECT_NEAR(roll_up_error(16, 2, false), quadratic.front(), 1e-7); // in space as in the plane
}

// M L/EI = theta: x = L sin(theta)/theta, y = L (1 - cos(theta))/theta.
TEST(RollUp, passes_the_arcs_on_its_way) {
  Cantilever beam(straight, 32, 2, true, {.EA = 1e6, .GA2 = 1e6, .GA3 = 1e6, .GJ = 1, .EI2 = 1, .EI3 = 1});
  for (const double theta : {0.5, 1.5, 3.0, 4.5}) {
    beam.load(5, theta, 2);
    const Eigen::Vector3d expected(std::sin(theta) / theta - 1, (1 - std::cos(theta)) / theta, 0);
    EXPECT_LT((beam.tip_displacement() - expected).norm(), 1e-5) << theta;
    EXPECT_NEAR(2 * std::atan2(beam.tip_rotation().z(), beam.tip_rotation().w()), theta, 1e-5);
  }
}

} // namespace
} // namespace dielast::fem::beams_test
