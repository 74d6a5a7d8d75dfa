// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/wall_contact_block.hpp"

#include "fem/contact/barrier.hpp"
#include "fem/contact/centreline.hpp"
#include "fem/elements/lower_triangle.hpp"

#include <algorithm>
#include <array>

namespace dielast::fem {

namespace {

constexpr int size = 8; // x and y of the node, of the beam's ends and of its middle

using Eigen::Vector2d;
using Positions = PointAndLine;

class WallContactBlock final : public ContactBlock {
 public:
  WallContactBlock(const meshing::Mesh& mesh, std::vector<ContactPair> pairs, const Barrier& barrier)
      : pairs_(std::move(pairs)), barrier_(barrier), drawn_(mesh.nodes) {}

  int element_count() const override { return static_cast<int>(pairs_.size()); }
  int dofs_per_element() const override { return size; }
  void claim_dofs(DofMap& /*those of the walls*/, Dimension /*dimension*/) override {}
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override {
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) {
      const int node = nodes(pair(element))[i / 2];
      equations[i] = node < 0 ? DofMap::absent : dofs.equation(node, static_cast<int>(i % 2));
    }
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    Evaluation result;
    for (int e = first; e < last; ++e) {
      const Positions x = positions(state, pair(e));
      const Centreline beam = line(pair(e));
      if (beam.least_distance(x) >= pair(e).touching + barrier_.thickness) continue;
      const double gap = beam.distance(x) - pair(e).touching;
      if (!(gap > 0)) {
        result.feasible = false;
        continue;
      }
      if (gap >= barrier_.thickness) continue;
      const BarrierEnergy energy = barrier_.at(gap);
      const double length = pair(e).length;
      result.energy += length * energy.value;
      if (!scatter.residual && !scatter.tangent) continue;
      const materials::Dual<size> closing = beam.distance_with_derivatives(x);
      const materials::Dual<size> total =
          closing.chain(length * energy.value, length * energy.slope, length * energy.curvature);
      if (scatter.residual) scatter.add_residual(e, std::span(total.gradient.data(), size));
      if (scatter.tangent) scatter.add_tangent(e, lower_triangle<size>(total.hessian));
    }
    return result;
  }
  double free_way(const State& from, const State& to) const override {
    double part = 1;
    for (const ContactPair& one : pairs_)
      part = line(one).free_way(positions(from, one), positions(to, one), one.touching, part);
    return part;
  }
  double contact_force(const State& state) const override {
    double sum = 0;
    for (const ContactPair& one : pairs_) {
      const Positions x = positions(state, one);
      const Centreline beam = line(one);
      if (beam.least_distance(x) >= one.touching + barrier_.thickness) continue;
      sum -= one.length * barrier_.at(beam.distance(x) - one.touching).slope;
    }
    return sum;
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}

 private:
  const ContactPair& pair(int element) const { return pairs_[static_cast<std::size_t>(element)]; }
  static Centreline line(const ContactPair& one) {
    using Shape = Centreline::Shape;
    const bool point = one.beam[1] == ContactPair::none, straight = one.beam[2] == ContactPair::none;
    return Centreline(point ? Shape::point : straight ? Shape::straight : Shape::parabola);
  }
  static std::array<int, 4> nodes(const ContactPair& one) {
    return {one.node, one.beam[0], one.beam[1], one.beam[2]};
  }
  Positions positions(const State& state, const ContactPair& one) const {
    Positions x;
    const std::array<int, 4> all = nodes(one);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto n = static_cast<std::size_t>(all[i] == ContactPair::none ? one.beam[0] : all[i]);
      x[i] = (drawn_[n] + state.displacement[n]).head<2>();
    }
    return x;
  }
  std::vector<ContactPair> pairs_;
  Barrier barrier_;
  std::vector<Eigen::Vector3d> drawn_;
};

} // namespace

std::unique_ptr<ElementBlock>
make_wall_contact_block(const meshing::Mesh& mesh, std::vector<ContactPair> pairs, const Barrier& barrier) {
  return std::make_unique<WallContactBlock>(mesh, std::move(pairs), barrier);
}

} // namespace dielast::fem
