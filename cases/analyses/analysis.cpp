// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/analyses/analysis.hpp"

#include "cases/analyses/positions.hpp"
#include "cases/case/quantities.hpp"
#include "fem/linear/modal.hpp"
#include "fem/paths/instability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::cases {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Change that counts as none, over what is of order one: internal variables, voltages, the extent.
constexpr double still = 1e-4;

bool flows(const fem::Model& model, const fem::State& state) {
  if (!state.history) return false;
  fem::State rest = state;
  rest.scheme = materials::TimeScheme::relaxed();
  const std::vector<double>& now = state.history->now;
  const std::vector<double> end = model.advanced_history(rest)->now;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (std::abs(end[i] - now[i]) > still * std::max(1.0, std::abs(now[i]))) return true;
  return false;
}

bool conducts(fem::Equilibrium& equilibrium, const fem::State& state) {
  if (state.sheet_drop.size() == 0) return false;
  fem::State rest = state;
  rest.scheme = materials::TimeScheme::relaxed();
  equilibrium.conduct(rest);
  double largest = 0;
  for (std::size_t e = 0; e < equilibrium.model().electrodes.size(); ++e)
    largest = std::max(largest, std::abs(state.voltage[e]));
  largest = std::max(largest, state.sheet_drop.lpNorm<Eigen::Infinity>());
  return (rest.sheet_drop - state.sheet_drop).lpNorm<Eigen::Infinity>() > still * largest;
}

/// Whether what has a mass would go on: to where its forces balance, and beyond as far as its kinetic energy
/// carries it there.
bool moves(fem::Equilibrium& equilibrium, const fem::State& state) {
  if (!state.motion) return false;
  const Eigen::Index free = equilibrium.model().dofs.free_count();
  fem::State at = state;
  fem::Balance balance;
  equilibrium.balance(at, balance);
  const Eigen::VectorXd velocity = state.motion->velocity.head(free);
  const Eigen::VectorXd momentum = (equilibrium.model().inertia.mass * state.motion->velocity).head(free);
  if (!equilibrium.factor(at)) return !momentum.isZero(0);
  Eigen::VectorXd step, swing;
  equilibrium.tangent().solve(-balance.force.head(free), step);
  equilibrium.tangent().solve(momentum, swing);
  const double kinetic = momentum.dot(velocity);                                               // twice
  const double seconds = kinetic > 0 ? std::sqrt(std::abs(momentum.dot(swing)) / kinetic) : 0; // 1/omega
  return equilibrium.step_size(step) + seconds * equilibrium.step_size(velocity) > still;
}

Analysis modes(const Device& device, fem::Equilibrium& equilibrium, fem::State state, const Step& step) {
  const std::vector<double> held = device.model.charges(state, false).charge;
  for (std::size_t e = 0; e < device.model.electrodes.size(); ++e) {
    if (step.control == Control::charge) {
      state.charge[e] = held[e];
      state.supply[e] = fem::Supply::charge;
    } else if (state.supply[e] == fem::Supply::charge) { // a source takes up at the electrode's voltage
      state.supply[e] = fem::Supply::voltage;
    }
  }
  const auto found = fem::vibration_modes(equilibrium, state, {.count = step.count});
  if (!found) throw AnalysisError("no modes found: the device is at a critical point");
  Analysis analysis{.kind = step.kind,
                    .step = step.name,
                    .columns = {"mode[1]", "frequency[Hz]", "angular_frequency[rad/s]", "stiffness[1/s^2]"}};
  for (const fem::VibrationMode& mode : *found) {
    const double number = static_cast<double>(analysis.rows.size()) + 1;
    analysis.rows.push_back(
        {number, mode.frequency() / (2 * std::numbers::pi), mode.frequency(), mode.stiffness});
    std::vector<Eigen::Vector3d> shape = fem::displacements(device.model.dofs, state, mode.shape);
    double largest = 0;
    for (const Eigen::Vector3d& u : shape) largest = std::max(largest, u.norm());
    std::vector<Eigen::Vector3d> spin = fem::spins(device.model.dofs, state, mode.shape);
    for (auto* vectors : {&shape, &spin})
      for (Eigen::Vector3d& u : *vectors) u /= largest > 0 ? largest : 1;
    analysis.shapes.push_back({mode.stiffness > 0 ? fmt::format("mode {:.0f}, {:.6g} Hz", number,
                                                                mode.frequency() / (2 * std::numbers::pi))
                                                  : fmt::format("mode {:.0f}, unstable", number),
                               std::move(shape), std::move(spin)});
  }
  return analysis;
}

void append_polar(std::vector<double>& row, std::complex<double> value) {
  row.push_back(std::abs(value));
  row.push_back(std::arg(value) / degree);
}

/// The voltage about which the sources of the driven electrodes swing; 0 where they differ.
double common_bias(const Device& device, const fem::State& at_rest, const std::vector<std::size_t>& driven) {
  const auto source = [&](std::size_t port) {
    return device.model.circuit_of(port) ? at_rest.source[port] : at_rest.voltage[port];
  };
  const double bias = source(driven.front());
  return std::ranges::all_of(driven, [&](std::size_t port) { return source(port) == bias; }) ? bias : 0;
}

Analysis harmonic(const Case& one, const Device& device, fem::Equilibrium& equilibrium,
                  const fem::State& state, const Step& step) {
  const Quantity& quantity = *response_quantity(one, step.response_of);
  Analysis analysis{
      .kind = step.kind,
      .step = step.name,
      .of = quantity.name,
      .columns = {"frequency[Hz]",
                  fmt::format("{}_per_volt[{}/V]", quantity.name, unit_of(quantity, one.quantities)),
                  quantity.name + "_phase[deg]"}};
  const std::vector<std::size_t> driven = driven_ports(one, step.driven);
  for (const std::size_t port : driven) {
    const std::string& name = analysis.driven.emplace_back(one.electrodes[port].name);
    const std::string of = one.electrodes.size() > 1 ? "_" + name : "";
    analysis.columns.push_back(fmt::format("voltage{}_per_volt[V/V]", of));
    analysis.columns.push_back(fmt::format("voltage{}_phase[deg]", of));
  }
  for (const char* of_all :
       {"admittance[S]", "admittance_phase[deg]", "impedance[Ohm]", "impedance_phase[deg]"})
    analysis.columns.emplace_back(of_all);
  const fem::State at_rest = operating_point(device, state);
  const double bias = common_bias(device, at_rest, driven);
  if (bias != 0)
    analysis.columns.push_back(
        fmt::format("{}_per_squared_volt[{}/V^2]", quantity.name, unit_of(quantity, one.quantities)));
  const std::vector<double> hertz = frequencies(step.sweep);
  std::vector<double> omega = hertz;
  for (double& w : omega) w *= 2 * std::numbers::pi;
  const Eigen::VectorXd output = response_row(one, device, state, quantity);
  const fem::Linearisation linear(equilibrium, at_rest);
  const auto responses = fem::harmonic_response(linear, common_drive(device, at_rest, driven), omega);
  std::size_t strongest = 0;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const fem::HarmonicResponse& at = responses[i];
    std::complex<double> current = 0; // of all driven electrodes together
    for (const std::size_t port : driven) current += at.current[static_cast<Eigen::Index>(port)];
    std::vector<double> row{hertz[i]};
    append_polar(row, (output.transpose() * at.displacement).value());
    for (const std::size_t port : driven) append_polar(row, at.voltage[static_cast<Eigen::Index>(port)]);
    append_polar(row, current);
    append_polar(row, 1.0 / current);
    if (bias != 0) row.push_back(row[1] / (2 * std::abs(bias)));
    analysis.rows.push_back(std::move(row));
    if (analysis.rows.back()[1] > analysis.rows[strongest][1]) strongest = i;
  }
  const std::string where = fmt::format("at {:.6g} Hz", hertz[strongest]);
  const Eigen::VectorXcd& peak = responses[strongest].displacement;
  const auto shape = [&](const std::string& phase, const Eigen::VectorXd& along) {
    const fem::DofMap& dofs = device.model.dofs;
    analysis.shapes.push_back(
        {phase + where, fem::displacements(dofs, state, along), fem::spins(dofs, state, along)});
  };
  shape("in phase ", peak.real());
  shape("a quarter period behind ", -peak.imag());
  return analysis;
}

} // namespace

std::vector<double> Analysis::column(std::size_t number) const {
  std::vector<double> values;
  for (const auto& row : rows) values.push_back(row.at(number));
  return values;
}

std::vector<std::complex<double>> Analysis::values(std::size_t magnitude) const {
  std::vector<std::complex<double>> values;
  for (const auto& row : rows)
    values.push_back(std::polar(row.at(magnitude), row.at(magnitude + 1) * degree));
  return values;
}

std::vector<double> frequencies(const Sweep& sweep) {
  if (!sweep.at.empty()) return sweep.at;
  std::vector<double> all;
  for (int i = 0; i < sweep.points; ++i)
    all.push_back(sweep.from * std::pow(sweep.to / sweep.from, static_cast<double>(i) / (sweep.points - 1)));
  return all;
}

std::string unrest(fem::Equilibrium& equilibrium, const fem::State& state) {
  if (flows(equilibrium.model(), state)) return "dashpots flow";
  if (conducts(equilibrium, state)) return "current flows along an electrode";
  if (moves(equilibrium, state)) return "the device moves";
  return "";
}

void require_rest(fem::Equilibrium& equilibrium, const fem::State& state) {
  if (const std::string found = unrest(equilibrium, state); !found.empty())
    throw AnalysisError(fmt::format(
        "small vibrations go about a state at rest, and here {}; let it come to rest before, by a "
        "hold, or take a step without a duration, with response = \"relaxed\"",
        found));
}

std::vector<std::size_t> driven_ports(const Case& one, const std::vector<std::string>& names) {
  const auto ports_with = [&](auto&& swings) {
    std::vector<std::size_t> ports;
    for (std::size_t e = 0; e < one.electrodes.size(); ++e)
      if (swings(one.electrodes[e].name)) ports.push_back(e);
    return ports;
  };
  if (!names.empty())
    return ports_with([&](const std::string& name) { return std::ranges::find(names, name) != names.end(); });
  const auto driven = ports_with([&](const std::string& name) {
    const auto drive = one.drives.find(name);
    return drive != one.drives.end() && drive->second.voltage;
  });
  return driven.empty() ? ports_with([](const std::string&) { return true; }) : driven;
}

fem::HarmonicDrive common_drive(const Device& device, const fem::State& at,
                                const std::vector<std::size_t>& ports) {
  fem::HarmonicDrive drive = fem::HarmonicDrive::at_port(device.model, ports.front());
  for (const std::size_t port : ports) {
    if (at.supply[port] == fem::Supply::charge)
      throw AnalysisError(fmt::format("electrode \"{}\" is isolated: there is no source that could swing",
                                      device.model.electrodes[port]));
    drive.source[static_cast<Eigen::Index>(port)] = 1;
  }
  return drive;
}

namespace {

/// How a rotation vector goes with a small rotation that follows it, about axes that stay.
Eigen::Matrix3d spin_per_turn(const Eigen::Vector3d& spin) {
  const double angle = spin.norm();
  Eigen::Matrix3d cross;
  cross << 0, -spin.z(), spin.y(), spin.z(), 0, -spin.x(), -spin.y(), spin.x(), 0;
  const double factor =
      angle < 1e-3 ? 1.0 / 12 : 1 / (angle * angle) - (1 + std::cos(angle)) / (2 * angle * std::sin(angle));
  return Eigen::Matrix3d::Identity() - cross / 2 + factor * cross * cross;
}

} // namespace

Eigen::VectorXd response_row(const Case& one, const Device& device, const fem::State& state,
                             const Quantity& quantity) {
  const fem::DofMap& dofs = device.model.dofs;
  Eigen::VectorXd row = Eigen::VectorXd::Zero(dofs.count());
  if (quantity.kind == QuantityKind::angle) {
    const int master = device.mesh.node_sets.at(quantity.of).front();
    const Eigen::Matrix3d turns =
        spin_per_turn(fem::spin_of(state.rotation[static_cast<std::size_t>(master)]));
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(master, 3 + c); e != fem::DofMap::absent)
        row[e] = turns(*quantity.along, c);
    return dofs.jacobian(state).transpose() * row;
  }
  const auto add = [&](int node, const Eigen::Vector3d& gradient) {
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(node, c); e != fem::DofMap::absent) row[e] += gradient[c];
  };
  const auto add_mean = [&](const std::string& place, const Eigen::Vector3d& gradient) {
    const auto& nodes = device.mesh.node_sets.at(place);
    for (const int node : nodes) add(node, gradient / static_cast<double>(nodes.size()));
  };
  if (quantity.kind == QuantityKind::distance) {
    const auto apart = [&](const fem::State& at) -> Eigen::Vector3d {
      return centroid(device.mesh, quantity.between[1], at) - centroid(device.mesh, quantity.between[0], at);
    };
    Eigen::Vector3d along = apart(state).normalized();
    if (quantity.along) // positive as drawn
      along = Eigen::Vector3d::Unit(*quantity.along) *
              (apart(device.model.initial_state())[*quantity.along] < 0 ? -1 : 1);
    add_mean(quantity.between[1], along);
    add_mean(quantity.between[0], -along);
  } else if (quantity.kind == QuantityKind::radius && one.dimension == fem::Dimension::axisymmetric) {
    add_mean(quantity.of, Eigen::Vector3d::UnitX());
  } else if (quantity.kind == QuantityKind::radius) {
    const Eigen::Vector3d middle = centroid(device.mesh, quantity.of, state);
    const auto& nodes = device.mesh.node_sets.at(quantity.of);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int node : nodes) {
      const Eigen::Vector3d outwards =
          (position(device.mesh, node, state) - middle).normalized() / static_cast<double>(nodes.size());
      add(node, outwards);
      sum += outwards;
    }
    add_mean(quantity.of, -sum); // the middle moves with the nodes
  } else {
    add_mean(quantity.of,
             quantity.along == along_gravity ? one.gravity.down() : Eigen::Vector3d::Unit(*quantity.along));
  }
  return dofs.jacobian(state).transpose() * row;
}

fem::State operating_point(const Device& device, fem::State state) {
  for (const fem::Circuit& circuit : device.model.circuits) {
    const auto e = static_cast<std::size_t>(circuit.electrode);
    if (state.supply[e] != fem::Supply::circuit) state.source[e] = state.voltage[e] / circuit.steady_share();
    state.supply[e] = fem::Supply::circuit;
  }
  return state;
}

Analysis analyse(const Case& one, const Device& device, fem::Equilibrium& equilibrium,
                 const fem::State& state, const Step& step) {
  require_rest(equilibrium, state);
  try {
    return step.kind == StepKind::modes ? modes(device, equilibrium, state, step)
                                        : harmonic(one, device, equilibrium, state, step);
  } catch (const std::domain_error& error) {
    throw AnalysisError(error.what());
  }
}

} // namespace dielast::cases
