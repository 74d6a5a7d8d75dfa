// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/planar.hpp"

#include "meshing/mesh_error.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace dielast::meshing {

namespace {

using Eigen::Vector2d;
using Triangle = std::array<int, 3>;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
struct FaceMark {
  int piece = 0; // unknown; from 1 on those of the region
};
constexpr int outside = -1;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel,
                                                CGAL::Triangulation_face_base_with_info_2<FaceMark, Kernel>>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::No_constraint_intersection_tag>;

// An interior point keeps these multiples of the target size from every other point and from the outline.
// With the largest empty circle then as small as the smallest distance, angles away from the outline are
// above 30 degrees.
constexpr double point_spacing = 0.75;
constexpr double outline_spacing = 0.55;
constexpr double size_growth = 0.5; // per distance from the outline
constexpr int smoothing_passes = 10;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double smallest_angle(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const auto angle = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
    return std::atan2(cross(q - p, r - p), (q - p).dot(r - p)); // negative when inverted
  };
  return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)});
}

Vector2d circumcentre(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d u = b - a, v = c - a;
  const double uu = u.squaredNorm(), vv = v.squaredNorm();
  return a + Vector2d(v.y() * uu - u.y() * vv, u.x() * vv - v.x() * uu) / (2 * cross(u, v));
}

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - t * along).norm();
}

/// Works about the middle of the outline's bounding box, so that mirror images are exact.
class GraphMesher {
 public:
  GraphMesher(const PlanarGraph& graph, const std::function<double(const Vector2d&)>& largest_size)
      : outline_(static_cast<int>(graph.outline.size())), sides_(graph.outline), largest_size_(largest_size) {
    sides_.insert(sides_.end(), graph.inner.begin(), graph.inner.end());
    Eigen::AlignedBox2d box;
    for (const Vector2d& p : graph.points) box.extend(p);
    middle_ = box.center();
    for (const Vector2d& p : graph.points) points_.push_back(p - middle_);
    for (int i = 0; i < side_count(); ++i)
      longest_side_ = std::max(longest_side_, (end(i) - start(i)).norm());
    mirror_x_ = is_symmetric({-1, 1});
    mirror_y_ = is_symmetric({1, -1});
  }

  Triangulation run() {
    triangulate();
    while (insert_points()) triangulate();
    for (int pass = 0; pass < smoothing_passes; ++pass) {
      smooth();
      triangulate();
    }
    for (Vector2d& p : points_) p += middle_;
    return {std::move(points_), std::move(triangles_), std::move(pieces_)};
  }

 private:
  /// An interior point and its mirror images: points_[first] to points_[first + images - 1].
  struct Orbit {
    int first, images;
  };

  int side_count() const { return static_cast<int>(sides_.size()); }
  const Vector2d& start(int side) const { return points_[sides_[side][0]]; }
  const Vector2d& end(int side) const { return points_[sides_[side][1]]; }

  bool is_symmetric(const Vector2d& mirror) const {
    const double tolerance = 1e-6 * longest_side_;
    const auto has_image = [&](const Vector2d& p) {
      return std::ranges::any_of(
          points_, [&](const Vector2d& q) { return (q - p.cwiseProduct(mirror)).norm() < tolerance; });
    };
    return std::ranges::all_of(points_, has_image);
  }

  std::vector<Vector2d> images(const Vector2d& p) const {
    std::vector<Vector2d> result{p};
    if (mirror_x_ && p.x() != 0) result.push_back({-p.x(), p.y()});
    if (mirror_y_ && p.y() != 0)
      for (std::size_t i = 0, n = result.size(); i < n; ++i)
        result.push_back({result[i].x(), -result[i].y()});
    return result;
  }

  bool is_inside(const Vector2d& p) const {
    bool inside = false;
    for (int i = 0; i < outline_; ++i) {
      const Vector2d &a = start(i), &b = end(i);
      if ((a.y() > p.y()) != (b.y() > p.y()) && (cross(b - a, p - a) > 0) == (b.y() > a.y()))
        inside = !inside;
    }
    return inside;
  }

  double target_size(const Vector2d& p) const {
    double size = largest_size_(p + middle_);
    for (int i = 0; i < side_count(); ++i)
      size =
          std::min(size, (end(i) - start(i)).norm() + size_growth * distance_to_segment(p, start(i), end(i)));
    return size;
  }

  /// Distance to the nearest point over the target size; 0 where no point may be.
  double room(const Vector2d& p) const {
    if (!p.allFinite() || !is_inside(p)) return 0;
    const double size = target_size(p);
    for (int i = 0; i < side_count(); ++i)
      if (distance_to_segment(p, start(i), end(i)) < outline_spacing * size) return 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector2d& q : points_) nearest = std::min(nearest, (p - q).squaredNorm());
    return std::sqrt(nearest) / size;
  }

  /// A point too near to a mirror axis for its own image is moved onto it.
  Vector2d snapped(Vector2d p) const {
    const double reach = 0.5 * point_spacing * target_size(p);
    if (mirror_x_ && std::abs(p.x()) < reach) p.x() = 0;
    if (mirror_y_ && std::abs(p.y()) < reach) p.y() = 0;
    return p;
  }

  /// Fills the largest empty circles first; returns whether there were any.
  bool insert_points() {
    std::vector<std::tuple<double, double, double>> candidates; // -room, x, y: a total order
    for (const auto& [a, b, c] : triangles_) {
      const Vector2d p = snapped(circumcentre(points_[a], points_[b], points_[c]));
      if (const double free = room(p); free >= point_spacing) candidates.emplace_back(-free, p.x(), p.y());
    }
    std::ranges::sort(candidates);
    for (const auto& [order, x, y] : candidates) {
      const Vector2d p(x, y);
      if (room(p) < point_spacing) continue;
      const std::vector<Vector2d> orbit = images(p);
      orbits_.push_back({static_cast<int>(points_.size()), static_cast<int>(orbit.size())});
      points_.insert(points_.end(), orbit.begin(), orbit.end());
    }
    return !candidates.empty();
  }

  /// Moves interior points towards the middle of their neighbours where that widens the smallest angle around
  /// them.
  void smooth() {
    std::vector<std::vector<Triangle>> stars(points_.size());
    for (const Triangle& triangle : triangles_)
      for (const int corner : triangle) stars[corner].push_back(triangle);
    for (const Orbit& orbit : orbits_) {
      const std::vector<Triangle>& star = stars[orbit.first];
      const Vector2d old = points_[orbit.first];
      Vector2d sum = Vector2d::Zero();
      for (const auto& [a, b, c] : star) sum += points_[a] + points_[b] + points_[c] - old;
      Vector2d target = sum / (2.0 * static_cast<double>(star.size()));
      if (old.x() == 0 && mirror_x_) target.x() = 0;
      if (old.y() == 0 && mirror_y_) target.y() = 0;
      double best = worst_angle(star);
      Vector2d kept = old;
      for (const double step : {1.0, 0.5, 0.25}) {
        place(orbit, old + step * (target - old));
        if (const double angle = worst_angle(star); angle > best) best = angle, kept = points_[orbit.first];
      }
      place(orbit, kept);
    }
  }

  double worst_angle(const std::vector<Triangle>& star) const {
    double worst = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : star)
      worst = std::min(worst, smallest_angle(points_[a], points_[b], points_[c]));
    return worst;
  }

  void place(const Orbit& orbit, const Vector2d& p) {
    const std::vector<Vector2d> moved = images(p);
    if (static_cast<int>(moved.size()) == orbit.images)
      std::ranges::copy(moved, points_.begin() + orbit.first);
  }

  void triangulate() {
    Delaunay delaunay;
    std::vector<Delaunay::Vertex_handle> vertices;
    for (const Vector2d& p : points_) {
      vertices.push_back(delaunay.insert({p.x(), p.y()}));
      vertices.back()->info() = static_cast<int>(vertices.size()) - 1;
    }
    try {
      for (const auto& [from, to] : sides_) delaunay.insert_constraint(vertices[from], vertices[to]);
    } catch (const Delaunay::Intersection_of_constraints_exception&) {
      throw MeshError("the outline of a region crosses itself");
    }
    number_pieces(delaunay);
    triangles_.clear();
    pieces_.clear();
    for (const auto face : delaunay.finite_face_handles())
      if (face->info().piece != outside) {
        triangles_.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
        pieces_.push_back(face->info().piece - 1);
      }
  }

  /// A piece is what can be reached without crossing a side; its largest triangle tells whether it is in the
  /// region. (Others do not: nearly straight chains of sides leave slivers outside whose centroids round to
  /// either side.)
  void number_pieces(Delaunay& delaunay) const {
    fill(delaunay.infinite_face(), outside);
    int count = 0;
    for (const auto face : delaunay.finite_face_handles()) {
      if (face->info().piece != 0) continue;
      const std::vector<Delaunay::Face_handle> piece = fill(face, ++count);
      const auto corner = [this](const Delaunay::Face_handle& f, int k) -> const Vector2d& {
        return points_[f->vertex(k)->info()];
      };
      const auto area = [&](const Delaunay::Face_handle& f) {
        return cross(corner(f, 1) - corner(f, 0), corner(f, 2) - corner(f, 0));
      };
      const auto largest = *std::ranges::max_element(piece, {}, area);
      if (is_inside((corner(largest, 0) + corner(largest, 1) + corner(largest, 2)) / 3)) continue;
      for (const auto& hole : piece) hole->info().piece = outside;
      --count;
    }
  }

  /// Marks the piece around a face, and returns its faces.
  static std::vector<Delaunay::Face_handle> fill(Delaunay::Face_handle start, int piece) {
    std::vector<Delaunay::Face_handle> found{start};
    start->info().piece = piece;
    for (std::size_t i = 0; i < found.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const Delaunay::Face_handle face = found[i], neighbour = face->neighbor(k);
        if (face->is_constrained(k) || neighbour->info().piece != 0) continue;
        neighbour->info().piece = piece;
        found.push_back(neighbour);
      }
    return found;
  }

  int outline_; ///< how many of the sides are the outline's: they come first
  std::vector<std::array<int, 2>> sides_;
  const std::function<double(const Vector2d&)>& largest_size_;
  Vector2d middle_;
  double longest_side_ = 0;
  bool mirror_x_ = false, mirror_y_ = false;
  std::vector<Vector2d> points_;
  std::vector<Orbit> orbits_;
  std::vector<Triangle> triangles_;
  std::vector<int> pieces_;
};

} // namespace

Triangulation triangulate(const PlanarGraph& graph,
                          const std::function<double(const Vector2d&)>& largest_size) {
  return GraphMesher(graph, largest_size).run();
}

Triangulation triangulate(std::span<const Vector2d> outline, double grading) {
  PlanarGraph graph{{outline.begin(), outline.end()}, {}};
  const int sides = static_cast<int>(outline.size());
  double longest = 0;
  for (int i = 0; i < sides; ++i) {
    graph.outline.push_back({i, (i + 1) % sides});
    longest = std::max(longest, (graph.points[(i + 1) % sides] - graph.points[i]).norm());
  }
  return triangulate(graph, [size = grading * longest](const Vector2d&) { return size; });
}

} // namespace dielast::meshing
