// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/ramp.hpp"
#include "meshing/rings.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::circular_actuator_test {
namespace {

/// Disc prestretched 3 x 3 and clamped, electrode of 30 mm drawn (10 mm undeformed) radius in the middle; mu
/// = 45 kPa, eps = 4e-11 F/m, H = 1 mm.
class CircularActuator {
 public:
  static constexpr double electrode_radius = 0.03;

  CircularActuator(double radius_ratio, int rings, bool curved)
      : mesh_(meshing::disc_mesh(radius_ratio * electrode_radius, electrode_radius, rings, 2, curved)) {
    std::vector<int> electrodes(static_cast<std::size_t>(mesh_.blocks[0].size()), passive);
    for (const int c : mesh_.cell_sets.at("electrode").cells) electrodes[static_cast<std::size_t>(c)] = 0;
    model_ = test::unnumbered_model(
        mesh_.node_count(), true,
        make_membrane_block(mesh_, mesh_.blocks[0], test::vhb(3, 3), electrodes, Dimension::planar, 6));
    for (const int a : mesh_.node_sets.at("rim"))
      for (const int c : {0, 1}) model_->dofs.hold(a, c);
    model_->dofs.number();
    model_->length_scale = model_->extent = radius_ratio * electrode_radius;
    state_ = model_->initial_state();
    equilibrium_ = std::make_unique<Equilibrium>(*model_, 1);
  }

  void charge(double volts, int increments) {
    const RampOptions options{.newton = {.tolerance = 1e-11, .max_iterations = 25}, .increments = increments};
    RampProgress progress = RampProgress::begin(state_, model_->dofs, options);
    Loads target = progress.start;
    target.voltage = {volts};
    target.dead_force.setZero();
    ASSERT_EQ(
        ramp(*equilibrium_, linear_path(model_->dofs, progress.start, target), options, progress, {}).end,
        RampEnd::complete);
    state_ = progress.points.back().state;
  }
  /// Current radius of the electrode's edge where it crosses the x axis, m.
  double edge_radius() const {
    for (const int a : mesh_.node_sets.at("electrode_edge")) {
      const auto n = static_cast<std::size_t>(a);
      if (mesh_.nodes[n].x() > 0 && std::abs(mesh_.nodes[n].y()) < 1e-12)
        return (mesh_.nodes[n] + state_.displacement[n]).x();
    }
    return 0;
  }
  double radial_strain() const { return edge_radius() / electrode_radius - 1; }
  /// Largest true field under the electrode, V/m: voltage over current thickness.
  double field_in_the_middle() const {
    const MembraneSample sample = model_->sample(state_).film.front();
    return sample.voltage / sample.thickness * std::sqrt((sample.F.transpose() * sample.F).determinant());
  }
  /// Capacitance over that of the undeformed electrode: mean of det C over the undeformed volume, over (pi
  /// A^2 H).
  double capacitance_ratio() const {
    double sum = 0;
    for (const MembraneSample& sample : model_->sample(state_).film)
      if (sample.electrode == 0) sum += sample.volume * (sample.F.transpose() * sample.F).determinant();
    return sum / (std::numbers::pi * 1e-4 * 1e-3);
  }

 private:
  meshing::Mesh mesh_;
  std::unique_ptr<Model> model_;
  State state_;
  std::unique_ptr<Equilibrium> equilibrium_;
};

struct Row {
  double voltage, strain, field; // V, -, MV/m
};

// Boundary-value problem of the axisymmetric membrane solved to 14 digits: clamped at B, electrode up to A.
constexpr std::array<Row, 8> large_disc{{{0, 0, 0}, // B/A = 10
                                         {1000, 0.003991341073720012, 9.07198751655906},
                                         {2000, 0.01657524537493682, 18.601654131164032},
                                         {2500, 0.026681385079051934, 23.716679995526405},
                                         {3000, 0.039932737186866296, 29.199422642570138},
                                         {3500, 0.057096673493203465, 35.199781378977484},
                                         {4000, 0.07941133626765962, 41.94463798307285},
                                         {4500, 0.10902797389219088, 49.81269339845442}}};
constexpr std::array<Row, 8> small_disc{{{0, 0, 0}, // B/A = 2
                                         {1000, 0.0030148517523058693, 9.0543491355213},
                                         {2000, 0.01240167872608633, 18.449228863573158},
                                         {2500, 0.019806526210141007, 23.40012039526788},
                                         {3000, 0.029328853939118993, 28.606983017893743},
                                         {3500, 0.041334617265220475, 34.157900231119456},
                                         {4000, 0.05636140195224182, 40.17237881524221},
                                         {4500, 0.07522526957768672, 46.822429903705576}}};

TEST(CircularActuator, matches_the_boundary_value_problem_at_sixteen_points) {
  for (const auto& [ratio, rings, rows] : {std::tuple{10.0, 40, large_disc}, {2.0, 24, small_disc}}) {
    CircularActuator actuator(ratio, rings, true);
    for (const Row& row : rows) {
      actuator.charge(row.voltage, 1);
      EXPECT_NEAR(actuator.radial_strain(), row.strain, 5e-5) << ratio << ", " << row.voltage << " V";
      EXPECT_NEAR(actuator.field_in_the_middle() / 1e6, row.field, 1e-4 * row.field)
          << ratio << ", " << row.voltage;
    }
  }
}

// A nodal value of quadratic triangles has an error of order h^3, the capacitance (derivative of the energy)
// of h^4.
TEST(CircularActuator, curved_six_node_triangles_converge) {
  const Row& row = small_disc.back();
  const double exact = std::pow(3 * (1 + row.strain), 4); // the electrode stretches uniformly
  std::vector<double> edge, capacitance;
  for (const int rings : {6, 12, 24, 48}) {
    CircularActuator actuator(2, rings, true);
    actuator.charge(row.voltage, 2);
    edge.push_back(std::abs(actuator.radial_strain() - row.strain));
    capacitance.push_back(std::abs(actuator.capacitance_ratio() / exact - 1));
  }
  // With all circles curved the first pair's order was 2.26, and every error of the edge a quarter to a half
  // larger.
  EXPECT_LT(edge[0], 5e-5);
  for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
    EXPECT_GT(std::log2(edge[i] / edge[i + 1]), i == 0 ? 2.1 : 2.2) << i;
    EXPECT_NEAR(std::log2(capacitance[i] / capacitance[i + 1]), 4, 0.4) << i;
  }
  EXPECT_GT(std::log2(edge[2] / edge[3]), 2.7);
  EXPECT_LT(edge.back(), 3e-7);
}

// Straight sides, 6 points, 5 kV, outer radius 3 times the electrode's: three independent codes agree on
// these meshes.
TEST(CircularActuator, edge_radius_of_given_meshes_equals_that_of_other_codes) {
  CircularActuator coarse(3, 21, false);
  coarse.charge(5e3, 4);
  EXPECT_NEAR(coarse.edge_radius() * 1e3, 33.795338054887, 1e-9);
  CircularActuator fine(3, 66, false);
  fine.charge(5e3, 2);
  EXPECT_NEAR(fine.edge_radius() * 1e3, 33.80085028827, 1e-9);
}

} // namespace
} // namespace dielast::fem::circular_actuator_test
