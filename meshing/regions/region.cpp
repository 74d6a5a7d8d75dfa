// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/regions/region.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace dielast::meshing {

namespace {

using Eigen::Vector2d;
constexpr double pi = std::numbers::pi;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
Vector2d left_of(const Vector2d& direction) { return {-direction.y(), direction.x()}; }
Vector2d toward(double angle) { return {std::cos(angle), std::sin(angle)}; }
double angle_of(const Vector2d& p) { return std::atan2(p.y(), p.x()); }

/// The angle from one direction to another, turning that way, in (0, 2 pi].
double turned(double from, double to, int turn) {
  const double angle = std::fmod(turn * (to - from), 2 * pi);
  return angle <= 0 ? angle + 2 * pi : angle;
}

double arc_angle(const Edge& arc) { return turned(angle_of(arc.from), angle_of(arc.to), arc.turn); }

/// A circle in quarters that begin on the axes: regions and films agree on these points.
std::vector<Edge> circle(double radius) {
  std::vector<Edge> quarters;
  const std::array<Vector2d, 4> ends{Vector2d(radius, 0), Vector2d(0, radius), Vector2d(-radius, 0),
                                     Vector2d(0, -radius)};
  for (std::size_t k = 0; k < 4; ++k) quarters.push_back({ends[k], ends[(k + 1) % 4], 1});
  return quarters;
}

double signed_area(const std::vector<Vector2d>& corners) {
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    area += cross(corners[i], corners[(i + 1) % corners.size()]) / 2;
  return area;
}

/// Fractions of two straight lines at which they cross; nothing for parallel ones.
std::optional<std::array<double, 2>> crossing(const Vector2d& p, const Vector2d& d, const Vector2d& q,
                                              const Vector2d& e) {
  const double sine = cross(d, e);
  if (std::abs(sine) <= 1e-12 * d.norm() * e.norm()) return std::nullopt;
  return std::array{cross(q - p, e) / sine, cross(q - p, d) / sine};
}

/// Two sides of a polygon that cross or touch without being neighbours.
std::optional<std::array<std::size_t, 2>> crossing_sides(const std::vector<Vector2d>& corners) {
  const std::size_t n = corners.size();
  const auto side = [&](std::size_t i) -> Vector2d { return corners[(i + 1) % n] - corners[i]; };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = i + 2; k < n; ++k) {
      if ((k + 1) % n == i) continue;
      const auto at = crossing(corners[i], side(i), corners[k], side(k));
      if (at && std::ranges::all_of(*at, [](double t) { return t >= 0 && t <= 1; })) return std::array{i, k};
    }
  return std::nullopt;
}

/// Whether two edges cross between their ends. Arcs, about one centre, do not cross each other.
bool cross_between_ends(const Edge& a, const Edge& b, double tolerance) {
  if (a.turn != 0 && b.turn != 0) return false;
  if (a.turn != 0) return cross_between_ends(b, a, tolerance);
  const Vector2d along = a.to - a.from;
  const auto inside = [&](const Edge& edge, double fraction) {
    const double margin = tolerance / edge.length();
    return fraction > margin && fraction < 1 - margin;
  };
  if (b.turn == 0) {
    const auto at = crossing(a.from, along, b.from, b.to - b.from);
    return at && inside(a, (*at)[0]) && inside(b, (*at)[1]);
  }
  const double radius = b.from.norm(), half = a.from.dot(along) / along.squaredNorm();
  const double root = half * half - (a.from.squaredNorm() - radius * radius) / along.squaredNorm();
  // A line that only touches the circle does not cross it.
  const double nearest = std::abs(cross(a.from, along)) / along.norm();
  if (root <= 0 || radius - nearest <= tolerance) return false;
  return std::ranges::any_of(std::array{-half - std::sqrt(root), -half + std::sqrt(root)}, [&](double t) {
    return inside(a, t) && inside(b, b.fraction_of(a.from + t * along, tolerance));
  });
}

bool cross_anywhere(const Region& a, const Region& b, double tolerance) {
  for (const auto& loop : a.loops)
    for (const Edge& edge : loop)
      for (const auto& other : b.loops)
        if (std::ranges::any_of(other, [&](const Edge& e) { return cross_between_ends(edge, e, tolerance); }))
          return true;
  return false;
}

/// Points of a region next to the middles of its edges.
std::vector<Vector2d> points_within(const Region& region, double distance) {
  std::vector<Vector2d> points;
  for (const auto& loop : region.loops)
    for (const Edge& edge : loop) {
      const Vector2d middle = edge.at(0.5);
      const Vector2d normal =
          edge.turn == 0 ? left_of(edge.to - edge.from).normalized() : middle.normalized();
      for (const double side : {distance, -distance})
        if (const Vector2d p = middle + side * normal; region.contains(p)) points.push_back(p);
    }
  return points;
}

bool overlap(const Region& a, const Region& b, double tolerance) {
  if (cross_anywhere(a, b, tolerance)) return true;
  const auto holds = [&](const Region& whole, const Region& part) {
    return std::ranges::any_of(points_within(part, 100 * tolerance),
                               [&](const Vector2d& p) { return whole.contains(p); });
  };
  return holds(a, b) || holds(b, a);
}

/// A point outside the film, nothing where there is none.
std::optional<Vector2d> point_outside(const RoundFilm& film, const Region& region, double tolerance) {
  const auto outside = [&](const Vector2d& p) {
    return p.norm() > film.outer_radius + tolerance || p.norm() < film.inner_radius - tolerance;
  };
  for (const auto& loop : region.loops)
    for (const Edge& edge : loop) {
      if (outside(edge.from)) return edge.from;
      if (edge.turn != 0) continue;
      const Vector2d along = edge.to - edge.from; // nearest to the hole
      const Vector2d nearest =
          edge.from + std::clamp(-edge.from.dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
      if (outside(nearest)) return nearest;
    }
  return std::nullopt;
}

} // namespace

double Edge::length() const { return turn == 0 ? (to - from).norm() : arc_angle(*this) * from.norm(); }

Vector2d Edge::at(double fraction) const {
  if (turn == 0) return from + fraction * (to - from);
  return from.norm() * toward(angle_of(from) + turn * fraction * arc_angle(*this));
}

double Edge::fraction_of(const Vector2d& point, double tolerance) const {
  const double margin = tolerance / length();
  double fraction = 0;
  if (turn == 0) {
    const Vector2d along = to - from;
    if (std::abs(cross(along, point - from)) > tolerance * along.norm()) return -1;
    fraction = (point - from).dot(along) / along.squaredNorm();
  } else {
    if (std::abs(point.norm() - from.norm()) > tolerance) return -1;
    const double whole = 2 * pi / arc_angle(*this);
    fraction = turned(angle_of(from), angle_of(point), turn) / arc_angle(*this);
    if (fraction > whole - margin) fraction -= whole; // at its beginning, a full turn further
  }
  return fraction < -margin || fraction > 1 + margin ? -1 : std::clamp(fraction, 0.0, 1.0);
}

bool Region::contains(const Vector2d& point) const {
  // What the edges turn about the point, in full turns: nothing outside.
  constexpr double chord = pi / 360;
  double turns = 0;
  for (const auto& loop : loops)
    for (const Edge& edge : loop) {
      const int pieces = edge.turn == 0 ? 1 : std::max(1, static_cast<int>(arc_angle(edge) / chord));
      Vector2d last = edge.from - point;
      for (int k = 1; k <= pieces; ++k) {
        const Vector2d next = edge.at(static_cast<double>(k) / pieces) - point;
        turns += std::atan2(cross(last, next), last.dot(next)) / (2 * pi);
        last = next;
      }
    }
  return std::lround(turns) != 0;
}

Region sector(std::string name, const RoundFilm& between, double from, double to, double gap_beside,
              double gap_along) {
  const double inner = between.inner_radius + (between.inner_radius > 0 ? gap_along : 0);
  const double outer = between.outer_radius - gap_along, angle = to - from;
  if (!(angle > 0 && angle < 2 * pi - 1e-9))
    throw std::invalid_argument(
        fmt::format("it leads from {:.6g} to {:.6g} deg: a sector leads counter-clockwise, \"to\" above "
                    "\"from\" by less than a full turn (from = \"-90 deg\" is 270 deg, too)",
                    from * 180 / pi, to * 180 / pi));
  if (!(between.outer_radius > between.inner_radius))
    throw std::invalid_argument("its outer_radius is not above its inner_radius");
  const double apex = gap_beside / std::sin(angle / 2); // where its sides meet
  if (!(outer > std::max(inner, apex)) || !(outer > gap_beside))
    throw std::invalid_argument("the gap leaves nothing of it");
  const auto on_side = [&](double direction, double side, double radius) -> Vector2d {
    return std::sqrt(radius * radius - gap_beside * gap_beside) * toward(direction) +
           side * gap_beside * left_of(toward(direction));
  };
  const Vector2d first = on_side(from, 1, outer), last = on_side(to, -1, outer);
  const Vector2d tip = apex * toward((from + to) / 2);
  // Of more than half a turn the sides go on inwards beyond the inner arc, which they cut twice, to the tip.
  const bool cuts_twice = angle > pi && inner > gap_beside && inner <= apex;
  const bool has_arc = inner > apex || cuts_twice;
  const Vector2d begin = has_arc ? on_side(from, 1, inner) : tip;
  Region region{std::move(name), {{{begin, first, 0}}}};
  std::vector<Edge>& loop = region.loops.front();
  const auto add = [&loop](const Vector2d& next, int turn) { loop.push_back({loop.back().to, next, turn}); };
  add(last, 1);
  if (has_arc) add(on_side(to, -1, inner), 0);
  if (cuts_twice) {
    add(on_side(to + pi, 1, inner), -1);
    add(tip, 0);
    add(on_side(from + pi, -1, inner), 0);
  }
  add(begin, has_arc ? -1 : 0);
  return region;
}

Region ring(std::string name, const RoundFilm& between, double gap) {
  const double inner = between.inner_radius + (between.inner_radius > 0 ? gap : 0);
  const double outer = between.outer_radius - gap;
  if (!(between.outer_radius > between.inner_radius))
    throw std::invalid_argument("its outer_radius is not above its inner_radius");
  if (!(outer > inner)) throw std::invalid_argument("the gap leaves nothing of it");
  Region region{std::move(name), {circle(outer)}};
  if (inner > 0) {
    std::vector<Edge> hole;
    for (const Edge& quarter : circle(inner)) hole.insert(hole.begin(), {quarter.to, quarter.from, -1});
    region.loops.push_back(std::move(hole));
  }
  return region;
}

Region polygon(std::string name, std::vector<Vector2d> corners, double gap) {
  if (corners.size() < 3) throw std::invalid_argument("a polygon has at least 3 corners");
  if (signed_area(corners) < 0) std::ranges::reverse(corners);
  const std::size_t n = corners.size();
  const auto next = [n](std::size_t i) { return (i + 1) % n; };
  for (std::size_t i = 0; i < n; ++i)
    if (corners[i] == corners[next(i)]) throw std::invalid_argument("two corners in turn are one point");
  if (const auto sides = crossing_sides(corners))
    throw std::invalid_argument(fmt::format("its sides {} and {} cross", (*sides)[0] + 1, (*sides)[1] + 1));
  std::vector<Vector2d> moved = corners;
  for (std::size_t i = 0; gap > 0 && i < n; ++i) {
    const Vector2d before = (corners[i] - corners[(i + n - 1) % n]).normalized();
    const Vector2d after = (corners[next(i)] - corners[i]).normalized();
    const double cosine = 1 + before.dot(after);
    if (cosine < 1e-6) throw std::invalid_argument("one of its corners is too sharp for a gap");
    moved[i] += gap / cosine * (left_of(before) + left_of(after));
  }
  for (std::size_t i = 0; i < n; ++i) // a side that has turned round was shorter than the gap lets it be
    if ((moved[next(i)] - moved[i]).dot(corners[next(i)] - corners[i]) <= 0)
      throw std::invalid_argument("the gap leaves nothing of it");
  if (const auto sides = crossing_sides(moved))
    throw std::invalid_argument(
        fmt::format("the gap leaves nothing between its sides {} and {}: draw what is left as regions of "
                    "their own",
                    (*sides)[0] + 1, (*sides)[1] + 1));
  double extent = 0;
  for (const Vector2d& corner : corners) extent = std::max(extent, (corner - corners[0]).norm());
  if (!(signed_area(moved) > 1e-9 * extent * extent))
    throw std::invalid_argument(gap > 0 ? "the gap leaves nothing of it" : "it has no area");
  Region region{std::move(name), {{}}};
  for (std::size_t i = 0; i < n; ++i) region.loops[0].push_back({moved[i], moved[next(i)], 0});
  return region;
}

std::vector<RegionFault> faults(const RoundFilm& film, std::span<const Region> regions) {
  const double tolerance = 1e-7 * film.outer_radius;
  std::vector<RegionFault> found;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (const auto point = point_outside(film, regions[r], tolerance)) {
      const double radius = 1e3 * point->norm();
      found.push_back(
          {static_cast<int>(r),
           point->norm() > film.outer_radius
               ? fmt::format("it leaves the film: ({:.6g}, {:.6g}) mm is {:.6g} mm from the middle, the film "
                             "ends at {:.6g} mm",
                             1e3 * point->x(), 1e3 * point->y(), radius, 1e3 * film.outer_radius)
               : fmt::format("it leaves the film: ({:.6g}, {:.6g}) mm is {:.6g} mm from the middle, the film "
                             "begins at {:.6g} mm",
                             1e3 * point->x(), 1e3 * point->y(), radius, 1e3 * film.inner_radius)});
      continue;
    }
    for (std::size_t before = 0; before < r; ++before)
      if (overlap(regions[before], regions[r], tolerance))
        found.push_back({static_cast<int>(r), fmt::format("it overlaps with \"{}\"", regions[before].name)});
  }
  return found;
}

} // namespace dielast::meshing
