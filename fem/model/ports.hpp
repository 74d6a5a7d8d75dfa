// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/chamber.hpp"
#include "fem/model/circuit.hpp"
#include "fem/model/element_block.hpp"
#include "fem/model/sheet.hpp"
#include "fem/model/state.hpp"

#include <optional>
#include <string>
#include <vector>

namespace dielast::fem {

/// An electrode (voltage Phi, charge Q) with what is between it and its source, or what fills a chamber
/// (pressure, volume): the energy E(u, Phi) of a model has the derivative -Q.
struct Port {
  std::string name;
  std::optional<Chamber> chamber{}; ///< without: an electrode
  std::optional<Circuit> circuit{}; ///< of an electrode
  std::optional<Sheet> sheet{};     ///< of an electrode

  bool is_electrode() const { return !chamber; }
};

/// The ports of a model by their numbers, and what these take of their sources at a state: of circuits and
/// sheets the charges are internal variables (State::history), behind those of the blocks.
class Ports {
 public:
  Ports() = default;
  Ports(std::initializer_list<Port> ports) : ports_(ports) {}

  void push_back(Port port) { ports_.push_back(std::move(port)); }
  std::size_t size() const { return ports_.size(); }
  Port& operator[](std::size_t port) { return ports_[port]; }
  const Port& operator[](std::size_t port) const { return ports_[port]; }
  auto begin() const { return ports_.begin(); }
  auto end() const { return ports_.end(); }
  /// Number of the electrode of that name, and of the chamber's port; size() where there is none.
  std::size_t electrode(std::string_view name) const;
  std::size_t chamber() const;
  bool any_circuit() const;
  bool any_sheet() const;
  /// All points of all sheets; the state's drops of voltage are those of these.
  const std::vector<SheetPoint>& sheet_points() const { return sheet_points_; }

  /// Places the internal variables behind the first ones, which are the blocks', of which the sheets' points
  /// are numbered. Throws std::invalid_argument for sheets that cannot be.
  void place_history(std::size_t first, const std::vector<std::unique_ptr<ElementBlock>>& blocks);
  /// One behind the last internal variable.
  std::size_t history_end() const { return sheet_place() + sheet_points_.size(); }
  /// Scales of the charges at the sheets' points, and leakage spread like their capacitances as drawn (F).
  /// Throws std::invalid_argument where a sheet is connected nowhere.
  void weigh_sheets(const Eigen::VectorXd& capacitances);

  /// What an electrode must hold, with what its circuit has drawn, C; the own volume that a chamber of a
  /// given pumped volume must have at the state's pressure, m^3.
  double given_charge(const State& state, std::size_t port) const;
  /// What the circuit of an electrode whose supply `flows` takes over the time step that the state ends.
  Circuit::Drawn taken(const State& state, std::size_t port) const;
  /// What leaks of an electrode, A: under a sheet by the voltages there.
  double leak(const State& state, std::size_t port) const;
  /// Adds what circuits draw to the charges that are held, and takes off what is given; `least_volume`, m^3,
  /// is that below which a chamber's compliance stays as it is.
  void take_off_given(const State& state, double least_volume, Charges& charges) const;
  /// Energy that goes with it: the sum of the integrals of given minus drawn charge over voltage, J.
  double supply_energy(const State& state) const;
  /// Port of the chamber whose pumped volume is given; nothing: there is none, or its pressure is.
  std::optional<std::size_t> closed_chamber(const State& state) const;

  /// Puts the charges that are held, C, into the circuits' internal variables, and into those of the sheets'
  /// points the charges of these capacitances (F) at the state's voltages.
  void remember(const std::vector<double>& charges, std::vector<double>& internal) const;
  void remember_sheets(const State& state, const Eigen::VectorXd& capacitances,
                       std::vector<double>& internal) const;
  /// At the sheets' points in an accepted state, C.
  Eigen::VectorXd sheet_charges(const State& state) const;
  /// (h1 q_n + h2 q_{n-1})/a0 of the charges at the sheets' points, C.
  Eigen::VectorXd past_sheet_charges(const State& state) const;
  /// V at a sheet's point.
  double sheet_voltage(const State& state, std::size_t point) const;

 private:
  std::size_t circuit_place(std::size_t port) const;
  std::size_t sheet_place() const;

  std::vector<Port> ports_;
  std::size_t first_ = 0; ///< internal variable
  std::vector<SheetPoint> sheet_points_;
};

} // namespace dielast::fem
