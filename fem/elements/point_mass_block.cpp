// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/point_mass_block.hpp"

namespace dielast::fem {

namespace {

class PointMassBlock final : public ElementBlock {
 public:
  explicit PointMassBlock(const PointMass& point) : point_(point) {}

  int element_count() const override { return 1; }
  int dofs_per_element() const override { return 1; }
  void claim_dofs(DofMap& dofs, Dimension dimension) override {
    if (moves(dimension, point_.axis)) dofs.add(point_.node, point_.axis);
  }
  void element_equations(int /*element*/, const DofMap& dofs, std::span<int> equations) const override {
    equations[0] = dofs.equation(point_.node, point_.axis);
  }
  Evaluation evaluate(const State& /*state*/, int /*first*/, int /*last*/,
                      const Scatter& /*scatter*/) const override {
    return {};
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  void add_mass(int /*element*/, std::span<double> packed) const override { packed[0] += point_.mass; }
  void add_damping(int /*element*/, std::span<double> packed) const override { packed[0] += point_.damping; }
  void add_drag(int /*element*/, std::span<double> drag) const override { drag[0] += point_.drag; }

 private:
  PointMass point_;
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

std::unique_ptr<ElementBlock> make_point_mass_block(const PointMass& point) {
  return std::make_unique<PointMassBlock>(point);
}

std::unique_ptr<ElementBlock> make_relative_mass_block(std::vector<RelativeMass> masses) {
  return std::make_unique<RelativeMassBlock>(std::move(masses));
}

} // namespace dielast::fem
