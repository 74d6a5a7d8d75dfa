// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>

#include <map>
#include <utility>
#include <vector>

namespace dielast::fem {

/// An electrode that resists the current along the film. At its terminal it has the electrode's voltage Phi,
/// elsewhere V = Phi - drop (see SheetConduction).
struct Sheet {
  double resistance = 0;     ///< Ohm per square of the current surface, > 0; of both faces together
  std::vector<int> terminal; ///< nodes where it is connected; what is no corner of its film does not count
  double voltage_scale = 1;  ///< V: charges in the history are over this and the drawn capacitance
};

/// One corner of a sheet's film elements: V is linear between corners, and so is V^2 = sum_a N_a V_a^2 in the
/// film's energy, which makes the capacitances lumped: charges q_a = C_a V_a, never a V outside its
/// neighbours' range behind a steep front.
struct SheetPoint {
  int electrode = 0, node = 0;
  bool at_terminal = false;
  double resistance = 0; ///< of its sheet, Ohm
  double leakage = 0;    ///< its part of the leakage of the electrode's circuit, as its capacitance drawn, S
  double charge_scale = 1; ///< C
};

/// Numbers the points of all sheets.
class SheetMap {
 public:
  static constexpr int none = -1;

  /// A sheet for each port, or null. Throws std::invalid_argument for a resistance that is not positive.
  explicit SheetMap(std::vector<const Sheet*> sheets);
  /// Number of an electrode's point at a node; `none` where the electrode is no sheet.
  int claim(int electrode, int node);
  const std::vector<SheetPoint>& points() const { return points_; }

 private:
  std::vector<const Sheet*> sheets_;
  std::map<std::pair<int, int>, int> numbers_;
  std::vector<SheetPoint> points_;
};

/// What the film says of the sheets at a state.
struct SheetMatrices {
  Eigen::VectorXd capacitance;                     ///< C_a = int N_a e (eps/H) f dA0, F
  std::vector<Eigen::Triplet<double>> conductance; ///< L_ab = int grad N_a . G J C^-1 grad N_b dA0, 1/Ohm
};

} // namespace dielast::fem
