// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/point_mass_block.hpp"
#include "fem/equilibrium/tangent_check.hpp"
#include "fem/linear/modal.hpp"
#include "meshing/rings.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"
#include "tests/fem/sample_shells.hpp"
#include "tests/fem/timed_run.hpp"

#include <cmath>
#include <numbers>

namespace dielast::fem::tie_test {
namespace {

constexpr double pi = std::numbers::pi;

void claim_body(DofMap& dofs, int master, Dimension dimension) {
  for (int c = 0; c < DofMap::components; ++c)
    if (moves(dimension, c)) dofs.add(master, c);
}

/// A prestretched, charged square whose right edge belongs to a body with its master beside it.
struct FilmOnBody {
  explicit FilmOnBody(Dimension dimension) : mesh(test::distorted_square(3, 2, 0.02)) {
    const Eigen::Vector3d beside(0.03, 0.013, 0);
    master = mesh.node_count();
    mesh.nodes.push_back(beside);
    mesh.nodes.emplace_back(0.033, -0.004, 0); // a part of the body that no element knows, with a mass
    model = test::unnumbered_model(
        mesh.node_count(), dimension,
        make_membrane_block(mesh, mesh.blocks[0], test::vhb(2, 1.5),
                            std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0), dimension,
                            1));
    for (int c = 0; c < 3; ++c)
      if (moves(dimension, c))
        model->blocks.push_back(make_point_mass_block({{.node = master + 1, .axis = c, .mass = 1e-3}}));
    for (const auto& block : model->blocks) block->claim_dofs(model->dofs, dimension);
    claim_body(model->dofs, master, dimension);
    const double right = 0.02;
    for (int a = 0; a < master; ++a)
      if (std::abs(mesh.nodes[a].x() - right) < 1e-9) {
        tied.push_back(a);
        model->dofs.tie({a, master, mesh.nodes[a] - beside});
      }
    tied.push_back(master + 1);
    model->dofs.tie({master + 1, master, mesh.nodes[master + 1] - beside});
    model->dofs.number();
    model->length_scale = 5e-3;
    model->extent = 0.04;
    model->drawn = mesh.nodes;
  }
  State anywhere(unsigned seed) const {
    std::mt19937 random(seed);
    State state = model->initial_state();
    state.voltage = {3e3};
    Eigen::VectorXd step(model->dofs.free_count());
    for (int n = 0; n < mesh.node_count(); ++n)
      for (int c = 0; c < 6; ++c)
        if (const int e = model->dofs.equation(n, c); model->dofs.is_free(e))
          step[e] = test::random_vector(random, 1, c < 3 ? 2e-4 : 0.4)[0];
    model->dofs.advance(state, step, 1);
    return state;
  }

  meshing::Mesh mesh;
  std::unique_ptr<Model> model;
  std::vector<int> tied;
  int master = 0;
};

class Ties : public ::testing::TestWithParam<Dimension> {};

TEST_P(Ties, keep_the_body_rigid) {
  const FilmOnBody film(GetParam());
  const State state = film.anywhere(3);
  const auto place = [&](int node) -> Eigen::Vector3d {
    return film.mesh.nodes[static_cast<std::size_t>(node)] +
           state.displacement[static_cast<std::size_t>(node)];
  };
  const Eigen::Quaterniond R = state.rotation[static_cast<std::size_t>(film.master)];
  EXPECT_GT(R.vec().norm(), 0.005);
  for (const int a : film.tied) {
    const Eigen::Vector3d arm =
        film.mesh.nodes[static_cast<std::size_t>(a)] - film.mesh.nodes[static_cast<std::size_t>(film.master)];
    EXPECT_LT((place(a) - place(film.master) - R * arm).norm(), 1e-17);
  }
}

TEST_P(Ties, have_forces_and_tangent_that_are_derivatives_of_the_energy) {
  const FilmOnBody film(GetParam());
  Equilibrium equilibrium(*film.model, 1);
  const TangentCheck check = check_tangent(equilibrium, film.anywhere(4), 1e-4, 6);
  EXPECT_LT(check.residual, 1e-8);
  EXPECT_LT(check.tangent, 1e-7);
}

/// Lets the state come from another one, with inertia.
void set_in_motion(State& state, const State& from, const DofMap& dofs, std::mt19937& random) {
  Motion motion{.position = position(from, dofs)};
  motion.velocity = test::random_vector(random, dofs.count(), 0.1);
  motion.acceleration = test::random_vector(random, dofs.count(), 1);
  motion.unbalanced = Eigen::VectorXd::Zero(dofs.count());
  state.motion = std::make_shared<Motion>(std::move(motion));
  state.motion_scheme = GeneralisedAlpha::of(0.01, 0.8);
}

/// Forces and tangent, those of dead forces and inertia with them, against differences of their energy.
void expect_derivatives(Equilibrium& equilibrium, State state, const Eigen::VectorXd& direction) {
  const DofMap& dofs = equilibrium.model().dofs;
  Balance here;
  equilibrium.balance(state, here);
  equilibrium.assembler().tangent(state);
  const Eigen::MatrixXd K = test::dense(equilibrium.assembler().matrix());
  const auto energy = [&](double s) {
    State there = state;
    dofs.advance(there, direction, s);
    Balance balance;
    equilibrium.balance(there, balance);
    return balance.energy - state.dead_force.dot(position(there, dofs));
  };
  const double h = 1e-2;
  const double slope = (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
  const double curvature =
      (16 * (energy(h) + energy(-h)) - (energy(2 * h) + energy(-2 * h)) - 30 * energy(0)) / (12 * h * h);
  const double told = here.force.head(direction.size()).dot(direction);
  const double scale = std::abs(told) + std::abs(direction.dot(K * direction));
  EXPECT_NEAR(told, slope, 1e-8 * scale);
  EXPECT_NEAR(direction.dot(K * direction), curvature, 1e-7 * scale);
}

// The energy check does not see dead forces and inertia: these act on tied nodes here, and turn with the
// body.
TEST_P(Ties, have_a_tangent_that_is_the_derivative_of_all_forces) {
  const FilmOnBody film(GetParam());
  const DofMap& dofs = film.model->dofs;
  Equilibrium equilibrium(*film.model, 1);
  State state = film.anywhere(5);
  std::mt19937 random(6);
  for (const int a : film.tied)
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(a, c); e != DofMap::absent)
        state.dead_force[e] = test::random_vector(random, 1, 0.3)[0];
  set_in_motion(state, film.anywhere(7), dofs, random);

  for (int sample = 0; sample < 4; ++sample) {
    Eigen::VectorXd direction(dofs.free_count());
    for (int n = 0; n < film.mesh.node_count(); ++n)
      for (int c = 0; c < 6; ++c)
        if (const int e = dofs.equation(n, c); dofs.is_free(e))
          direction[e] = test::random_vector(random, 1, c < 3 ? 1e-3 : 0.1)[0];
    expect_derivatives(equilibrium, state, direction);
  }
}

TEST_P(Ties, move_forces_to_the_master_with_their_moments) {
  const FilmOnBody film(GetParam());
  const DofMap& dofs = film.model->dofs;
  const State state = film.anywhere(8);
  std::mt19937 random(9);
  Eigen::VectorXd force = test::random_vector(random, dofs.count());
  const Eigen::VectorXd direction = test::random_vector(random, dofs.free_count());
  const double power = force.dot(dofs.jacobian(state) * direction);
  dofs.gather(state, force);
  EXPECT_NEAR(force.head(dofs.free_count()).dot(direction), power, 1e-13);
  for (const int a : film.tied) EXPECT_EQ(force[dofs.equation(a, 0)], 0);
}

INSTANTIATE_TEST_SUITE_P(All, Ties, ::testing::Values(Dimension::planar, Dimension::spatial),
                         [](const auto& tested) {
                           return std::string(tested.param == Dimension::planar ? "planar" : "spatial");
                         });

// Tied to nodes that tilt: a shell whose layers have their mass beside the drawn surface.
TEST(Tie, along_a_director_has_forces_and_tangent_of_one_energy) {
  meshing::Mesh mesh = test::flat_mesh();
  const int drawn = mesh.node_count();
  const auto model = test::shell_with_mass(mesh, test::two_layers());
  const DofMap& dofs = model->dofs;
  std::mt19937 random(3);
  const auto anywhere = [&] {
    State state = test::random_state(*model, mesh, random);
    dofs.carry(state);
    return state;
  };
  State state = anywhere();
  for (int n = drawn; n < mesh.node_count(); ++n) {
    EXPECT_TRUE(dofs.tilts(n - drawn));
    for (int c = 0; c < 3; ++c)
      state.dead_force[dofs.equation(n, c)] = test::random_vector(random, 1, 1e5)[0];
  }
  set_in_motion(state, anywhere(), dofs, random);

  Equilibrium equilibrium(*model, 1);
  for (int sample = 0; sample < 4; ++sample) {
    const Eigen::VectorXd direction = test::random_vector(random, dofs.free_count(), 0.02);
    expect_derivatives(equilibrium, state, direction);
  }
}

TEST(Tie, to_a_tied_node_leads_to_its_master) {
  DofMap dofs(4);
  for (int n = 0; n < 4; ++n) claim_body(dofs, n, Dimension::planar);
  dofs.tie({0, 1, {1, 0, 0}});
  dofs.tie({1, 2, {0, 2, 0}}); // takes 0 along
  dofs.tie({3, 0, {0, 0, 1}});
  for (const Tie& tie : dofs.ties()) EXPECT_EQ(tie.master, 2);
  EXPECT_EQ(dofs.ties()[0].arm, Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(dofs.ties()[2].arm, Eigen::Vector3d(1, 2, 1));
  EXPECT_THROW(dofs.tie({2, 3, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(dofs.tie({0, 3, {0, 0, 0}}), std::invalid_argument);
  dofs.number();
  EXPECT_EQ(dofs.free_count(), 3);
  EXPECT_EQ(dofs.count(), 9);
}

/// A pinned node goes where its master takes it, turns by itself, and carries no other.
TEST(Tie, pinned_nodes_turn_by_themselves) {
  DofMap dofs(3);
  for (int n = 0; n < 3; ++n) claim_body(dofs, n, Dimension::planar);
  dofs.tie({0, 1, {0, 0, 0}, false});
  dofs.tie({1, 2, {2, 0, 0}}); // takes 0 along, which stays pinned
  EXPECT_THROW(dofs.tie({2, 0, {1, 0, 0}}), std::invalid_argument);
  dofs.number();
  EXPECT_EQ(dofs.free_count(), 4);
  EXPECT_NE(dofs.equation(0, 5), dofs.equation(2, 5));
  EXPECT_EQ(dofs.equation(1, 5), dofs.equation(2, 5));
  State state;
  state.displacement.assign(3, Eigen::Vector3d::Zero());
  state.rotation.assign(3, Eigen::Quaterniond::Identity());
  state.angle.assign(3, Eigen::Vector3d::Zero());
  Eigen::VectorXd turn = Eigen::VectorXd::Zero(dofs.count());
  turn[dofs.equation(2, 5)] = std::numbers::pi / 2;
  dofs.advance(state, turn, 1);
  EXPECT_LT((state.displacement[0] - Eigen::Vector3d(-2, 2, 0)).norm(), 1e-15);
  EXPECT_EQ(state.rotation[0].angularDistance(Eigen::Quaterniond::Identity()), 0);
  EXPECT_NEAR(state.rotation[1].angularDistance(Eigen::Quaterniond::Identity()), std::numbers::pi / 2, 1e-15);
}

TEST(Tie, cannot_be_held_or_shared) {
  for (const bool held : {true, false}) {
    DofMap dofs(3);
    for (int n = 0; n < 3; ++n) claim_body(dofs, n, Dimension::planar);
    dofs.tie({0, 1, {1, 0, 0}});
    if (held)
      dofs.hold(0, 1);
    else
      dofs.share(0, 2, 1);
    EXPECT_THROW(dofs.number(), std::invalid_argument);
  }
}

/// A pendulum of 1 m and 1 kg about the origin, in the plane; released from the horizontal. The time to the
/// lowest point is K(1/2)/sqrt(g).
TEST(Tie, lets_a_pendulum_swing_far) {
  const meshing::Mesh mesh{{{0, 0, 0}, {1, 0, 0}}, {}, {}, {}};
  auto model = test::unnumbered_model(2, true, make_point_mass_block({{.node = 1, .axis = 0, .mass = 1}}),
                                      make_point_mass_block({{.node = 1, .axis = 1, .mass = 1}}));
  claim_body(model->dofs, 0, Dimension::planar);
  for (const int c : {0, 1}) model->dofs.hold(0, c);
  model->dofs.tie({1, 0, {1, 0, 0}});
  model->dofs.number();
  Equilibrium equilibrium(*model, 1);
  State start = model->initial_state();
  start.dead_force[model->dofs.equation(1, 1)] = -9.81;
  const double quarter = 1.8540746773013719 / std::sqrt(9.81);
  double before = 0;
  for (const int steps : {100, 200}) {
    RampOptions options = test::equal_steps(steps, quarter);
    options.inertia = true;
    const auto run = test::run_in_time(equilibrium, start, test::constant_loads(model->dofs, start), options);
    const double error = std::abs(run.end().displacement[1].x() + 1);
    EXPECT_NEAR(run.end().displacement[1].y(), -1, 1e-5);
    EXPECT_LT(error, 1e-3);
    if (steps > 100) {
      EXPECT_GT(before / error, 3.5) << "second order";
    }
    before = error;
    const EnergyPoint end = energy_point(equilibrium, run.end(), 0);
    EXPECT_NEAR(run.balance.work().mechanical, 9.81, 1e-3);
    EXPECT_NEAR(end.energy.kinetic, 9.81, 1e-2);
  }
}

/// A rigid plate that may tilt in the middle of a stretched film: K_rot = 2 pi T a^2 b^2/(b^2 - a^2), T the
/// tension per length.
TEST(Tie, lets_a_plate_on_a_film_tilt) {
  const double a = 12.7e-3, b = 68.58e-3, H = 1e-3, stretch = 2, mu = 40e3;
  meshing::Mesh mesh = meshing::annulus_mesh(a, b, 8, 2, true);
  const int master = mesh.node_count();
  const double arm = 0.01, m = 0.05; // four masses: I = 2 m arm^2 about x and y
  for (const Eigen::Vector3d& x :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(arm, 0, 0), Eigen::Vector3d(-arm, 0, 0),
        Eigen::Vector3d(0, arm, 0), Eigen::Vector3d(0, -arm, 0)})
    mesh.nodes.push_back(x);
  Model model{.dofs = DofMap(mesh.node_count())};
  model.blocks.push_back(make_membrane_block(
      mesh, mesh.blocks[0],
      {.material = {.law = materials::NeoHookean{mu}, .density = 1},
       .thickness = H,
       .prestretch = {stretch, stretch}},
      std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), passive), Dimension::spatial, 6));
  for (int n = master + 1; n < mesh.node_count(); ++n)
    for (int c = 0; c < 3; ++c) model.blocks.push_back(make_point_mass_block({{n, c, m, 0}}));
  for (const auto& block : model.blocks) block->claim_dofs(model.dofs, Dimension::spatial);
  claim_body(model.dofs, master, Dimension::spatial);
  for (const int n : mesh.node_sets.at("outer"))
    for (int c = 0; c < 3; ++c) model.dofs.hold(n, c);
  for (const int n : mesh.node_sets.at("inner"))
    model.dofs.tie({n, master, mesh.nodes[static_cast<std::size_t>(n)]});
  for (int n = master + 1; n < mesh.node_count(); ++n)
    model.dofs.tie({n, master, mesh.nodes[static_cast<std::size_t>(n)]});
  model.dofs.number();
  model.place_histories();
  model.length_scale = 4e-3;
  model.extent = 2 * b;
  model.drawn = mesh.nodes;
  Equilibrium equilibrium(model, 1);

  const double T = mu * H * (stretch * stretch - std::pow(stretch, -4)) / (stretch * stretch);
  const double K = 2 * pi * T * a * a * b * b / (b * b - a * a);
  State state = model.initial_state();
  const double weight = 1e-3 * K / arm; // tilts by about 1e-3
  state.dead_force[model.dofs.equation(master + 1, 2)] = -weight;
  ASSERT_EQ(equilibrium.solve(state, {.tolerance = 1e-10}).outcome, Outcome::converged);
  const Eigen::Vector3d tilt = spin_of(state.rotation[static_cast<std::size_t>(master)]);
  EXPECT_NEAR(tilt.y(), weight * arm / K, 5e-3 * tilt.norm());
  EXPECT_NEAR(tilt.x(), 0, 1e-6 * tilt.norm());

  const auto modes = vibration_modes(equilibrium, model.initial_state(), {.count = 6});
  ASSERT_TRUE(modes);
  int tilting = 0; // two of the six of the body
  for (const VibrationMode& mode : *modes)
    if (std::abs(mode.frequency() / std::sqrt(K / (2 * m * arm * arm)) - 1) < 5e-3) ++tilting;
  EXPECT_EQ(tilting, 2);
}

} // namespace
} // namespace dielast::fem::tie_test
