// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/symmetric_solver.hpp"
#include "fem/films/membrane_block.hpp"
#include "fem/films/triangle.hpp"
#include "fem/paths/continuation.hpp"
#include "fem/paths/ramp.hpp"
#include "fem/shells/shell_block.hpp"
#include "meshing/middle_nodes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <vector>

namespace dielast::fem::test {

/// A shell over the parameters (u, v) in 0..1 x 0..1, n x m rectangles of two 6-node triangles each; all
/// nodes lie on `surface`.
inline meshing::Mesh surface_mesh(int n, int m,
                                  const std::function<Eigen::Vector3d(double u, double v)>& surface) {
  meshing::Mesh mesh;
  const auto node = [m](int i, int j) { return i * (2 * m + 1) + j; };
  for (int i = 0; i <= 2 * n; ++i)
    for (int j = 0; j <= 2 * m; ++j) mesh.nodes.push_back(surface(0.5 * i / n, 0.5 * j / m));
  meshing::CellBlock triangles{meshing::CellType::triangle6, {}};
  for (int i = 0; i < 2 * n; i += 2)
    for (int j = 0; j < 2 * m; j += 2) {
      triangles.nodes.insert(triangles.nodes.end(), {node(i, j), node(i + 2, j), node(i + 2, j + 2),
                                                     node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 1)});
      triangles.nodes.insert(triangles.nodes.end(), {node(i, j), node(i + 2, j + 2), node(i, j + 2),
                                                     node(i + 1, j + 1), node(i + 1, j + 2), node(i, j + 1)});
    }
  mesh.blocks = {std::move(triangles)};
  return mesh;
}

/// A shell with supports and dead loads.
class ShellProblem {
 public:
  using Surface = std::function<Eigen::Vector3d(double u, double v)>;

  using Blocks = std::function<std::unique_ptr<ElementBlock>(const meshing::Mesh&)>;

  ShellProblem(int n, int m, const Surface& surface, const Blocks& block)
      : n_(n), m_(m), mesh_(surface_mesh(n, m, surface)),
        model_(unnumbered_model(mesh_.node_count(), false, block(mesh_))) {}
  /// `charged`: number of the layer that has the electrode, -1: none has.
  ShellProblem(int n, int m, const Surface& surface, const ShellSection& section, int charged = -1)
      : ShellProblem(n, m, surface, [&](const meshing::Mesh& mesh) {
          const auto cells = static_cast<std::size_t>(mesh.blocks[0].size());
          std::vector<std::vector<int>> electrodes(section.layers.size(), std::vector<int>(cells, passive));
          if (charged >= 0) std::ranges::fill(electrodes[static_cast<std::size_t>(charged)], 0);
          return make_shell_block(mesh, mesh.blocks[0], section, electrodes);
        }) {}
  int node(double u, double v) const {
    return static_cast<int>(std::lround(u * 2 * n_)) * (2 * m_ + 1) +
           static_cast<int>(std::lround(v * 2 * m_));
  }
  /// Nodes of a side: u = 0, u = 1, v = 0 or v = 1.
  std::vector<int> side(int parameter, double value) const {
    std::vector<int> nodes;
    const int count = parameter == 0 ? 2 * m_ : 2 * n_;
    for (int i = 0; i <= count; ++i) {
      const double t = static_cast<double>(i) / count;
      nodes.push_back(parameter == 0 ? node(value, t) : node(t, value));
    }
    return nodes;
  }
  void hold(const std::vector<int>& nodes, const std::vector<int>& components) {
    for (const int n : nodes)
      for (const int c : components) model_->dofs.hold(n, c);
  }
  /// After the supports.
  void number() {
    model_->dofs.number();
    const auto& X = mesh_.nodes;
    model_->length_scale = (X[static_cast<std::size_t>(node(0.5 / n_, 0))] - X[0]).norm();
    model_->extent = mesh_.bounds().diagonal().norm();
    model_->drawn = X;
    load_ = Eigen::VectorXd::Zero(model_->dofs.count());
    state_ = model_->initial_state();
  }
  void load(int at, int component, double value) { load_[model_->dofs.equation(at, component)] += value; }
  /// A total force (moment), spread evenly over a straight side.
  void load_side(const std::vector<int>& nodes, int component, double total) {
    const auto sides = (nodes.size() - 1) / 2;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double weight = i % 2 ? 4 : i == 0 || i + 1 == nodes.size() ? 1 : 2; // Simpson
      load(nodes[i], component, total * weight / (6 * static_cast<double>(sides)));
    }
  }
  /// A force per area along z.
  void load_surface(double pressure) {
    for (int e = 0; e < mesh_.blocks[0].size(); ++e) {
      const auto cell = mesh_.blocks[0].cell(e);
      Eigen::Matrix<double, 3, 6> X;
      for (int a = 0; a < 6; ++a)
        X.col(a) = mesh_.nodes[static_cast<std::size_t>(cell[static_cast<std::size_t>(a)])];
      for (const TrianglePoint& at : triangle_rule(6)) {
        const Eigen::Matrix<double, 3, 2> t = X * shape_gradients<6>(at.xi, at.eta);
        const auto N = shape_values<6>(at.xi, at.eta);
        for (int a = 0; a < 6; ++a)
          load(cell[static_cast<std::size_t>(a)], 2,
               pressure * at.weight * t.col(0).cross(t.col(1)).norm() * N[a]);
      }
    }
  }
  /// Displacement and spin per equation of the linear shell.
  Eigen::VectorXd linear_answer() const {
    Assembler assembler(*model_, 1);
    assembler.tangent(model_->initial_state());
    SymmetricSolver solver(assembler.matrix(), assembler.workers());
    Eigen::VectorXd u = Eigen::VectorXd::Zero(load_.size()), x;
    EXPECT_TRUE(solver.factor());
    solver.solve(load_.head(model_->dofs.free_count()), x);
    u.head(x.size()) = x;
    return u;
  }
  double linear_answer(int at, int component) const {
    return linear_answer()[model_->dofs.equation(at, component)];
  }
  /// Raises load and voltage to `factor` times the full ones.
  RampResult raise(double factor, int increments, double voltage = 0, double tolerance = 1e-8) {
    Equilibrium equilibrium(*model_, 1);
    Loads target = Loads::of(state_, model_->dofs);
    target.dead_force = factor * load_;
    target.voltage = {voltage};
    const RampOptions options{.newton = {.tolerance = tolerance, .max_iterations = 60},
                              .increments = increments};
    RampProgress progress = RampProgress::begin(state_, model_->dofs, options);
    const RampResult result =
        ramp(equilibrium, linear_path(model_->dofs, progress.start, target), options, progress,
             {.on_accept = [this](const RampProgress&, const Increment& increment) {
               iterations += increment.newton.iterations;
               return true;
             }});
    state_ = progress.points.back().state;
    return result;
  }
  Eigen::Vector3d displacement(int at) const { return state_.displacement[static_cast<std::size_t>(at)]; }
  Model& model() { return *model_; }
  const meshing::Mesh& mesh() const { return mesh_; }
  State& state() { return state_; }
  const Eigen::VectorXd& load() const { return load_; }

  int iterations = 0; ///< Newton's, of raise()

 private:
  int n_, m_;
  meshing::Mesh mesh_;
  std::unique_ptr<Model> model_;
  Eigen::VectorXd load_;
  State state_;
};

inline ShellSection elastic_shell(double youngs_modulus, double poisson_ratio, double thickness) {
  return {.layers = {{{.law = materials::StVenantKirchhoff{youngs_modulus, poisson_ratio},
                       .dielectric = {},
                       .density = 960,
                       .branches = {}},
                      thickness}}};
}

/// A quarter of a hemisphere with a hole of 18 degrees: radius 10, thickness 0.04; u along its equator, v up.
/// Free to move along x at u = 0, along y at u = 1.
inline ShellProblem hemisphere(int n) {
  ShellProblem shell(
      n, n,
      [](double u, double v) {
        const double along = u * std::numbers::pi / 2, up = v * 72 * std::numbers::pi / 180;
        return Eigen::Vector3d(10 * std::cos(up) * std::cos(along), 10 * std::cos(up) * std::sin(along),
                               10 * std::sin(up));
      },
      elastic_shell(6.825e7, 0.3, 0.04));
  shell.hold(shell.side(0, 0), {1, 3, 5});
  shell.hold(shell.side(0, 1), {0, 4, 5});
  shell.hold({shell.node(0, 0)}, {2});
  shell.number();
  return shell;
}

} // namespace dielast::fem::test
