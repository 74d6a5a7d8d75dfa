// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/model.hpp"

#include <Eigen/SparseCholesky>

namespace dielast::fem {

/// Voltages of electrodes with a sheet resistance, at fixed displacements: current along the film charges it,
///   dq_a/dt + g_a V_a + sum_b L_ab V_b = 0  away from the terminals,  q_a = C_a(u) V_a,
/// the Galerkin form of div(G J C^-1 grad V) = d/dt[(eps/H) f V] + leakage in the unstretched film, with C,
/// f = det C, J = sqrt f, and G = 1/resistance of the current surface (see SheetPoint for what is lumped).
/// Charges go by the state's TimeScheme: frozen, they stay where they are; relaxed, they are in steady flow,
/// which without leakage leaves no drop.
///
/// With d = Phi - V, which vanishes at the terminals, and s = dt/a0 this is
///   (C + s (g + L)) d = (C + s g) Phi - (h1 q_n + h2 q_{n-1})/a0,
/// linear in Phi. Where Phi is not given, the electrode's balance of charge (Model::surplus) determines it:
/// what the rows above sum up to.
class SheetConduction {
 public:
  /// Throws std::invalid_argument, naming the electrode, where a part of a sheet is not connected to its
  /// terminal. The model must outlive this.
  explicit SheetConduction(const Model& model);

  /// Sets the drops, and the voltages of sheets that follow from charges or circuits. Returns the largest
  /// change of a voltage over the largest voltage; not finite where there is no solution.
  double solve(State& state);

 private:
  void require_connections(const SheetMatrices& matrices) const;
  Eigen::SparseMatrix<double> inner(const SheetMatrices& matrices, const materials::TimeScheme& scheme) const;
  Eigen::VectorXd spread(const Eigen::VectorXd& sources) const;
  /// d = per_volt Phi - past
  struct Drops {
    Eigen::VectorXd per_volt, past;
  };
  void set_drops(State& state, const Drops& drops) const;
  void follow_charge(State& state, std::size_t electrode, const Eigen::VectorXd& capacitance,
                     const Drops& drops) const;
  Eigen::VectorXd voltages(const State& state) const;
  const SheetPoint& point(Eigen::Index a) const {
    return model_.ports.sheet_points()[static_cast<std::size_t>(a)];
  }
  std::size_t electrode_of(Eigen::Index a) const { return static_cast<std::size_t>(point(a).electrode); }

  const Model& model_;
  std::vector<int> inner_; ///< per point, its number among those away from terminals; SheetMap::none at one
  int inner_count_ = 0;
  bool leaks_ = false;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

} // namespace dielast::fem
