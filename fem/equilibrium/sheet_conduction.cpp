// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/sheet_conduction.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace dielast::fem {

namespace {

constexpr int most_corrections = 30; ///< a source at its limit bends the balance of charge once
constexpr double voltage_tolerance = 1e-14;

} // namespace

SheetConduction::SheetConduction(const Model& model) : model_(model) {
  for (const SheetPoint& point : model.ports.sheet_points()) {
    inner_.push_back(point.at_terminal ? SheetMap::none : inner_count_++);
    leaks_ = leaks_ || point.leakage > 0;
  }
  const SheetMatrices matrices = model.sheet_matrices(model.initial_state());
  require_connections(matrices);
  solver_.analyzePattern(inner(matrices, materials::TimeScheme::relaxed()));
}

/// Walks along the sheets from their terminals.
void SheetConduction::require_connections(const SheetMatrices& matrices) const {
  std::vector<std::vector<int>> neighbours(inner_.size());
  for (const auto& entry : matrices.conductance)
    neighbours[static_cast<std::size_t>(entry.row())].push_back(entry.col());
  std::vector<bool> reached(inner_.size(), false);
  std::vector<int> open;
  const auto reach = [&](int point) {
    if (reached[static_cast<std::size_t>(point)]) return;
    reached[static_cast<std::size_t>(point)] = true;
    open.push_back(point);
  };
  for (std::size_t a = 0; a < inner_.size(); ++a)
    if (inner_[a] == SheetMap::none) reach(static_cast<int>(a));
  while (!open.empty()) {
    const int from = open.back();
    open.pop_back();
    for (const int to : neighbours[static_cast<std::size_t>(from)]) reach(to);
  }
  for (std::size_t a = 0; a < inner_.size(); ++a)
    if (!reached[a]) {
      const auto electrode = static_cast<std::size_t>(model_.ports.sheet_points()[a].electrode);
      throw std::invalid_argument("electrode \"" + model_.ports[electrode].name +
                                  "\" has a part that is not connected to its terminal");
    }
}

/// C + s (g + L) away from the terminals; g + L in steady flow.
Eigen::SparseMatrix<double> SheetConduction::inner(const SheetMatrices& matrices,
                                                   const materials::TimeScheme& scheme) const {
  const double share = scheme.is_relaxed() ? 1 : scheme.dt / scheme.a0;
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& entry : matrices.conductance) {
    const int row = inner_[static_cast<std::size_t>(entry.row())];
    const int column = inner_[static_cast<std::size_t>(entry.col())];
    if (row >= 0 && column >= 0) entries.emplace_back(row, column, share * entry.value());
  }
  for (std::size_t a = 0; a < inner_.size(); ++a) {
    if (inner_[a] < 0) continue;
    const double stored = scheme.is_relaxed() ? 0 : matrices.capacitance[static_cast<Eigen::Index>(a)];
    entries.emplace_back(inner_[a], inner_[a], stored + share * model_.ports.sheet_points()[a].leakage);
  }
  Eigen::SparseMatrix<double> matrix(inner_count_, inner_count_);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Solution for sources at all points, those at terminals left out; 0 there.
Eigen::VectorXd SheetConduction::spread(const Eigen::VectorXd& sources) const {
  Eigen::VectorXd inner(inner_count_), all = Eigen::VectorXd::Zero(sources.size());
  for (std::size_t a = 0; a < inner_.size(); ++a)
    if (inner_[a] >= 0) inner[inner_[a]] = sources[static_cast<Eigen::Index>(a)];
  const Eigen::VectorXd solution = solver_.solve(inner);
  for (std::size_t a = 0; a < inner_.size(); ++a)
    if (inner_[a] >= 0) all[static_cast<Eigen::Index>(a)] = solution[inner_[a]];
  return all;
}

void SheetConduction::set_drops(State& state, const Drops& drops) const {
  for (Eigen::Index a = 0; a < drops.past.size(); ++a)
    state.sheet_drop[a] = drops.per_volt[a] * state.voltage[electrode_of(a)] - drops.past[a];
}

/// Phi at which an electrode has no surplus of charge.
void SheetConduction::follow_charge(State& state, std::size_t electrode, const Eigen::VectorXd& capacitance,
                                    const Drops& drops) const {
  const bool has_circuit = flows(state.supply[electrode]);
  const double share = has_circuit ? state.scheme.dt / state.scheme.a0 : 0;
  double& voltage = state.voltage[electrode];
  for (int correction = 0; correction <= most_corrections; ++correction) {
    set_drops(state, drops);
    double surplus = -model_.ports.given_charge(state, electrode), slope = 0;
    for (Eigen::Index a = 0; a < capacitance.size(); ++a) {
      if (electrode_of(a) != electrode) continue;
      surplus += capacitance[a] * (voltage - state.sheet_drop[a]);
      slope += capacitance[a] * (1 - drops.per_volt[a]) - share * point(a).leakage * drops.per_volt[a];
    }
    if (has_circuit) {
      const Circuit::Drawn drawn = model_.ports.taken(state, electrode);
      surplus += drawn.charge;
      slope += drawn.capacitance;
    }
    const double change = -surplus / slope;
    voltage += change;
    if (!(std::abs(change) > voltage_tolerance * std::abs(voltage))) return;
  }
}

Eigen::VectorXd SheetConduction::voltages(const State& state) const {
  Eigen::VectorXd V(state.sheet_drop.size());
  for (Eigen::Index a = 0; a < V.size(); ++a)
    V[a] = model_.ports.sheet_voltage(state, static_cast<std::size_t>(a));
  return V;
}

double SheetConduction::solve(State& state) {
  const auto points = static_cast<Eigen::Index>(inner_.size());
  if (state.sheet_drop.size() == 0) state.sheet_drop = Eigen::VectorXd::Zero(points);
  const Eigen::VectorXd before = voltages(state);
  const bool relaxed = state.scheme.is_relaxed();
  if (relaxed && !leaks_) {
    state.sheet_drop.setZero();
  } else {
    const SheetMatrices matrices = model_.sheet_matrices(state);
    solver_.factorize(inner(matrices, state.scheme));
    if (solver_.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    Eigen::VectorXd sources = relaxed ? Eigen::VectorXd::Zero(points) : matrices.capacitance;
    const double share = relaxed ? 1 : state.scheme.dt / state.scheme.a0;
    for (Eigen::Index a = 0; a < points; ++a) sources[a] += share * point(a).leakage;
    const Drops drops{spread(sources), relaxed ? Eigen::VectorXd::Zero(points)
                                               : spread(model_.ports.past_sheet_charges(state))};
    for (std::size_t p = 0; p < model_.ports.size(); ++p)
      if (model_.ports[p].sheet && state.supply[p] != Supply::voltage)
        follow_charge(state, p, matrices.capacitance, drops);
    set_drops(state, drops);
  }
  const Eigen::VectorXd after = voltages(state);
  const double largest = after.lpNorm<Eigen::Infinity>();
  return largest > 0 ? (after - before).lpNorm<Eigen::Infinity>() / largest : 0;
}

} // namespace dielast::fem
