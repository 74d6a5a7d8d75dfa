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
  bool outside = false;
};
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
class PolygonMesher {
 public:
  PolygonMesher(std::span<const Vector2d> outline, double grading)
      : sides_(static_cast<int>(outline.size())) {
    Eigen::AlignedBox2d box;
    for (const Vector2d& p : outline) box.extend(p);
    middle_ = box.center();
    for (const Vector2d& p : outline) points_.push_back(p - middle_);
    for (int i = 0; i < sides_; ++i) longest_side_ = std::max(longest_side_, (end(i) - points_[i]).norm());
    largest_size_ = grading * longest_side_;
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
    return {std::move(points_), std::move(triangles_)};
  }

 private:
  /// An interior point and its mirror images: points_[first] to points_[first + images - 1].
  struct Orbit {
    int first, images;
  };

  const Vector2d& end(int side) const { return points_[(side + 1) % sides_]; }

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
    for (int i = 0; i < sides_; ++i) {
      const Vector2d &a = points_[i], &b = end(i);
      if ((a.y() > p.y()) != (b.y() > p.y()) && (cross(b - a, p - a) > 0) == (b.y() > a.y()))
        inside = !inside;
    }
    return inside;
  }

  double target_size(const Vector2d& p) const {
    double size = largest_size_;
    for (int i = 0; i < sides_; ++i)
      size = std::min(size, (end(i) - points_[i]).norm() +
                                size_growth * distance_to_segment(p, points_[i], end(i)));
    return size;
  }

  /// Distance to the nearest point over the target size; 0 where no point may be.
  double room(const Vector2d& p) const {
    if (!p.allFinite() || !is_inside(p)) return 0;
    const double size = target_size(p);
    for (int i = 0; i < sides_; ++i)
      if (distance_to_segment(p, points_[i], end(i)) < outline_spacing * size) return 0;
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
      for (int i = 0; i < sides_; ++i) delaunay.insert_constraint(vertices[i], vertices[(i + 1) % sides_]);
    } catch (const Delaunay::Intersection_of_constraints_exception&) {
      throw MeshError("the outline of a region crosses itself");
    }
    mark_outside(delaunay);
    triangles_.clear();
    for (const auto face : delaunay.finite_face_handles())
      if (!face->info().outside)
        triangles_.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }

  /// What can be reached from infinity without crossing the outline. (The position of a face does not tell:
  /// nearly straight chains of sides leave slivers outside whose centroids round to either side.)
  static void mark_outside(Delaunay& delaunay) {
    std::vector<Delaunay::Face_handle> front{delaunay.infinite_face()};
    front.back()->info().outside = true;
    while (!front.empty()) {
      const Delaunay::Face_handle face = front.back();
      front.pop_back();
      for (int k = 0; k < 3; ++k) {
        const Delaunay::Face_handle neighbour = face->neighbor(k);
        if (face->is_constrained(k) || neighbour->info().outside) continue;
        neighbour->info().outside = true;
        front.push_back(neighbour);
      }
    }
  }

  int sides_;
  Vector2d middle_;
  double longest_side_ = 0, largest_size_ = 0;
  bool mirror_x_ = false, mirror_y_ = false;
  std::vector<Vector2d> points_;
  std::vector<Orbit> orbits_;
  std::vector<Triangle> triangles_;
};

} // namespace

Triangulation triangulate(std::span<const Vector2d> outline, double grading) {
  return PolygonMesher(outline, grading).run();
}

} // namespace dielast::meshing
