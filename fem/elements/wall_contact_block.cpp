// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/wall_contact_block.hpp"

#include "materials/laws/dual.hpp"

#include <array>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr int size = 6; // x and y of the node and of the beam's ends

using Dual = materials::Dual<size>;
using Point = std::array<Dual, 2>;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1]}; }
Dual dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1]; }
Dual length(const Point& a) { return sqrt(dot(a, a)); }

/// From a point to a segment.
Dual distance(const Point& node, const Point& from, const Point& to) {
  const Point along = minus(to, from), away = minus(node, from);
  const double place = dot(away, along).value / dot(along, along).value;
  if (place <= 0) return length(away);
  if (place >= 1) return length(minus(node, to));
  const Dual area = along[0] * away[1] - along[1] * away[0];
  return (area.value < 0 ? -area : area) / length(along);
}

class WallContactBlock final : public ElementBlock {
 public:
  WallContactBlock(const meshing::Mesh& mesh, std::vector<ContactPair> pairs, const Barrier& barrier)
      : pairs_(std::move(pairs)), barrier_(barrier), drawn_(mesh.nodes) {}

  int element_count() const override { return static_cast<int>(pairs_.size()); }
  int dofs_per_element() const override { return size; }
  void claim_dofs(DofMap& /*those of the walls*/, Dimension /*dimension*/) const override {}
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override {
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i)
      equations[i] = dofs.equation(nodes(element)[i / 2], static_cast<int>(i % 2));
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    Evaluation result;
    for (int e = first; e < last; ++e) {
      const ContactPair& pair = pairs_[static_cast<std::size_t>(e)];
      if (is_far(state, e)) continue;
      const Dual gap = distance(point(state, e, 0), point(state, e, 1), point(state, e, 2)) - pair.touching;
      if (!(gap.value > 0)) {
        result.feasible = false;
        continue;
      }
      if (gap.value >= barrier_.thickness) continue;
      const Dual into = gap - barrier_.thickness, energy = -(barrier_.stiffness * pair.length) * into * into *
                                                           log(gap / Dual(barrier_.thickness));
      result.energy += energy.value;
      if (scatter.residual) scatter.add_residual(e, std::span(energy.gradient.data(), size));
      if (!scatter.tangent) continue;
      std::array<double, size*(size + 1) / 2> packed;
      std::size_t k = 0;
      for (int i = 0; i < size; ++i)
        for (int j = 0; j <= i; ++j) packed[k++] = energy.hessian(i, j);
      scatter.add_tangent(e, packed);
    }
    return result;
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}

 private:
  std::array<int, 3> nodes(int element) const {
    const ContactPair& pair = pairs_[static_cast<std::size_t>(element)];
    return {pair.node, pair.beam[0], pair.beam[1]};
  }
  Eigen::Vector2d place(const State& state, int node) const {
    const auto n = static_cast<std::size_t>(node);
    return (drawn_[n] + state.displacement[n]).head<2>();
  }
  Point point(const State& state, int element, std::size_t which) const {
    const Eigen::Vector2d x = place(state, nodes(element)[which]);
    const int first = 2 * static_cast<int>(which);
    return {Dual::variable(x[0], first), Dual::variable(x[1], first + 1)};
  }
  /// Farther than the barrier reaches, without the work of telling how far.
  bool is_far(const State& state, int element) const {
    const ContactPair& pair = pairs_[static_cast<std::size_t>(element)];
    const Eigen::Vector2d a = place(state, pair.beam[0]), b = place(state, pair.beam[1]);
    const double reach = pair.touching + barrier_.thickness + (b - a).norm() / 2;
    return (place(state, pair.node) - (a + b) / 2).squaredNorm() > reach * reach;
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
