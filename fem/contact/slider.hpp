// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>

namespace dielast::fem {

/// Coulomb's friction of what is pressed on a surface at one point: where it stands still it is held by a
/// stiff spring along the surface, to an anchor; where the spring's force would exceed `most` the anchor
/// slides. `most` is friction times a normal force that is given (lagged potential), so that the tangent is
/// symmetric: that of the last accepted state, then of the solution with it, until these agree (see
/// Equilibrium). The tangent of what slides is a little firmer than the derivative (a body that slides as a
/// whole would have none).
///
/// Accepted states are in balance with their anchors where they are (`frozen`). What has just touched
/// (`fresh`) is held by a weak spring for an increment, whatever the force: nothing else may keep a body from
/// sliding away.
struct Slider {
  /// Of springs of what stands still, over the barrier's.
  static constexpr double stick = 10;
  /// Over that, where it has just touched.
  static constexpr double fresh_stick = 1e-4;
  /// Normal force of what touches and is not pressed yet, over the barrier's (stiffness times thickness times
  /// area).
  static constexpr double light = 1e-9;
  /// What slides has no stiffness along its way; where all of a body does, Newton's method needs some. This
  /// part of force over way makes it converge linearly, and quickly, as the body is much stiffer.
  static constexpr double firmness = 0.01;

  /// Whether a normal force, over the barrier's, is that of something that was pressed before.
  static constexpr bool is_bounded(double force) { return force > light; }
  /// The force that bounds friction of what was, where this one presses it.
  static constexpr double bound(double force) { return std::max(force, 2 * light); }

  double stiffness = 0; ///< of the spring, N/m
  double most = 0;      ///< N
  bool fresh = false, frozen = false;

  struct Response {
    double energy = 0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Matrix3d tangent = Eigen::Matrix3d::Zero();
  };
  /// Of a spring that is `stretched` by so much along the surface, m, on which `along` projects.
  Response pulled(const Eigen::Vector3d& stretched, const Eigen::Matrix3d& along) const {
    const double k = stiffness * (fresh && !frozen ? fresh_stick : 1), length = stretched.norm();
    if (most == 0 && !frozen) return {};
    if (frozen || fresh || k * length <= most) return {k * length * length / 2, k * stretched, k * along};
    const Eigen::Vector3d direction = stretched / length;
    return {most * (length - most / k / 2), most * direction,
            most / length * (along - (1 - firmness) * direction * direction.transpose())};
  }
  /// The force that it is accepted with, where the limit has become `most_now` if it is fresh.
  Eigen::Vector3d kept(const Eigen::Vector3d& stretched, const Eigen::Matrix3d& along,
                       double most_now) const {
    const Eigen::Vector3d force = pulled(stretched, along).force;
    if (!(force.norm() > 0)) return Eigen::Vector3d::Zero();
    return force.normalized() * std::min(fresh ? most_now : force.norm(), force.norm());
  }
};

} // namespace dielast::fem
