// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/analyses/measurement.hpp"

#include "cases/analyses/analysis.hpp"
#include "cases/analyses/forces.hpp"
#include "cases/analyses/positions.hpp"
#include "cases/case/quantities.hpp"
#include "fem/linear/modal.hpp"
#include "fem/model/contact_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::cases {

namespace {

/// The same state as its branches let it move slowly.
fem::State relaxed(fem::State state) {
  if (state.history) state.scheme = materials::TimeScheme::relaxed();
  for (fem::Supply& supply : state.supply)
    if (supply == fem::Supply::circuit) supply = fem::Supply::voltage; // the source keeps it
  return state;
}

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double component(const Eigen::Vector3d& vector, const std::optional<int>& along) {
  return along ? vector[*along] : vector.norm();
}

/// A part of the energy balance; the reader admits no other word.
double energy(const std::string& part, const fem::EnergyBalance& balance) {
  const fem::EnergyParts& stored = balance.parts();
  const fem::Work& work = balance.work();
  if (part == "electrical_work") return work.electrical;
  if (part == "mechanical_work") return work.mechanical;
  if (part == "dissipated") return work.dissipated;
  if (part == "released") return work.released;
  if (part == "source_work") return work.source();
  if (part == "resistance_heat") return work.resistance;
  if (part == "leak_heat") return work.leak;
  if (part == "stored") return balance.stored();
  if (part == "elastic") return stored.elastic;
  if (part == "branches") return stored.branches;
  if (part == "electric") return stored.electric;
  if (part == "kinetic") return stored.kinetic;
  if (part == "wrinkle_regularisation") return stored.regularised;
  return balance.error();
}

} // namespace

Measured::Measured(const Device& device, fem::Equilibrium& solver, const fem::State& at,
                   const fem::EnergyBalance& balance, bool with_fields)
    : equilibrium(solver), state(at), samples(with_fields ? device.model.sample(at) : fem::Samples{}),
      extremes(samples), charges(device.model.charges(at, false)), energy(balance) {
  equilibrium.internal_force(at, reaction);
  Eigen::VectorXd dead = at.dead_force;
  device.model.dofs.gather(at, dead);
  reaction -= dead;
}

Measurement::Measurement(const Case& one, const Device& device) : case_(one), device_(device) {
  const fem::Samples drawn = device.model.sample(device.model.initial_state());
  int written = 0; // by the user, who counts no others
  for (const Quantity& quantity : one.quantities) {
    written += !quantity.standard;
    const auto refuse = [&](const char* key, const std::string& message) {
      const std::string where = fmt::format("quantity[{}].{}", written, key);
      throw CaseError({{case_.where(where), where, message}});
    };
    if (quantity.kind == QuantityKind::value)
      readings_[quantity.name] = readings_of(quantity, fmt::format("quantity[{}]", written), drawn);
    if (quantity.kind == QuantityKind::displacement && quantity.point) {
      const auto found = elements_at(Eigen::Vector3d(quantity.point->data()), device.mesh);
      if (found.empty()) refuse("point", "there is no film; coordinates are those of the film as drawn");
      points_[quantity.name] = found.front();
    }
    if (quantity.kind == QuantityKind::film_force && !std::ranges::count(film_at(quantity.of), 1))
      refuse("of", "no film meets this place, so none pulls on it");
    if (quantity.kind == QuantityKind::radius && device.mesh.cells_of(quantity.of, device.mesh.film()))
      refuse("of", fmt::format("found \"{}\": an area has no radius; give its edge, whose nodes have one",
                               quantity.of));
    if (quantity.kind == QuantityKind::radial_stretch)
      readings_[quantity.name] = readings_at(quantity.of, device.mesh, drawn);
    if (quantity.kind == QuantityKind::stretch)
      prestretch_[quantity.name] = prestretch_between(one, device, quantity.between, *quantity.along).value();
  }
}

std::vector<FilmReading> Measurement::readings_of(const Quantity& quantity, const std::string& key,
                                                  const fem::Samples& drawn) const {
  const std::string where = key + (quantity.point ? ".point" : ".place");
  const auto fail = [&](const char* message) { throw CaseError({{case_.where(where), where, message}}); };
  std::vector<FilmReading> readings;
  if (quantity.point) {
    readings = readings_at(Eigen::Vector3d(quantity.point->data()), device_.mesh, drawn);
  } else {
    readings = readings_in(quantity.place, device_.mesh, drawn);
    if (!readings.empty()) return readings;
    readings = readings_at(quantity.place, device_.mesh, drawn);
  }
  if (readings.empty()) fail("there is no film; coordinates are those of the film as drawn");
  const auto film = [&](const FilmReading& reading) {
    return std::pair(device_.film_parts[static_cast<std::size_t>(reading.cell)],
                     drawn.film[static_cast<std::size_t>(reading.first)].electrode);
  };
  for (const FilmReading& reading : readings)
    if (film(reading) != film(readings[0]))
      fail(
          "the edge of an electrode or of a film is there, where a field has two values; give a point beside "
          "it, or a part of the film");
  return readings;
}

const std::vector<char>& Measurement::film_at(const std::string& place) const {
  const auto [entry, fresh] = film_at_.try_emplace(place);
  if (!fresh) return entry->second;
  const meshing::CellBlock& film = *device_.mesh.film();
  std::vector<char>& near = entry->second;
  near.assign(static_cast<std::size_t>(film.size()), 0);
  if (const std::vector<int>* cells = device_.mesh.cells_of(place, &film)) {
    for (const int cell : *cells) near[static_cast<std::size_t>(cell)] = 1;
    return near;
  }
  const auto& nodes = device_.mesh.node_sets.at(place);
  for (int cell = 0; cell < film.size(); ++cell)
    near[static_cast<std::size_t>(cell)] = std::ranges::any_of(
        film.cell(cell), [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); });
  return near;
}

double Measurement::length(const Quantity& quantity, const fem::State& state) const {
  if (!quantity.between[0].empty()) {
    const auto between = [&](const fem::State& at) {
      return component(centroid(device_.mesh, quantity.between[1], at) -
                           centroid(device_.mesh, quantity.between[0], at),
                       quantity.along);
    };
    // Positive as drawn; negative when the places have passed each other.
    return between(device_.model.initial_state()) < 0 ? -between(state) : between(state);
  }
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const int n : device_.mesh.node_sets.at(quantity.of)) {
    const Eigen::Vector3d x = position(device_.mesh, n, state);
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  return component(high - low, quantity.along);
}

double Measurement::displacement(const Quantity& quantity, const fem::State& state) const {
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  if (quantity.point) {
    const ElementPoint& at = points_.at(quantity.name);
    const auto nodes = device_.mesh.film()->cell(at.cell);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      moved +=
          at.shape[static_cast<Eigen::Index>(a)] * state.displacement[static_cast<std::size_t>(nodes[a])];
  } else {
    moved = centroid(device_.mesh, quantity.of, state) -
            centroid(device_.mesh, quantity.of, device_.model.initial_state());
  }
  return quantity.along == along_gravity ? moved.dot(case_.gravity.down()) : component(moved, quantity.along);
}

/// NaN where the state is not at rest.
Measurement::Flexibility Measurement::flexibility(const std::string& place, int along,
                                                  const Measured& measured) const {
  const Eigen::Vector3d axis = along == along_gravity ? case_.gravity.down() : Eigen::Vector3d::Unit(along);
  const fem::DofMap& dofs = device_.model.dofs;
  const auto& nodes = device_.mesh.node_sets.at(place);
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(dofs.count());
  for (const int node : nodes)
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(node, c); e != fem::DofMap::absent)
        unit[e] += axis[c] / static_cast<double>(nodes.size());
  unit = (dofs.jacobian(measured.state).transpose() * unit).eval();
  Flexibility found{{}, unknown};
  if (unit.isZero() || !measured.may_rest || !unrest(measured.equilibrium, measured.state).empty() ||
      !measured.equilibrium.factor(relaxed(measured.state)))
    return found;
  measured.equilibrium.tangent().solve(unit, found.displacement);
  found.own = unit.dot(found.displacement);
  return found;
}

/// With the charge Q = C(u) Phi the electrode pulls with Phi^2/2 dC/du; that moves the place by Phi^2/2 times
/// the flexibility's product with dC/du, and the force that takes it back is that over its own. Capacitance
/// and length are those as drawn: a strip free across itself has 1/2, one of held width 1.
double Measurement::coupling(const Quantity& quantity, const Measured& measured) const {
  const Flexibility give = flexibility(quantity.place, *quantity.along, measured);
  if (std::isnan(give.own)) return unknown;
  const std::size_t e = electrode(quantity.of);
  fem::State one_volt = measured.state;
  one_volt.voltage[e] = 1;
  one_volt.sheet_drop.setZero();
  fem::Charges charges = device_.model.charges(one_volt, true);
  device_.model.dofs.gather(one_volt, charges.coupling[e]);
  const double force =
      charges.coupling[e].head(give.displacement.size()).dot(give.displacement) / 2 / give.own;
  const double drawn = device_.model.charges(device_.model.initial_state(), false).capacitance[e];
  return force * quantity.length / drawn;
}

/// NaN where nothing has a mass, or the state is not at rest.
double Measurement::modal_stiffness(const Quantity& quantity, const Measured& measured) const {
  if (!measured.may_rest || !unrest(measured.equilibrium, measured.state).empty()) return unknown;
  const auto modes = fem::vibration_modes(measured.equilibrium, measured.state, {.count = quantity.mode});
  if (!modes || std::ssize(*modes) < quantity.mode) return unknown;
  return (*modes)[static_cast<std::size_t>(quantity.mode) - 1].stiffness;
}

std::size_t Measurement::electrode(const std::string& name) const {
  const auto& names = device_.model.electrodes;
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
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
    const auto rest = references.find(quantity.name);
    return rest == references.end() ? unknown : length(quantity, state) / rest->second - 1;
  }
  case QuantityKind::displacement: {
    const double moved = displacement(quantity, state);
    if (quantity.since.empty()) return moved;
    const auto rest = references.find(quantity.name);
    return rest == references.end() ? unknown : moved - rest->second;
  }
  case QuantityKind::swelling: {
    double largest = -std::numeric_limits<double>::infinity();
    for (const int n : device_.mesh.node_sets.at(quantity.of))
      largest = std::max(largest, state.displacement[static_cast<std::size_t>(n)][*quantity.along]);
    return largest;
  }
  case QuantityKind::angle: {
    const auto master = static_cast<std::size_t>(device_.mesh.node_sets.at(quantity.of).front());
    return fem::spin_of(state.rotation[master])[*quantity.along];
  }
  case QuantityKind::moment: {
    const int master = device_.mesh.node_sets.at(quantity.of).front();
    const int e = device_.model.dofs.equation(master, 3 + *quantity.along);
    return device_.model.dofs.is_held(e) ? measured.reaction[e] : 0.0;
  }
  case QuantityKind::radius: {
    if (case_.dimension == fem::Dimension::axisymmetric)
      return centroid(device_.mesh, quantity.of, state).x();
    const Eigen::Vector3d centre = centroid(device_.mesh, quantity.of, state);
    const auto& nodes = device_.mesh.node_sets.at(quantity.of);
    double sum = 0;
    for (const int n : nodes) sum += (position(device_.mesh, n, state) - centre).norm();
    return sum / static_cast<double>(nodes.size());
  }
  case QuantityKind::force:
    return component(support_force(device_, quantity.of, measured.reaction), quantity.along);
  case QuantityKind::film_force:
    return component(film_force(device_, quantity.of, measured.equilibrium, state), quantity.along);
  case QuantityKind::contact_force:
    return fem::contact_force(device_.model, state, quantity.of);
  case QuantityKind::contact_pressure:
    return largest_contact_pressure(device_, quantity.of, state);
  case QuantityKind::stretch: {
    const double drawn = length(quantity, device_.model.initial_state());
    return length(quantity, state) / drawn * prestretch_.at(quantity.name);
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
    return energy(quantity.of, measured.energy);
  case QuantityKind::capacitance:
    return device_.model.capacitance(state, electrode(quantity.of));
  case QuantityKind::charge:
    return measured.charges.charge[electrode(quantity.of)];
  case QuantityKind::current:
  case QuantityKind::pressure:
  case QuantityKind::volume:
  case QuantityKind::pumped_volume: {
    const std::size_t electrodes = device_.model.electrodes.size();
    if (quantity.kind == QuantityKind::pressure) return state.voltage[electrodes];
    if (quantity.kind == QuantityKind::volume) return measured.charges.charge[electrodes];
    if (quantity.kind == QuantityKind::pumped_volume)
      return device_.model.chambers[0].pumped(measured.charges.charge[electrodes], state.voltage[electrodes]);
    const std::size_t e = electrode(quantity.of);
    const fem::Circuit* circuit = device_.model.circuit_of(e);
    const fem::Supply supply = state.supply[e];
    if (!circuit || supply == fem::Supply::charge) return unknown;
    if (supply == fem::Supply::circuit) return circuit->current(state.source[e], state.voltage[e]);
    return circuit->leakage * state.voltage[e]; // without time what leaks
  }
  case QuantityKind::stiffness:
    return 1 / flexibility(quantity.of, *quantity.along, measured).own;
  case QuantityKind::coupling:
    return coupling(quantity, measured);
  case QuantityKind::natural_frequency:
    return std::sqrt(modal_stiffness(quantity, measured)); // NaN where that is negative
  case QuantityKind::modal_stiffness:
    return modal_stiffness(quantity, measured);
  case QuantityKind::radial_stretch:
    return mean(readings_.at(quantity.name), measured.samples,
                [](const fem::MembraneSample& sample, const FilmReading& reading) {
                  return (sample.F * reading.drawn.head<2>().normalized()).norm();
                });
  case QuantityKind::value:
    return mean(readings_.at(quantity.name), measured.samples,
                [&](const fem::MembraneSample& sample, const auto&) {
                  return post::film_value(sample, quantity.of);
                });
  case QuantityKind::fin_force:
    return fin_load(quantity, state).force;
  case QuantityKind::thrust:
    return fin_load(quantity, state).thrust;
  case QuantityKind::fin_power:
    return fin_load(quantity, state).power;
  case QuantityKind::margin: // told at the end of a run
  case QuantityKind::peak:   // of the others, see all()
  case QuantityKind::mean:
    return unknown;
  case QuantityKind::extreme: {
    const auto extremum = measured.extremes.find(quantity.of, quantity.extreme);
    return extremum ? extremum->value : unknown;
  }
  }
  return unknown;
}

FinLoad Measurement::fin_load(const Quantity& quantity, const fem::State& state) const {
  const auto fin = std::ranges::find(case_.fins, quantity.of, &Fin::name) - case_.fins.begin();
  return load_on(device_.fins[static_cast<std::size_t>(fin)], device_.model, state);
}

std::vector<double> Measurement::all(const Measured& measured) {
  std::vector<double> values;
  for (const Quantity& quantity : case_.quantities) values.push_back(evaluate(quantity, measured));
  for (std::size_t q = 0; q < values.size(); ++q)
    if (const Quantity& quantity = case_.quantities[q]; is_of_course(quantity.kind))
      values[q] = value_so_far(references, quantity,
                               values[static_cast<std::size_t>(&subject(quantity) - case_.quantities.data())],
                               measured.state.time);
  return values;
}

const Quantity& Measurement::subject(const Quantity& quantity) const {
  return *std::ranges::find(case_.quantities, quantity.of, &Quantity::name);
}

void Measurement::pass(const Measured& measured) {
  for (const Quantity& quantity : case_.quantities)
    if (is_of_course(quantity.kind))
      value_so_far(references, quantity, evaluate(subject(quantity), measured), measured.state.time);
}

bool Measurement::follows_course() const {
  return std::ranges::any_of(case_.quantities,
                             [](const Quantity& quantity) { return is_of_course(quantity.kind); });
}

bool Measurement::follows_fields() const {
  return std::ranges::any_of(case_.quantities, [this](const Quantity& quantity) {
    if (!is_of_course(quantity.kind)) return false;
    const QuantityKind kind = subject(quantity).kind;
    return kind == QuantityKind::extreme || reads_film(kind);
  });
}

void Measurement::step_ended(const std::string& step, const Measured& measured) {
  for (const Quantity& quantity : case_.quantities) {
    if (quantity.since != step || step.empty()) continue;
    if (quantity.kind == QuantityKind::mean)
      begin_mean(references, quantity, measured.state.time);
    else
      references[quantity.name] = quantity.kind == QuantityKind::displacement
                                      ? displacement(quantity, measured.state)
                                      : length(quantity, measured.state);
  }
}

} // namespace dielast::cases
