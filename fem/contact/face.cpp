// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/face.hpp"

#include "fem/films/triangle.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace dielast::fem {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Shape = Eigen::Vector<double, 6>;

const std::array<Vector2d, 3> corners{Vector2d{0, 0}, {1, 0}, {0, 1}};
constexpr int most_steps = 30;
constexpr double still = 1e-14; ///< of local coordinates

/// d2N/dxi2, d2N/(dxi deta), d2N/deta2: the same everywhere.
const std::array<Shape, 3> bends = [] {
  const auto slope = [](double xi, double eta) { return shape_gradients<6>(xi, eta); };
  const Eigen::Matrix<double, 6, 2> here = slope(0, 0), along = slope(1, 0) - here,
                                    across = slope(0, 1) - here;
  return std::array<Shape, 3>{along.col(0), along.col(1), across.col(1)};
}();

Shape bend_along(const Vector2d& a, const Vector2d& b) {
  return a[0] * b[0] * bends[0] + (a[0] * b[1] + a[1] * b[0]) * bends[1] + a[1] * b[1] * bends[2];
}

/// What is at some local coordinates, with the directions along which they may move.
FacePlace place_at(const FaceNodes& face, const Vector3d& point, const Vector2d& at,
                   std::initializer_list<Vector2d> directions) {
  FacePlace place;
  place.shape = shape_values<6>(at[0], at[1]);
  const Vector3d way = point - face * place.shape;
  place.distance = way.norm();
  place.normal = way / place.distance;
  const Eigen::Matrix<double, 6, 2> slope = shape_gradients<6>(at[0], at[1]);
  for (const Vector2d& direction : directions)
    place.slope[static_cast<std::size_t>(place.free++)] = slope * direction;
  std::size_t k = 0;
  for (auto a = directions.begin(); a != directions.end(); ++a)
    for (auto b = a; b != directions.end(); ++b) place.bend[k++] = bend_along(*a, *b);
  return place;
}

FacePlace at_corner(const FaceNodes& face, const Vector3d& point, int corner) {
  return place_at(face, point, corners[static_cast<std::size_t>(corner)], {});
}

/// Newton's method for the parabola of an edge, from the nearest of some of its points.
FacePlace on_edge(const FaceNodes& face, const Vector3d& point, int edge) {
  const int a = edge, b = (edge + 1) % 3;
  const Vector3d from = face.col(a), to = face.col(b), middle = face.col(3 + edge);
  const Vector3d first = 4 * middle - 3 * from - to, second = 4 * (from + to - 2 * middle);
  const auto way = [&](double t) { return Vector3d(point - from - t * (first + t / 2 * second)); };
  double t = 0, least = std::numeric_limits<double>::infinity();
  for (const double start : {0.0, 0.25, 0.5, 0.75, 1.0})
    if (const double squared = way(start).squaredNorm(); squared < least) {
      least = squared;
      t = start;
    }
  for (int step = 0; step < most_steps; ++step) {
    const Vector3d r = way(t), slope = first + t * second;
    const double stiff = slope.squaredNorm(), curved = stiff - r.dot(second);
    const double next = std::clamp(t + r.dot(slope) / (curved > 0.1 * stiff ? curved : stiff), 0.0, 1.0);
    const bool ends = std::abs(next - t) <= still;
    t = next;
    if (ends) break;
  }
  if (t <= 0) return at_corner(face, point, a);
  if (t >= 1) return at_corner(face, point, b);
  const Vector2d direction = corners[static_cast<std::size_t>(b)] - corners[static_cast<std::size_t>(a)];
  return place_at(face, point, corners[static_cast<std::size_t>(a)] + t * direction, {direction});
}

/// Where the way to the point is across the face, if that is within it.
std::optional<Vector2d> foot(const FaceNodes& face, const Vector3d& point) {
  constexpr double far = 0.5; // outside
  Vector2d at(1.0 / 3, 1.0 / 3);
  for (int step = 0; step < most_steps; ++step) {
    const Vector3d r = point - face * shape_values<6>(at[0], at[1]);
    const Eigen::Matrix<double, 3, 2> slope = face * shape_gradients<6>(at[0], at[1]);
    const Eigen::Matrix2d stiff = slope.transpose() * slope;
    Eigen::Matrix2d curved = stiff;
    if (step > 0) {
      const double mixed = r.dot(face * bends[1]);
      curved(0, 0) -= r.dot(face * bends[0]);
      curved(1, 1) -= r.dot(face * bends[2]);
      curved(0, 1) -= mixed;
      curved(1, 0) -= mixed;
      if (!(curved(0, 0) > 0 && curved.determinant() > 0.01 * stiff.determinant())) curved = stiff;
    }
    const Vector2d way = curved.inverse() * (slope.transpose() * r);
    at += way;
    if (!(at.minCoeff() > -far && at.sum() < 1 + far)) return std::nullopt;
    if (way.cwiseAbs().maxCoeff() <= still) break;
  }
  if (at.minCoeff() < 0 || at.sum() > 1) return std::nullopt;
  return at;
}

double distance(const Vector3d& point, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = to - from;
  const double t = std::clamp(along.dot(point - from) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - t * along).norm();
}

} // namespace

FacePlace nearest_place(const FaceNodes& face, FacePart part, const Vector3d& point) {
  if (part.kind == FacePart::Kind::corner) return at_corner(face, point, part.number);
  if (part.kind == FacePart::Kind::edge) return on_edge(face, point, part.number);
  if (const auto at = foot(face, point))
    return place_at(face, point, *at, {Vector2d::UnitX(), Vector2d::UnitY()});
  FacePlace nearest = on_edge(face, point, 0);
  for (const int edge : {1, 2})
    if (FacePlace other = on_edge(face, point, edge); other.distance < nearest.distance) nearest = other;
  return nearest;
}

FaceNodes control_points(const FaceNodes& face) {
  FaceNodes points = face;
  for (int edge = 0; edge < 3; ++edge)
    points.col(3 + edge) = 2 * face.col(3 + edge) - (face.col(edge) + face.col((edge + 1) % 3)) / 2;
  return points;
}

Eigen::AlignedBox3d box_of(const FaceNodes& face) {
  const FaceNodes points = control_points(face);
  return {points.rowwise().minCoeff(), points.rowwise().maxCoeff()};
}

double way_of(const FaceNodes& from, const FaceNodes& to) {
  return std::sqrt((control_points(to) - control_points(from)).colwise().squaredNorm().maxCoeff());
}

namespace {

using Flat = std::array<Vector3d, 3>;

std::vector<Flat> flat_parts(const FaceNodes& face) {
  constexpr int parts = 4; // of an edge
  const auto at = [&](int i, int j) {
    return Vector3d(face * shape_values<6>(static_cast<double>(i) / parts, static_cast<double>(j) / parts));
  };
  std::vector<Flat> all;
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j) {
      all.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + j + 1 < parts) all.push_back({at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)});
    }
  return all;
}

/// Whether an edge of the one leads through the other.
bool leads_through(const Flat& one, const Flat& other) {
  const auto volume = [](const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  const auto& [a, b, c] = other;
  for (std::size_t e = 0; e < 3; ++e) {
    const Vector3d &from = one[e], &to = one[(e + 1) % 3];
    if (volume(a, b, c, from) * volume(a, b, c, to) >= 0) continue;
    const double first = volume(from, to, a, b), second = volume(from, to, b, c),
                 third = volume(from, to, c, a);
    if ((first > 0 && second > 0 && third > 0) || (first < 0 && second < 0 && third < 0)) return true;
  }
  return false;
}

Eigen::AlignedBox3d box_of(const Flat& flat) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& corner : flat) box.extend(corner);
  return box;
}

} // namespace

bool cross(const FaceNodes& one, const FaceNodes& other) {
  if (!box_of(one).intersects(box_of(other))) return false;
  const std::vector<Flat> parts = flat_parts(one), others = flat_parts(other);
  return std::ranges::any_of(parts, [&](const Flat& a) {
    return std::ranges::any_of(others, [&](const Flat& b) {
      return box_of(a).intersects(box_of(b)) && (leads_through(a, b) || leads_through(b, a));
    });
  });
}

const std::vector<FacePoint>& face_rule() {
  static const std::vector<FacePoint> rule = [] {
    constexpr int parts = 4;                        // of an edge
    std::map<std::array<int, 2>, FacePoint> points; // by thirds of half a part
    const auto add = [&](const Vector2d& at, double weight) {
      FacePoint point{at[0], at[1], 0, shape_values<6>(at[0], at[1]), {}};
      const Vector3d corner(1 - at.sum(), at[0], at[1]);
      for (int c = 0; c < 3; ++c) point.share[c] = std::max(0.0, 2 * corner[c] - 1);
      for (int c = 0; c < 3; ++c) { // linear on each of four parts
        const double here = corner[c], next = corner[(c + 1) % 3], last = corner[(c + 2) % 3];
        point.share[3 + c] = last >= 0.5               ? 0
                             : corner.maxCoeff() < 0.5 ? 1 - 2 * last
                                                       : 2 * std::min(here, next);
      }
      const std::array<int, 2> key{static_cast<int>(std::lround(6 * parts * at[0])),
                                   static_cast<int>(std::lround(6 * parts * at[1]))};
      points.try_emplace(key, point).first->second.weight += weight / (2 * parts * parts);
    };
    const auto add_part = [&](const Vector2d& a, const Vector2d& b, const Vector2d& c) {
      const std::array<Vector2d, 3> x{a, b, c};
      for (std::size_t k = 0; k < 3; ++k) {
        add(x[k], 1.0 / 20);
        add((x[k] + x[(k + 1) % 3]) / 2, 2.0 / 15);
      }
      add((a + b + c) / 3, 9.0 / 20);
    };
    const auto at = [](int i, int j) -> Vector2d { return Vector2d(i, j) / double{parts}; };
    for (int i = 0; i < parts; ++i)
      for (int j = 0; i + j < parts; ++j) {
        add_part(at(i, j), at(i + 1, j), at(i, j + 1));
        if (i + j + 1 < parts) add_part(at(i + 1, j + 1), at(i, j + 1), at(i + 1, j));
      }
    std::vector<FacePoint> all;
    for (const auto& [key, point] : points) all.push_back(point);
    return all;
  }();
  return rule;
}

std::vector<std::vector<CountedPart>> parts_beside(const meshing::CellBlock& faces) {
  std::map<int, int> faces_at; // a node
  for (const int node : faces.nodes) ++faces_at[node];
  std::map<int, double> of_corner;
  std::set<int> done; // nodes: edges are told by their middles
  for (int i = 0; i < faces.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const auto own = faces.cell(i);
      const bool fresh = done.insert(own[3 + a]).second;
      for (const int end : {own[a], own[(a + 1) % 3]}) {
        double& factor = of_corner.try_emplace(end, 1 - faces_at[end]).first->second;
        if (fresh) factor += faces_at[own[3 + a]] - 1;
      }
    }
  done.clear();
  std::vector<std::vector<CountedPart>> parts(static_cast<std::size_t>(faces.size()));
  for (int i = 0; i < faces.size(); ++i)
    for (int a = 0; a < 3; ++a) {
      const auto own = faces.cell(i);
      const int corner = own[static_cast<std::size_t>(a)], middle = own[static_cast<std::size_t>(3 + a)];
      std::vector<CountedPart>& beside = parts[static_cast<std::size_t>(i)];
      if (faces_at[middle] > 1 && done.insert(middle).second)
        beside.push_back({{FacePart::Kind::edge, a}, 1.0 - faces_at[middle]});
      if (of_corner[corner] != 0 && done.insert(corner).second)
        beside.push_back({{FacePart::Kind::corner, a}, of_corner[corner]});
    }
  return parts;
}

FaceEnds::FaceEnds(const meshing::CellBlock& faces, const std::vector<Vector3d>& drawn,
                   const std::vector<int>& mirrored, double over) {
  std::map<std::pair<int, int>, std::pair<int, int>> edges; // corners: the middle, how many faces have it
  for (int i = 0; i < faces.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const auto cell = faces.cell(i);
      auto& [middle, count] = edges[std::minmax(cell[a], cell[(a + 1) % 3])];
      middle = cell[3 + a];
      ++count;
    }
  const auto at = [&](int node) { return drawn[static_cast<std::size_t>(node)]; };
  const auto is_mirrored = [&](int node) { return std::ranges::binary_search(mirrored, node); };
  std::vector<std::array<Vector3d, 2>> ends;
  for (const auto& [corners, edge] : edges) {
    if (edge.second > 1 ||
        (is_mirrored(corners.first) && is_mirrored(edge.first) && is_mirrored(corners.second)))
      continue;
    ends.push_back({at(corners.first), at(edge.first)});
    ends.push_back({at(edge.first), at(corners.second)});
  }
  std::map<int, double> away;
  for (const int node : faces.nodes) {
    const auto [place, fresh] = away.try_emplace(node, std::numeric_limits<double>::max());
    if (!fresh) continue;
    for (const auto& [from, to] : ends) place->second = std::min(place->second, distance(at(node), from, to));
  }
  double farthest = 0;
  for (const auto& [node, least] : away) farthest = std::max(farthest, least);
  over = std::min(over, farthest);
  for (int i = 0; i < faces.size(); ++i) {
    Eigen::Vector<double, 6>& own = faces_.emplace_back();
    for (int a = 0; a < 6; ++a)
      own[a] = ends.empty() ? 1 : away.at(faces.cell(i)[static_cast<std::size_t>(a)]) / over;
  }
}

} // namespace dielast::fem
