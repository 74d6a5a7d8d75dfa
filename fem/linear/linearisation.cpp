// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/linearisation.hpp"

#include "fem/linear/rigid_motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dielast::fem {

namespace {

constexpr double propped = 1e-12;      ///< over the squared frequency of single unknowns
constexpr std::size_t most_rates = 16; ///< that are worth a matrix each
constexpr double same_rate = 1e-6;     ///< relative
constexpr int most_nodes = 32;         ///< between which rates that vary are interpolated
constexpr double interpolation_error = 1e-15;

State without_schemes(State state) {
  state.scheme = materials::TimeScheme::relaxed();
  state.motion_scheme = {};
  return state;
}

std::vector<double> or_zeros(const std::vector<double>& values, std::size_t size) {
  return values.empty() ? std::vector<double>(size, 0.0) : values;
}

} // namespace

Linearisation::Linearisation(Equilibrium& equilibrium, const State& state, bool drifts)
    : equilibrium_(equilibrium), state_(without_schemes(state)) {
  Assembler& assembler = equilibrium.assembler();
  assembler.tangent(state_);
  stiffness_ = assembler.matrix();
  mass_ = or_zeros(assembler.mass(state_), stiffness_.values.size());
  damping_ = or_zeros(assembler.damping(state_), stiffness_.values.size());
  if (drifts) {
    const double shift = propped * free_mass(equilibrium, state_).fastest;
    for (std::size_t i = 0; i < mass_.size(); ++i) stiffness_.values[i] += shift * mass_[i];
  }
  find_rates();
  add_ports();
}

void Linearisation::find_rates() {
  const auto same = [](double a, double b) { return std::abs(a - b) <= same_rate * b; };
  const Assembler& assembler = equilibrium_.assembler();
  double low = std::numeric_limits<double>::infinity(), high = 0;
  assembler.relaxation(state_, [&](double rate) {
    low = std::min(low, rate);
    high = std::max(high, rate);
    if (!rates_vary_ && std::ranges::none_of(rates_, [&](double known) { return same(rate, known); }))
      rates_.push_back(rate);
    rates_vary_ = rates_.size() > most_rates;
    return 0.0;
  });
  if (rates_vary_) {
    rates_.clear();
    interpolate_rates(low, high);
  }
  std::ranges::sort(rates_);
  for (const double known : rates_) // a rate between two that it is close to is one of the first
    relaxing_.push_back(assembler.relaxation(state_, [&](double rate) {
      const auto first = std::ranges::find_if(rates_, [&](double other) { return same(rate, other); });
      return first != rates_.end() && *first == known ? 1.0 : 0.0;
    }));
}

/// Between Chebyshev's points of the rates' logarithms. The pole of s/(s + rate), s = i omega, lies pi/2
/// beside them, so that the error falls with the power of the ellipse through it (Bernstein).
void Linearisation::interpolate_rates(double low, double high) {
  const double middle = std::log(low * high) / 2, half = std::log(high / low) / 2 * (1 + same_rate);
  const double pole = std::numbers::pi / 2 / half, ellipse = pole + std::hypot(1.0, pole);
  const double count = std::ceil(std::log(interpolation_error) / -std::log(ellipse));
  if (!(low > 0) || !(count <= most_nodes)) return;
  const int size = static_cast<int>(count);
  std::vector<double> logarithms;
  for (int j = 0; j < size; ++j) {
    logarithms.push_back(middle + half * std::cos(std::numbers::pi * (j + 0.5) / size));
    nodes_.push_back(std::exp(logarithms.back()));
  }
  for (int j = 0; j < size; ++j)
    of_nodes_.push_back(equilibrium_.assembler().relaxation(state_, [&](double rate) {
      const double at = std::log(rate);
      double share = 1;
      for (int other = 0; other < size; ++other)
        if (other != j)
          share *= (at - logarithms[static_cast<std::size_t>(other)]) /
                   (logarithms[static_cast<std::size_t>(j)] - logarithms[static_cast<std::size_t>(other)]);
      return share;
    }));
}

void Linearisation::add_ports() {
  Charges charges = model().charges(state_, true);
  for (Eigen::VectorXd& coupling : charges.coupling) model().dofs.gather(state_, coupling);
  for (std::size_t p = 0; p < model().ports.size(); ++p) {
    Port port{state_.supply[p], charges.coupling[p].head(stiffness_.size), charges.capacitance[p]};
    if (const auto& chamber = model().ports[p].chamber)
      port.capacitance = chamber->compliance(charges.charge[p], state_.voltage[p]);
    if (flows(port.supply)) {
      const Circuit& circuit = *model().ports[p].circuit;
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
  if (rates_vary_ && nodes_.empty()) return {};
  for (const auto& each : rates_vary_ ? of_nodes_ : relaxing_) all.push_back(&each);
  return all;
}

std::vector<Linearisation::Complex> Linearisation::weights(Complex s) const {
  std::vector<Complex> all{1, s, s * s};
  for (const double rate : rates_vary_ ? nodes_ : rates_) all.push_back(s / (s + rate));
  return all;
}

std::vector<Linearisation::Complex> Linearisation::dynamic_stiffness(Complex s) const {
  const std::size_t size = stiffness_.values.size();
  std::vector<Complex> Z(size);
  if (const auto matrices = terms(); !matrices.empty()) {
    const auto factors = weights(s);
    for (std::size_t k = 0; k < matrices.size(); ++k)
      for (std::size_t i = 0; i < size; ++i) Z[i] += factors[k] * (*matrices[k])[i];
    return Z;
  }
  const Assembler& assembler = equilibrium_.assembler();
  const auto storage = assembler.relaxation(state_, [s](double rate) { return (s / (s + rate)).real(); });
  const auto loss = assembler.relaxation(state_, [s](double rate) { return (s / (s + rate)).imag(); });
  for (std::size_t i = 0; i < size; ++i)
    Z[i] = stiffness_.values[i] + s * damping_[i] + s * s * mass_[i] + Complex(storage[i], loss[i]);
  return Z;
}

} // namespace dielast::fem
