// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/model.hpp"

namespace dielast::fem {

// Tied nodes move with the unknowns q of their masters: x = x(q), v = J v_q, and a = J a_q + c with the
// centripetal c = omega x (omega x arm).

/// Accelerations of tied nodes (count() entries, m/s^2), those of all others as they are: of their masters
/// and centripetal ones by `velocity`.
void carry_accelerations(const DofMap& dofs, const State& state, const Eigen::VectorXd& velocity,
                         Eigen::VectorXd& acceleration);

/// Gives bodies that carry their own mass, and what is tied to them, the accelerations that the forces on
/// them at the motion's time do, Motion::acceleration_now: J^T (M (J a_q + c) + C v + d |v| v + r) = 0. A
/// scheme for each tied node by itself knows nothing of c where a motion sets out, and goes up and down
/// behind that.
void accelerate_bodies(const Model& model, const State& state, Motion& motion);

} // namespace dielast::fem
