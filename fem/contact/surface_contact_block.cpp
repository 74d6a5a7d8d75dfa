// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/surface_contact_block.hpp"

#include "fem/contact/centreline.hpp"
#include "fem/contact/surface_ends.hpp"
#include "fem/contact/two_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <vector>

namespace dielast::fem {

namespace {

using Eigen::Vector2d;

constexpr int dofs = 12;             ///< of a side's ends and its middle, then of the other surface's side
constexpr double least_share = 1e-3; ///< of a side's mean radius: the barrier must hold on the axis, too

/// Simpson's rule on equal parts of 0..1.
struct SidePoint {
  double s, weight;
};
constexpr int parts = 8;
constexpr std::array<SidePoint, 2 * parts + 1> rule = [] {
  std::array<SidePoint, 2 * parts + 1> points{};
  for (int i = 0; i <= 2 * parts; ++i) {
    const double share = i % 2 == 1 ? 4 : i == 0 || i == 2 * parts ? 1 : 2;
    points[static_cast<std::size_t>(i)] = {i / (2.0 * parts), share / (6 * parts)};
  }
  return points;
}();
constexpr std::size_t rule_size = rule.size();
constexpr double ramp_spacings = 4; ///< of the coarser surface's points: so far from an end both count

const Centreline parabola(Centreline::Shape::parabola), end(Centreline::Shape::point);

/// A side with the disc about its parabola, in some state.
struct Side {
  std::array<Vector2d, 3> x; ///< ends, middle
  Vector2d centre;
  double radius;

  Vector2d at(const std::array<double, 3>& N) const { return N[0] * x[0] + N[1] * x[1] + N[2] * x[2]; }
};

class SurfaceContactBlock final : public TwoSurfaces<SurfaceContact, 3, Side> {
 public:
  SurfaceContactBlock(const meshing::Mesh& mesh, SurfaceContact contact)
      : TwoSurfaces(mesh, std::move(contact), rule_size), up_(contact_.width ? 1 : 2) {
    for (std::size_t k = 0; k < 2; ++k) {
      const meshing::CellBlock& sides = contact_.surfaces[k];
      if (sides.type != meshing::CellType::line3 && sides.type != meshing::CellType::meridian3)
        throw std::invalid_argument("surfaces in contact are made of 3-node sides");
      std::set<int> last;
      for (int i = 0; i < sides.size(); ++i) last.insert(sides.cell(i)[1]);
      for (int i = 0; i < sides.size(); ++i) {
        shared_[k].push_back(last.contains(sides.cell(i)[0]));
        add_areas(k, i);
      }
    }
    const auto mean_side = [&](std::size_t k) {
      double length = 0;
      for (int i = 0; i < contact_.surfaces[k].size(); ++i) {
        const auto own = contact_.surfaces[k].cell(i);
        length +=
            (drawn_[static_cast<std::size_t>(own[0])] - drawn_[static_cast<std::size_t>(own[1])]).norm();
      }
      return length / contact_.surfaces[k].size();
    };
    const double finer = std::pow(mean_side(1) / mean_side(0), 2);
    share_ = {finer / (1 + finer), 1 / (1 + finer)};
    const double over = ramp_spacings * std::max(mean_side(0), mean_side(1)) / (2 * parts);
    const auto goes_on = [&](int node) {
      return (!contact_.width && drawn_[static_cast<std::size_t>(node)].x() <= 1e-9 * over) ||
             std::ranges::binary_search(contact_.mirrored, node);
    };
    for (std::size_t k = 0; k < 2; ++k) ends_[k] = SurfaceEnds(contact_.surfaces[k], drawn_, goes_on, over);
    require_apart(contact_.surfaces[0], contact_.surfaces[1]);
    std::vector<double> areas(drawn_.size(), 0);
    for_each_point([&](const Pair& pair, std::size_t q) {
      share(pair, q, share_[pair.surface] * area(pair, q), areas);
    });
    sliders_ = Sliders(contact_.friction, contact_.barrier, contact_.surfaces, areas, drawn_, up_);
  }

  int element_count() const override { return 2 * contact_.surfaces[0].size() * contact_.surfaces[1].size(); }
  int dofs_per_element() const override { return dofs; }
  void element_equations(int element, const DofMap& map, std::span<int> equations) const override {
    const Pair pair = this->pair(element);
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t i = 0; i < 2; ++i)
          equations[6 * k + 2 * a + i] = map.equation(nodes(pair, k)[a], i == 0 ? 0 : up_);
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    Evaluation result;
    for (int e = first; e < last; ++e) {
      const Pair pair = this->pair(e);
      const Side own = side(state, pair, 0), other = side(state, pair, 1);
      const bool near = clearance(own, other) <= contact_.barrier.reach();
      if (!near && !sliders_.any()) continue;
      Sums sums;
      for (std::size_t q = 0; q < rule_size && near; ++q) {
        const PointAndLine x = facing(own, other, q);
        if (parabola.least_distance(x) > contact_.barrier.reach()) continue;
        add(parabola, pair, x, q, area(pair, q), scatter, sums);
        if (is_shared(pair)) add(end, pair, x, q, -area(pair, q), scatter, sums);
      }
      sliders_.add(state, pair.surface, pair.own, pair.other, scatter.residual || scatter.tangent, sums);
      sums.add_to(result, e, scatter);
    }
    return result;
  }
  double free_way(const State& from, const State& to) const override {
    const Moved before = moved(from), after = moved(to);
    double part = 1;
    for (int e = 0; e < element_count(); ++e) {
      const Pair pair = this->pair(e);
      const Side &own = before.of(pair, 0), &other = before.of(pair, 1);
      const Side &own_end = after.of(pair, 0), &other_end = after.of(pair, 1);
      if (clearance(own, other) > part * (way(own, own_end) + way(other, other_end))) continue;
      for (std::size_t q = 0; q < rule_size; ++q)
        part = parabola.free_way(facing(own, other, q), facing(own_end, other_end, q), 0, part);
    }
    return part;
  }

 private:
  using Sums = ContactSums<dofs>;
  const SurfaceEnds& other_ends(const Pair& pair) const { return ends_[1 - pair.surface]; }
  /// The part of the integral of a point's surface, where the other one's ramp is `other`: a function of the
  /// same s.
  Ramp share_at(const Pair& pair, std::size_t q, const Ramp& other) const {
    const double own = ends_[pair.surface].at(pair.own, rule[q].s).value;
    return shared(share_[pair.surface], own, share_[1 - pair.surface], other);
  }
  Pair pair(int element) const {
    const int a = contact_.surfaces[0].size(), b = contact_.surfaces[1].size();
    if (element < a * b) return {0, element / b, element % b};
    return {1, (element - a * b) / a, (element - a * b) % a};
  }
  /// Whether the other side's first end is also that of the side before it.
  bool is_shared(const Pair& pair) const {
    return shared_[1 - pair.surface][static_cast<std::size_t>(pair.other)];
  }
  Side face(const State& state, std::span<const int> own) const override {
    Side side;
    for (std::size_t a = 0; a < 3; ++a) {
      const Eigen::Vector3d x = position(state, own[a]);
      side.x[a] = {x.x(), x[up_]};
    }
    side.centre = (side.x[0] + side.x[1]) / 2;
    side.radius = std::max((side.x[0] - side.x[1]).norm(), 4 * (side.x[2] - side.centre).norm()) / 2;
    return side;
  }
  Side side(const State& state, const Pair& pair, std::size_t k) const { return face(state, nodes(pair, k)); }
  /// No more than the distance of two sides, m.
  static double clearance(const Side& one, const Side& other) {
    return (one.centre - other.centre).norm() - one.radius - other.radius;
  }
  /// As far as any point of a side moves, at most: its control polygon does, m.
  static double way(const Side& from, const Side& to) {
    const auto control = [](const Side& side) { return Vector2d(2 * side.x[2] - side.centre); };
    return std::max(
        {(to.x[0] - from.x[0]).norm(), (to.x[1] - from.x[1]).norm(), (control(to) - control(from)).norm()});
  }
  Eigen::Vector3d in_space(const Vector2d& x) const {
    return x.x() * Eigen::Vector3d::UnitX() + x.y() * Eigen::Vector3d::Unit(up_);
  }
  static PointAndLine facing(const Side& own, const Side& other, std::size_t q) {
    return {own.at(parabola.shape(rule[q].s)), other.x[0], other.x[1], other.x[2]};
  }
  void add(const Centreline& line, const Pair& pair, const PointAndLine& x, std::size_t q, double area,
           const Scatter& scatter, Sums& sums) const {
    const double gap = line.distance(x);
    if (!(gap > 0)) {
      sums.feasible = false;
      return;
    }
    if (!contact_.barrier.touches(gap)) return;
    const BarrierEnergy energy = contact_.barrier.at(gap);
    sums.any = true;
    const Ramp part = share_at(pair, q, other_ends(pair).at(pair.other, line.nearest(x)));
    sums.energy += area * part.value * energy.value;
    if (!scatter.residual && !scatter.tangent) return;
    const double size = area * part.value;
    materials::Dual<Centreline::size> total = line.distance_with_derivatives(x).chain(
        size * energy.value, size * energy.slope, size * energy.curvature);
    if (part.first != 0 || part.second != 0) { // the share of a point that passes by an end
      const auto along = line.nearest_with_derivatives(x).chain(part.value, part.first, part.second);
      total = line.distance_with_derivatives(x).chain(area * energy.value, area * energy.slope,
                                                      area * energy.curvature) *
              along;
    }
    Eigen::Matrix<double, Centreline::size, dofs> moves; // point and line with the two sides' nodes
    moves.setZero();
    const std::array<double, 3> N = parabola.shape(rule[q].s);
    for (int a = 0; a < 3; ++a)
      moves.block<2, 2>(0, 2 * a) = N[static_cast<std::size_t>(a)] * Eigen::Matrix2d::Identity();
    moves.bottomRightCorner<6, 6>().setIdentity();
    sums.first += moves.transpose() * total.gradient;
    if (scatter.tangent) sums.second += moves.transpose() * total.hessian * moves;
  }
  void for_each_touching(
      const State& state,
      const std::function<void(const Pair&, std::size_t, const Touching&)>& use) const override {
    const Moved now = moved(state);
    for (int e = 0; e < element_count(); ++e) {
      const Pair pair = this->pair(e);
      if (clearance(now.of(pair, 0), now.of(pair, 1)) > contact_.barrier.reach()) continue;
      for (std::size_t q = 0; q < rule_size; ++q) {
        const PointAndLine x = facing(now.of(pair, 0), now.of(pair, 1), q);
        const auto add = [&](const Centreline& line, double factor) {
          const double nearest = line.nearest(x);
          const Vector2d way = x[0] - line.at(x, nearest);
          const BarrierEnergy energy = contact_.barrier.at(way.norm());
          if (contact_.barrier.touches(way.norm()))
            use(pair, q,
                Touching{{factor * energy.value, factor * energy.slope},
                         in_space(way.normalized()),
                         factor,
                         share_at(pair, q, other_ends(pair).at(pair.other, nearest)).value});
        };
        add(parabola, 1);
        if (is_shared(pair)) add(end, -1);
      }
    }
  }
  std::vector<Sliders::Nearest> nearest(const State& state) const override {
    std::vector<Sliders::Nearest> all(static_cast<std::size_t>(sliders_.count()));
    const Moved now = moved(state);
    for (int i = 0; i < sliders_.count(); ++i) {
      const Eigen::Vector3d node = position(state, sliders_.node(i));
      Sliders::Nearest& nearest = all[static_cast<std::size_t>(i)];
      const std::vector<Side>& others = now.faces[1 - sliders_.surface(i)];
      for (std::size_t other = 0; other < others.size(); ++other) {
        const auto& [first, second, middle] = others[other].x;
        const PointAndLine x{Vector2d(node.x(), node[up_]), first, second, middle};
        if (!(parabola.least_distance(x) < nearest.distance)) continue;
        const std::array<double, 3> N = parabola.shape(parabola.nearest(x));
        const Vector2d way = x[0] - others[other].at(N);
        if (const double distance = way.norm(); distance < nearest.distance)
          nearest = {distance, static_cast<int>(other), {N[0], N[1], N[2]}, in_space(way / distance)};
      }
    }
    return all;
  }
  double part_of_node(int node, std::size_t q) const override {
    const double s = rule[q].s, middle = 1 - std::abs(2 * s - 1);
    return node == 2 ? middle : (node == 0) == (s < 0.5) ? 1 - middle : 0;
  }
  void add_areas(std::size_t surface, int number) {
    const Side own = face(as_drawn(), contact_.surfaces[surface].cell(number));
    const double mean = (own.x[0].x() + own.x[1].x()) / 2;
    for (const SidePoint& at : rule) {
      const Vector2d slope =
          (4 * at.s - 3) * own.x[0] + (4 * at.s - 1) * own.x[1] + (4 - 8 * at.s) * own.x[2];
      const double radius = std::max(own.at(parabola.shape(at.s)).x(), least_share * mean);
      areas_[surface].push_back(at.weight * slope.norm() *
                                contact_.width.value_or(2 * std::numbers::pi * radius));
    }
  }

  int up_; ///< the second direction: y, of revolution z
  std::array<std::vector<char>, 2> shared_;
  std::array<SurfaceEnds, 2> ends_;
};

} // namespace

std::unique_ptr<ContactBlock> make_surface_contact_block(const meshing::Mesh& mesh, SurfaceContact contact) {
  return std::make_unique<SurfaceContactBlock>(mesh, std::move(contact));
}

} // namespace dielast::fem
