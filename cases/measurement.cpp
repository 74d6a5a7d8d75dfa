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

/// sum of eps/h da over an electrode.
double capacitance(const fem::Samples& samples, int electrode) {
  double sum = 0;
  for (const fem::MembraneSample& s : samples.film)
    if (s.electrode == electrode) {
      const double area_ratio_squared = (s.F.transpose() * s.F).determinant();
      sum += s.permittivity * area_ratio_squared * s.volume / (s.thickness * s.thickness);
    }
  return sum;
}

} // namespace

Eigen::Vector3d Measurement::position(const std::string& place, const fem::State& state) const {
  const auto& nodes = device_.mesh.node_sets.at(place);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int n : nodes)
    sum += device_.mesh.nodes[static_cast<std::size_t>(n)] + state.displacement[static_cast<std::size_t>(n)];
  return sum / static_cast<double>(nodes.size());
}

double Measurement::length(const Quantity& quantity, const fem::State& state) const {
  if (quantity.kind == QuantityKind::distance || quantity.kind == QuantityKind::elongation) {
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
  case QuantityKind::capacitance:
  case QuantityKind::charge: {
    const auto& names = device_.model.electrodes;
    const auto electrode = std::find(names.begin(), names.end(), quantity.of) - names.begin();
    const double value = capacitance(measured.samples, static_cast<int>(electrode));
    return quantity.kind == QuantityKind::charge ? value * state.voltage[static_cast<std::size_t>(electrode)]
                                                 : value;
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
