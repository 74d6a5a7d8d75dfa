// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

// A sheared film that resists bending, beside its tension field: gallery/wrinkles.

namespace dielast::cases {
namespace {

constexpr double shear = 2e-3, height = 50e-3, thickness = 0.2e-3; // m

struct Sheared {
  meshing::Mesh mesh;
  std::vector<Eigen::Vector3d> displacement;
};

Sheared sheared(const char* file) {
  const Case one = read_case(std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/wrinkles" / file);
  Simulation simulation(one, 1);
  const Outcome outcome = simulation.run({});
  EXPECT_EQ(outcome.ending, Ending::complete) << outcome.message;
  return {simulation.device().mesh, simulation.state().displacement};
}

/// Distances along x between the zeros of the deflection at mid height, at least `margin` from the free
/// sides, m.
std::vector<double> half_waves(const Sheared& film, double margin) {
  std::vector<std::array<double, 2>> row; // x, z
  for (std::size_t n = 0; n < film.mesh.nodes.size(); ++n)
    if (const Eigen::Vector3d& x = film.mesh.nodes[n]; std::abs(x.y() + height / 2) < 1e-9)
      row.push_back({x.x(), film.displacement[n].z()});
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

// Wong & Pellegrino 2006 (J. Mech. Mater. Struct. 1, 27-61): the half-wavelength sqrt(pi H t)/(3 (1 - nu^2)
// gamma)^(1/4) across wrinkles at 45 degrees, without a prestretch.
TEST(Wrinkles, sheared_film_wrinkles_as_published_about_its_tension_field) {
  const Sheared wrinkled = sheared("case.toml"), mean = sheared("tension_field.toml");
  const std::vector<double> found = half_waves(wrinkled, 15e-3);
  ASSERT_GE(found.size(), 4u);
  double sum = 0;
  for (const double distance : found) sum += distance;
  const double across = sum / static_cast<double>(found.size()) / std::numbers::sqrt2;
  const double published =
      std::sqrt(std::numbers::pi * height * thickness) / std::pow(3 * 0.75 * shear / height, 0.25);
  EXPECT_NEAR(across, published, 0.15 * published);

  ASSERT_EQ(wrinkled.mesh.nodes.size(), mean.mesh.nodes.size());
  double squares = 0;
  int count = 0;
  for (std::size_t n = 0; n < mean.mesh.nodes.size(); ++n) {
    ASSERT_LT((wrinkled.mesh.nodes[n] - mean.mesh.nodes[n]).norm(), 1e-12);
    if (std::abs(mean.mesh.nodes[n].x()) > 30e-3) continue; // where free sides hang slack
    squares += (wrinkled.displacement[n] - mean.displacement[n]).head<2>().squaredNorm();
    ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), 0.02 * shear);
}

} // namespace
} // namespace dielast::cases
