// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/dofs.hpp"

#include <Eigen/SparseCore>

namespace dielast::fem {

class ElementBlock;

/// What resists acceleration and velocity, M a + C v + d |v| v: M (kg), C (N s/m) and d (N s^2/m^2), per
/// equation, held ones too; the matrices symmetric, both triangles stored. Empty where nothing has a mass.
struct Inertia {
  Eigen::SparseMatrix<double> mass, damping;
  Eigen::VectorXd drag;

  /// The sum over blocks; `dofs` numbered.
  static Inertia of(const std::vector<std::unique_ptr<ElementBlock>>& blocks, const DofMap& dofs);
  bool empty() const { return mass.nonZeros() == 0 && damping.nonZeros() == 0 && drag.isZero(0); }
  /// C v + d |v| v, N.
  Eigen::VectorXd resistance(const Eigen::VectorXd& velocity) const {
    return damping * velocity + Eigen::VectorXd(drag.array() * velocity.array().abs() * velocity.array());
  }
};

/// Displacements of a state per equation, m, and of rotations their vectors, rad, full turns counted.
Eigen::VectorXd position(const State& state, const DofMap& dofs);

/// What moments do work on: lets the coordinates of spins go on from those `before`, at the state `from`, by
/// the spins to the state `to`, rad. About one axis that is position(); about several no function of a state.
void follow_spins(const DofMap& dofs, const State& from, const State& to, const Eigen::VectorXd& before,
                  Eigen::VectorXd& coordinate);

/// The forces of inertia, damping and drag in a trial state as a function of the displacement since the last
/// accepted time (see GeneralisedAlpha): the gradient of an energy, quadratic but for the drag's share.
class InertialForce {
 public:
  /// Precondition: state.motion is there and the scheme is not static.
  InertialForce(const Inertia& inertia, const DofMap& dofs, const State& state);

  const Eigen::VectorXd& force() const { return force_; } ///< per equation, N
  double energy() const { return energy_; }               ///< J
  /// What drag adds to the tangent's diagonal, N/m.
  Eigen::VectorXd drag_stiffness() const;
  /// The motion that a converged trial state has arrived with; its unbalanced forces follow from the balance.
  Motion arrived() const;

 private:
  const Inertia& inertia_;
  const Motion& start_;
  GeneralisedAlpha scheme_;
  Eigen::VectorXd step_, acceleration_, velocity_, force_;
  double energy_ = 0;
};

} // namespace dielast::fem
