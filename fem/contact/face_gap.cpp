// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/face_gap.hpp"

#include <Eigen/LU>

#include <array>

namespace dielast::fem {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Row = Eigen::Matrix<double, 1, 36>; ///< a derivative by all nodes
using Weights = Eigen::Vector<double, 12>;

/// A point and the place nearest to it with their derivatives. What goes with the nodes: the way from the
/// place to the point, r, and its slopes along the directions in which the place may move; these follow, as
/// the gap is the least.
struct NearestPlace {
  NearestPlace(const Eigen::Vector<double, 6>& own, const FaceNodes& face, const FacePlace& at) : place(at) {
    weight.col(0) << own, -place.shape;
    for (std::size_t k = 0; k < static_cast<std::size_t>(place.free); ++k)
      weight.col(1 + static_cast<int>(k)).tail<6>() = -place.slope[k];
    across = (Matrix3d::Identity() - place.normal * place.normal.transpose()) / place.distance;
    for (int k = 0; k < place.free; ++k) {
      slope.col(k) = -(face * place.slope[static_cast<std::size_t>(k)]);
      for (int l = 0; l < place.free; ++l)
        bend[k + l] = -(face * place.bend[static_cast<std::size_t>(k + l)]);
    }
    for (int k = 0; k < place.free; ++k) {
      mixed.col(k).head<3>() = across * slope.col(k);
      mixed.col(k).segment<3>(3 + 3 * k) = place.normal;
      for (int l = 0; l < place.free; ++l)
        stiff(k, l) = slope.col(k).dot(across * slope.col(l)) + place.normal.dot(bend[k + l]);
    }
  }
  /// Of the gap, by r and its slopes.
  Eigen::Matrix<double, 9, 9> second() const {
    Eigen::Matrix<double, 9, 9> by = Eigen::Matrix<double, 9, 9>::Zero();
    by.topLeftCorner<3, 3>() = across;
    if (place.free > 0) by -= mixed * stiff.inverse() * mixed.transpose();
    return by;
  }

  const FacePlace& place;
  Eigen::Matrix<double, 12, 3> weight = Eigen::Matrix<double, 12, 3>::Zero(); ///< of nodes in r, its slopes
  Matrix3d across;
  Eigen::Matrix<double, 3, 2> slope = Eigen::Matrix<double, 3, 2>::Zero(); ///< of r
  std::array<Vector3d, 3> bend{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  Eigen::Matrix<double, 9, 2> mixed =
      Eigen::Matrix<double, 9, 2>::Zero();             ///< of the gap: by these and the place
  Eigen::Matrix2d stiff = Eigen::Matrix2d::Identity(); ///< and twice by the place
};

/// v . x where the nodes have these weights in x.
Row dot(const Vector3d& v, const Weights& weights) {
  Row row;
  for (int a = 0; a < 12; ++a) row.segment<3>(3 * a) = weights[a] * v.transpose();
  return row;
}

/// What the ramp's change with the place adds to area * share * barrier. With r.t_k = 0 for the slopes t_k of
/// the way r the place moves by d, H d = -(r.dt + dr.t), H_kl = t_k.t_l + r.u_kl with t_k's own slopes u_kl;
/// one more variation of that is what twice moves it.
void add_fading(const NearestPlace& at, const Eigen::Vector<double, 6>& field, double area,
                const BarrierEnergy& barrier, const Ramp& share, bool tangent, ContactSums<36>& sums) {
  const FacePlace& place = at.place;
  const int free = place.free;
  std::array<Weights, 3> of_bend; // nodes in u
  for (std::size_t k = 0; k < 3; ++k) of_bend[k] << Eigen::Vector<double, 6>::Zero(), -place.bend[k];
  Eigen::Matrix<double, 2, 36> moves = Eigen::Matrix<double, 2, 36>::Zero();
  for (int k = 0; k < free; ++k)
    moves.row(k) =
        -dot(at.across * at.slope.col(k), at.weight.col(0)) - dot(place.normal, at.weight.col(1 + k));
  moves = (at.stiff.inverse() * moves).eval();
  Vector2d rate = Vector2d::Zero();
  for (int k = 0; k < free; ++k) rate[k] = place.slope[static_cast<std::size_t>(k)].dot(field);
  const Row along = rate.transpose() * moves;
  sums.first += (area * barrier.value * share.first) * along.transpose();
  if (!tangent) return;
  const Vector2d c = at.stiff.inverse() * rate / place.distance;
  const Vector3d r = place.distance * place.normal, slopes = at.slope * c;
  Eigen::Matrix<double, 36, 36> twice =
      Eigen::Matrix<double, 36, 36>::Zero(); // of the field, and its transpose
  for (int l = 0; l < free; ++l) {
    Row with = dot(slopes, at.weight.col(1 + l));
    for (int m = 0; m < free; ++m) {
      with += c[m] * dot(r, of_bend[static_cast<std::size_t>(l + m)]);
      const double bend = place.bend[static_cast<std::size_t>(l + m)].dot(field);
      with += (at.bend[static_cast<std::size_t>(l + m)].dot(slopes) - bend) / 2 * moves.row(m);
    }
    twice -= with.transpose() * moves.row(l);
  }
  for (int i = 0; i < 3; ++i) { // dr.dt, of a place that moves
    const Vector3d e = Vector3d::Unit(i);
    Row way = dot(e, at.weight.col(0)) + at.slope.row(i) * moves, slope = Row::Zero();
    for (int k = 0; k < free; ++k) {
      slope += c[k] * dot(e, at.weight.col(1 + k));
      for (int l = 0; l < free; ++l)
        slope += c[k] * at.bend[static_cast<std::size_t>(k + l)][i] * moves.row(l);
    }
    twice -= way.transpose() * slope;
  }
  twice *= barrier.value * share.first;
  twice += barrier.slope * share.first * along.transpose() * dot(place.normal, at.weight.col(0)) +
           barrier.value * share.second / 2 * along.transpose() * along;
  sums.second += area * (twice + twice.transpose());
}

} // namespace

void add_pressed(const Eigen::Vector<double, 6>& own, const FaceNodes& other, const FacePlace& place,
                 const Eigen::Vector<double, 6>& field, double area, const BarrierEnergy& barrier,
                 const Ramp& share, const Scatter& scatter, ContactSums<36>& sums) {
  const double part = area * share.value;
  sums.any = true;
  sums.energy += part * barrier.value;
  if (!scatter.residual && !scatter.tangent) return;
  const NearestPlace at(own, other, place);
  const Vector3d& n = place.normal;
  for (int a = 0; a < 12; ++a) sums.first.segment<3>(3 * a) += (part * barrier.slope * at.weight(a, 0)) * n;
  if (place.free > 0 && (share.first != 0 || share.second != 0))
    add_fading(at, field, area, barrier, share, scatter.tangent != nullptr, sums);
  if (!scatter.tangent) return;
  Eigen::Matrix<double, 9, 9> second = part * barrier.slope * at.second();
  second.topLeftCorner<3, 3>() += part * barrier.curvature * n * n.transpose();
  Eigen::Matrix<double, 9, 36> of_nodes; // second, with nodes
  for (int b = 0; b < 12; ++b)
    of_nodes.middleCols<3>(3 * b) = at.weight(b, 0) * second.leftCols<3>() +
                                    at.weight(b, 1) * second.middleCols<3>(3) +
                                    at.weight(b, 2) * second.rightCols<3>();
  for (int a = 0; a < 12; ++a)
    sums.second.middleRows<3>(3 * a) += at.weight(a, 0) * of_nodes.topRows<3>() +
                                        at.weight(a, 1) * of_nodes.middleRows<3>(3) +
                                        at.weight(a, 2) * of_nodes.bottomRows<3>();
}

} // namespace dielast::fem
