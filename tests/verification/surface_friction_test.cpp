// SPDX-License-Identifier: GPL-3.0-or-later
// Coulomb's friction between two deformable solids: the force with which one slides, and its heat; on an
// incline.
#include "tests/verification/two_bodies.hpp"

#include "fem/contact/plane_contact_block.hpp"
#include "meshing/solids/extruded.hpp"

#include <cmath>

namespace dielast::fem::surface_friction_test {
namespace {

constexpr double thickness = 1e-3, friction = 0.3;

/// A flat block `wide` from the abscissa `from`, half as high as one; `way`: 1 above the contact, -1 below.
meshing::Mesh block(double from, double wide, int elements, double way, bool in_space) {
  const double face = way > 0 ? thickness : 0, back = face + way / 2, deep = way > 0 ? 0.8 : 1;
  const meshing::Mesh side = named({even_line(from, from + wide, elements),
                                    even_line(std::min(face, back), std::max(face, back), in_space ? 1 : 2),
                                    [](double u, double v) { return Eigen::Vector3d(u, v, 0); }},
                                   face, back);
  if (!in_space) return side;
  return meshing::extruded(
      side, even_line((1 - deep) / 2, (1 + deep) / 2, way > 0 ? 1 : 2),
      [](const Eigen::Vector3d& drawn, double level) { return Eigen::Vector3d(drawn.x(), drawn.y(), level); },
      "deep", "front");
}

struct Blocks : TwoBodies {
  Blocks(Dimension drawn, bool held, bool lower_is_rigid = false)
      : TwoBodies(block(0, 3, drawn == Dimension::spatial ? 4 : 9, -1, drawn == Dimension::spatial),
                  block(0.63, 1.5, drawn == Dimension::spatial ? 2 : 5, 1, drawn == Dimension::spatial),
                  drawn, {thickness, 0.03 * mu / thickness, 1}, held, 3, lower_is_rigid, friction) {}
  struct Ridden {
    RampEnd end;
    double load_factor;
    State state;
  };
  Ridden ride(Equilibrium& equilibrium, const State& from, int increments, const LoadPath& path,
              const std::function<void(const State&)>& accepted) {
    const RampOptions options{.newton = {.tolerance = 1e-8, .max_iterations = 60},
                              .increments = increments,
                              .smallest_increment = 1e-4};
    RampProgress progress = RampProgress::begin(from, model.dofs, options);
    RampObserver observer;
    observer.on_accept = [&](const RampProgress& now, const Increment&) {
      accepted(now.points.back().state);
      return true;
    };
    const RampEnd end = ramp(equilibrium, path, options, progress, observer).end;
    return {end, progress.load_factor, progress.points.back().state};
  }
};

/// Pressed on the lower block and drawn along it: it is held at first, then slides with the coefficient times
/// the normal force, and what drawing it costs is stored or becomes heat.
void slides(Dimension dimension) {
  Blocks blocks(dimension, true);
  Equilibrium equilibrium(blocks.model, 1);
  const auto move = [&](double down, double along) {
    LoadPath path;
    path.apply = [&blocks, down, along](State& state, double s) {
      for (const int node : blocks.nodes("upper.back"))
        state.displacement[static_cast<std::size_t>(node)] =
            Eigen::Vector3d(along > 0 ? s * along : 0, along > 0 ? -down : -s * down, 0);
    };
    return path;
  };
  constexpr double down = 0.002, along = 0.02;
  const auto pressed =
      blocks.ride(equilibrium, blocks.model.initial_state(), 5, move(down, 0), [](const State&) {});
  ASSERT_EQ(pressed.end, RampEnd::complete);
  struct Point {
    double way, drawn, pressed, stored, heat;
  };
  std::vector<Point> points;
  const auto note = [&](const State& state) {
    equilibrium.internal_force(state, blocks.force);
    Point point{state.displacement[static_cast<std::size_t>(blocks.nodes("upper.back").front())].x(), 0,
                -blocks.reaction("upper.back"), blocks.model.energies(state).elastic,
                friction_heat(blocks.model, state)};
    for (const int node : blocks.nodes("upper.back"))
      point.drawn += blocks.force[blocks.model.dofs.equation(node, 0)];
    points.push_back(point);
  };
  note(pressed.state);
  const auto drawn = blocks.ride(equilibrium, pressed.state, 30, move(down, along), note);
  ASSERT_EQ(drawn.end, RampEnd::complete);
  const Point &first = points.front(), &last = points.back();
  EXPECT_NEAR(contact_force(blocks.model, drawn.state), last.pressed, 0.002 * last.pressed);
  EXPECT_NEAR(last.drawn, friction * last.pressed, 0.002 * last.drawn);
  EXPECT_LT(points[1].drawn, 0.9 * friction * points[1].pressed); // the block shears before all of it slides
  double work = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    work += (points[i].drawn + points[i - 1].drawn) / 2 * (points[i].way - points[i - 1].way);
  const double gained = last.stored - first.stored, heat = last.heat - first.heat;
  ::testing::Test::RecordProperty("force over friction",
                                  std::to_string(last.drawn / last.pressed / friction));
  ::testing::Test::RecordProperty("work less energy and heat", std::to_string((work - gained - heat) / work));
  EXPECT_GT(heat, 0.5 * work);
  EXPECT_NEAR(gained + heat, work, 0.01 * work);
}

TEST(SurfaceFriction, block_slides_with_the_coefficient_times_its_force) { slides(Dimension::planar); }
TEST(SurfaceFriction, block_slides_with_the_coefficient_times_its_force_in_space) {
  slides(Dimension::spatial);
}

/// A block's edges pass over points and nodes of a coarser surface: none of them catches on an edge, and all
/// of the way the force is the coefficient times that across (points that did took it 20 % beyond it).
void passes_over_nodes(Dimension dimension) {
  Blocks blocks(dimension, true, true);
  Equilibrium equilibrium(blocks.model, 1);
  constexpr double down = 0.025, along = 0.5;
  const auto move = [&](double from, double to, double way) {
    LoadPath path;
    path.apply = [&blocks, from, to, way](State& state, double s) {
      for (const int node : blocks.nodes("upper.back"))
        state.displacement[static_cast<std::size_t>(node)] = {s * way, -from - s * (to - from), 0};
    };
    return path;
  };
  const auto pressed =
      blocks.ride(equilibrium, blocks.model.initial_state(), 5, move(0, down, 0), [](const State&) {});
  ASSERT_EQ(pressed.end, RampEnd::complete);
  double most = 0, least = 1;
  const auto drawn =
      blocks.ride(equilibrium, pressed.state, 50, move(down, down, along), [&](const State& state) {
        equilibrium.internal_force(state, blocks.force);
        double force = 0;
        for (const int node : blocks.nodes("upper.back"))
          force += blocks.force[blocks.model.dofs.equation(node, 0)];
        const double way =
            state.displacement[static_cast<std::size_t>(blocks.nodes("upper.back").front())].x();
        const double ratio = force / -blocks.reaction("upper.back") / friction;
        if (way < 0.1) return; // it begins to slide, and its normal forces follow by an increment
        most = std::max(most, ratio);
        least = std::min(least, ratio);
      });
  ASSERT_EQ(drawn.end, RampEnd::complete) << drawn.load_factor;
  ::testing::Test::RecordProperty("most of the friction", std::to_string(most));
  ::testing::Test::RecordProperty("least of the friction", std::to_string(least));
  EXPECT_LT(most, 1.005);
  EXPECT_GT(least, 0.995);
}

TEST(SurfaceFriction, edges_pass_over_nodes_without_catching) { passes_over_nodes(Dimension::planar); }
TEST(SurfaceFriction, edges_pass_over_nodes_without_catching_in_space) {
  passes_over_nodes(Dimension::spatial);
}

/// Pressed on the lower block by a traction whose slope then grows: it sticks until the slope is the
/// coefficient.
void sticks_and_slips(Dimension dimension) {
  Blocks blocks(dimension, false);
  Equilibrium equilibrium(blocks.model, 1);
  const PlaneContact top =
      dimension == Dimension::spatial
          ? surface_of(blocks.mesh, meshing::faces_at(blocks.mesh, "upper.back"))
          : surface_of(blocks.mesh,
                       meshing::sides_at(blocks.mesh, "upper.back", meshing::CellType::meridian3), 1);
  const auto climb = [&](double from, double to, int increments, const State& state) {
    LoadPath path;
    path.apply = [&, from, to](State& at, double s) {
      const double angle = from + s * (to - from), pressure = (to > 0 ? 1 : s) * 0.02 * mu;
      for (std::size_t i = 0; i < top.nodes.size(); ++i)
        for (int c = 0; c < 2; ++c)
          at.dead_force[blocks.model.dofs.equation(top.nodes[i], c)] =
              top.areas[i] * pressure * (c == 0 ? std::sin(angle) : -std::cos(angle));
    };
    return blocks.ride(equilibrium, state, increments, path, [](const State&) {});
  };
  const auto level = climb(0, 0, 4, blocks.model.initial_state());
  ASSERT_EQ(level.end, RampEnd::complete);
  const double slope = std::atan(friction);
  const auto there = climb(0, 0.98 * slope, 25, level.state);
  EXPECT_EQ(there.end, RampEnd::complete);
  const auto beyond = climb(0.98 * slope, 1.1 * slope, 30, there.state);
  EXPECT_EQ(beyond.end, RampEnd::gave_up);
  const double reached = (0.98 + 0.12 * beyond.load_factor) * slope;
  ::testing::Test::RecordProperty("angle over that of the coefficient", std::to_string(reached / slope));
  EXPECT_NEAR(reached, slope, 5e-3 * slope);
}

TEST(SurfaceFriction, block_on_an_incline_sticks_and_slips_at_the_right_angle) {
  sticks_and_slips(Dimension::planar);
}
TEST(SurfaceFriction, block_on_an_incline_sticks_and_slips_at_the_right_angle_in_space) {
  sticks_and_slips(Dimension::spatial);
}

} // namespace
} // namespace dielast::fem::surface_friction_test
