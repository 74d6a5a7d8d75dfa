// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/face_motion.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dielast::fem {

namespace {

using Eigen::Vector3d;
constexpr double near = 1.2; ///< times the gap that is kept: where a way ends
constexpr int most_advances = 100;

using Parts = std::array<MovingFace, 4>;

/// Control points of the four parts of a face with these: values of its polar form (corners, 01, 12, 20).
std::array<FaceNodes, 4> parts_of(const FaceNodes& c) {
  const auto middle = [](const Vector3d& a, const Vector3d& b) { return Vector3d((a + b) / 2); };
  // p(m_e, corner) and p(m_e, m_f), of the middles m_e of the edges
  std::array<Vector3d, 3> from, to, across, between;
  for (int e = 0; e < 3; ++e) {
    const int a = e, b = (e + 1) % 3, next = 3 + b, last = 3 + (e + 2) % 3;
    from[static_cast<std::size_t>(e)] = middle(c.col(a), c.col(3 + e));
    to[static_cast<std::size_t>(e)] = middle(c.col(3 + e), c.col(b));
    across[static_cast<std::size_t>(e)] = middle(c.col(last), c.col(next));
  }
  std::array<Vector3d, 3> at; // p(m_e, m_e)
  for (std::size_t e = 0; e < 3; ++e) {
    at[e] = middle(from[e], to[e]);
    between[e] = middle(to[e], across[e]); // p(m_e, m_e+1)
  }
  std::array<FaceNodes, 4> parts;
  for (std::size_t k = 0; k < 3; ++k) { // at corner k, between the edges k and k + 2
    const std::size_t last = (k + 2) % 3;
    parts[k] << c.col(static_cast<int>(k)), at[k], at[last], from[k], between[last], to[last];
  }
  parts[3] << at[0], at[1], at[2], between[0], between[1], between[2];
  return parts;
}

Parts parts_of(const MovingFace& face) {
  const std::array<FaceNodes, 4> from = parts_of(face.from), to = parts_of(face.to);
  Parts parts;
  for (std::size_t k = 0; k < 4; ++k) parts[k] = {from[k], to[k]};
  return parts;
}

/// Extent of a face, between its corners.
double size_of(const FaceNodes& c) {
  return std::max({(c.col(1) - c.col(0)).norm(), (c.col(2) - c.col(1)).norm(), (c.col(0) - c.col(2)).norm()});
}

/// How far they move at most, as seen from the one's middle.
double motion(const MovingFace& one, const MovingFace& other) {
  const FaceNodes way = one.to - one.from, others = other.to - other.from;
  const Vector3d mean = way.rowwise().mean();
  return std::sqrt(std::max((way.colwise() - mean).colwise().squaredNorm().maxCoeff(),
                            (others.colwise() - mean).colwise().squaredNorm().maxCoeff()));
}

/// Corners of a hull: those at the beginning and at the end of a part of the way.
using Hull = Eigen::Matrix<double, 3, 12>;

class Advance {
 public:
  Advance(double clearance, int tests) : clearance_(clearance), tests_(tests) {}

  /// The first time of begin..end at which it is not known that the two are apart; `end`: at none.
  double until(const MovingFace& one, const MovingFace& other, double begin, double end) {
    if (are_apart(one, other, begin, end)) return end;
    if (--tests_ < 0) return begin;
    const double a = size_of(one.from), b = size_of(other.from);
    const double moved = motion(one, other) * (end - begin);
    if (std::max({a, b, moved}) < clearance_) return begin;
    if (moved > std::max(a, b)) {
      const double middle = (begin + end) / 2, first = until(one, other, begin, middle);
      return first < middle ? first : until(one, other, middle, end);
    }
    if (a >= b)
      for (const MovingFace& part : parts_of(one)) end = until(part, other, begin, end);
    else
      for (const MovingFace& part : parts_of(other)) end = until(one, part, begin, end);
    return end;
  }

 private:
  bool are_apart(const MovingFace& one, const MovingFace& other, double begin, double end) const {
    // Seen from the one face's middle.
    const auto middle = [&](double s) {
      return Vector3d((one.from + s * (one.to - one.from)).leftCols<3>().rowwise().mean());
    };
    const auto hull = [&](const MovingFace& face) {
      Hull corners;
      corners.leftCols<6>() = (face.from + begin * (face.to - face.from)).colwise() - middle(begin);
      corners.rightCols<6>() = (face.from + end * (face.to - face.from)).colwise() - middle(end);
      return corners;
    };
    const Hull a = hull(one), b = hull(other);
    const auto normal = [](const Hull& x) {
      return Vector3d((x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)));
    };
    constexpr int most_turns = 6;
    if (separates(normal(a), a, b) || separates(normal(b), a, b)) return true;
    // Turned towards what separates them (Chung and Wang 1996).
    Vector3d along = b.rowwise().mean() - a.rowwise().mean();
    for (int turn = 0; turn < most_turns; ++turn) {
      if (!(along.squaredNorm() > 0)) return false;
      along.normalize();
      int last = 0, first = 0;
      const double high = (along.transpose() * a).maxCoeff(&last),
                   low = (along.transpose() * b).minCoeff(&first);
      if (low - high > clearance_) return true;
      const Vector3d between = (b.col(first) - a.col(last)).normalized();
      along -= 2 * along.dot(between) * between;
    }
    return false;
  }
  /// Whether all of the one is on one side of the other along a direction, whichever.
  bool separates(const Vector3d& direction, const Hull& a, const Hull& b) const {
    const double length = direction.norm();
    if (!(length > 0)) return false;
    const Eigen::Matrix<double, 1, 12> ours = direction.transpose() * a, theirs = direction.transpose() * b;
    return std::max(theirs.minCoeff() - ours.maxCoeff(), ours.minCoeff() - theirs.maxCoeff()) >
           clearance_ * length;
  }

  double clearance_;
  int tests_; ///< that are left
};

} // namespace

MovingFace moving(const FaceNodes& from, const FaceNodes& to) {
  return {control_points(from), control_points(to)};
}

double way_apart(const MovingFace& one, const MovingFace& other, double clearance, double most, int tests) {
  return Advance(clearance, tests).until(one, other, 0, most);
}

double gap_of_points(const FaceNodes& own, const FaceNodes& other) {
  double least = std::numeric_limits<double>::infinity();
  for (const FacePoint& at : face_rule())
    least = std::min(least, nearest_place(other, {}, own * at.shape).distance);
  return least;
}

double way_of_points(const FaceNodes& own, const FaceNodes& own_to, const FaceNodes& other,
                     const FaceNodes& other_to, double kept, double most) {
  const FaceNodes own_way = own_to - own, other_way = other_to - other;
  const MovingFace corners = moving(other, other_to);
  const FaceNodes corners_way = corners.to - corners.from;
  const Eigen::AlignedBox3d box(corners.from.rowwise().minCoeff(), corners.from.rowwise().maxCoeff());
  const double fastest = std::sqrt(corners_way.colwise().squaredNorm().maxCoeff());
  for (const FacePoint& at : face_rule()) {
    const Vector3d x = own * at.shape, way = own_way * at.shape;
    const double away = (1 - kept) * box.exteriorDistance(x);
    if (away > most * (way.norm() + fastest)) continue;
    const FaceNodes seen = corners_way.colwise() - way; // from the point
    const double speed = std::sqrt(seen.colwise().squaredNorm().maxCoeff());
    if (away > most * speed) continue;
    FacePlace now = nearest_place(other, {}, x);
    const double least = kept * now.distance;
    double s = 0;
    for (int k = 0;; ++k) {
      double step = (now.distance - least) / speed;
      const Eigen::RowVector<double, 6> gap = now.normal.transpose() *
                                              ((-corners.from - s * corners_way).colwise() + (x + s * way)),
                                        slower = now.normal.transpose() * seen;
      if (gap.minCoeff() > least)
        step = std::max(
            step,
            ((gap.array() - least) / slower.array().max(std::numeric_limits<double>::min())).minCoeff());
      s += step;
      if (!(s < most)) break;
      now = nearest_place(other + s * other_way, {}, x + s * way);
      if (now.distance <= near * least || k == most_advances) {
        most = s;
        break;
      }
    }
  }
  return most;
}

} // namespace dielast::fem
