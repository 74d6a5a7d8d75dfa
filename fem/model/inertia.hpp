// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/dofs.hpp"

#include <Eigen/SparseCore>

namespace dielast::fem {

class ElementBlock;

/// What resists acceleration and velocity: M (kg) and C (N s/m), per equation, held ones too; symmetric, both
/// triangles stored. Empty where nothing has a mass.
struct Inertia {
  Eigen::SparseMatrix<double> mass, damping;

  /// The sum over blocks; `dofs` numbered.
  static Inertia of(const std::vector<std::unique_ptr<ElementBlock>>& blocks, const DofMap& dofs);
  bool empty() const { return mass.nonZeros() == 0 && damping.nonZeros() == 0; }
};

/// Displacements of a state per equation, m, and of rotations their vectors, rad.
Eigen::VectorXd position(const State& state, const DofMap& dofs);

/// The forces of inertia and damping in a trial state as a linear function of the displacement d since the
/// last accepted time, force = start + stiffness . d (see GeneralisedAlpha): the gradient of a quadratic
/// energy.
class InertialForce {
 public:
  /// Precondition: state.motion is there and the scheme is not static.
  InertialForce(const Inertia& inertia, const DofMap& dofs, const State& state);

  const Eigen::VectorXd& force() const { return force_; } ///< per equation, N
  double energy() const { return energy_; }               ///< J
  /// The motion that a converged trial state has arrived with; its unbalanced forces follow from the balance.
  Motion arrived() const;

 private:
  const Motion& start_;
  GeneralisedAlpha scheme_;
  Eigen::VectorXd step_, acceleration_, velocity_, force_;
  double energy_ = 0;
};

} // namespace dielast::fem
