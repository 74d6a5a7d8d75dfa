// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/wall_contact_block.hpp"

#include "fem/elements/barrier.hpp"
#include "materials/laws/dual.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr int size = 8; // x and y of the node, of the beam's ends and of its middle

using Eigen::Vector2d;
/// The node, the beam's ends and its middle.
using Positions = std::array<Vector2d, 4>;

/// A beam's centreline between its ends, s = 0..1: a parabola through its middle, or straight; or its first
/// end.
class Centreline {
 public:
  enum class Shape { parabola, straight, point };
  explicit Centreline(Shape shape) : shape_(shape) {}

  /// Of the ends and the middle; T: double or a dual number.
  template<class T>
  std::array<T, 3> shape(const T& s) const {
    if (shape_ == Shape::point) return {T(1.0), T(0.0), T(0.0)};
    if (shape_ == Shape::straight) return {1.0 - s, s, T(0.0)};
    return {(1.0 - s) * (1.0 - 2.0 * s), s * (2.0 * s - 1.0), 4.0 * s * (1.0 - s)};
  }
  /// Of Bezier's control polygon, in whose hull the line is: its ends and this.
  Vector2d control(const Positions& x) const {
    const Vector2d mean = (x[1] + x[2]) / 2;
    return shape_ == Shape::parabola ? Vector2d(2 * x[3] - mean) : mean;
  }
  Vector2d at(const Positions& x, double s) const {
    const std::array<double, 3> N = shape(s);
    return N[0] * x[1] + N[1] * x[2] + N[2] * x[3];
  }
  /// The place that is nearest to the node.
  double nearest(const Positions& x) const;

 private:
  Shape shape_;
};

double Centreline::nearest(const Positions& x) const {
  if (shape_ == Shape::point) return 0;
  if (shape_ == Shape::straight) {
    const Vector2d along = x[2] - x[1];
    return std::clamp((x[0] - x[1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
  }
  const Vector2d bend = x[1] + x[2] - 2 * x[3]; // c(s) = x1 + slope s + 2 bend s^2
  const Vector2d slope = x[2] - x[1] - 2 * bend;
  constexpr int starts = 4, most_steps = 20;
  double best = 0, least = (x[0] - x[1]).squaredNorm();
  for (int start = 0; start <= starts; ++start) {
    double s = static_cast<double>(start) / starts;
    for (int step = 0; step < most_steps; ++step) {
      const Vector2d away = at(x, s) - x[0], first = slope + 4 * s * bend;
      const double second = first.squaredNorm() + 4 * away.dot(bend);
      const double to =
          std::clamp(s - away.dot(first) / (second > 0 ? second : first.squaredNorm()), 0.0, 1.0);
      const bool there = std::abs(to - s) < 1e-14;
      s = to;
      if (there) break;
    }
    if (const double distance = (at(x, s) - x[0]).squaredNorm(); distance < least) {
      least = distance;
      best = s;
    }
  }
  return best;
}

class WallContactBlock final : public ContactBlock {
 public:
  WallContactBlock(const meshing::Mesh& mesh, std::vector<ContactPair> pairs, const Barrier& barrier)
      : pairs_(std::move(pairs)), barrier_(barrier), drawn_(mesh.nodes) {}

  int element_count() const override { return static_cast<int>(pairs_.size()); }
  int dofs_per_element() const override { return size; }
  void claim_dofs(DofMap& /*those of the walls*/, Dimension /*dimension*/) const override {}
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
      if (least_distance(pair(e), x) >= pair(e).touching + barrier_.thickness) continue;
      const double gap = this->gap(pair(e), x);
      if (!(gap > 0)) {
        result.feasible = false;
        continue;
      }
      if (gap >= barrier_.thickness) continue;
      const BarrierEnergy energy = barrier_.at(gap);
      const double length = pair(e).length;
      result.energy += length * energy.value;
      if (!scatter.residual && !scatter.tangent) continue;
      const materials::Dual<size> closing = gap_with_derivatives(pair(e), x);
      const materials::Dual<size> total =
          closing.chain(length * energy.value, length * energy.slope, length * energy.curvature);
      if (scatter.residual) scatter.add_residual(e, std::span(total.gradient.data(), size));
      if (!scatter.tangent) continue;
      std::array<double, size*(size + 1) / 2> packed;
      std::size_t k = 0;
      for (int i = 0; i < size; ++i)
        for (int j = 0; j <= i; ++j) packed[k++] = total.hessian(i, j);
      scatter.add_tangent(e, packed);
    }
    return result;
  }
  double free_way(const State& from, const State& to) const override {
    double part = 1;
    for (const ContactPair& one : pairs_) part = std::min(part, free_way(one, from, to));
    return part;
  }
  double contact_force(const State& state) const override {
    double sum = 0;
    for (const ContactPair& one : pairs_) {
      const Positions x = positions(state, one);
      if (least_distance(one, x) >= one.touching + barrier_.thickness) continue;
      sum -= one.length * barrier_.at(gap(one, x)).slope;
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
  /// No more than the distance of node and centreline, m: that from a disc about the latter.
  static double least_distance(const ContactPair& one, const Positions& x) {
    const Vector2d centre = (x[1] + x[2]) / 2;
    const double radius = std::max((x[1] - x[2]).norm() / 2, (line(one).control(x) - centre).norm());
    return (x[0] - centre).norm() - radius;
  }
  static double gap(const ContactPair& one, const Positions& x) {
    const Centreline beam = line(one);
    return (x[0] - beam.at(x, beam.nearest(x))).norm() - one.touching;
  }
  /// The nearest place s on the beam follows: d2g/dx2 = g_xx - g_xs g_ss^-1 g_sx, as g_s = 0 there.
  static materials::Dual<size> gap_with_derivatives(const ContactPair& one, const Positions& x) {
    using Dual = materials::Dual<size + 1>;
    const Centreline beam = line(one);
    const double nearest = beam.nearest(x);
    const bool follows = nearest > 0 && nearest < 1;
    const std::array<Dual, 3> N = beam.shape(follows ? Dual::variable(nearest, size) : Dual(nearest));
    Dual squared = 0;
    for (int i = 0; i < 2; ++i) {
      Dual away = Dual::variable(x[0][i], i);
      for (std::size_t a = 0; a < 3; ++a)
        away += -(N[a] * Dual::variable(x[a + 1][i], 2 * static_cast<int>(a + 1) + i));
      squared += away * away;
    }
    const Dual full = sqrt(squared);
    materials::Dual<size> gap(full.value - one.touching);
    gap.gradient = full.gradient.head<size>();
    gap.hessian = full.hessian.topLeftCorner<size, size>();
    const double stiffness = full.hessian(size, size);
    const Eigen::Vector<double, size> mixed = full.hessian.col(size).head<size>();
    if (follows && stiffness > 0) gap.hessian -= mixed * mixed.transpose() / stiffness;
    return gap;
  }
  /// Conservative advancement: as far as the gap allows at the speed with which node and beam move at most,
  /// until it is `kept` of what it was.
  double free_way(const ContactPair& one, const State& from, const State& to) const {
    constexpr double kept = 0.1, near = 1.2;
    const Positions start = positions(from, one), end = positions(to, one);
    const Vector2d moved = end[0] - start[0];
    const Centreline beam = line(one);
    const double speed = std::max({(end[1] - start[1] - moved).norm(), (end[2] - start[2] - moved).norm(),
                                   (beam.control(end) - beam.control(start) - moved).norm()});
    if (least_distance(one, start) - one.touching > speed) return 1;
    double gap = this->gap(one, start);
    const double least = kept * gap;
    for (double part = 0;;) {
      if (gap - least >= (1 - part) * speed) return 1;
      if (gap <= near * least) return part;
      part += (gap - least) / speed;
      Positions x;
      for (std::size_t i = 0; i < 4; ++i) x[i] = start[i] + part * (end[i] - start[i]);
      gap = this->gap(one, x);
    }
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
