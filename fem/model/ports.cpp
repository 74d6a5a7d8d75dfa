// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/ports.hpp"

#include <algorithm>
#include <span>
#include <stdexcept>

namespace dielast::fem {

namespace {

/// h1 x_n + h2 x_{n-1} of an internal variable.
double past(const State& state, std::size_t place) {
  const History& history = *state.history;
  const double before = history.before.empty() ? 0 : history.before[place];
  return state.scheme.h1 * history.now[place] + state.scheme.h2 * before;
}

} // namespace

SheetMap::SheetMap(std::vector<const Sheet*> sheets) : sheets_(std::move(sheets)) {
  for (const Sheet* sheet : sheets_)
    if (sheet && !(sheet->resistance > 0)) throw std::invalid_argument("a sheet resistance must be positive");
}

int SheetMap::claim(int electrode, int node) {
  const bool is_port = electrode >= 0 && electrode < std::ssize(sheets_); // not passive
  const Sheet* sheet = is_port ? sheets_[static_cast<std::size_t>(electrode)] : nullptr;
  if (!sheet) return none;
  const auto [place, is_new] = numbers_.try_emplace({electrode, node}, static_cast<int>(points_.size()));
  if (is_new)
    points_.push_back({.electrode = electrode,
                       .node = node,
                       .at_terminal = std::ranges::find(sheet->terminal, node) != sheet->terminal.end(),
                       .resistance = sheet->resistance});
  return place->second;
}

std::size_t Ports::electrode(std::string_view name) const {
  const auto found = std::ranges::find_if(
      ports_, [name](const Port& port) { return port.is_electrode() && port.name == name; });
  return static_cast<std::size_t>(found - ports_.begin());
}

std::size_t Ports::chamber() const {
  return static_cast<std::size_t>(std::ranges::find(ports_, false, &Port::is_electrode) - ports_.begin());
}

bool Ports::any_circuit() const {
  return std::ranges::any_of(ports_, [](const Port& port) { return port.circuit.has_value(); });
}

bool Ports::any_sheet() const {
  return std::ranges::any_of(ports_, [](const Port& port) { return port.sheet.has_value(); });
}

void Ports::place_history(std::size_t first, const std::vector<std::unique_ptr<ElementBlock>>& blocks) {
  first_ = first;
  std::vector<const Sheet*> sheets;
  for (const Port& port : ports_) sheets.push_back(port.sheet ? &*port.sheet : nullptr);
  SheetMap map(std::move(sheets));
  for (const auto& block : blocks) block->place_sheets(map);
  sheet_points_ = map.points();
}

std::size_t Ports::circuit_place(std::size_t port) const {
  const auto before = std::span(ports_).first(port);
  return first_ + static_cast<std::size_t>(std::ranges::count_if(
                      before, [](const Port& other) { return other.circuit.has_value(); }));
}

std::size_t Ports::sheet_place() const { return circuit_place(ports_.size()); }

void Ports::weigh_sheets(const Eigen::VectorXd& capacitances) {
  for (std::size_t e = 0; e < ports_.size(); ++e) {
    const Port& port = ports_[e];
    if (!port.sheet) continue;
    double whole = 0;
    bool connected = false;
    for (std::size_t a = 0; a < sheet_points_.size(); ++a)
      if (sheet_points_[a].electrode == static_cast<int>(e)) {
        whole += capacitances[static_cast<Eigen::Index>(a)];
        connected = connected || sheet_points_[a].at_terminal;
      }
    if (!connected)
      throw std::invalid_argument("the terminal of electrode \"" + port.name +
                                  "\" touches no element of the film that it covers");
    for (std::size_t a = 0; a < sheet_points_.size(); ++a)
      if (SheetPoint& point = sheet_points_[a]; point.electrode == static_cast<int>(e)) {
        const double capacitance = capacitances[static_cast<Eigen::Index>(a)];
        point.charge_scale = capacitance * port.sheet->voltage_scale;
        point.leakage = port.circuit ? port.circuit->leakage * capacitance / whole : 0;
      }
  }
}

double Ports::sheet_voltage(const State& state, std::size_t point) const {
  const double drop = state.sheet_drop.size() > 0 ? state.sheet_drop[static_cast<Eigen::Index>(point)] : 0;
  return state.voltage[static_cast<std::size_t>(sheet_points_[point].electrode)] - drop;
}

Circuit::Drawn Ports::taken(const State& state, std::size_t port) const {
  const Circuit& circuit = *ports_[port].circuit;
  const double voltage = state.voltage[port];
  return state.supply[port] == Supply::leak ? circuit.leaked(voltage, state.scheme)
                                            : circuit.drawn(state.source[port], voltage, state.scheme);
}

double Ports::leak(const State& state, std::size_t port) const {
  const auto& circuit = ports_[port].circuit;
  if (!circuit) return 0;
  double current = circuit->leakage * state.voltage[port];
  for (Eigen::Index a = 0; a < state.sheet_drop.size(); ++a)
    if (const SheetPoint& point = sheet_points_[static_cast<std::size_t>(a)];
        static_cast<std::size_t>(point.electrode) == port)
      current -= point.leakage * state.sheet_drop[a];
  return current;
}

double Ports::given_charge(const State& state, std::size_t port) const {
  if (const auto& chamber = ports_[port].chamber)
    return chamber->filled(state.charge[port], state.voltage[port]);
  if (!flows(state.supply[port])) return state.charge[port];
  double given = ports_[port].circuit->charge_scale * past(state, circuit_place(port)) / state.scheme.a0;
  for (Eigen::Index a = 0; a < state.sheet_drop.size(); ++a) // less leaks where the voltage is lower
    if (const SheetPoint& point = sheet_points_[static_cast<std::size_t>(a)];
        static_cast<std::size_t>(point.electrode) == port)
      given += state.scheme.dt / state.scheme.a0 * point.leakage * state.sheet_drop[a];
  return given;
}

void Ports::take_off_given(const State& state, double least_volume, Charges& charges) const {
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    if (state.supply[p] == Supply::voltage) continue;
    const double given = given_charge(state, p);
    charges.charge[p] -= given;
    if (const auto& chamber = ports_[p].chamber)
      charges.capacitance[p] += chamber->compliance(std::max(given, least_volume), state.voltage[p]);
    if (!flows(state.supply[p])) continue;
    const Circuit::Drawn more = taken(state, p);
    charges.charge[p] += more.charge;
    charges.capacitance[p] += more.capacitance;
  }
}

double Ports::supply_energy(const State& state) const {
  double energy = 0;
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    if (state.supply[p] == Supply::voltage) continue;
    const auto& chamber = ports_[p].chamber;
    energy += chamber ? chamber->energy(state.charge[p], state.voltage[p])
                      : given_charge(state, p) * state.voltage[p];
    if (flows(state.supply[p])) energy -= taken(state, p).energy;
  }
  return energy;
}

std::optional<std::size_t> Ports::closed_chamber(const State& state) const {
  for (std::size_t p = 0; p < ports_.size(); ++p)
    if (ports_[p].chamber && state.supply[p] == Supply::charge) return p;
  return std::nullopt;
}

void Ports::remember(const std::vector<double>& charges, std::vector<double>& internal) const {
  for (std::size_t p = 0; p < ports_.size(); ++p)
    if (const auto& circuit = ports_[p].circuit)
      internal[circuit_place(p)] = charges[p] / circuit->charge_scale;
}

void Ports::remember_sheets(const State& state, const Eigen::VectorXd& capacitances,
                            std::vector<double>& internal) const {
  for (std::size_t a = 0; a < sheet_points_.size(); ++a)
    internal[sheet_place() + a] =
        capacitances[static_cast<Eigen::Index>(a)] * sheet_voltage(state, a) / sheet_points_[a].charge_scale;
}

Eigen::VectorXd Ports::sheet_charges(const State& state) const {
  Eigen::VectorXd charges(static_cast<Eigen::Index>(sheet_points_.size()));
  for (std::size_t a = 0; a < sheet_points_.size(); ++a)
    charges[static_cast<Eigen::Index>(a)] =
        sheet_points_[a].charge_scale * state.history->now[sheet_place() + a];
  return charges;
}

Eigen::VectorXd Ports::past_sheet_charges(const State& state) const {
  Eigen::VectorXd charges(static_cast<Eigen::Index>(sheet_points_.size()));
  for (std::size_t a = 0; a < sheet_points_.size(); ++a)
    charges[static_cast<Eigen::Index>(a)] =
        sheet_points_[a].charge_scale * past(state, sheet_place() + a) / state.scheme.a0;
  return charges;
}

} // namespace dielast::fem
