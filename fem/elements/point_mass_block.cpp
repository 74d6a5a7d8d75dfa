// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/point_mass_block.hpp"

namespace dielast::fem {

namespace {

/// One element per mass.
class PointMassBlock final : public ElementBlock {
 public:
  explicit PointMassBlock(std::vector<PointMass> points) : points_(std::move(points)) {}

  int element_count() const override { return static_cast<int>(points_.size()); }
  int dofs_per_element() const override { return 1; }
  void claim_dofs(DofMap& dofs, Dimension dimension) override {
    for (const PointMass& point : points_)
      if (moves(dimension, point.axis)) dofs.add(point.node, point.axis);
  }
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override {
    equations[0] = dofs.equation(of(element).node, of(element).axis);
  }
  Evaluation evaluate(const State& /*state*/, int /*first*/, int /*last*/,
                      const Scatter& /*scatter*/) const override {
    return {};
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  void add_mass(int element, std::span<double> packed) const override { packed[0] += of(element).mass; }
  void add_damping(int element, std::span<double> packed) const override { packed[0] += of(element).damping; }
  void add_drag(int element, std::span<double> drag) const override { drag[0] += of(element).drag; }

 private:
  const PointMass& of(int element) const { return points_[static_cast<std::size_t>(element)]; }

  std::vector<PointMass> points_;
};

/// One element per mass and axis.
class RelativeMassBlock final : public ElementBlock {
 public:
  explicit RelativeMassBlock(std::vector<RelativeMass> masses) : masses_(std::move(masses)) {}

  int element_count() const override { return axes * static_cast<int>(masses_.size()); }
  int dofs_per_element() const override { return 2; }
  void claim_dofs(DofMap& dofs, Dimension dimension) override {
    for (const RelativeMass& mass : masses_)
      for (int c = 0; c < axes; ++c)
        if (moves(dimension, c))
          for (const int node : {mass.beside, mass.node}) dofs.add(node, c);
  }
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override {
    equations[0] = dofs.equation(of(element).beside, element % axes);
    equations[1] = dofs.equation(of(element).node, element % axes);
  }
  Evaluation evaluate(const State& /*state*/, int /*first*/, int /*last*/,
                      const Scatter& /*scatter*/) const override {
    return {};
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  void add_mass(int element, std::span<double> packed) const override { add(of(element).mass, packed); }
  void add_damping(int element, std::span<double> packed) const override { add(of(element).damping, packed); }

 private:
  static void add(double of_difference, std::span<double> packed) {
    packed[0] += of_difference;
    packed[1] -= of_difference;
    packed[2] += of_difference;
  }

  static constexpr int axes = 3;
  const RelativeMass& of(int element) const { return masses_[static_cast<std::size_t>(element / axes)]; }

  std::vector<RelativeMass> masses_;
};

} // namespace

std::unique_ptr<ElementBlock> make_point_mass_block(std::vector<PointMass> points) {
  return std::make_unique<PointMassBlock>(std::move(points));
}

std::unique_ptr<ElementBlock> make_relative_mass_block(std::vector<RelativeMass> masses) {
  return std::make_unique<RelativeMassBlock>(std::move(masses));
}

} // namespace dielast::fem
