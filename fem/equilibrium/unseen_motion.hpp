// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/assembler.hpp"

namespace dielast::fem {

/// What a step that takes time and leaves out inertia says of it: the kinetic energy T = 1/2 v^T M v that its
/// motion would have, beside the work 1/2 d^T K d that it takes to move the device as far, d, as it goes in
/// the step. Where the motion is a vibration T / (1/2 d^T K d) is the square of its frequency over the
/// natural one.
struct UnseenMotion {
  double kinetic = 0;       ///< the largest so far, J
  double size = 0;          ///< d^T M d, kg m^2
  Eigen::VectorXd start;    ///< where the step began, per equation, m or rad; empty before the first state
  Eigen::VectorXd farthest; ///< d, per equation, largest by its size

  /// Goes on from one accepted state to the next. Precondition: something has a mass.
  void pass(const Model& model, const State& from, const State& to);
  /// The work, J, about a state; overwrites the assembler's tangent.
  double work(Assembler& assembler, const State& state) const;
};

} // namespace dielast::fem
