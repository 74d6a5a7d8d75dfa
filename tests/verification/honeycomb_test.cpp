// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/ramp.hpp"
#include "meshing/honeycomb_mesh.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem {
namespace {

/// Unidirectional actuator: 33 cells of 150 degrees, film stretched 4.0 x 2.5, TPU walls of 0.8 x 2 mm, free
/// body.
class Honeycomb {
 public:
  Honeycomb(int order, int wall_elements, bool planar)
      : mesh_(meshing::honeycomb_mesh({150 * std::numbers::pi / 180, {7, 6, 7, 6, 7}, 8e-3},
                                      {.order = order, .wall_elements = wall_elements})),
        model_(test::unnumbered_model(
            mesh_.node_count(), planar,
            make_membrane_block(mesh_, mesh_.blocks[0], test::vhb(4, 2.5),
                                std::vector<int>(static_cast<std::size_t>(mesh_.blocks[0].size()), 0),
                                test::dimension(planar), order == 2 ? 3 : 1),
            make_beam_block(mesh_, mesh_.blocks[1],
                            materials::rectangular_section({78e6, 0.36, 0.55}, 0.8e-3, 2e-3)))) {
    const int centre = node("centre"), left = node("left_apex"), top = node("top");
    for (const auto& [a, c] :
         {std::pair{centre, 0}, {centre, 1}, {left, 1}, {centre, 2}, {left, 2}, {top, 2}})
      model_->dofs.hold(a, c);
    model_->dofs.number();
    model_->length_scale = 1e-3;
    model_->extent = 0.08;
    equilibrium_ = std::make_unique<Equilibrium>(*model_, 1);
    state_ = model_->initial_state();
    equilibrium_->internal_force(state_, state_.dead_force); // what the printing frame held
  }

  /// Lets the frame go, or charges: ramps to these volts without dead forces.
  void ramp_to(double volts) {
    const RampOptions options{.newton = {.tolerance = 1e-10, .max_iterations = 25}, .increments = 1};
    RampProgress progress = RampProgress::begin(state_, model_->dofs, options);
    Loads target = progress.start;
    target.voltage = {volts};
    target.dead_force.setZero();
    RampObserver observer;
    observer.on_accept = [](const RampProgress&, const Increment& increment) {
      EXPECT_EQ(increment.newton.negative_pivots, 0);
      return true;
    };
    ASSERT_EQ(
        ramp(*equilibrium_, linear_path(model_->dofs, progress.start, target), options, progress, observer)
            .end,
        RampEnd::complete);
    state_ = progress.points.back().state;
  }
  /// The gauges: between the outer apexes, and between the corner columns' top and bottom walls, m.
  Eigen::Vector2d size() const {
    return {place("right_apex").x() - place("left_apex").x(),
            place("corner_top").y() - place("corner_bottom").y()};
  }
  const State& state() const { return state_; }

 private:
  int node(const char* name) const { return mesh_.node_sets.at(name)[0]; }
  Eigen::Vector3d place(const char* name) const {
    const auto& nodes = mesh_.node_sets.at(name);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int a : nodes)
      sum += mesh_.nodes[static_cast<std::size_t>(a)] + state_.displacement[static_cast<std::size_t>(a)];
    return sum / static_cast<double>(nodes.size());
  }

  meshing::Mesh mesh_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Equilibrium> equilibrium_;
  State state_;
};

struct Actuation {
  Eigen::Vector2d released, strain;
};

Actuation actuate(int order, int wall_elements) {
  Honeycomb honeycomb(order, wall_elements, true);
  honeycomb.ramp_to(0);
  const Eigen::Vector2d released = honeycomb.size();
  honeycomb.ramp_to(7.5e3);
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
  }
}

} // namespace
} // namespace dielast::fem
