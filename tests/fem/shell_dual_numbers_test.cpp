// SPDX-License-Identifier: GPL-3.0-or-later
// A shell element against its energy in dual numbers, made anew of the formulas.
#include "fem/shells/shell_tables.hpp"
#include "materials/laws/dual.hpp"
#include "tests/fem/sample_shells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::fem::shell_dual_numbers_test {
namespace {

using test::dome;
using test::flat_mesh;
using test::keep_spins;
using test::random_state;
using test::two_layers;

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
  const auto& X = mesh.nodes;
  const auto tangents = [](const std::vector<Eigen::Vector3d>& surface, std::size_t a) {
    std::array<Eigen::Vector3d, 2> t{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (std::size_t b = 0; b < 6; ++b)
      for (std::size_t i = 0; i < 2; ++i) t[i] += shell_tables().node[a][b][i] * surface[b];
    return t;
  };
  // Strains are those of the surface of the layers' middle as drawn.
  const double lever = section.offset / (section.prestretch[0] * section.prestretch[1]);
  std::vector<Eigen::Vector3d> D, middle;
  for (std::size_t a = 0; a < 6; ++a) {
    const auto t = tangents(X, a);
    D.push_back(t[0].cross(t[1]).normalized());
    middle.push_back(X[a] + lever * D[a]);
  }
  for (std::size_t a = 0; a < 6; ++a) {
    const auto [r, s] = tangents(middle, a);
    drawn.x[a] = constant(middle[a]);
    drawn.d[a] = constant(D[a]);
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
    now.d[a] = turned(D[a]);
    now.along[a] = {turned(r), turned(s)};
    for (std::size_t c = 0; c < 3; ++c) now.x[a][c] += lever * now.d[a][c];
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
  std::array<double, 2> shear_modulus{}; // per area, along x and y of the unstretched film
  double height = 0, area = 0;           // m; m^2
  const auto extra = [&](const ShellLayer& layer, std::size_t i) {
    return (layer.prestretch ? (*layer.prestretch)[i] : section.prestretch[i]) / section.prestretch[i];
  };
  const auto depth = [&](const ShellLayer& layer) { // before the prestretch of the section
    return layer.thickness / (extra(layer, 0) * extra(layer, 1));
  };
  for (const ShellLayer& layer : section.layers) {
    for (std::size_t i = 0; i < 2; ++i) // each is sheared by what its own unstretched film sees
      shear_modulus[i] += 5.0 / 6 * depth(layer) * materials::initial_shear_modulus(layer.material.law) *
                          extra(layer, i) * extra(layer, i);
    height += depth(layer);
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
    for (std::size_t i = 0; i < 2; ++i) energy += 0.5 * shear_modulus[i] * dA * gamma[i] * gamma[i];
    const auto inverse_metric = [&a] {
      const Unknowns det = a[0][0] * a[1][1] - a[0][1] * a[0][1];
      return Metric{{{a[1][1] / det, -a[0][1] / det}, {-a[0][1] / det, a[0][0] / det}}};
    };
    const auto square_of_curvature = [&](const Metric& inverse) {
      Metric square;
      for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t l = 0; l < 2; ++l)
          square[i / 4][l] += b[i / 4][i / 2 % 2] * inverse[i / 2 % 2][i % 2] * b[i % 2][l];
      return square;
    };
    double bottom = -height / 2;
    const Unknowns thinning = 1.0 / sqrt(a[0][0] * a[1][1] - a[0][1] * a[0][1]);
    const Metric inverse = inverse_metric(), square = square_of_curvature(inverse);
    const Unknowns twice_mean =
        inverse[0][0] * b[0][0] + inverse[1][1] * b[1][1] + 2.0 * inverse[0][1] * b[0][1];
    for (std::size_t l = 0; l < section.layers.size(); ++l) {
      const materials::Material& material = section.layers[l].material;
      const double H = depth(section.layers[l]), own = section.layers[l].thickness;
      const double k = l > 0 ? 0 : material.dielectric.permittivity * voltage * voltage / (own * own);
      Unknowns elastance; // mean over the layer of what a slice has, over H/eps
      for (const auto& [place, weight] :
           {std::pair{-std::sqrt(0.6), 5.0 / 18}, {0.0, 8.0 / 18}, {std::sqrt(0.6), 5.0 / 18}}) {
        const double Z = bottom + H / 2 * (1 + place);
        const auto C = [&](std::size_t i, std::size_t j) {
          return extra(section.layers[l], i) * extra(section.layers[l], j) *
                 (a[i][j] + 2 * Z * thinning * b[i][j] +
                  Z * Z * thinning * thinning * (square[i][j] - twice_mean * b[i][j]));
        };
        const materials::InPlaneC<Unknowns> all{C(0, 0), C(1, 1), C(0, 1)};
        energy += weight * H * dA *
                  std::visit(
                      [&](const auto& law) {
                        return materials::membrane_energy(law, material.dielectric, all, Unknowns(0));
                      },
                      material.law);
        elastance += weight / materials::capacitance_ratio_value(material.dielectric, all.trace(), all.det());
      }
      energy += -0.5 * k * H * dA / elastance; // slices in series
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
    if (with_spins)
      energy += 0.25 * section.drilling * (shear_modulus[0] + shear_modulus[1]) * area / 6 * omega * omega;
  }
  return energy;
}

TEST(Shell, energy_residual_and_tangent_equal_dual_numbers) {
  for (const auto& [with_spins, offset] :
       {std::pair{false, 0.02}, {true, 0.02}, {false, -0.12}, {true, 0.12}}) {
    ShellSection section = two_layers();
    section.offset = offset; // those beyond 0.075 lie beside the drawn surface
    section.layers[0].material.dielectric.electrostriction = with_spins ? 0.3 : 0;
    section.layers[1].material.branches.clear();
    section.layers[1].material.law = materials::MooneyRivlin{20e3, 5e3};
    std::mt19937 random(31);
    for (const bool flat : {true, false}) {
      meshing::Mesh mesh = flat ? flat_mesh() : dome();
      if (!flat) section.prestretch = {1, 1}, section.layers[0].prestretch.reset();
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

} // namespace
} // namespace dielast::fem::shell_dual_numbers_test
