// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/inertia.hpp"

#include "fem/model/element_block.hpp"

#include <deque>

namespace dielast::fem {

namespace {

using Triplets = std::deque<Eigen::Triplet<double>>; // hundreds of an element: none of them is moved

void scatter(const std::vector<double>& packed, const std::vector<int>& equations, Triplets& triplets) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < equations.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j, ++at) {
      const int p = equations[i], q = equations[j];
      if (packed[at] == 0 || p == DofMap::absent || q == DofMap::absent) continue;
      triplets.emplace_back(p, q, packed[at]);
      if (i != j) triplets.emplace_back(q, p, packed[at]);
    }
}

} // namespace

Inertia Inertia::of(const std::vector<std::unique_ptr<ElementBlock>>& blocks, const DofMap& dofs) {
  Triplets mass, damping;
  Eigen::VectorXd drag = Eigen::VectorXd::Zero(dofs.count());
  for (const auto& block : blocks) {
    const auto size = static_cast<std::size_t>(block->dofs_per_element());
    std::vector<int> equations(size);
    std::vector<double> packed(size * (size + 1) / 2);
    for (int e = 0; e < block->element_count(); ++e) {
      block->element_equations(e, dofs, equations);
      std::ranges::fill(packed, 0.0);
      block->add_mass(e, packed);
      scatter(packed, equations, mass);
      std::ranges::fill(packed, 0.0);
      block->add_damping(e, packed);
      scatter(packed, equations, damping);
      std::ranges::fill(packed, 0.0);
      block->add_drag(e, std::span(packed).first(size));
      for (std::size_t i = 0; i < size; ++i)
        if (equations[i] != DofMap::absent) drag[equations[i]] += packed[i];
    }
  }
  Inertia inertia{Eigen::SparseMatrix<double>(dofs.count(), dofs.count()),
                  Eigen::SparseMatrix<double>(dofs.count(), dofs.count()), std::move(drag)};
  inertia.mass.setFromTriplets(mass.begin(), mass.end());
  inertia.damping.setFromTriplets(damping.begin(), damping.end());
  return inertia;
}

Eigen::VectorXd position(const State& state, const DofMap& dofs) {
  Eigen::VectorXd position = Eigen::VectorXd::Zero(dofs.count());
  for (int n = 0; n < dofs.node_count(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(n, c); e != DofMap::absent) position[e] = state.displacement[i][c];
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(n, 3 + c); e != DofMap::absent) position[e] = state.angle[i][c];
    if (dofs.tilts(n)) {
      const Eigen::Vector2d along = dofs.tilt_axes()->at(i).transpose() * state.angle[i];
      for (int k = 0; k < 2; ++k) position[dofs.equation(n, DofMap::tilt + k)] = along[k];
    }
  }
  for (int s = 0; s < dofs.scalar_count(); ++s)
    position[dofs.scalar_equation(s)] = state.scalar[static_cast<std::size_t>(s)] / dofs.scalar_unit(s);
  return position;
}

void follow_spins(const DofMap& dofs, const State& from, const State& to, const Eigen::VectorXd& before,
                  Eigen::VectorXd& coordinate) {
  for (int n = 0; n < dofs.node_count(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    const auto go_on = [&](int e, double by) { coordinate[e] = before[e] + by; };
    if (dofs.tilts(n)) {
      const Eigen::Vector2d turn =
          dofs.tilt_axes()->at(i).transpose() * spin_of(from.rotation[i].conjugate() * to.rotation[i]);
      for (int k = 0; k < 2; ++k) go_on(dofs.equation(n, DofMap::tilt + k), turn[k]);
      continue;
    }
    Eigen::Vector3d spin = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(n, 3 + c); e != DofMap::absent) {
        if (spin.isZero()) spin = spin_of(to.rotation[i] * from.rotation[i].conjugate());
        go_on(e, spin[c]);
      }
  }
}

InertialForce::InertialForce(const Inertia& inertia, const DofMap& dofs, const State& state)
    : inertia_(inertia), start_(*state.motion), scheme_(state.motion_scheme),
      step_(position(state, dofs) - start_.position) {
  const auto& s = scheme_;
  const auto force = [&](const Eigen::VectorXd& step) {
    acceleration_ = (step - s.dt * start_.velocity) / (s.beta * s.dt * s.dt) - s.start * start_.acceleration;
    velocity_ = start_.velocity + s.dt * ((1 - s.gamma) * start_.acceleration + s.gamma * acceleration_);
    return Eigen::VectorXd(
        (inertia.mass * ((1 - s.alpha_m) * acceleration_ + s.alpha_m * start_.acceleration) +
         inertia.damping * ((1 - s.alpha_f) * velocity_ + s.alpha_f * start_.velocity) +
         s.alpha_f * start_.unbalanced) /
        (1 - s.alpha_f));
  };
  const Eigen::VectorXd at_start = force(Eigen::VectorXd::Zero(step_.size()));
  const Eigen::VectorXd velocity_at_start = velocity_;
  force_ = force(step_);
  energy_ = (at_start + force_).dot(step_) / 2;
  if (inertia.drag.isZero(0)) return;
  // Drag is the gradient of d |v|^3 / (3 dv/du), as the velocity grows by dv/du for each step, and of a dead
  // force.
  const double growth = s.damping_factor();
  const auto cubed = [](const Eigen::VectorXd& v) { return v.array().abs().cube(); };
  const Eigen::ArrayXd dead = s.alpha_f / (1 - s.alpha_f) * inertia.drag.array() *
                              start_.velocity.array().abs() * start_.velocity.array();
  energy_ += (dead * step_.array() +
              inertia.drag.array() / (3 * growth) * (cubed(velocity_) - cubed(velocity_at_start)))
                 .sum();
  force_.array() += dead + inertia.drag.array() * velocity_.array().abs() * velocity_.array();
}

Eigen::VectorXd InertialForce::drag_stiffness() const {
  return 2 * scheme_.damping_factor() * inertia_.drag.cwiseProduct(velocity_.cwiseAbs());
}

Motion InertialForce::arrived() const {
  // The scheme's accelerations are those of (alpha_f - alpha_m) dt before their times, each of its own step.
  const double lag = scheme_.alpha_f - scheme_.alpha_m;
  const double late = lag / (1 - lag * (1 - start_.step / scheme_.dt));
  return {start_.position + step_,
          velocity_,
          acceleration_,
          -force_,
          acceleration_ + late * (acceleration_ - start_.acceleration),
          scheme_.dt};
}

} // namespace dielast::fem
