// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/linearisation.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr std::size_t most_rates = 16; ///< that are worth a matrix each
constexpr double same_rate = 1e-6;     ///< relative

State relaxed(State state) {
  state.scheme = materials::TimeScheme::relaxed();
  state.motion_scheme = {};
  return state;
}

std::vector<double> or_zeros(const std::vector<double>& values, std::size_t size) {
  return values.empty() ? std::vector<double>(size, 0.0) : values;
}

} // namespace

Linearisation::Linearisation(Equilibrium& equilibrium, const State& state)
    : equilibrium_(equilibrium), state_(relaxed(state)) {
  Assembler& assembler = equilibrium.assembler();
  assembler.tangent(state_);
  stiffness_ = assembler.matrix();
  mass_ = or_zeros(assembler.mass(state_), stiffness_.values.size());
  damping_ = or_zeros(assembler.damping(state_), stiffness_.values.size());
  find_rates();
  add_ports();
}

void Linearisation::find_rates() {
  const auto same = [](double a, double b) { return std::abs(a - b) <= same_rate * b; };
  const Assembler& assembler = equilibrium_.assembler();
  assembler.relaxation(state_, [&](double rate) {
    if (!rates_vary_ && std::ranges::none_of(rates_, [&](double known) { return same(rate, known); }))
      rates_.push_back(rate);
    rates_vary_ = rates_.size() > most_rates;
    return 0.0;
  });
  if (rates_vary_) rates_.clear();
  std::ranges::sort(rates_);
  for (const double known : rates_)
    relaxing_.push_back(assembler.relaxation(state_, [&](double rate) { return same(rate, known); }));
}

void Linearisation::add_ports() {
  Charges charges = model().charges(state_, true);
  for (Eigen::VectorXd& coupling : charges.coupling) model().dofs.gather(state_, coupling);
  for (std::size_t p = 0; p < model().port_count(); ++p) {
    Port port{state_.supply[p], charges.coupling[p].head(stiffness_.size), charges.capacitance[p]};
    if (const Chamber* chamber = model().chamber_of(p))
      port.capacitance = chamber->compliance(charges.charge[p], state_.voltage[p]);
    if (flows(port.supply)) {
      const Circuit& circuit = *model().circuit_of(p);
      const double drop = state_.source[p] - state_.voltage[p];
      const bool limited = std::abs(drop) > circuit.current_limit * circuit.resistance;
      port.conductance = limited || is_isolated(port.supply) ? 0 : 1 / circuit.resistance;
      port.leakage = circuit.leakage;
    }
    ports_.push_back(std::move(port));
  }
}

std::vector<Linearisation::Complex> Linearisation::dynamic_stiffness(Complex s) const {
  const std::size_t size = stiffness_.values.size();
  std::vector<Complex> Z(size);
  for (std::size_t i = 0; i < size; ++i) Z[i] = stiffness_.values[i] + s * damping_[i] + s * s * mass_[i];
  for (std::size_t r = 0; r < rates_.size(); ++r) {
    const Complex factor = s / (s + rates_[r]);
    for (std::size_t i = 0; i < size; ++i) Z[i] += factor * relaxing_[r][i];
  }
  if (!rates_vary_) return Z;
  const Assembler& assembler = equilibrium_.assembler();
  const auto storage = assembler.relaxation(state_, [s](double rate) { return (s / (s + rate)).real(); });
  const auto loss = assembler.relaxation(state_, [s](double rate) { return (s / (s + rate)).imag(); });
  for (std::size_t i = 0; i < size; ++i) Z[i] += Complex(storage[i], loss[i]);
  return Z;
}

} // namespace dielast::fem
