// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/complex_solver.hpp"
#include "fem/equilibrium/equilibrium.hpp"

#include <complex>

namespace dielast::fem {

/// A model about a relaxed equilibrium (prestretched, charged, under its dead forces), for small motions
/// exp(s t) of everything:
///   Z(s) du - B dPhi = df,  Z = K + sum_r K_r s/(s + rate_r) + s C + s^2 M,  dQ = B^T du + C_el dPhi,
/// and per port what its supply says: dPhi given, dQ given, s dQ + G dPhi = (dU - dPhi)/R of its circuit, or
/// s dQ + G dPhi = 0 of one that is isolated but for its leak.
/// K: tangent at fixed voltages with the dashpots relaxed; K_r: what branches that relax at rate_r add to it
/// at once (see Relaxation). Matrices in the pattern of the assembler's.
class Linearisation {
 public:
  using Complex = std::complex<double>;

  /// Throws std::domain_error where branches are not relaxed or wrinkled. `equilibrium` must outlive this.
  /// `drifts`: nothing holds the model, but a little of its mass as stiffness, 1e-12 of the squared frequency
  /// of single unknowns: else Z would be singular where it moves slowly.
  Linearisation(Equilibrium& equilibrium, const State& state, bool drifts = false);

  const Model& model() const { return equilibrium_.model(); }
  const SparseSymmetric& stiffness() const { return stiffness_; } ///< K, N/m
  const std::vector<double>& mass() const { return mass_; }       ///< M, kg; zeros where there is none
  const std::vector<double>& damping() const { return damping_; } ///< C, N s/m
  /// Rates of relaxation, 1/s, ascending, and what belongs to them; none where `rates_vary`: the rates of
  /// nominal dashpots go with the stretch, and so with the place.
  const std::vector<double>& rates() const { return rates_; }
  const std::vector<std::vector<double>>& relaxing() const { return relaxing_; }
  bool rates_vary() const { return rates_vary_; }
  /// Z(s), N/m.
  std::vector<Complex> dynamic_stiffness(Complex s) const;
  /// Real matrices T_k and functions of s of which Z(s) is the sum, K first. Where rates vary, s/(s + rate)
  /// is interpolated between some of them, to 1e-14; empty where they are too far apart for that.
  std::vector<const std::vector<double>*> terms() const;
  std::vector<Complex> weights(Complex s) const;

  /// Per port: what is given, dQ/du (C/m, of the free equations), capacitance (F), 1/R (0 where the source is
  /// at its current limit, or not connected) and G (S). Of a chamber likewise with pressure and volume.
  struct Port {
    Supply supply{};
    Eigen::VectorXd coupling;
    double capacitance = 0, conductance = 0, leakage = 0;
  };
  const std::vector<Port>& ports() const { return ports_; }

 private:
  void find_rates();
  void interpolate_rates(double low, double high);
  void add_ports();

  Equilibrium& equilibrium_;
  State state_;
  SparseSymmetric stiffness_;
  std::vector<double> mass_, damping_, rates_;
  std::vector<std::vector<double>> relaxing_;
  bool rates_vary_ = false;
  std::vector<double> nodes_; ///< where rates vary, those between which they are interpolated
  std::vector<std::vector<double>> of_nodes_;
  std::vector<Port> ports_;
};

} // namespace dielast::fem
