// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/verification/honeycomb_model.hpp"

namespace dielast::fem::honeycomb_test {
namespace {

using test::Honeycomb;

struct Actuation {
  Eigen::Vector2d released, strain;
};

Actuation actuate(int order, int wall_elements) {
  Honeycomb honeycomb(order, wall_elements, true);
  honeycomb.ramp_to(0);
  EXPECT_EQ(honeycomb.unstable_modes(), 0);
  const Eigen::Vector2d released = honeycomb.size();
  honeycomb.ramp_to(7.5e3);
  EXPECT_EQ(honeycomb.unstable_modes(), 0);
  return {released, honeycomb.size().cwiseQuotient(released).array() - 1};
}

// Reference: independent planar finite-element model, Richardson limit of 8 and 16 quadratic beams per wall.
TEST(HoneycombActuator, release_and_actuation_match_an_independent_model) {
  const Actuation at = actuate(2, 8), coarse = actuate(2, 4);
  EXPECT_NEAR(at.released.x(), 83.97e-3, 0.01 * 83.97e-3);
  EXPECT_NEAR(at.released.y(), 43.21e-3, 0.01 * 43.21e-3);
  EXPECT_NEAR(at.strain.x(), -0.0352, 0.01 * 0.0352);
  EXPECT_NEAR(at.strain.y(), 0.3319, 0.01 * 0.3319);
  // Half as many elements along the walls change little.
  EXPECT_LT((coarse.strain - at.strain).cwiseAbs().maxCoeff(), 0.01 * 0.3319);
  EXPECT_LT((coarse.released - at.released).norm(), 0.005 * at.released.norm());
}

TEST(HoneycombActuator, in_space_the_flat_actuator_moves_as_in_the_plane) {
  Honeycomb planar(2, 2, true), spatial(2, 2, false);
  for (const double volts : {0.0, 7.5e3}) {
    planar.ramp_to(volts);
    spatial.ramp_to(volts);
    for (std::size_t a = 0; a < planar.state().displacement.size(); ++a) {
      EXPECT_LT((planar.state().displacement[a] - spatial.state().displacement[a]).norm(), 1e-8 * 0.08);
      EXPECT_LT(std::abs(spatial.state().displacement[a].z()), 1e-12);
    }
    EXPECT_EQ(spatial.unstable_modes(), 0);
  }
}

} // namespace
} // namespace dielast::fem::honeycomb_test
