#include "cases/measurement.hpp"

#include "post/reductions.hpp"

#include <algorithm>
#include <limits>

namespace dielast::cases {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double component(const Eigen::Vector3d& vector, const std::optional<int>& along) {
  return along ? vector[*along] : vector.norm();
}

/// A part of the energy balance; the reader admits no other word.
double energy(const std::string& part, const fem::EnergyBalance& balance, const fem::Work& work) {
  const fem::EnergyParts& stored = balance.record().window.back().energy;
  if (part == "electrical_work") return work.electrical;
  if (part == "mechanical_work") return work.mechanical;
  if (part == "dissipated") return work.dissipated;
  if (part == "released") return work.released;
  if (part == "stored") return balance.stored();
  if (part == "elastic") return stored.elastic;
  if (part == "branches") return stored.branches;
  if (part == "electric") return stored.electric;
  if (part == "wrinkle_regularisation") return stored.regularised;
  return balance.error(work);
}

} // namespace

Measured::Measured(const Device& device, fem::Equilibrium& equilibrium, const fem::State& at,
                   const fem::EnergyBalance& balance)
    : state(at), samples(device.model.sample(at)), extremes(samples),
      charges(device.model.charges(at, false)), energy(balance), work(balance.work()) {
  equilibrium.internal_force(at, internal_force);
}

const std::vector<char>& Measurement::film_at(const std::string& place) const {
  const auto [entry, fresh] = film_at_.try_emplace(place);
  if (!fresh) return entry->second;
  const meshing::CellBlock& film = *device_.mesh.triangles();
  std::vector<char>& near = entry->second;
  near.assign(static_cast<std::size_t>(film.size()), 0);
  const auto cells = device_.mesh.cell_sets.find(place);
  if (cells != device_.mesh.cell_sets.end() &&
      &device_.mesh.blocks[static_cast<std::size_t>(cells->second.block)] == &film) {
    for (const int cell : cells->second.cells) near[static_cast<std::size_t>(cell)] = 1;
    return near;
  }
  const auto& nodes = device_.mesh.node_sets.at(place);
  for (int cell = 0; cell < film.size(); ++cell)
    near[static_cast<std::size_t>(cell)] = std::ranges::any_of(
        film.cell(cell), [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); });
  return near;
}

Eigen::Vector3d Measurement::position(const std::string& place, const fem::State& state) const {
  const auto& nodes = device_.mesh.node_sets.at(place);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int n : nodes)
    sum += device_.mesh.nodes[static_cast<std::size_t>(n)] + state.displacement[static_cast<std::size_t>(n)];
  return sum / static_cast<double>(nodes.size());
}

double Measurement::length(const Quantity& quantity, const fem::State& state) const {
  if (!quantity.between[0].empty()) {
    const auto between = [&](const fem::State& at) {
      return component(position(quantity.between[1], at) - position(quantity.between[0], at), quantity.along);
    };
    // Positive as drawn; negative when the places have passed each other.
    return between(device_.model.initial_state()) < 0 ? -between(state) : between(state);
  }
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const int n : device_.mesh.node_sets.at(quantity.of)) {
    const Eigen::Vector3d x =
        device_.mesh.nodes[static_cast<std::size_t>(n)] + state.displacement[static_cast<std::size_t>(n)];
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return component(high - low, quantity.along);
}

double Measurement::evaluate(const Quantity& quantity, const Measured& measured) const {
  const fem::State& state = measured.state;
  switch (quantity.kind) {
  case QuantityKind::distance:
  case QuantityKind::size:
    return length(quantity, state);
  case QuantityKind::elongation:
  case QuantityKind::growth: {
    if (quantity.since.empty()) {
      const double drawn = length(quantity, device_.model.initial_state());
      return length(quantity, state) / drawn - 1;
    }
    const auto rest = rest_lengths.find(quantity.name);
    return rest == rest_lengths.end() ? unknown : length(quantity, state) / rest->second - 1;
  }
  case QuantityKind::displacement: {
    const Eigen::Vector3d drawn = position(quantity.of, device_.model.initial_state());
    return component(position(quantity.of, state) - drawn, quantity.along);
  }
  case QuantityKind::radius: {
    const Eigen::Vector3d centre = position(quantity.of, state);
    const auto& nodes = device_.mesh.node_sets.at(quantity.of);
    double sum = 0;
    for (const int n : nodes)
      sum += (device_.mesh.nodes[static_cast<std::size_t>(n)] +
              state.displacement[static_cast<std::size_t>(n)] - centre)
                 .norm();
    return sum / static_cast<double>(nodes.size());
  }
  case QuantityKind::force: {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int n : device_.mesh.node_sets.at(quantity.of))
      for (int c = 0; c < 3; ++c) {
        const int e = device_.model.dofs.equation(n, c);
        if (e >= device_.model.dofs.free_count()) sum[c] += measured.internal_force[e] - state.dead_force[e];
      }
    return component(sum, quantity.along);
  }
  case QuantityKind::stretch: {
    const double drawn = length(quantity, device_.model.initial_state());
    return length(quantity, state) / drawn *
           case_.film.prestretch.at(static_cast<std::size_t>(*quantity.along));
  }
  case QuantityKind::nominal_stress: {
    const std::vector<char>& near = film_at(quantity.of);
    double sum = 0, volume = 0;
    for (const fem::MembraneSample& s : measured.samples.film) {
      if (!near[static_cast<std::size_t>(s.cell)]) continue;
      sum += s.volume * s.F.row(*quantity.along).dot(s.S.col(*quantity.along));
      volume += s.volume;
    }
    return volume > 0 ? sum / volume : unknown;
  }
  case QuantityKind::energy:
    return energy(quantity.of, measured.energy, measured.work);
  case QuantityKind::capacitance:
  case QuantityKind::charge: {
    const auto& names = device_.model.electrodes;
    const auto electrode =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), quantity.of) - names.begin());
    return (quantity.kind == QuantityKind::charge ? measured.charges.charge
                                                  : measured.charges.capacitance)[electrode];
  }
  case QuantityKind::extreme: {
    const auto extremum = measured.extremes.find(quantity.of, quantity.extreme);
    return extremum ? extremum->value : unknown;
  }
  }
  return unknown;
}

std::vector<double> Measurement::all(const Measured& measured) const {
  std::vector<double> values;
  for (const Quantity& quantity : case_.quantities) values.push_back(evaluate(quantity, measured));
  return values;
}

void Measurement::step_ended(const std::string& step, const Measured& measured) {
  for (const Quantity& quantity : case_.quantities)
    if (is_relative(quantity.kind) && quantity.since == step)
      rest_lengths[quantity.name] = length(quantity, measured.state);
}

} // namespace dielast::cases
