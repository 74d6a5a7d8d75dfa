// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/chamber_block.hpp"

#include "fem/elements/lower_triangle.hpp"
#include "fem/films/meridian.hpp"
#include "fem/films/triangle.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <span>

namespace dielast::fem {

namespace {

/// A volume as a function of an element's unknowns.
template<int Size>
struct Volume {
  double value = 0;
  Eigen::Vector<double, Size> gradient = Eigen::Vector<double, Size>::Zero();
  Eigen::Matrix<double, Size, Size> hessian = Eigen::Matrix<double, Size, Size>::Zero();
};

template<int Nodes>
struct UnderTriangle {
  static constexpr int nodes = Nodes, dim = 3;
  static constexpr std::array<int, 3> components{0, 1, 2};

  /// int N n da, by nodes, m^2.
  static Eigen::Matrix<double, 3, Nodes> areas(const Eigen::Matrix<double, 3, Nodes>& x) {
    Eigen::Matrix<double, 3, Nodes> areas = Eigen::Matrix<double, 3, Nodes>::Zero();
    for (const TrianglePoint& at : triangle_rule(Nodes == 6 ? 6 : 1)) {
      const Eigen::Matrix<double, 3, 2> t = x * shape_gradients<Nodes>(at.xi, at.eta);
      areas += at.weight * t.col(0).cross(t.col(1)) * shape_values<Nodes>(at.xi, at.eta).transpose();
    }
    return areas;
  }

  static Volume<3 * Nodes> of(const Eigen::Matrix<double, 3, Nodes>& x) {
    Volume<3 * Nodes> V;
    for (const TrianglePoint& at : triangle_rule(Nodes == 6 ? 6 : 1)) {
      const Eigen::Matrix<double, Nodes, 1> N = shape_values<Nodes>(at.xi, at.eta);
      const Eigen::Matrix<double, Nodes, 2> dN = shape_gradients<Nodes>(at.xi, at.eta);
      const Eigen::Matrix<double, 3, 2> t = x * dN;
      const double z = x.row(2).dot(N), area = t(0, 0) * t(1, 1) - t(0, 1) * t(1, 0), w = at.weight;
      V.value += w * z * area;
      const Eigen::Matrix<double, Nodes, 1> area_x = dN.col(0) * t(1, 1) - dN.col(1) * t(1, 0);
      const Eigen::Matrix<double, Nodes, 1> area_y = dN.col(1) * t(0, 0) - dN.col(0) * t(0, 1);
      for (int a = 0; a < Nodes; ++a) {
        V.gradient[3 * a] += w * z * area_x[a];
        V.gradient[3 * a + 1] += w * z * area_y[a];
        V.gradient[3 * a + 2] += w * N[a] * area;
        for (int b = 0; b < Nodes; ++b) {
          const double xy = w * z * (dN(a, 0) * dN(b, 1) - dN(a, 1) * dN(b, 0));
          V.hessian(3 * a, 3 * b + 1) += xy;
          V.hessian(3 * b + 1, 3 * a) += xy;
          V.hessian(3 * a + 2, 3 * b) += w * N[a] * area_x[b];
          V.hessian(3 * b, 3 * a + 2) += w * N[a] * area_x[b];
          V.hessian(3 * a + 2, 3 * b + 1) += w * N[a] * area_y[b];
          V.hessian(3 * b + 1, 3 * a + 2) += w * N[a] * area_y[b];
        }
      }
    }
    return V;
  }
};

template<int Nodes>
struct UnderMeridian {
  static constexpr int nodes = Nodes, dim = 2;
  static constexpr std::array<int, 2> components{0, 2};

  /// int N n da all around, by nodes, m^2.
  static Eigen::Matrix<double, 2, Nodes> areas(const Eigen::Matrix<double, 2, Nodes>& x) {
    Eigen::Matrix<double, 2, Nodes> areas = Eigen::Matrix<double, 2, Nodes>::Zero();
    for (const MeridianPoint& at : meridian_rule(3)) {
      const Eigen::Matrix<double, Nodes, 1> N = meridian_shape<Nodes>(at.xi);
      const Eigen::Vector2d t = x * meridian_slope<Nodes>(at.xi);
      const double around = 2 * std::numbers::pi * x.row(0).dot(N);
      areas += at.weight * around * Eigen::Vector2d(t.y(), -t.x()) * N.transpose();
    }
    return areas;
  }

  static Volume<2 * Nodes> of(const Eigen::Matrix<double, 2, Nodes>& x) {
    Volume<2 * Nodes> V;
    for (const MeridianPoint& at : meridian_rule(3)) {
      const Eigen::Matrix<double, Nodes, 1> N = meridian_shape<Nodes>(at.xi),
                                            dN = meridian_slope<Nodes>(at.xi);
      const double r = x.row(0).dot(N), dr = x.row(0).dot(dN), z = x.row(1).dot(N);
      const double w = -2 * std::numbers::pi * at.weight;
      V.value += w * r * z * dr;
      for (int a = 0; a < Nodes; ++a) {
        V.gradient[2 * a] += w * z * (N[a] * dr + r * dN[a]);
        V.gradient[2 * a + 1] += w * r * dr * N[a];
        for (int b = 0; b < Nodes; ++b) {
          V.hessian(2 * a, 2 * b) += w * z * (N[a] * dN[b] + dN[a] * N[b]);
          const double zr = w * N[a] * (N[b] * dr + r * dN[b]);
          V.hessian(2 * a + 1, 2 * b) += zr;
          V.hessian(2 * b, 2 * a + 1) += zr;
        }
      }
    }
    return V;
  }
};

/// Where the nodes of a cell are, in the components of its unknowns.
template<class Under>
Eigen::Matrix<double, Under::dim, Under::nodes>
positions(std::span<const int> cell, const std::vector<Eigen::Vector3d>& drawn, const State& state) {
  Eigen::Matrix<double, Under::dim, Under::nodes> x;
  for (int a = 0; a < Under::nodes; ++a) {
    const auto n = static_cast<std::size_t>(cell[static_cast<std::size_t>(a)]);
    for (int d = 0; d < Under::dim; ++d) {
      const int c = Under::components[static_cast<std::size_t>(d)];
      x(d, a) = drawn[n][c] + state.displacement[n][c];
    }
  }
  return x;
}

template<class Under>
std::vector<Eigen::Vector3d> forces_of(const meshing::Mesh& mesh, const meshing::CellBlock& wall,
                                       const State& state, double pressure) {
  std::vector<Eigen::Vector3d> forces;
  for (int cell = 0; cell < wall.size(); ++cell) {
    const auto areas = Under::areas(positions<Under>(wall.cell(cell), mesh.nodes, state)).eval();
    for (int a = 0; a < Under::nodes; ++a) {
      Eigen::Vector3d& force = forces.emplace_back(Eigen::Vector3d::Zero());
      for (int d = 0; d < Under::dim; ++d)
        force[Under::components[static_cast<std::size_t>(d)]] = pressure * areas(d, a);
    }
  }
  return forces;
}

template<class Under>
class PressureBlock final : public ElementBlock {
 public:
  PressureBlock(const meshing::Mesh& mesh, const meshing::CellBlock& film, std::size_t port)
      : port_(port), nodes_(film.nodes), reference_(mesh.nodes) {}

  int element_count() const override { return static_cast<int>(nodes_.size()) / Nodes; }
  int dofs_per_element() const override { return size; }
  void claim_dofs(DofMap& dofs, Dimension /*the film's*/) override {
    for (const int node : nodes_)
      for (const int c : Under::components) dofs.add(node, c);
  }
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override {
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i)
      equations[i] = dofs.equation(node(element, static_cast<int>(i) / Dim), Under::components[i % Dim]);
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    Evaluation result;
    const double p = state.voltage[port_];
    for (int e = first; e < last; ++e) {
      const Volume<size> V = volume(state, e);
      result.energy -= p * V.value;
      if (scatter.residual) {
        const Eigen::Vector<double, size> force = -p * V.gradient;
        scatter.add_residual(e, std::span(force.data(), size));
      }
      if (scatter.tangent)
        scatter.add_tangent(e, lower_triangle<size>(Eigen::Matrix<double, size, size>(-p * V.hessian)));
    }
    return result;
  }
  /// Those of edges that stay where they are, or in a plane of symmetry: p n da less the gradient.
  void add_forces_at_rest(const State& state, const DofMap& dofs, Eigen::VectorXd& residual) const override {
    std::array<int, size> equations;
    for (int e = 0; e < element_count(); ++e) {
      element_equations(e, dofs, equations);
      const Eigen::Matrix<double, Dim, Nodes> areas = Under::areas(position(state, e));
      const Volume<size> V = volume(state, e);
      for (int i = 0; i < size; ++i)
        if (const int at = equations[static_cast<std::size_t>(i)]; at >= 0)
          residual[at] -= state.voltage[port_] * (areas(i % Dim, i / Dim) - V.gradient[i]);
    }
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  void add_charges(const State& state, const DofMap* dofs, Charges& charges) const override {
    std::array<int, size> equations;
    for (int e = 0; e < element_count(); ++e) {
      const Volume<size> V = volume(state, e);
      charges.charge[port_] += V.value;
      if (!dofs) continue;
      element_equations(e, *dofs, equations);
      for (std::size_t i = 0; i < equations.size(); ++i)
        if (equations[i] >= 0) charges.coupling[port_][equations[i]] += V.gradient[static_cast<int>(i)];
    }
  }
  void add_energies(const State& /*state*/, EnergyParts& /*the load stores none*/) const override {}

 private:
  static constexpr int Nodes = Under::nodes, Dim = Under::dim, size = Nodes * Dim;

  int node(int element, int a) const { return nodes_[static_cast<std::size_t>(element * Nodes + a)]; }
  Eigen::Matrix<double, Dim, Nodes> position(const State& state, int element) const {
    const auto first = static_cast<std::size_t>(element * Nodes);
    return positions<Under>(std::span(nodes_).subspan(first, Nodes), reference_, state);
  }
  Volume<size> volume(const State& state, int element) const { return Under::of(position(state, element)); }

  std::size_t port_;
  std::vector<int> nodes_;
  std::vector<Eigen::Vector3d> reference_;
};

class LevelEdgeBlock final : public ElementBlock {
 public:
  LevelEdgeBlock(const meshing::Mesh& mesh, const meshing::CellBlock& meridians, const std::vector<int>& ends,
                 std::size_t port)
      : port_(port) {
    for (int cell = 0; cell < meridians.size(); ++cell)
      for (const std::size_t k : {0u, 1u})
        if (const int node = meridians.cell(cell)[k]; std::ranges::count(ends, node) > 0) {
          const Eigen::Vector3d& drawn = mesh.nodes[static_cast<std::size_t>(node)];
          edges_.push_back({node, drawn.x(), (k == 1 ? 1 : -1) * std::numbers::pi * drawn.z()});
        }
  }

  int element_count() const override { return static_cast<int>(edges_.size()); }
  int dofs_per_element() const override { return 1; }
  void claim_dofs(DofMap& /*those of the film*/, Dimension /*dimension*/) override {}
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override {
    equations[0] = dofs.equation(edge(element).node, 0);
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    Evaluation result;
    const double p = state.voltage[port_];
    for (int e = first; e < last; ++e) {
      const double r = radius(state, e), k = -p * edge(e).height;
      result.energy += k * r * r;
      if (scatter.residual) scatter.add_residual(e, std::array{2 * k * r});
      if (scatter.tangent) scatter.add_tangent(e, std::array{2 * k});
    }
    return result;
  }
  /// It is in p n da already.
  void add_forces_at_rest(const State& state, const DofMap& dofs, Eigen::VectorXd& residual) const override {
    for (int e = 0; e < element_count(); ++e)
      if (const int at = dofs.equation(edge(e).node, 0); at >= 0)
        residual[at] += 2 * state.voltage[port_] * edge(e).height * radius(state, e);
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  void add_charges(const State& state, const DofMap* dofs, Charges& charges) const override {
    for (int e = 0; e < element_count(); ++e) {
      const double r = radius(state, e), h = edge(e).height;
      charges.charge[port_] += h * r * r;
      if (!dofs) continue;
      if (const int i = dofs->equation(edge(e).node, 0); i >= 0) charges.coupling[port_][i] += 2 * h * r;
    }
  }
  void add_energies(const State& /*state*/, EnergyParts& /*the load stores none*/) const override {}

 private:
  struct Edge {
    int node;
    double drawn, height; ///< its radius; pi z with its sign; m
  };
  const Edge& edge(int element) const { return edges_[static_cast<std::size_t>(element)]; }
  double radius(const State& state, int element) const {
    return edge(element).drawn + state.displacement[static_cast<std::size_t>(edge(element).node)].x();
  }

  std::size_t port_;
  std::vector<Edge> edges_;
};

class LidBlock final : public ElementBlock {
 public:
  LidBlock(const meshing::Mesh& mesh, const Lid& lid, std::size_t port)
      : lid_(lid), drawn_(mesh.nodes[static_cast<std::size_t>(lid.node)].z()), port_(port) {}

  int element_count() const override { return 1; }
  int dofs_per_element() const override { return 1; }
  void claim_dofs(DofMap& /*those of the film*/, Dimension /*dimension*/) override {}
  void element_equations(int /*element*/, const DofMap& dofs, std::span<int> equations) const override {
    equations[0] = dofs.equation(lid_.node, 2);
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    if (first >= last) return {};
    const double p = state.voltage[port_];
    if (scatter.residual) scatter.add_residual(0, std::array{-p * lid_.area});
    return {-p * lid_.area * height(state), true};
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  void add_charges(const State& state, const DofMap* dofs, Charges& charges) const override {
    charges.charge[port_] += lid_.area * height(state);
    if (!dofs) return;
    if (const int e = dofs->equation(lid_.node, 2); e >= 0) charges.coupling[port_][e] += lid_.area;
  }
  void add_energies(const State& /*state*/, EnergyParts& /*the load stores none*/) const override {}

 private:
  double height(const State& state) const {
    return drawn_ + state.displacement[static_cast<std::size_t>(lid_.node)].z();
  }

  Lid lid_;
  double drawn_;
  std::size_t port_;
};

/// Calls `use` with what is under cells of that type.
template<class Use>
auto by_kind(meshing::CellType type, const Use& use) {
  switch (type) {
  case meshing::CellType::triangle6:
    return use(UnderTriangle<6>());
  case meshing::CellType::triangle3:
    return use(UnderTriangle<3>());
  case meshing::CellType::meridian3:
    return use(UnderMeridian<3>());
  default:
    return use(UnderMeridian<2>());
  }
}

} // namespace

std::unique_ptr<ElementBlock> make_pressure_block(const meshing::Mesh& mesh, const meshing::CellBlock& film,
                                                  std::size_t port) {
  return by_kind(film.type, [&]<class Under>(Under) -> std::unique_ptr<ElementBlock> {
    return std::make_unique<PressureBlock<Under>>(mesh, film, port);
  });
}

std::vector<Eigen::Vector3d> pressure_forces(const meshing::Mesh& mesh, const meshing::CellBlock& wall,
                                             const State& state, double pressure) {
  return by_kind(wall.type,
                 [&]<class Under>(Under) { return forces_of<Under>(mesh, wall, state, pressure); });
}

std::unique_ptr<ElementBlock> make_level_edge_block(const meshing::Mesh& mesh,
                                                    const meshing::CellBlock& meridians,
                                                    const std::vector<int>& ends, std::size_t port) {
  return std::make_unique<LevelEdgeBlock>(mesh, meridians, ends, port);
}

std::unique_ptr<ElementBlock> make_lid_block(const meshing::Mesh& mesh, const Lid& lid, std::size_t port) {
  return std::make_unique<LidBlock>(mesh, lid, port);
}

} // namespace dielast::fem
