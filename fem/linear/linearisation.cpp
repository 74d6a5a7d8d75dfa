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

std::vector<const std::vector<double>*> Linearisation::terms() const {
  std::vector<const std::vector<double>*> all{&stiffness_.values, &damping_, &mass_};
  for (const auto& each : relaxing_) all.push_back(&each);
  return all;
}

std::vector<Linearisation::Complex> Linearisation::weights(Complex s) const {
  std::vector<Complex> all{1, s, s * s};
  for (const double rate : rates_) all.push_back(s / (s + rate));
  return all;
}

std::array<std::vector<double>, 2> Linearisation::varying(Complex s) const {
  if (!rates_vary_) return {};
  const Assembler& assembler = equilibrium_.assembler();
  return {assembler.relaxation(state_, [s](double rate) { return (s / (s + rate)).real(); }),
          assembler.relaxation(state_, [s](double rate) { return (s / (s + rate)).imag(); })};
}

std::vector<Linearisation::Complex> Linearisation::dynamic_stiffness(Complex s) const {
  std::vector<Complex> Z(stiffness_.values.size());
  const auto matrices = terms();
  const auto factors = weights(s);
  for (std::size_t k = 0; k < matrices.size(); ++k)
    for (std::size_t i = 0; i < Z.size(); ++i) Z[i] += factors[k] * (*matrices[k])[i];
  const auto [storage, loss] = varying(s);
  for (std::size_t i = 0; i < storage.size(); ++i) Z[i] += Complex(storage[i], loss[i]);
  return Z;
}

} // namespace dielast::fem
