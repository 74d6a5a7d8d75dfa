// SPDX-License-Identifier: GPL-3.0-or-later
// Deformable solids against one another: the patch test across meshes that do not match, and Hertz.
#include "tests/verification/two_bodies.hpp"

#include "fem/contact/face.hpp"
#include "fem/films/triangle.hpp"
#include "fem/model/assembler.hpp"
#include "meshing/solids/extruded.hpp"
#include "meshing/solids/sides.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include <cmath>
#include <numbers>

namespace dielast::fem::surface_contact_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double contact_modulus = 4 * mu; ///< E / (1 - nu^2), incompressible

/// Two blocks of 5 and 7 elements, pressed by a fifth of their height, free to widen: homogeneous.
TEST(SurfaceContact, passes_the_patch_test_across_meshes_that_do_not_match) {
  constexpr double thickness = 1e-3;
  const auto block = [](int elements, double bottom, double face) {
    const auto place = [](double u, double v) { return Eigen::Vector3d(u, v, 0); };
    return named({even_line(0, 1, elements), even_line(bottom, bottom + 1, elements), place}, bottom + face,
                 bottom + 1 - face);
  };
  TwoBodies blocks(block(5, 0, 1), block(7, 1 + thickness, 0), Dimension::planar,
                   {thickness, 0.03 * mu / thickness, 1}, false, 1);
  const State state = blocks.press(0.4, 1e-13);
  const double pressed = contact_force(blocks.model, state);
  EXPECT_NEAR(-blocks.reaction("upper.back"), blocks.reaction("lower.back"), 1e-10 * pressed);
  EXPECT_NEAR(-blocks.reaction("upper.back"), pressed, 2e-4 * pressed); // some of it aside, at the edge
  // mu (l - 1/l^3) of the stretch l along y, per area as drawn.
  for (const char* place : {"lower.face", "upper.face"}) {
    const double way = state.displacement[static_cast<std::size_t>(blocks.nodes(place).front())].y();
    const double l = place[0] == 'l' ? 1 + way : 1 - 0.4 - way;
    EXPECT_NEAR(blocks.reaction("lower.back"), mu * (1 / (l * l * l) - l), 1e-3 * pressed) << place;
  }
  // Where the one shape functions have their kinks between points of the other surface pressures are uneven;
  // the last element meets the other surface's edge.
  const NodalPressure pressure = blocks.pressure(state);
  double worst = 0;
  for (const char* place : {"lower.face", "upper.face"})
    for (const int node : blocks.nodes(place)) {
      const auto n = static_cast<std::size_t>(node);
      if (blocks.mesh.nodes[n].x() < 0.8)
        worst = std::max(worst, std::abs(pressure.force[n] / pressure.area[n] / pressed - 1));
    }
  RecordProperty("largest error of a pressure", std::to_string(worst));
  EXPECT_LT(worst, 0.005);
}

/// Halves of two bodies, 0.4 long and high, whose faces are those of cylinders or spheres of radius 1.
struct Hertz : TwoBodies {
  static constexpr double size = 0.4, thickness = 2e-6;
  explicit Hertz(Dimension drawn)
      : TwoBodies(body(1e-3, -1, drawn), body(1.3e-3, 1, drawn), drawn, {thickness, 0.1 * mu / thickness, 1},
                  true, size) {}
  static meshing::Mesh body(double finest, double way, Dimension drawn) {
    const std::vector<double> across = meshing::graded_line({0, size}, {0}, finest, size / 6);
    std::vector<double> heights = across;
    if (way < 0) {
      for (double& v : heights) v = -v;
      std::ranges::reverse(heights);
    }
    const Eigen::Vector3d up = Eigen::Vector3d::Unit(drawn == Dimension::axisymmetric ? 2 : 1);
    return named({across, heights,
                  [&](double u, double v) -> Eigen::Vector3d {
                    const double height = v + way * (thickness / 2 + u * u / 2 * (1 - way * v / size));
                    return u * Eigen::Vector3d::UnitX() + height * up;
                  }},
                 0, way * size);
  }
  /// Force, and the means of x^2 weighted with the pressure on either face.
  std::array<double, 3> pressed(const State& state) const {
    const NodalPressure pressure = this->pressure(state);
    std::array<double, 3> result{contact_force(model, state), 0, 0};
    for (std::size_t k = 0; k < 2; ++k) {
      double sum = 0;
      for (const int node : nodes(k == 0 ? "lower.face" : "upper.face")) {
        const auto n = static_cast<std::size_t>(node);
        const double x = mesh.nodes[n].x() + state.displacement[n].x();
        sum += pressure.force[n];
        result[k + 1] += pressure.force[n] * x * x;
      }
      result[k + 1] /= sum;
    }
    return result;
  }
};

/// Johnson, Contact Mechanics, 4.2: F = pi E* a^2 / (4 R) per length, 1/E* = 2/E', 1/R = 2; the mean x^2 of
/// the pressures is a^2/4.
TEST(SurfaceContact, cylinders_on_one_another_bear_the_force_of_hertz) {
  Hertz cylinders(Dimension::planar);
  const State state = cylinders.press(12e-4, 1e-8);
  const auto [half, lower, upper] = cylinders.pressed(state);
  EXPECT_NEAR(cylinders.reaction("lower.back"), half, 1e-3 * half);
  EXPECT_NEAR(-cylinders.reaction("upper.back"), cylinders.reaction("lower.back"), 1e-6 * half);
  const double second = (lower + upper) / 2;
  RecordProperty("force over Hertz", std::to_string(2 * half / (pi * contact_modulus * second)));
  EXPECT_NEAR(lower, upper, 0.02 * upper);
  EXPECT_NEAR(2 * half, pi * contact_modulus * second, 0.02 * 2 * half);
  double peak = 0;
  const NodalPressure pressure = cylinders.pressure(state);
  for (std::size_t n = 0; n < pressure.area.size(); ++n)
    if (pressure.area[n] > 0) peak = std::max(peak, pressure.force[n] / pressure.area[n]);
  EXPECT_NEAR(peak, 4 * half / (pi * std::sqrt(4 * second)), 0.01 * peak); // 2 F / (pi a)
}

/// F = 4 E* a^3 / (3 R), the mean r^2 of the pressures is 2 a^2 / 5.
TEST(SurfaceContact, spheres_on_one_another_bear_the_force_of_hertz) {
  Hertz spheres(Dimension::axisymmetric);
  const auto [force, lower, upper] = spheres.pressed(spheres.press(12e-4, 1e-8));
  const double a = std::sqrt(2.5 * (lower + upper) / 2);
  RecordProperty("force over Hertz", std::to_string(force / (4.0 / 3 * contact_modulus * a * a * a)));
  EXPECT_NEAR(force, 4.0 / 3 * contact_modulus * a * a * a, 0.02 * force);
}

/// The least gap of the bodies' faces, m, at many more points than they are integrated with; negative where
/// one is behind the other.
double least_gap(const TwoBodies& bodies, const State& state) {
  const auto faces = [&](const char* place) {
    const meshing::CellBlock cells = meshing::faces_at(bodies.mesh, place); // their normals point inwards
    std::vector<FaceNodes> all(static_cast<std::size_t>(cells.size()));
    for (int i = 0; i < cells.size(); ++i)
      for (std::size_t a = 0; a < 6; ++a) {
        const auto n = static_cast<std::size_t>(cells.cell(i)[a]);
        all[static_cast<std::size_t>(i)].col(static_cast<int>(a)) =
            bodies.mesh.nodes[n] + state.displacement[n];
      }
    return all;
  };
  const std::vector<FaceNodes> lower = faces("lower.face"), upper = faces("upper.face");
  double least = 1;
  constexpr int parts = 13;
  for (const FaceNodes& own : lower)
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const Eigen::Vector3d x =
            own * shape_values<6>(static_cast<double>(i) / parts, static_cast<double>(j) / parts);
        double nearest = 1e-2, gap = nearest;
        for (const FaceNodes& other : upper) {
          if (box_of(other).exteriorDistance(x) >= nearest) continue;
          const FacePlace place = nearest_place(other, {}, x);
          if (place.distance >= nearest) continue;
          nearest = place.distance;
          gap = place.normal.y() < 0 ? nearest : -nearest; // the lower one is below
        }
        least = std::min(least, gap);
      }
  return least;
}

/// Two cubes of 2 and 3 elements along each edge, pressed by a fifth of their height, free to widen.
TEST(SurfaceContact, passes_the_patch_test_in_space) {
  constexpr double thickness = 1e-3;
  const auto block = [](int elements, double bottom, double face) {
    const auto place = [](double u, double v) { return Eigen::Vector3d(u, v, 0); };
    const meshing::Mesh side =
        named({even_line(0, 1, elements), even_line(bottom, bottom + 1, elements), place}, bottom + face,
              bottom + 1 - face);
    return meshing::extruded(
        side, even_line(0, 1, elements),
        [](const Eigen::Vector3d& drawn, double level) {
          return Eigen::Vector3d(drawn.x(), drawn.y(), level);
        },
        "deep", "front");
  };
  TwoBodies blocks(block(2, 0, 1), block(3, 1 + thickness, 0), Dimension::spatial,
                   {thickness, 0.03 * mu / thickness, 1}, false, 1);
  const State state = blocks.press(0.4, 1e-12);
  EXPECT_GT(least_gap(blocks, state), 0);
  const double pressed = contact_force(blocks.model, state);
  EXPECT_NEAR(-blocks.reaction("upper.back"), blocks.reaction("lower.back"), 1e-9 * pressed);
  EXPECT_NEAR(-blocks.reaction("upper.back"), pressed, 1e-3 * pressed);
  // mu (1/l^2 - l) of the stretch l along y, per area as drawn.
  for (const char* place : {"lower.face", "upper.face"}) {
    const double way = state.displacement[static_cast<std::size_t>(blocks.nodes(place).front())].y();
    const double l = place[0] == 'l' ? 1 + way : 1 - 0.4 - way;
    EXPECT_NEAR(blocks.reaction("lower.back"), mu * (1 / (l * l) - l), 2e-3 * pressed) << place;
  }
  const NodalPressure pressure = blocks.pressure(state);
  double worst = 0;
  for (const char* place : {"lower.face", "upper.face"})
    for (const int node : blocks.nodes(place)) {
      const auto n = static_cast<std::size_t>(node);
      if (blocks.mesh.nodes[n].x() < 0.6 && blocks.mesh.nodes[n].z() < 0.6)
        worst = std::max(worst, std::abs(pressure.force[n] / pressure.area[n] / pressed - 1));
    }
  RecordProperty("largest error of a pressure", std::to_string(worst));
  EXPECT_LT(worst, 0.02);
}

/// The half width of the contact of two spheres, m: the mean r^2 of the pressures is 2 a^2 / 5. Nodal forces
/// of quadratic faces have the pressures' own second moment.
double half_width(const TwoBodies& bodies, const State& state, const char* place) {
  Assembler assembler(bodies.model, 1);
  Eigen::VectorXd unused;
  assembler.residual(state, unused);
  const Eigen::VectorXd& force = assembler.block_residuals()[1];
  double sum = 0, second = 0;
  for (const int node : bodies.nodes(place)) {
    const auto n = static_cast<std::size_t>(node);
    const Eigen::Vector3d x = bodies.mesh.nodes[n] + state.displacement[n];
    const double pushed = force[bodies.model.dofs.equation(node, bodies.up)];
    sum += pushed;
    second += pushed * (x.x() * x.x() + x.z() * x.z());
  }
  return std::sqrt(2.5 * second / sum);
}

/// Quarters of two spheres in space, of meshes that do not match, with 2.4 and 3.2 elements in the contact's
/// half width: what is missing to Hertz's force comes of the meshes (4 % and 1 %).
TEST(SurfaceContact, spheres_on_one_another_in_space_bear_the_force_of_hertz) {
  constexpr double size = 0.4, radius = 4, thickness = 2e-5, depth = 0.004;
  const auto body = [](double way, double finest) {
    const std::vector<double> across = meshing::graded_line({0, size}, {0, 0.13}, finest, size / 3);
    std::vector<double> heights = meshing::graded_line({0, size}, {0}, finest, size / 3);
    if (way < 0) {
      for (double& v : heights) v = -v;
      std::ranges::reverse(heights);
    }
    const auto flat = [](double u, double v) { return Eigen::Vector3d(u, v, 0); };
    return meshing::extruded(
        named({across, heights, flat}, 0, way * size), across,
        [way](const Eigen::Vector3d& drawn, double z) {
          const double round = (drawn.x() * drawn.x() + z * z) / (2 * radius);
          const double sag = thickness / 2 + round * (1 - way * drawn.y() / size);
          return Eigen::Vector3d(drawn.x(), drawn.y() + way * sag, z);
        },
        "deep", "front");
  };
  std::vector<double> errors;
  for (const double finest : {0.04, 0.03}) {
    TwoBodies spheres(body(-1, 1.3 * finest), body(1, finest), Dimension::spatial,
                      {thickness, 0.1 * mu / thickness, 1}, true, size);
    const State state = spheres.press(depth, 1e-7, 3);
    EXPECT_GT(least_gap(spheres, state), 0);
    const double force = 4 * contact_force(spheres.model, state);
    EXPECT_NEAR(force, -4 * spheres.reaction("upper.back"), 1e-4 * force);
    const double lower = half_width(spheres, state, "lower.face"),
                 upper = half_width(spheres, state, "upper.face"), a = (lower + upper) / 2;
    EXPECT_NEAR(lower, upper, 1e-3 * upper);
    const double hertz = 4.0 / 3 * (contact_modulus / 2) * a * a * a / (radius / 2);
    errors.push_back(force / hertz - 1);
    RecordProperty("error at " + std::to_string(a / finest), std::to_string(errors.back()));
  }
  EXPECT_LT(std::abs(errors[0]), 0.06);
  EXPECT_LT(std::abs(errors[1]), 0.02);
}

/// A quarter of a body whose face is that of a sphere, of a radius at which strains are small, on a block
/// that does not give way: F = 4 E* a^3 / (3 R), the mean r^2 of the pressures is 2 a^2 / 5.
TEST(SurfaceContact, sphere_in_space_bears_the_force_of_hertz) {
  constexpr double size = 0.4, radius = 4, thickness = 2e-5;
  const auto drawn_out = [](const meshing::Mesh& side, const std::vector<double>& levels, double curvature) {
    return meshing::extruded(
        side, levels,
        [curvature](const Eigen::Vector3d& drawn, double z) {
          const double sag = curvature * (drawn.x() * drawn.x() + z * z) / 2 * (1 - drawn.y() / size);
          return Eigen::Vector3d(drawn.x(), drawn.y() + sag, z);
        },
        "deep", "front");
  };
  const auto flat = [](double u, double v) { return Eigen::Vector3d(u, v, 0); };
  const std::vector<double> across = meshing::graded_line({0, size}, {0, 0.13}, 0.04, size / 3),
                            heights = meshing::graded_line({0, size}, {0}, 0.04, size / 3);
  meshing::TriangleGrid side(even_line(0, size, 9), {-0.1, -thickness}, flat);
  side.name_nodes("axis", [](double u, double) { return u == 0; });
  side.name_nodes("face", [](double, double v) { return v == -thickness; });
  side.name_nodes("back", [](double, double v) { return v == -0.1; });
  TwoBodies bodies(drawn_out(side.take(), even_line(0, size, 9), 0),
                   drawn_out(named({across, heights, flat}, 0, size), across, 1 / radius), Dimension::spatial,
                   {thickness, 0.1 * mu / thickness, 1}, true, size, true);
  const State state = bodies.press(0.004, 1e-7, 2);
  const double gap = least_gap(bodies, state);
  RecordProperty("unknowns", bodies.model.dofs.free_count());
  RecordProperty("least gap over thickness", std::to_string(gap / thickness));
  EXPECT_GT(gap, 0);
  const double quarter = contact_force(bodies.model, state);
  const NodalPressure pressure = bodies.pressure(state);
  double second = 0, sum = 0;
  for (const int node : bodies.nodes("lower.face")) {
    const auto n = static_cast<std::size_t>(node);
    const Eigen::Vector3d x = bodies.mesh.nodes[n];
    sum += pressure.force[n];
    second += pressure.force[n] * (x.x() * x.x() + x.z() * x.z());
  }
  const double a = std::sqrt(2.5 * second / sum), hertz = 4.0 / 3 * contact_modulus * a * a * a / radius;
  RecordProperty("half width", std::to_string(a));
  RecordProperty("force over Hertz", std::to_string(4 * quarter / hertz));
  EXPECT_NEAR(4 * quarter, hertz, 0.02 * hertz);
}

} // namespace
} // namespace dielast::fem::surface_contact_test
