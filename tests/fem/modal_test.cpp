// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/modal.hpp"

#include "fem/elements/chamber_block.hpp"
#include "tests/fem/diaphragm.hpp"
#include "tests/fem/material_point_block.hpp"
#include "tests/fem/sample_meshes.hpp"

#include <numbers>

namespace dielast::fem::modal_test {
namespace {

/// Prestretched disc of 10 mm undeformed radius, mu = 45 kPa, H = 1 mm, 960 kg/m^3: f = j_mn / (2 pi lp A)
/// sqrt(sigma/rho), sigma = mu (lp^2 - lp^-4).
struct DiscModes {
  double prestretch;
  std::vector<double> hertz; ///< 01, 11, 11, 21, 21, 02
};
const DiscModes twice{2,
                      {259.98879943316865, 414.25068516390996, 414.25068516390996, 555.2187651719383,
                       555.2187651719383, 596.7827795566907}};
const DiscModes fourfold{4,
                         {262.01208908761265, 417.4744745250894, 417.4744745250894, 559.5395989385266,
                          559.5395989385266, 601.4270735665092}};

double hertz(const VibrationMode& mode) { return mode.frequency() / (2 * std::numbers::pi); }

std::unique_ptr<Model> disc(const meshing::Mesh& mesh, double prestretch, Dimension dimension) {
  const bool meridian = dimension == Dimension::axisymmetric;
  auto model = test::unnumbered_model(
      mesh.node_count(), false,
      make_membrane_block(mesh, mesh.blocks[0], test::vhb(prestretch, prestretch),
                          std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0), dimension,
                          meridian ? 3 : 6));
  for (const int a : mesh.node_sets.at(mesh.node_sets.contains("rim") ? "rim" : "edge"))
    model->dofs.hold(a, 2);
  for (int a = 0; a < mesh.node_count(); ++a) // across its plane only
    for (const int c : {0, 1}) model->dofs.hold(a, c);
  model->dofs.number();
  model->length_scale = model->extent = prestretch * 0.01;
  return model;
}

TEST(Modal, a_clamped_disc_of_triangles_has_its_pairs_of_frequencies) {
  for (const DiscModes& exact : {twice, fourfold}) {
    const double radius = exact.prestretch * 0.01;
    const meshing::Mesh mesh = meshing::disc_mesh(radius, radius / 2, 8, 2, true);
    const auto model = disc(mesh, exact.prestretch, Dimension::spatial);
    Equilibrium equilibrium(*model, 1);
    const auto modes = vibration_modes(equilibrium, model->initial_state(), {.count = 6});
    ASSERT_TRUE(modes);
    ASSERT_EQ(modes->size(), 6U);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(hertz((*modes)[i]), exact.hertz[i], 1e-3 * exact.hertz[i]) << i;
  }
}

TEST(Modal, modes_are_orthonormal_in_mass_and_fulfil_the_equations) {
  const meshing::Mesh mesh = meshing::disc_mesh(0.02, 0.01, 4, 2, true);
  const auto model = disc(mesh, 2, Dimension::spatial);
  Equilibrium equilibrium(*model, 1);
  const State state = model->initial_state();
  const auto modes = vibration_modes(equilibrium, state, {.count = 5});
  ASSERT_TRUE(modes);
  equilibrium.assembler().tangent(state);
  const Eigen::MatrixXd K = test::dense(equilibrium.assembler().matrix());
  const Eigen::MatrixXd M = Eigen::MatrixXd(model->inertia().mass).topLeftCorner(K.rows(), K.rows());
  for (std::size_t i = 0; i < 5; ++i) {
    const VibrationMode& mode = (*modes)[i];
    const Eigen::VectorXd force = K * mode.shape;
    EXPECT_LT((force - mode.stiffness * M * mode.shape).norm(), 1e-5 * force.norm());
    for (std::size_t j = 0; j < 5; ++j)
      EXPECT_NEAR(mode.shape.dot(M * (*modes)[j].shape), i == j, 1e-6) << i << j;
  }
}

// A square film's modes (1,2) and (2,1) have one frequency; the mesh is the same turned by 90 degrees. A pair
// is told by the first prominent node, even where only one of it is wanted.
TEST(Modal, twins_are_those_of_the_first_prominent_unknown) {
  const meshing::Mesh mesh = test::distorted_square(6, 2, 0.02, 0);
  auto model = disc(mesh, 2, Dimension::spatial);
  Equilibrium equilibrium(*model, 1);
  const auto few = vibration_modes(equilibrium, model->initial_state(), {.count = 2});
  const auto more = vibration_modes(equilibrium, model->initial_state(), {.count = 5});
  ASSERT_TRUE(few && more);
  EXPECT_NEAR((*more)[1].stiffness, (*more)[2].stiffness, 1e-9 * (*more)[1].stiffness);
  EXPECT_LT(((*few)[1].shape - (*more)[1].shape).norm(), 1e-5 * (*more)[1].shape.norm());
  for (const VibrationMode& mode : *more) {
    const double largest = mode.shape.cwiseAbs().maxCoeff();
    EXPECT_GT(*std::ranges::find_if(mode.shape, [&](double u) { return std::abs(u) > 0.7 * largest; }), 0);
  }
}

TEST(Modal, a_clamped_disc_of_meridians_has_the_round_modes) {
  for (const DiscModes& exact : {twice, fourfold}) {
    const double radius = exact.prestretch * 0.01;
    const meshing::Mesh mesh = meshing::disc_meridian(radius, radius / 2, 20, 2);
    const auto model = disc(mesh, exact.prestretch, Dimension::axisymmetric);
    Equilibrium equilibrium(*model, 1);
    const auto modes = vibration_modes(equilibrium, model->initial_state(), {.count = 2});
    ASSERT_TRUE(modes);
    EXPECT_NEAR(hertz((*modes)[0]), exact.hertz[0], 1e-4 * exact.hertz[0]);
    EXPECT_NEAR(hertz((*modes)[1]), exact.hertz[5], 1e-4 * exact.hertz[5]);
  }
}

TEST(Modal, a_plate_on_a_film_without_mass_has_one_mode) {
  for (const int rings : {0, 6}) {
    const test::Diaphragm light({.density = 0, .rings = rings});
    Equilibrium equilibrium(light.model, 1);
    const State state = light.settled(equilibrium, 0);
    EXPECT_NEAR(light.drop(state), 6.6815559e-3, rings ? 2e-5 : 1e-7);
    const auto modes = vibration_modes(equilibrium, state, {.count = 6});
    ASSERT_TRUE(modes);
    ASSERT_EQ(modes->size(), 1U);
    EXPECT_NEAR((*modes)[0].frequency(), 38.35, rings ? 0.02 : 0.005);
    EXPECT_NEAR(std::abs((*modes)[0].shape[light.plate]), 1 / std::sqrt(0.1), 1e-9);
  }
}

TEST(Modal, the_film_s_mass_slows_the_plate) {
  const test::Diaphragm heavy({});
  Equilibrium equilibrium(heavy.model, 1);
  const auto modes = vibration_modes(equilibrium, heavy.settled(equilibrium, 0), {.count = 3});
  ASSERT_TRUE(modes);
  EXPECT_NEAR((*modes)[0].frequency(), 38.27, 0.005);
}

// At constant charge the frequency is higher: omega_Q^2 - omega_V^2 = (dQ/dx)^2/(C m).
TEST(Modal, charge_that_is_kept_stiffens) {
  const test::Diaphragm light({.density = 0});
  Equilibrium equilibrium(light.model, 1);
  State state = light.settled(equilibrium, 5e3);
  const auto at_voltage = vibration_modes(equilibrium, state, {});
  EXPECT_NEAR(at_voltage->front().frequency(), std::sqrt(131.59316 / 0.1), 0.01);
  const Charges held = light.model.charges(state, true);
  state.supply[0] = Supply::charge;
  state.charge[0] = held.charge[0];
  const auto at_charge = vibration_modes(equilibrium, state, {});
  ASSERT_TRUE(at_voltage && at_charge);
  const Eigen::VectorXd coupling = held.coupling[0].head(light.model.dofs.free_count());
  const Eigen::VectorXd& shape = at_charge->front().shape;
  EXPECT_GT(at_charge->front().stiffness, at_voltage->front().stiffness * 1.001);
  // Rayleigh's quotient of the stiffer problem's mode in both
  equilibrium.assembler().tangent(state);
  const Eigen::MatrixXd K = test::dense(equilibrium.assembler().matrix());
  EXPECT_NEAR(at_charge->front().stiffness,
              shape.dot(K * shape) + std::pow(coupling.dot(shape), 2) / held.capacitance[0],
              1e-8 * at_charge->front().stiffness);
}

// mu = 1, permittivity 1: K = 2 + 10 l^-6 - 6 Phi^2 l^2 (see material_point_block.hpp), mass 1.
TEST(Modal, tells_an_unstable_state) {
  auto model = test::material_point(std::numeric_limits<double>::infinity());
  Eigen::SparseMatrix<double> mass(1, 1);
  mass.insert(0, 0) = 1;
  model->known_inertia = Inertia{mass, Eigen::SparseMatrix<double>(1, 1)};
  Equilibrium equilibrium(*model, 1);
  for (const double l : {1.1, 1.5}) {
    State state = model->initial_state();
    state.displacement[0].x() = l - 1;
    state.voltage[0] = test::equilibrium_voltage(std::numeric_limits<double>::infinity(), l);
    const auto modes = vibration_modes(equilibrium, state, {});
    ASSERT_TRUE(modes);
    const double K = 2 + 10 * std::pow(l, -6) - 6 * std::pow(state.voltage[0] * l, 2);
    EXPECT_NEAR(modes->front().stiffness, K, 1e-9);
    EXPECT_EQ(modes->front().frequency() > 0, l < std::cbrt(2.0));
  }
}

TEST(Modal, motion_without_stiffness_has_frequency_zero) {
  const meshing::Mesh mesh = meshing::disc_mesh(0.02, 0.01, 3, 2, true);
  auto model = test::unnumbered_model(
      mesh.node_count(), true,
      make_membrane_block(mesh, mesh.blocks[0], test::vhb(),
                          std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0),
                          Dimension::planar, 6));
  model->dofs.number();
  Equilibrium equilibrium(*model, 1);
  const auto modes = vibration_modes(equilibrium, model->initial_state(), {.count = 5});
  ASSERT_TRUE(modes);
  for (int i = 0; i < 3; ++i)
    EXPECT_LT(std::abs((*modes)[static_cast<std::size_t>(i)].stiffness), 1e-5 * (*modes)[3].stiffness) << i;
  EXPECT_GT((*modes)[3].frequency(), 100);
}

TEST(Modal, a_model_without_mass_has_none) {
  const auto model = test::material_point(std::numeric_limits<double>::infinity());
  Equilibrium equilibrium(*model, 1);
  const auto modes = vibration_modes(equilibrium, model->initial_state(), {});
  ASSERT_TRUE(modes);
  EXPECT_TRUE(modes->empty());
}

// R = 20 mm, H = 0.5 mm: omega^2 = (2 mu (1 + 5 l^-6) - 2 p R l/H)/(rho R^2) at constant pressure.
TEST(Modal, a_balloon_breathes_at_constant_pressure) {
  const meshing::Mesh mesh = meshing::balloon_meridian(0.02, 40, 2);
  MembraneSection film = test::vhb();
  film.thickness = 0.5e-3;
  Model model{
      .dofs = DofMap(mesh.node_count()), .blocks = {}, .ports = {{.name = "inside", .chamber = Chamber{}}}};
  model.blocks.push_back(make_membrane_block(
      mesh, mesh.blocks[0], film, std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), passive),
      Dimension::axisymmetric, 3));
  model.blocks.push_back(make_pressure_block(mesh, mesh.blocks[0], 0));
  for (const auto& block : model.blocks) block->claim_dofs(model.dofs, Dimension::axisymmetric);
  for (const char* pole : {"south", "north"}) model.dofs.hold(mesh.node_sets.at(pole).front(), 0);
  for (const int a : mesh.node_sets.at("equator")) model.dofs.hold(a, 2);
  model.dofs.number();
  model.length_scale = model.extent = 0.02;
  Equilibrium equilibrium(model, 1);
  for (const auto& [l, pascal, breathing] : {std::tuple{1.1, 890.8487794354559, 132.3682238562463},
                                             {1.2, 1247.0662937242798, 89.33498846547488}}) {
    State state = model.initial_state();
    for (std::size_t a = 0; a < mesh.nodes.size(); ++a) state.displacement[a] = (l - 1) * mesh.nodes[a];
    state.voltage[0] = pascal;
    ASSERT_EQ(equilibrium.solve(state, {.tolerance = 1e-11}).outcome, Outcome::converged);
    const auto modes = vibration_modes(equilibrium, state, {.count = 4});
    ASSERT_TRUE(modes);
    Eigen::VectorXd radial = Eigen::VectorXd::Zero(model.dofs.count());
    for (int a = 0; a < mesh.node_count(); ++a)
      for (const int c : {0, 2})
        radial[model.dofs.equation(a, c)] = mesh.nodes[static_cast<std::size_t>(a)][c];
    radial.tail(model.dofs.count() - model.dofs.free_count()).setZero();
    const Eigen::VectorXd momentum = (model.inertia().mass * radial).head(model.dofs.free_count());
    int breathing_modes = 0;
    for (const VibrationMode& mode : *modes) {
      if (std::pow(mode.shape.dot(momentum), 2) < 0.999 * radial.dot(model.inertia().mass * radial)) continue;
      ++breathing_modes;
      EXPECT_NEAR(hertz(mode), breathing, 1e-5 * breathing);
    }
    EXPECT_EQ(breathing_modes, 1);
  }
}

// Of numbers that small no vector is left: no modes, instead of a decomposition of nothing.
TEST(Modal, a_film_without_stiffness_has_none) {
  for (const int rings : {0, 3}) {
    const test::Diaphragm diaphragm({.shear_modulus = 1e-200, .rings = rings});
    Equilibrium equilibrium(diaphragm.model, 1);
    EXPECT_FALSE(vibration_modes(equilibrium, diaphragm.model.initial_state(), {.count = 6})) << rings;
  }
}

// In the plane and across it: 3.5160 sqrt(EI/(rho A))/L^2 (Bernoulli's beam).
TEST(VibrationModes, of_a_cantilever_of_beams_are_those_of_the_closed_form) {
  const materials::BeamSection section = materials::rectangular_section(
      {.youngs_modulus = 78e6, .poisson_ratio = 0.36, .density = 1200}, 0.8e-3, 2e-3);
  for (const int order : {1, 2}) {
    const meshing::Mesh mesh = test::line(
        40 / order, order, [](double s) { return Eigen::Vector3d(0.1 * s, 0, 0); },
        [](double t) { return t; });
    const auto model =
        test::unnumbered_model(mesh.node_count(), false, make_beam_block(mesh, mesh.blocks[0], section));
    int root = 0;
    for (int n = 1; n < mesh.node_count(); ++n)
      if (mesh.nodes[static_cast<std::size_t>(n)].x() < mesh.nodes[static_cast<std::size_t>(root)].x())
        root = n;
    for (int c = 0; c < DofMap::components; ++c) model->dofs.hold(root, c);
    model->dofs.number();
    model->length_scale = 2.5e-3;
    model->extent = 0.1;
    Equilibrium equilibrium(*model, 1);
    const auto modes = vibration_modes(equilibrium, model->initial_state(), {.count = 2});
    ASSERT_TRUE(modes);
    const double slow = std::sqrt(section.EI3 / section.line_density),
                 fast = std::sqrt(section.EI2 / section.line_density);
    EXPECT_NEAR((*modes)[0].frequency(), 3.51602 * slow / 0.01, 2e-3 * 351.602 * slow) << order;
    EXPECT_NEAR((*modes)[1].frequency(), 3.51602 * fast / 0.01, 2e-3 * 351.602 * fast) << order;
  }
}

} // namespace
} // namespace dielast::fem::modal_test
