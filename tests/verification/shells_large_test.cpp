// SPDX-License-Identifier: GPL-3.0-or-later
// Large deflections: Sze, Liu & Lo 2004, Finite Elem. Anal. Des. 40, 1551 (tables of converged S4R meshes).
#include "tests/verification/shell_problem.hpp"

#include <cmath>
#include <numbers>

namespace dielast::fem::shells_large_test {
namespace {

using std::numbers::pi;
using test::elastic_shell;
using test::ShellProblem;

struct Row {
  double load, first, second; // load over the largest one, displacements
};

constexpr double rounding = 5e-4; ///< of the tables

TEST(CantileverPlate, bends_under_end_shear_as_published) {
  constexpr Row table[] = {
      {0.05, 0.026, 0.663}, {0.1, 0.103, 1.309}, {0.15, 0.224, 1.922}, {0.2, 0.381, 2.493},
      {0.25, 0.563, 3.015}, {0.3, 0.763, 3.488}, {0.35, 0.971, 3.912}, {0.4, 1.184, 4.292},
      {0.45, 1.396, 4.631}, {0.5, 1.604, 4.933}, {0.55, 1.807, 5.202}, {0.6, 2.002, 5.444},
      {0.65, 2.19, 5.66},   {0.7, 2.37, 5.855},  {0.75, 2.541, 6.031}, {0.8, 2.705, 6.19},
      {0.85, 2.861, 6.335}, {0.9, 3.01, 6.467},  {0.95, 3.151, 6.588}, {1.0, 3.286, 6.698}};
  ShellProblem plate(
      8, 1, [](double u, double v) { return Eigen::Vector3d(10 * u, v, 0); }, elastic_shell(1.2e6, 0, 0.1));
  plate.hold(plate.side(0, 0), {0, 1, 2, 3, 4, 5});
  plate.number();
  plate.load_side(plate.side(0, 1), 2, 4);
  for (const auto& [load, shortening, deflection] : table) {
    ASSERT_EQ(plate.raise(load, 1).end, RampEnd::complete);
    EXPECT_NEAR(-plate.displacement(plate.node(1, 0)).x(), shortening, 0.015 * shortening + rounding) << load;
    EXPECT_NEAR(plate.displacement(plate.node(1, 0)).z(), deflection, 0.015 * deflection + rounding) << load;
  }
}

// Theta = 2 pi M/M_max: u = L (sin(theta)/theta - 1), w = L (1 - cos(theta))/theta. A moment about a fixed
// axis has no potential; with the tip's other spins held, which do not turn, it has.
TEST(CantileverPlate, rolls_up_to_a_circle_under_an_end_moment) {
  std::vector<double> errors;
  for (const int n : {8, 16}) {
    ShellProblem plate(
        n, 1, [](double u, double v) { return Eigen::Vector3d(12 * u, v, 0); }, elastic_shell(1.2e6, 0, 0.1));
    plate.hold(plate.side(0, 0), {0, 1, 2, 3, 4, 5});
    plate.hold(plate.side(0, 1), {1, 3, 5});
    plate.number();
    plate.load_side(plate.side(0, 1), 4, -50 * pi / 3);
    for (const double part : {0.25, 0.5, 0.75, 1.0}) {
      ASSERT_EQ(plate.raise(part, 5).end, RampEnd::complete);
      const double theta = 2 * pi * part;
      const Eigen::Vector3d u = plate.displacement(plate.node(1, 0)),
                            exact(12 * (std::sin(theta) / theta - 1), 0, 12 * (1 - std::cos(theta)) / theta);
      EXPECT_LT((u - exact).norm(), (n == 16 ? 0.001 : 0.005) * 12) << part;
      if (part == 1) errors.push_back((u - exact).norm());
    }
  }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 2.5);
}

TEST(SlitAnnulus, lifts_as_published) {
  constexpr Row table[] = {
      {0.025, 1.305, 1.789}, {0.05, 2.455, 3.37},   {0.075, 3.435, 4.72},  {0.1, 4.277, 5.876},
      {0.125, 5.007, 6.872}, {0.15, 5.649, 7.736},  {0.2, 6.725, 9.16},    {0.25, 7.602, 10.288},
      {0.3, 8.34, 11.213},   {0.35, 8.974, 11.992}, {0.4, 9.529, 12.661},  {0.45, 10.023, 13.247},
      {0.5, 10.468, 13.768}, {0.55, 10.876, 14.24}, {0.6, 11.257, 14.674}, {0.65, 11.62, 15.081},
      {0.7, 11.97, 15.469},  {0.75, 12.31, 15.842}, {0.8, 12.642, 16.202}, {0.85, 12.966, 16.55},
      {0.9, 13.282, 16.886}, {0.95, 13.59, 17.212}, {1.0, 13.891, 17.528}};
  ShellProblem plate(
      36, 6,
      [](double u, double v) {
        const double r = 6 + 4 * v, angle = -2 * pi * u;
        return Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 0);
      },
      elastic_shell(2.1e7, 0, 0.03));
  plate.hold(plate.side(0, 0), {0, 1, 2, 3, 4, 5});
  plate.number();
  plate.load_side(plate.side(0, 1), 2, 0.8 * 4);
  for (const auto& [load, inner, outer] : table) {
    ASSERT_EQ(plate.raise(load, 1).end, RampEnd::complete);
    EXPECT_NEAR(plate.displacement(plate.node(1, 0)).z(), inner, 0.015 * inner) << load;
    EXPECT_NEAR(plate.displacement(plate.node(1, 1)).z(), outer, 0.015 * outer) << load;
  }
}

TEST(PinchedHemisphere, deflects_far_as_published) {
  ShellProblem half = test::hemisphere(16);
  half.load(half.node(0, 0), 0, 200);
  half.load(half.node(1, 0), 1, -200);
  ASSERT_EQ(half.raise(1, 10).end, RampEnd::complete);
  EXPECT_NEAR(half.displacement(half.node(0, 0)).x(), 4.067, 0.02 * 4.067);
  EXPECT_NEAR(-half.displacement(half.node(1, 0)).y(), 8.178, 0.02 * 8.178);
}

TEST(HingedRoof, snaps_through_its_limit_points_as_published) {
  constexpr struct {
    double load, deflection;
  } table[] = {{0.0877, 0.693},  {0.198, 1.638},   {0.3473, 3.087},  {0.4686, 4.477},  {0.5647, 5.802},
               {0.6381, 7.057},  {0.6908, 8.237},  {0.7246, 9.339},  {0.7412, 10.358}, {0.7421, 11.293},
               {0.7286, 12.141}, {0.7023, 12.903}, {0.6649, 13.583}, {0.6182, 14.188}, {0.5643, 14.728},
               {0.5055, 15.217}, {0.4442, 15.676}, {0.383, 16.125},  {0.3245, 16.59},  {0.2717, 17.094},
               {0.2272, 17.657}, {0.194, 18.299},  {0.175, 19.028},  {0.1729, 19.852}, {0.1905, 20.771},
               {0.2303, 21.78},  {0.295, 22.875},  {0.3871, 24.049}, {0.5093, 25.293}, {0.6644, 26.601},
               {0.8549, 27.964}, {1.0835, 29.374}};
  ShellProblem roof(
      8, 8,
      [](double u, double v) {
        return Eigen::Vector3d(2540 * std::sin(0.1 * u), 254 * v, 2540 * std::cos(0.1 * u));
      },
      elastic_shell(3102.75, 0.3, 12.7));
  roof.hold(roof.side(0, 1), {0, 1, 2});
  roof.hold(roof.side(0, 0), {0, 4, 5}); // planes of symmetry
  roof.hold(roof.side(1, 0), {1, 3, 5});
  roof.number();
  constexpr double highest = 1.2; // of the load 3000
  roof.load(roof.node(0, 0), 2, -highest * 3000 / 4);
  Equilibrium equilibrium(roof.model(), 1);
  const Loads none = Loads::of(roof.state(), roof.model().dofs);
  Loads target = none;
  target.dead_force = roof.load();
  const LoadPath path = linear_path(roof.model().dofs, none, target);
  const ContinuationOptions options{.newton = {.tolerance = 1e-8, .max_iterations = 12},
                                    .first_arc = 0.002,
                                    .largest_arc = 0.006,
                                    .wanted_iterations = 8};
  auto progress = begin_continuation(equilibrium, path, roof.state(), 0, options);
  ASSERT_TRUE(progress);
  std::vector<std::pair<double, double>> found{{0, 0}}; // deflection, load
  const auto end =
      continuation(equilibrium, path, options, *progress, {.on_accept = [&](const ContinuationProgress& at) {
                     found.emplace_back(-at.state.displacement[static_cast<std::size_t>(roof.node(0, 0))].z(),
                                        highest * at.load_factor);
                     return true;
                   }});
  ASSERT_EQ(end, ContinuationEnd::reached_load);
  ASSERT_TRUE(std::ranges::is_sorted(found));
  for (const auto& [load, deflection] : table) {
    const auto next = std::ranges::lower_bound(found, std::pair{deflection, -1.0});
    const auto& [w1, P1] = *next;
    const auto& [w0, P0] = *(next - 1);
    const double there = P0 + (P1 - P0) * (deflection - w0) / (w1 - w0), slope = (P1 - P0) / (w1 - w0);
    // across the curve: in load or in deflection, whichever is nearer
    const double error =
        std::min(std::abs(there / load - 1), std::abs((there - load) / (slope * deflection)));
    EXPECT_LT(error, 0.015) << load << " " << deflection;
  }
}

} // namespace
} // namespace dielast::fem::shells_large_test
