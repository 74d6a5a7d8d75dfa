// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

// Sheared and electrically loosened films that resist bending, beside their tension fields: gallery/wrinkles.

namespace dielast::cases::wrinkles_test {
namespace {

constexpr double shear = 2e-3, height = 50e-3, thickness = 0.2e-3; // m

struct Film {
  meshing::Mesh mesh;
  std::vector<Eigen::Vector3d> displacement;
  Ending ending;
};

Film run(const char* file, const std::vector<std::string>& settings = {}) {
  const Case one =
      read_case(std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/wrinkles" / file, settings);
  Simulation simulation(one, 1);
  const Outcome outcome = simulation.run({});
  return {simulation.device().mesh, simulation.state().displacement, outcome.ending};
}

Film complete(const char* file, const std::vector<std::string>& settings = {}) {
  Film film = run(file, settings);
  EXPECT_EQ(film.ending, Ending::complete);
  return film;
}

/// Root mean square distance in the plane between the nodes of two films at most `farthest` from the middle,
/// m.
double distance_in_plane(const Film& one, const Film& other, double farthest) {
  EXPECT_EQ(one.mesh.nodes.size(), other.mesh.nodes.size());
  double squares = 0;
  int count = 0;
  for (std::size_t n = 0; n < one.mesh.nodes.size(); ++n) {
    EXPECT_LT((one.mesh.nodes[n] - other.mesh.nodes[n]).norm(), 1e-12);
    if (std::abs(one.mesh.nodes[n].x()) > farthest) continue;
    squares += (one.displacement[n] - other.displacement[n]).head<2>().squaredNorm();
    ++count;
  }
  return std::sqrt(squares / count);
}

/// Distances along an axis (0: x, 1: y) between the zeros of the deflection where the other coordinate is
/// `at`, at least `margin` from the ends, m.
std::vector<double> half_waves(const Film& film, int axis, double at, double margin) {
  std::vector<std::array<double, 2>> row; // place, z
  for (std::size_t n = 0; n < film.mesh.nodes.size(); ++n)
    if (const Eigen::Vector3d& x = film.mesh.nodes[n]; std::abs(x[1 - axis] - at) < 1e-9)
      row.push_back({x[axis], film.displacement[n].z()});
  std::ranges::sort(row);
  std::vector<double> zeros, distances;
  for (std::size_t i = 1; i < row.size(); ++i) {
    const auto& [x0, z0] = row[i - 1];
    const auto& [x1, z1] = row[i];
    if (z0 * z1 < 0 && x0 > row.front()[0] + margin && x1 < row.back()[0] - margin)
      zeros.push_back(x0 - z0 * (x1 - x0) / (z1 - z0));
  }
  for (std::size_t i = 1; i < zeros.size(); ++i) distances.push_back(zeros[i] - zeros[i - 1]);
  return distances;
}

double mean_of(const std::vector<double>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0) / static_cast<double>(numbers.size());
}

// Wong & Pellegrino 2006 (J. Mech. Mater. Struct. 1, 27-61): the half-wavelength sqrt(pi H t)/(3 (1 - nu^2)
// gamma)^(1/4) across wrinkles at 45 degrees, without a prestretch.
TEST(Wrinkles, sheared_film_wrinkles_as_published_about_its_tension_field) {
  const Film wrinkled = complete("case.toml"), mean = complete("tension_field.toml");
  const std::vector<double> found = half_waves(wrinkled, 0, -height / 2, 15e-3);
  ASSERT_GE(found.size(), 4u);
  const double across = mean_of(found) / std::numbers::sqrt2;
  const double published =
      std::sqrt(std::numbers::pi * height * thickness) / std::pow(3 * 0.75 * shear / height, 0.25);
  EXPECT_NEAR(across, published, 0.15 * published);
  EXPECT_LT(distance_in_plane(wrinkled, mean, 30e-3), 0.02 * shear) << "free sides hang slack";
}

// With a prestretch of 5 % normal to the clamps no part of the tension field is slack, and the free sides do
// not stand off.
TEST(Wrinkles, sheared_prestretched_film_has_the_mean_shape_of_its_tension_field_all_over) {
  const std::vector<std::string> settings{"film.thickness=0.1 mm", "film.prestretch=[1, 1.05]",
                                          "support.upper_end.displacement.x=8 mm", "mesh.across=25"};
  EXPECT_LT(distance_in_plane(complete("case.toml", settings), complete("tension_field.toml", settings), 1),
            0.02 * 8e-3);
}

// A strip between clamps, a apart, under the tension N_x along it: compressed across itself by N_y it
// wrinkles with w = sin(pi x/a) sin(k y), N_x (pi/a)^2/k^2 + D k^2 being least: k^4 = N_x (pi/a)^2/D at N_y =
// 2 (pi/a) sqrt(N_x D). D is the incremental one across the wrinkles, at constant voltage: what is bent is a
// cylindrical capacitor, which adds eps E^2 h^3/3 to that under an even field. The disc's diameter is a; away
// from the middle the wrinkles are shorter and need a little more.
TEST(Wrinkles, a_charged_film_loosens_and_wrinkles_across_the_tension_that_is_left) {
  constexpr double mu = 45e3, permittivity = 4.7 * 8.8541878128e-12, H = 0.1e-3, a = 50e-3, lx = 1.1,
                   ly = 1.02;
  const double lz = 1 / (lx * ly), h = H * lz;
  const auto squared_field = [&](double volts) { return permittivity * std::pow(volts / h, 2); }; // Pa
  const double loose = h * std::sqrt(mu * (ly * ly - lz * lz) / permittivity); // V: no tension along y
  const double maxwell = squared_field(loose), Nx = h * (mu * (lx * lx - lz * lz) - maxwell);
  const double D = std::pow(h, 3) / 12 * (2 * mu * (ly * ly + lz * lz) + (4 - 2) * maxwell);
  const double k = std::pow(Nx * std::pow(std::numbers::pi / a, 2) / D, 0.25);
  const double critical = // V
      std::sqrt((maxwell + 2 * std::numbers::pi / a * std::sqrt(Nx * D) / h) / permittivity) * h;
  EXPECT_NEAR(critical - loose, 8.0, 0.1);
  const auto at = [](double volts) {
    return std::vector<std::string>{"drive.voltage=" + std::to_string(volts) + " V",
                                    "step.voltage.on_instability=stop"};
  };
  EXPECT_EQ(run("loosened.toml", at(critical)).ending, Ending::complete);
  EXPECT_NE(run("loosened.toml", at(critical + 0.3 * (critical - loose))).ending, Ending::complete);
  // in the middle, next to where they begin
  const std::vector<double> found =
      half_waves(complete("loosened.toml", {"drive.voltage=1.48 kV"}), 1, 0, 11e-3);
  ASSERT_EQ(found.size(), 5u);
  EXPECT_NEAR(mean_of(found), std::numbers::pi / k, 0.03 * std::numbers::pi / k);
}

} // namespace
} // namespace dielast::cases::wrinkles_test
