// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/equilibrium.hpp"
#include "fem/paths/load_path.hpp"

namespace dielast::fem {

// What has no mass follows what has one, and the loads, at once: it is in equilibrium at every time, and a
// path of equilibria may lose its stability and end while the masses hardly move.

/// Equilibrium::stiffness() at the free displacements that have no mass, 0 at all other equations; empty
/// where every free displacement has one.
Eigen::VectorXd stiffness_without_mass(const Equilibrium& equilibrium, const State& state);

/// The state with its masses held where they are: what pulls at them is not looked at (Motion::held), and the
/// inertia of a time step that is far too short for them to move stiffens them. They keep their velocities.
State with_masses_held(const Equilibrium& equilibrium, State state);

/// A state that was found with the masses held, at the motion that `before` has.
State with_masses_let_go(const Model& model, State state, const State& before);

/// `path` with the masses held where `state` has them. `equilibrium` must outlive the path.
LoadPath with_masses_held(const Equilibrium& equilibrium, LoadPath path, const State& state);

/// Where every displacement has a mass: lets voltages, pressures of chambers and scalars follow loads that
/// have jumped from those of `before` to those of `state`, while the displacements stay as they are, to the
/// digit. The pressures that keep a volume change by what the jump would accelerate it with. False where
/// there are none that do.
[[nodiscard]] bool follow(Equilibrium& equilibrium, const State& before, State& state);

// What is held moves as the loads want it: its masses know their accelerations from the beginning.

/// The motion with which a state sets out at s, at a break, in a step of `duration`: what is free without
/// acceleration, what is held with that of the way that `path` leads it on over half of `ds`, or none where
/// it sets out with another velocity than its own, with a jerk; tied nodes as their masters.
std::shared_ptr<const Motion> motion_setting_out(const Model& model, const State& state, const LoadPath& path,
                                                 double s, double ds, double duration);

/// That motion where loads have jumped, with the accelerations of what is held and of bodies there.
std::shared_ptr<const Motion> motion_behind_jump(Equilibrium& equilibrium, const State& state);

/// The motion of a state that a step has led to, as long as `ds` of the load factor and up to s, with the
/// accelerations of its own time: of what is held those that `path` gives it, of bodies that carry masses on
/// arms what the forces on them do, J^T (M a + C v + r) = 0. The scheme's own lag behind, and go up and down
/// where time steps change.
std::shared_ptr<const Motion> motion_now(const Model& model, const State& state, const LoadPath& path,
                                         double s, double ds, double duration);

/// What the supports' impulses do, J, where what they hold sets out with another velocity than its own in the
/// step from `before` to `after`: sum of J (v0 + v1)/2 over the held equations, J = [M (v1 - v0)], less the
/// part of it that the forces at `after` already have, as of film that is struck with it; 0 elsewhere.
double work_of_impulses(const Model& model, const State& before, const State& after);

/// The time step that a motion sets out with: backward Euler where Motion::acceleration is zero, as in what
/// is free; what is held goes on with that acceleration.
GeneralisedAlpha first_step_of_motion(double dt);

} // namespace dielast::fem
