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
/// (`fresh`) sticks in the first solution of an increment, whatever the force. Where that presses anything of
/// the contact, limits follow, which come down gently: what is not pressed yet slides alike in the smallest
/// increment. Where it presses nothing, a spring that is next to nothing (`loose`) keeps a body from sliding
/// away, as nothing else may.
struct Slider {
  /// Of springs of what stands still, over the barrier's.
  static constexpr double stick = 10;
  /// Of a loose one, over that.
  static constexpr double loose_stick = 1e-7;
  /// Normal force of what touches and is not pressed yet, over the barrier's (stiffness times thickness times
  /// area), and of what is loose.
  static constexpr double light = 1e-9, lighter = light / 2;
  /// Part of all that is pressed above which what is pressed first makes limits come down gently.
  static constexpr double much = 0.1;
  /// What slides has no stiffness along its way; where all of a body does, Newton's method needs some. This
  /// part of force over way makes it converge linearly, and quickly, as the body is much stiffer.
  static constexpr double firmness = 0.01;

  /// Whether a normal force, over the barrier's, is that of something that is pressed.
  static constexpr bool presses(double force) { return force > light; }
  /// Whether what has not been pressed so far is `now`, over the barrier's.
  static constexpr bool is_pressed_first(double before, double now) {
    return before <= light && presses(now);
  }
  /// The force that bounds friction where that was `before` and `now` presses, over the barrier's; `solved`:
  /// in a solution, in which anything of the contact is pressed or not. What did not touch (0) slides from
  /// where it was at the last accepted state.
  static constexpr double bound(double before, double now, bool solved, bool any_is_pressed) {
    if (before == 0) return solved && presses(now) ? now : 0;
    if (presses(before) || (solved && any_is_pressed)) return std::max(now, 2 * light);
    return solved ? lighter : before;
  }
  /// Part of the work of the force at the end of an increment that turns into heat where the normal force has
  /// grown from `then` to the `bound` of that force as it slid: by the trapezoidal rule. What has come off
  /// may have gone far since: nothing is added for it.
  static constexpr double heat_of(double then, double bound) {
    return bound > 2 * light ? (then + bound) / (2 * bound) : 1;
  }

  double stiffness = 0; ///< of the spring, N/m
  double most = 0;      ///< N
  bool fresh = false, loose = false, frozen = false;

  /// Of one whose force, over `force_unit`, N, is written as `force`.
  static Slider of(double stiffness, double friction, double force, double force_unit, bool frozen) {
    return {stiffness, friction * force * force_unit, force == light, force == lighter, frozen};
  }

  struct Response {
    double energy = 0;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    Eigen::Matrix3d tangent = Eigen::Matrix3d::Zero();
  };
  /// Of a spring that is `stretched` by so much along the surface, m, on which `along` projects.
  Response pulled(const Eigen::Vector3d& stretched, const Eigen::Matrix3d& along) const {
    const double k = stiffness * (loose && !frozen ? loose_stick : 1), length = stretched.norm();
    if (most == 0) return {};
    if (frozen || fresh || loose || k * length <= most)
      return {k * length * length / 2, k * stretched, k * along};
    const Eigen::Vector3d direction = stretched / length;
    return {most * (length - most / k / 2), most * direction,
            most / length * (along - (1 - firmness) * direction * direction.transpose())};
  }
  /// The force that it is accepted with, where the limit has become `most_now` if it has had none.
  Eigen::Vector3d kept(const Eigen::Vector3d& stretched, const Eigen::Matrix3d& along,
                       double most_now) const {
    const Eigen::Vector3d force = pulled(stretched, along).force;
    if (!(force.norm() > 0)) return Eigen::Vector3d::Zero();
    return force.normalized() * std::min(fresh || loose ? most_now : force.norm(), force.norm());
  }
};

/// Writes the forces that bound the sliders of a contact, see Slider::bound(). `force(i)`: where that of one
/// is written; `now(i)`: what presses it.
template<class Force, class Now>
void bound_sliders(int count, const Force& force, const Now& now, bool solved) {
  bool any_is_pressed = false;
  for (int i = 0; i < count; ++i) any_is_pressed = any_is_pressed || Slider::presses(now(i));
  for (int i = 0; i < count; ++i) force(i) = Slider::bound(force(i), now(i), solved, any_is_pressed);
}

/// Whether what was not pressed in the last accepted state bears much of all. `bound(i)`: the force that
/// bounds a slider, over `unit(i)`, N; `now(i)`: what presses it, N.
template<class Bound, class Now, class Unit>
bool is_pressed_first(int count, const Bound& bound, const Now& now, const Unit& unit) {
  double first = 0, all = 0;
  for (int i = 0; i < count; ++i) {
    all += now(i);
    if (Slider::is_pressed_first(bound(i), now(i) / unit(i))) first += now(i);
  }
  return first > Slider::much * all;
}

} // namespace dielast::fem
