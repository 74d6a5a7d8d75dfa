// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/beam_block.hpp"
#include "fem/shells/shell_block.hpp"
#include "fem/shells/shell_tables.hpp"
#include "materials/laws/dual.hpp"
#include "tests/fem/derivative_contract.hpp"
#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace dielast::fem {
namespace {

/// Two layers of different film, the first one charged on some elements, the second one viscoelastic.
ShellSection two_layers() {
  return {.layers = {{test::vhb().material, 0.05}, {test::viscoelastic_vhb().material, 0.1}},
          .prestretch = {1.2, 0.9},
          .offset = 0.02};
}

/// Unit square of eight curved triangles in the xy plane.
meshing::Mesh flat_mesh() {
  meshing::Mesh mesh = test::distorted_square(2, 2);
  std::mt19937 random(5);
  for (int a = 9; a < mesh.node_count(); ++a)
    mesh.nodes[static_cast<std::size_t>(a)].head<2>() += test::random_vector(random, 2, 0.03);
  return mesh;
}

/// The square bent to a dome with a twist.
meshing::Mesh dome() {
  meshing::Mesh mesh = flat_mesh();
  for (auto& x : mesh.nodes) x.z() = 0.4 * x.x() * (1.5 - x.x()) + 0.3 * x.x() * x.y() - 0.2 * x.y() * x.y();
  return mesh;
}

/// As if something acted on the spins of all nodes.
void keep_spins(Model& model) {
  for (int n = 0; n < model.dofs.node_count(); ++n) model.dofs.keep_spins(n);
}

std::unique_ptr<Model> shell_model(const meshing::Mesh& mesh, const ShellSection& section,
                                   bool with_spins = false) {
  std::vector<int> electrodes(static_cast<std::size_t>(mesh.blocks[0].size()), 0);
  for (std::size_t e = 0; e < electrodes.size(); e += 3) electrodes[e] = passive;
  std::vector<std::vector<int>> all{electrodes};
  if (section.layers.size() > 1) all.emplace_back(electrodes.size(), passive);
  auto model =
      test::unnumbered_model(mesh.node_count(), false, make_shell_block(mesh, mesh.blocks[0], section, all));
  if (with_spins) keep_spins(*model);
  model->dofs.number();
  return model;
}

/// Stretched, turned and shaken.
State random_state(const Model& model, const meshing::Mesh& mesh, std::mt19937& random) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 0) = 1.3;
  F(0, 1) = 0.2;
  State state = test::homogeneous(model, mesh, F);
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) {
    state.displacement[a] += test::random_vector(random, 3, 0.03);
    state.rotation[a] = test::random_rotation(random, 0.2);
  }
  const State turned = test::moved(state, mesh, test::random_rotation(random, 3), {0.3, 0.2, -0.5});
  State charged = turned;
  charged.voltage = {3e5};
  charged.scheme = materials::TimeScheme::backward_euler(0.3);
  return charged;
}

TEST(Shell, residual_and_tangent_are_the_derivatives_of_the_energy) {
  ShellSection curved = two_layers();
  curved.prestretch = {1, 1};
  for (const bool with_spins : {false, true}) {
    std::mt19937 random(21);
    for (const auto& [mesh, section] : {std::pair{flat_mesh(), two_layers()}, {dome(), curved}}) {
      const auto model = shell_model(mesh, section, with_spins);
      test::expect_consistent_derivatives(*model, random_state(*model, mesh, random), 0.1);
    }
  }
  // Elements whose nodes are of both kinds.
  const meshing::Mesh mesh = flat_mesh();
  const std::vector<int> charged(8, 0), not_charged(8, passive);
  const auto model = test::unnumbered_model(
      mesh.node_count(), false, make_shell_block(mesh, mesh.blocks[0], two_layers(), {charged, not_charged}));
  for (int n = 0; n < mesh.node_count(); n += 2) model->dofs.keep_spins(n);
  model->dofs.number();
  std::mt19937 random(21);
  test::expect_consistent_derivatives(*model, random_state(*model, mesh, random), 0.1);
}

TEST(Shell, nodes_tilt_but_where_it_is_folded_or_a_beam_meets_it) {
  meshing::Mesh mesh = test::distorted_square(2, 2);
  const auto kinds = [&](std::unique_ptr<ElementBlock> beam = nullptr) {
    auto model = test::unnumbered_model(
        mesh.node_count(), false,
        make_shell_block(mesh, mesh.blocks[0], {{{test::vhb().material, 0.05}}}, {std::vector<int>(8, 0)}));
    if (beam) {
      model->blocks.push_back(std::move(beam));
      model->blocks.back()->claim_dofs(model->dofs, Dimension::spatial);
    }
    model->dofs.number();
    return model;
  };
  const auto flat = kinds();
  EXPECT_EQ(flat->dofs.count(), 5 * mesh.node_count());
  const auto cell = mesh.blocks[0].cell(2);
  const std::set<int> on_beam{cell[0], cell[1], cell[3]};
  const auto stiffened = kinds(
      make_beam_block(mesh, {meshing::CellType::line3, {cell[0], cell[1], cell[3]}}, test::uneven_section()));
  for (int n = 0; n < mesh.node_count(); ++n) EXPECT_EQ(stiffened->dofs.tilts(n), !on_beam.contains(n));
  const Eigen::Quaterniond turn = rotation_of({0.7, -0.4, 0.2}); // flat film lies in any plane
  for (auto& x : mesh.nodes) x = turn * x + Eigen::Vector3d(30, 20, -10);
  EXPECT_EQ(kinds()->dofs.count(), 5 * mesh.node_count());
  const auto drawn = mesh.nodes;
  // The first triangle, turned about one of its sides, takes its neighbours' nodes along.
  const auto one = mesh.blocks[0].cell(0);
  const auto at = [&](int n) { return drawn[static_cast<std::size_t>(n)]; };
  const Eigen::Vector3d side = at(one[1]) - at(one[0]);
  for (const int n : {one[2], one[4], one[5]})
    mesh.nodes[static_cast<std::size_t>(n)] +=
        0.3 * side.cross(at(n) - at(one[0])).norm() * (turn * Eigen::Vector3d::UnitZ());
  const auto folded = kinds();
  int tilting = 0;
  for (int n = 0; n < mesh.node_count(); ++n) {
    int elements = 0;
    for (int e = 0; e < mesh.blocks[0].size(); ++e)
      elements += std::ranges::count(mesh.blocks[0].cell(e), n) > 0;
    if (std::ranges::count(one, n) > 0) EXPECT_EQ(folded->dofs.tilts(n), elements == 1) << n;
    tilting += folded->dofs.tilts(n);
  }
  EXPECT_GT(tilting, 0);
}

/// The unknowns of one element (displacement and spin of each node) by those of the model.
Eigen::MatrixXd element_jacobian(const Model& model, const State& state) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(36, model.dofs.count());
  for (int e = 0; e < model.dofs.count(); ++e)
    for (int n = 0; n < 6; ++n) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(model.dofs.count(), e);
      for (int c = 0; c < 3; ++c) J(6 * n + c, e) = model.dofs.equation(n, c) == e;
      J.block<3, 1>(6 * n + 3, e) = model.dofs.spin(state, n, unit);
    }
  return J;
}

/// Energy of one element in dual numbers of its 36 unknowns: strains from the tables, curvature and director
/// by the shape functions, every layer by its law's own formula.
materials::Dual<36> element_energy(const meshing::Mesh& mesh, const ShellSection& section, const State& state,
                                   double voltage, bool with_spins) {
  using Unknowns = materials::Dual<36>;
  using Vector = std::array<Unknowns, 3>;
  const auto dot = [](const Vector& u, const Vector& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
  const auto cross = [](const Vector& u, const Vector& v) {
    return Vector{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  };
  const auto constant = [](const Eigen::Vector3d& v) { return Vector{v[0], v[1], v[2]}; };
  struct Nodes {
    std::array<Vector, 6> x, d;
    std::array<std::array<Vector, 2>, 6> along;
  };
  Nodes drawn, now;
  for (std::size_t a = 0; a < 6; ++a) {
    const auto& X = mesh.nodes;
    Eigen::Vector3d r = Eigen::Vector3d::Zero(), s = r;
    for (std::size_t b = 0; b < 6; ++b) {
      r += shell_tables().node[a][b][0] * X[b];
      s += shell_tables().node[a][b][1] * X[b];
    }
    drawn.x[a] = constant(X[a]);
    drawn.d[a] = constant(r.cross(s).normalized());
    drawn.along[a] = {constant(r), constant(s)};
    Vector spin;
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      now.x[a][i] = Unknowns::variable(X[a][c] + state.displacement[a][c], static_cast<int>(6 * a) + c);
      spin[i] = Unknowns::variable(0, static_cast<int>(6 * a) + 3 + c);
    }
    const auto turned = [&](const Eigen::Vector3d& v) { // exp(spin) R v to second order
      const Vector Rv = constant(state.rotation[a] * v), once = cross(spin, Rv), twice = cross(spin, once);
      Vector sum;
      for (std::size_t c = 0; c < 3; ++c) sum[c] = Rv[c] + once[c] + 0.5 * twice[c];
      return sum;
    };
    now.d[a] = turned(r.cross(s).normalized());
    now.along[a] = {turned(r), turned(s)};
  }
  using Metric = std::array<std::array<Unknowns, 2>, 2>;
  struct Strains {
    Metric metric, curvature;
    std::array<Unknowns, 2> gamma;
  };
  const auto strains = [&](const ShellTables::Point& table, const Nodes& n) {
    Strains s;
    std::array<Vector, 2> x, d;
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          x[i][c] += table.gradient[a][i] * n.x[a][c];
          d[i][c] += table.gradient[a][i] * n.d[a][c];
        }
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        s.curvature[i][j] = 0.5 * (dot(x[i], d[j]) + dot(x[j], d[i]));
        for (std::size_t a = 0; a < 6; ++a)
          for (std::size_t b = 0; b < 6; ++b) {
            s.metric[i][j] += table.metric[i == j ? i : 2][a][b] * dot(n.x[a], n.x[b]);
            if (j == 0) s.gamma[i] += table.shear[i][a][b] * dot(n.x[a], n.d[b]);
          }
      }
    return s;
  };
  double shear_modulus = 0, height = 0, area = 0; // per area; m; m^2
  for (const ShellLayer& layer : section.layers) {
    shear_modulus += 5.0 / 6 * layer.thickness * materials::initial_shear_modulus(layer.material.law);
    height += layer.thickness;
  }
  Unknowns energy;
  const Eigen::Vector2d prestretch(section.prestretch[0], section.prestretch[1]);
  for (const ShellTables::Point& table : shell_tables().point) {
    Eigen::Matrix<double, 3, 2> t = Eigen::Matrix<double, 3, 2>::Zero();
    for (std::size_t a = 0; a < 6; ++a)
      for (int i = 0; i < 2; ++i) t.col(i) += table.gradient[a][static_cast<std::size_t>(i)] * mesh.nodes[a];
    Eigen::Matrix<double, 3, 2> axes;
    const Eigen::Vector3d normal = t.col(0).cross(t.col(1)).normalized();
    axes.col(0) = (Eigen::Vector3d::UnitX() - normal.x() * normal).normalized();
    axes.col(1) = normal.cross(axes.col(0));
    const Eigen::Matrix2d J = axes.transpose() * t, G = J.inverse() * prestretch.asDiagonal();
    const double dA = table.weight * J.determinant() / prestretch.prod();
    area += dA;
    const Strains at = strains(table, now), before = strains(table, drawn);
    Metric a, b;
    std::array<Unknowns, 2> gamma;
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 2; ++k) {
        const auto I = static_cast<std::size_t>(i), K = static_cast<std::size_t>(k);
        gamma[I] += G(k, i) * (at.gamma[K] - before.gamma[K]);
        a[I][K] += i == k ? prestretch[i] * prestretch[i] : 0;
        for (int j = 0; j < 2; ++j)
          for (int l = 0; l < 2; ++l) {
            const auto Jj = static_cast<std::size_t>(j), L = static_cast<std::size_t>(l);
            a[I][K] += G(j, i) * G(l, k) * (at.metric[Jj][L] - before.metric[Jj][L]);
            b[I][K] += G(j, i) * G(l, k) * (at.curvature[Jj][L] - before.curvature[Jj][L]);
          }
      }
    energy += 0.5 * shear_modulus * dA * (gamma[0] * gamma[0] + gamma[1] * gamma[1]);
    const Unknowns thinning = 1.0 / sqrt(a[0][0] * a[1][1] - a[0][1] * a[0][1]);
    double bottom = section.offset - height / 2;
    for (std::size_t l = 0; l < section.layers.size(); ++l) {
      const materials::Material& material = section.layers[l].material;
      const double H = section.layers[l].thickness;
      const double k = l > 0 ? 0 : material.dielectric.permittivity * voltage * voltage / (H * H);
      for (const auto& [place, weight] :
           {std::pair{-std::sqrt(0.6), 5.0 / 18}, {0.0, 8.0 / 18}, {std::sqrt(0.6), 5.0 / 18}}) {
        const double Z = bottom + H / 2 * (1 + place);
        const auto C = [&](std::size_t i, std::size_t j) { return a[i][j] + 2 * Z * thinning * b[i][j]; };
        const materials::InPlaneC<Unknowns> all{C(0, 0), C(1, 1), C(0, 1)};
        energy += weight * H * dA *
                  std::visit(
                      [&](const auto& law) {
                        return materials::membrane_energy(law, material.dielectric, all, Unknowns(k));
                      },
                      material.law);
      }
      bottom += H;
    }
  }
  for (std::size_t n = 0; n < 6; ++n) {
    std::array<Vector, 2> x;
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t c = 0; c < 3; ++c) x[i][c] += shell_tables().node[n][a][i] * now.x[a][c];
    const Vector cell = cross(now.along[n][0], now.along[n][1]);
    const double size = std::sqrt(dot(cell, cell).value); // turning keeps it
    const Unknowns omega = (dot(now.along[n][0], x[1]) - dot(now.along[n][1], x[0])) / size;
    if (with_spins) energy += 0.5 * section.drilling * shear_modulus * area / 6 * omega * omega;
  }
  return energy;
}

TEST(Shell, energy_residual_and_tangent_equal_dual_numbers) {
  for (const bool with_spins : {false, true}) {
    ShellSection section = two_layers();
    section.layers[1].material.branches.clear();
    section.layers[1].material.law = materials::MooneyRivlin{20e3, 5e3};
    std::mt19937 random(31);
    for (const bool flat : {true, false}) {
      meshing::Mesh mesh = flat ? flat_mesh() : dome();
      if (!flat) section.prestretch = {1, 1};
      meshing::Mesh one;
      for (int a = 0; a < 6; ++a) {
        one.nodes.push_back(
            mesh.nodes[static_cast<std::size_t>(mesh.blocks[0].cell(3)[static_cast<std::size_t>(a)])]);
      }
      one.blocks = {{meshing::CellType::triangle6, {0, 1, 2, 3, 4, 5}}};
      const auto model =
          test::unnumbered_model(6, false, make_shell_block(one, one.blocks[0], section, {{0}, {passive}}));
      if (with_spins) keep_spins(*model);
      model->dofs.number();
      Assembler assembler(*model, 1);
      for (int sample = 0; sample < 5; ++sample) {
        const State state = random_state(*model, one, random);
        const auto expected = element_energy(one, section, state, state.voltage[0], with_spins);
        Eigen::VectorXd residual;
        const Evaluation evaluation = assembler.residual(state, residual);
        assembler.tangent(state);
        ASSERT_EQ(residual.size(), with_spins ? 36 : 30);
        const double scale = expected.hessian.norm();
        EXPECT_NEAR(evaluation.energy, expected.value, 1e-12 * scale);
        const Eigen::MatrixXd J = element_jacobian(*model, state);
        const Eigen::VectorXd gradient = J.transpose() * expected.gradient;
        const Eigen::MatrixXd hessian = J.transpose() * expected.hessian * J;
        EXPECT_LT((residual - gradient).norm(), 1e-12 * scale);
        EXPECT_LT((test::dense(assembler.matrix()) - hessian).norm(), 1e-12 * scale);
      }
    }
  }
}

// Stretches along the sides and linear metrics are kept as they are, and so is the shear of a rigid plate.
TEST(ShellTables, reproduce_linear_fields) {
  const Eigen::Matrix<double, 3, 2> slope{{1.2, 0.3}, {-0.2, 0.8}, {0.5, 0.1}};
  const Eigen::Vector3d director(0.3, -0.4, 0.8);
  const std::array<Eigen::Vector2d, 6> place{{{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}};
  for (const ShellTables::Point& table : shell_tables().point) {
    Eigen::Vector3d metric = Eigen::Vector3d::Zero();
    Eigen::Vector2d shear = Eigen::Vector2d::Zero();
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 6; ++b) {
        for (std::size_t c = 0; c < 3; ++c)
          metric[static_cast<Eigen::Index>(c)] +=
              table.metric[c][a][b] * (slope * place[a]).dot(slope * place[b]);
        for (std::size_t c = 0; c < 2; ++c)
          shear[static_cast<Eigen::Index>(c)] += table.shear[c][a][b] * (slope * place[a]).dot(director);
      }
    const Eigen::Matrix2d expected = slope.transpose() * slope;
    EXPECT_NEAR(metric[0], expected(0, 0), 1e-13);
    EXPECT_NEAR(metric[1], expected(1, 1), 1e-13);
    EXPECT_NEAR(metric[2], expected(0, 1), 1e-13);
    EXPECT_LT((shear - slope.transpose() * director).norm(), 1e-13);
  }
}

TEST(Shell, charges_are_the_slopes_of_the_energy_and_its_parts_add_up) {
  const meshing::Mesh mesh = flat_mesh();
  ShellSection section = two_layers();
  section.layers[1].material.branches.clear();
  const auto model = shell_model(mesh, section);
  std::mt19937 random(8);
  const State state = random_state(*model, mesh, random);
  Assembler assembler(*model, 1);
  Eigen::VectorXd here, there;
  const double energy = assembler.residual(state, here).energy;
  const Charges charges = model->charges(state, true);
  State other = state;
  const double step = 1e-3 * state.voltage[0];
  other.voltage[0] += step; // the energy and the forces are quadratic in the voltage
  const double slope = (assembler.residual(other, there).energy - energy) / step;
  EXPECT_NEAR(-slope, charges.charge[0] + charges.capacitance[0] * step / 2, 1e-9 * charges.charge[0]);
  const Eigen::VectorXd coupling = (here - there) / (step * (1 + step / (2 * state.voltage[0])));
  EXPECT_LT((coupling - charges.coupling[0]).norm(), 1e-8 * coupling.norm());
  EXPECT_NEAR(charges.charge[0], charges.capacitance[0] * state.voltage[0], 1e-12 * charges.charge[0]);
  const EnergyParts parts = model->energies(state);
  EXPECT_NEAR(parts.elastic - parts.electric, energy, 1e-12 * parts.elastic);
}

TEST(Shell, has_the_mass_of_its_layers_and_turns_without) {
  const meshing::Mesh mesh = test::distorted_square(2, 2);
  const ShellSection section = two_layers();
  const auto model = shell_model(mesh, section);
  const Eigen::SparseMatrix<double> mass = Inertia::of(model->blocks, model->dofs).mass;
  std::array<double, 3> sum{};
  for (int a = 0; a < mesh.node_count(); ++a)
    for (int b = 0; b < mesh.node_count(); ++b)
      for (int c = 0; c < 3; ++c)
        sum[static_cast<std::size_t>(c)] +=
            mass.coeff(model->dofs.equation(a, c), model->dofs.equation(b, c));
  const double area = 1 / (1.2 * 0.9), density = 960; // undeformed
  for (const double along : sum) EXPECT_NEAR(along, density * 0.15 * area, 1e-9);
  EXPECT_NEAR(mass.sum(), 3 * density * 0.15 * area, 1e-9);
  for (int a = 0; a < mesh.node_count(); ++a)
    for (int c = 6; c < 8; ++c) EXPECT_EQ(mass.col(model->dofs.equation(a, c)).nonZeros(), 0);
}

TEST(Shell, refuses_what_it_cannot_be) {
  const auto make = [](const meshing::Mesh& mesh, const ShellSection& section, std::size_t layers = 2) {
    const std::vector<int> none(static_cast<std::size_t>(mesh.blocks[0].size()), passive);
    return make_shell_block(mesh, mesh.blocks[0], section, std::vector(layers, none));
  };
  EXPECT_NO_THROW(make(flat_mesh(), two_layers()));
  EXPECT_THROW(make(test::distorted_square(2, 1), two_layers()), std::invalid_argument); // 3 nodes
  EXPECT_THROW(make(flat_mesh(), two_layers(), 1), std::invalid_argument);
  EXPECT_THROW(make(dome(), two_layers()), std::invalid_argument); // prestretched, and not flat
  meshing::Mesh turned = flat_mesh();
  for (auto& x : turned.nodes) x.x() *= -1;
  EXPECT_THROW(make(turned, two_layers()), std::invalid_argument);
}

TEST(Shell, rigid_motion_makes_no_stress_and_keeps_the_energy_of_a_deformed_one) {
  const meshing::Mesh mesh = dome();
  ShellSection section = two_layers();
  section.prestretch = {1, 1};
  for (const bool with_spins : {false, true}) {
    const auto model = shell_model(mesh, section, with_spins);
    Assembler assembler(*model, 1);
    Eigen::VectorXd here, there;
    const Eigen::Quaterniond Q = rotation_of({2, 1, -1.5});
    const State at_rest = model->initial_state();
    assembler.tangent(at_rest);
    const double stiffness = test::dense(assembler.matrix()).norm();
    assembler.residual(test::moved(at_rest, mesh, Q, {3, 4, 5}), here);
    EXPECT_LT(here.norm(), 1e-12 * stiffness);

    std::mt19937 random(4);
    const State state = random_state(*model, mesh, random);
    const State moved = test::moved(state, mesh, Q, {3, 4, 5});
    const double energy = assembler.residual(state, here).energy;
    EXPECT_NEAR(assembler.residual(moved, there).energy, energy, 1e-12 * std::abs(energy));
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
    for (int a = 0; a < mesh.node_count(); ++a) {
      Eigen::Vector3d f, g;
      for (int c = 0; c < 3; ++c) {
        f[c] = here[model->dofs.equation(a, c)];
        g[c] = there[model->dofs.equation(a, c)];
      }
      const Eigen::Vector3d m = model->dofs.spin(state, a, here);
      EXPECT_LT((g - Q * f).norm(), 1e-12 * here.norm());
      const auto n = static_cast<std::size_t>(a);
      force += f;
      moment += m + (mesh.nodes[n] + state.displacement[n]).cross(f);
    }
    EXPECT_LT(force.norm(), 1e-12 * here.norm());
    EXPECT_LT(moment.norm(), 1e-12 * here.norm());
  }
}

TEST(Shell, one_element_has_the_six_rigid_motions_and_no_other_modes_without_energy) {
  meshing::Mesh mesh = dome();
  mesh.blocks[0].nodes.resize(6);
  for (const bool with_spins : {false, true}) {
    const auto model = test::unnumbered_model(
        mesh.node_count(), false,
        make_shell_block(mesh, mesh.blocks[0], {{{test::vhb().material, 0.2}}}, {{0}}));
    if (with_spins) keep_spins(*model);
    model->dofs.number();
    Assembler assembler(*model, 1);
    assembler.tangent(model->initial_state());
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(test::dense(assembler.matrix())).eigenvalues();
    ASSERT_EQ(values.size(), with_spins ? 36 : 30);
    const double largest = values[values.size() - 1];
    EXPECT_LT(std::abs(values[5]), 1e-12 * largest);
    EXPECT_GT(values[6], 1e-6 * largest);
  }
}

} // namespace
} // namespace dielast::fem
