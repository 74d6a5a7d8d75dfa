// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/paths/ramp.hpp"
#include "meshing/honeycomb_mesh.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <numbers>

namespace dielast::fem::test {

/// Unidirectional actuator: 33 cells of 150 degrees, film stretched 4.0 x 2.5, TPU walls of 0.8 x 2 mm, free
/// body.
class Honeycomb {
 public:
  static materials::BeamSection section(double wall_height) {
    return materials::rectangular_section({78e6, 0.36, 0.55}, 0.8e-3, wall_height);
  }

  Honeycomb(int order, int wall_elements, bool planar, double wall_height = 2e-3)
      : mesh_(meshing::honeycomb_mesh({150 * std::numbers::pi / 180, {7, 6, 7, 6, 7}, 8e-3},
                                      {.order = order, .wall_elements = wall_elements})),
        model_(unnumbered_model(
            mesh_.node_count(), planar,
            make_membrane_block(mesh_, mesh_.blocks[0], vhb(4, 2.5),
                                std::vector<int>(static_cast<std::size_t>(mesh_.blocks[0].size()), 0),
                                dimension(planar), order == 2 ? 3 : 1),
            make_beam_block(mesh_, mesh_.blocks[1], section(wall_height)))) {
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
    observer.on_accept = [this](const RampProgress&, const Increment& increment) {
      unstable_modes_ = increment.newton.unstable_modes;
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
  const Model& model() const { return *model_; }
  const meshing::Mesh& mesh() const { return mesh_; }
  int unstable_modes() const { return unstable_modes_; } ///< of the last state that was reached

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
  int unstable_modes_ = 0;
};

} // namespace dielast::fem::test
