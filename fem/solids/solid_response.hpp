// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "fem/solids/solid_section.hpp"
#include "materials/branches/solid_branch.hpp"

#include <optional>

namespace dielast::fem {

/// A solid's potential per undeformed volume and its derivatives in the components of C (counted as in
/// SolidPotential), the pressure p and the nominal field E0.
struct SolidDensity {
  double value = 0;
  Eigen::Vector<double, 6> in_C;
  double in_p = 0;
  Eigen::Vector3d in_E;
  Eigen::Matrix<double, 6, 6> in_CC;
  Eigen::Vector<double, 6> in_Cp;
  Eigen::Matrix<double, 6, 3> in_CE;
  Eigen::Matrix3d in_EE;
  double in_pp = 0;
};

/// What a solid stores and does at its integration points:
///   Psi(C, p, E0) = W(C) + sum_b Psi_b(C; history) - p (J - 1) - p^2/(2 kappa) - (eps/2) J E0 . C^-1 E0,
/// with W and Psi_b at J^(-2/3) C, so that p is the pressure (positive in compression) that keeps J = 1, or
/// p = -kappa (J - 1) (perturbed Lagrangian). Laws that are compressible by themselves do without p.
class SolidResponse {
 public:
  explicit SolidResponse(const SolidSection& section);

  bool has_pressure() const { return has_pressure_; }
  /// The value is not finite where the law cannot be.
  SolidDensity potential(const State& state, int point, const Eigen::Matrix3d& C, double p,
                         const Eigen::Vector3d& E0, materials::Derivatives wanted) const;
  /// The part of the field alone, -(eps/2) J E0 . C^-1 E0.
  SolidDensity electric(const Eigen::Matrix3d& C, const Eigen::Vector3d& E0) const {
    return electric(C, materials::volume_ratio(C), E0, materials::Derivatives::second);
  }
  /// What relaxed branches resist besides that, by C alone: sum_j weight(rate_j) w_j w_j^T, see
  /// relaxation_spectrum(). Throws std::domain_error where their dashpots flow.
  SolidDensity relaxation(const State& state, int point, const Eigen::Matrix3d& C,
                          const RateWeight& weight) const;
  /// Densities, per undeformed volume; `electric` stays 0: it follows from the charges.
  EnergyParts energies(const State& state, int point, const Eigen::Matrix3d& C, double p) const;
  const materials::Material& material() const { return material_; }

  // --- internal variables: branch by branch, point by point
  int history_size(int points) const { return points * branches() * per_branch; }
  void place_history(int first) { first_ = first; }
  void start_history(int points, std::vector<double>& all) const;
  void advance_history(const State& state, int point, const Eigen::Matrix3d& C,
                       std::vector<double>& all) const;

 private:
  static constexpr int per_branch = 6;

  SolidDensity electric(const Eigen::Matrix3d& C, const materials::SolidPotential& J,
                        const Eigen::Vector3d& E0, materials::Derivatives wanted) const;

  int branches() const { return static_cast<int>(material_.branches.size()); }
  std::size_t place(int point, int branch) const {
    return static_cast<std::size_t>(first_ + (point * branches() + branch) * per_branch);
  }

  materials::Material material_;
  bool has_pressure_;
  double compliance_; ///< 1/kappa, 1/Pa
  int first_ = 0;
};

} // namespace dielast::fem
