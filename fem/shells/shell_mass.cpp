// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/films/triangle.hpp"
#include "fem/shells/shell_block.hpp"

#include <cmath>
#include <stdexcept>

namespace dielast::fem {

ShellMass ShellMass::of(const ShellSection& section) {
  double mass = 0, moment = 0, height = 0;
  section.for_each_layer([&](const ShellLayer& layer, double middle) {
    const double depth = section.depth_of(layer), of_layer = layer.material.density * depth;
    mass += of_layer;
    moment += of_layer * middle;
    height += depth;
  });
  const double drawn = section.prestretch[0] * section.prestretch[1]; // times as wide and as thin
  if (!(std::abs(moment) > 1e-6 * mass * height)) return {mass / drawn, 0};
  return {mass / drawn, moment / mass / drawn};
}

namespace {

/// Three elements per triangle, one for each axis: between axes there is no mass.
class ShellMassBlock final : public ElementBlock {
 public:
  ShellMassBlock(const meshing::Mesh& mesh, const meshing::CellBlock& cells, double per_area,
                 std::vector<int> carriers)
      : carriers_(std::move(carriers)) {
    for (int e = 0; e < cells.size(); ++e) {
      Eigen::Matrix<double, 3, Nodes> X;
      for (int a = 0; a < Nodes; ++a)
        X.col(a) = mesh.nodes[static_cast<std::size_t>(cells.cell(e)[static_cast<std::size_t>(a)])];
      Packed& packed = masses_.emplace_back();
      for (const TrianglePoint& at : triangle_rule(6)) {
        const Eigen::Matrix<double, 3, 2> t = X * shape_gradients<Nodes>(at.xi, at.eta);
        const double mass = per_area * at.weight * t.col(0).cross(t.col(1)).norm();
        const Eigen::Vector<double, Nodes> N = shape_values<Nodes>(at.xi, at.eta);
        std::size_t place = 0;
        for (int a = 0; a < Nodes; ++a)
          for (int b = 0; b <= a; ++b) packed[place++] += mass * N[a] * N[b];
      }
    }
  }

  int element_count() const override { return axes * static_cast<int>(masses_.size()); }
  int dofs_per_element() const override { return Nodes; }
  void claim_dofs(DofMap& dofs, Dimension /*only space will do*/) override {
    for (const int node : carriers_)
      for (int c = 0; c < axes; ++c) dofs.add(node, c);
  }
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override {
    for (std::size_t a = 0; a < Nodes; ++a)
      equations[a] =
          dofs.equation(carriers_[static_cast<std::size_t>(element / axes * Nodes) + a], element % axes);
  }
  Evaluation evaluate(const State& /*state*/, int /*first*/, int /*last*/,
                      const Scatter& /*scatter*/) const override {
    return {};
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  void add_mass(int element, std::span<double> packed) const override {
    const Packed& mass = masses_[static_cast<std::size_t>(element / axes)];
    for (std::size_t i = 0; i < mass.size(); ++i) packed[i] += mass[i];
  }

 private:
  static constexpr int Nodes = 6, axes = 3;
  using Packed = std::array<double, Nodes*(Nodes + 1) / 2>;

  std::vector<int> carriers_;
  std::vector<Packed> masses_; ///< kg
};

} // namespace

std::unique_ptr<ElementBlock> make_shell_mass_block(const meshing::Mesh& mesh,
                                                    const meshing::CellBlock& cells, const ShellMass& mass,
                                                    std::vector<int> carriers) {
  if (cells.type != meshing::CellType::triangle6 || carriers.size() != cells.nodes.size())
    throw std::invalid_argument(
        "the mass of a shell is that of 6-node triangles with a carrier for each node");
  return std::make_unique<ShellMassBlock>(mesh, cells, mass.per_area, std::move(carriers));
}

} // namespace dielast::fem
