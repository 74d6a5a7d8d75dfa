// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/distance_block.hpp"

#include <cmath>
#include <stdexcept>

namespace dielast::fem {

namespace {

/// V, dV/dl, d2V/dl2
using Derivatives = std::array<double, 3>;

Derivatives evaluate(const Spring& spring, double l) {
  const double extension = l - spring.free_length;
  return {spring.stiffness * extension * extension / 2, spring.stiffness * extension, spring.stiffness};
}

Derivatives evaluate(const Linkage& linkage, double distance) {
  const double l = distance + linkage.offset;
  const double difference = linkage.arm * linkage.arm - linkage.strut * linkage.strut;
  const double scale = linkage.force / (2 * linkage.arm);
  return {-scale * (difference * std::log(l / linkage.arm) + l * l / 2), -scale * (difference / l + l),
          -scale * (1 - difference / (l * l))};
}

class DistanceBlock final : public ElementBlock {
 public:
  DistanceBlock(const meshing::Mesh& mesh, const Distance& distance, const DistancePotential& potential)
      : potential_(potential), axis_(distance.axis) {
    for (int end = 0; end < 2; ++end) {
      const auto& [nodes, weights] = distance.ends[static_cast<std::size_t>(end)];
      if (nodes.empty()) throw std::invalid_argument("a spring's end needs a node");
      if (weights.size() != nodes.size())
        throw std::invalid_argument("a spring's end needs a weight per node");
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (weights[n] == 0) continue;
        nodes_.push_back(nodes[n]);
        weights_.push_back(end == 0 ? -weights[n] : weights[n]);
        drawn_ += weights_.back() * mesh.nodes[static_cast<std::size_t>(nodes[n])][axis_];
      }
    }
    if (drawn_ < 0) {
      drawn_ = -drawn_;
      for (double& weight : weights_) weight = -weight;
    }
  }

  int element_count() const override { return 1; }
  int dofs_per_element() const override { return static_cast<int>(nodes_.size()); }
  void claim_dofs(DofMap& dofs, Dimension dimension) override {
    for (const int node : nodes_)
      if (moves(dimension, axis_)) dofs.add(node, axis_);
  }
  void element_equations(int /*element*/, const DofMap& dofs, std::span<int> equations) const override {
    for (std::size_t i = 0; i < nodes_.size(); ++i) equations[i] = dofs.equation(nodes_[i], axis_);
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    if (first >= last) return {};
    const Derivatives V = derivatives(state);
    const std::size_t n = nodes_.size();
    if (scatter.residual) {
      std::vector<double> residual(n);
      for (std::size_t i = 0; i < n; ++i) residual[i] = V[1] * weights_[i];
      scatter.add_residual(0, residual);
    }
    if (scatter.tangent) {
      std::vector<double> tangent;
      tangent.reserve(n * (n + 1) / 2);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j <= i; ++j) tangent.push_back(V[2] * weights_[i] * weights_[j]);
      scatter.add_tangent(0, tangent);
    }
    return {V[0], std::isfinite(V[0])};
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}

 private:
  Derivatives derivatives(const State& state) const {
    double l = drawn_;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      l += weights_[i] * state.displacement[static_cast<std::size_t>(nodes_[i])][axis_];
    return std::visit([l](const auto& potential) { return fem::evaluate(potential, l); }, potential_);
  }

  DistancePotential potential_;
  int axis_;
  double drawn_ = 0;
  std::vector<int> nodes_;
  std::vector<double> weights_; ///< l = drawn + sum of weight * displacement
};

} // namespace

std::unique_ptr<ElementBlock> make_distance_block(const meshing::Mesh& mesh, const Distance& distance,
                                                  const DistancePotential& potential) {
  return std::make_unique<DistanceBlock>(mesh, distance, potential);
}

} // namespace dielast::fem
