// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/analyses/analysis.hpp"

#include "cases/case/quantities.hpp"
#include "cases/devices/pins.hpp"
#include "cases/quantities/measurement.hpp"
#include "fem/equilibrium/lowest_mode.hpp"
#include "fem/linear/modal.hpp"
#include "fem/linear/rest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace dielast::cases {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr std::complex<double> none{no_value, no_value};

Analysis modes(const Case& one, const Device& given, fem::Equilibrium& equilibrium, const fem::State& at,
               const Step& step) {
  WithoutPins loose(one, given, equilibrium, at);
  const Device& device = loose.device();
  fem::State state = loose.state();
  const std::vector<double> held = device.model.charges(state, false).charge;
  for (std::size_t e = 0; e < device.model.ports.size(); ++e) {
    if (device.model.ports[e].chamber) continue;
    if (step.control == Control::charge) {
      state.charge[e] = held[e];
      state.supply[e] = fem::Supply::charge;
    } else if (fem::is_isolated(state.supply[e])) { // a source takes up at the electrode's voltage
      state.supply[e] = fem::Supply::voltage;
    }
  }
  const auto found =
      fem::vibration_modes(loose.equilibrium(), state, {.count = step.count, .drifts = loose.drifts()});
  if (!found)
    throw AnalysisError("no modes found: the device is at a critical point, or "
                        "more modes than can be told apart lie next to one another");
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
    return device.model.ports[port].circuit ? at_rest.source[port] : at_rest.voltage[port];
  };
  const double bias = source(driven.front());
  return std::ranges::all_of(driven, [&](std::size_t port) { return source(port) == bias; }) ? bias : 0;
}

Analysis harmonic(const Case& one, const Device& given, fem::Equilibrium& equilibrium,
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
  const fem::State about = operating_point(given, state, driven);
  require_rest(equilibrium, about);
  require_stable(equilibrium, about);
  WithoutPins loose(one, given, equilibrium, about);
  const Device& device = loose.device();
  const fem::State& at_rest = loose.state();
  const double bias = analysis.bias = common_bias(device, at_rest, driven);
  if (bias != 0)
    analysis.columns.push_back(
        fmt::format("{}_per_squared_volt[{}/V^2]", quantity.name, unit_of(quantity, one.quantities)));
  const std::vector<double> hertz = frequencies(step.sweep);
  std::vector<double> omega = hertz;
  for (double& w : omega) w *= 2 * std::numbers::pi;
  const Eigen::VectorXd output = response_row(one, device, at_rest, quantity);
  const fem::Linearisation linear(loose.equilibrium(), at_rest, loose.drifts());
  auto responses = fem::harmonic_response(linear, common_drive(device, at_rest, driven), omega);
  loose.take_off_drift(responses);
  std::size_t strongest = 0;
  for (std::size_t i = 0; i < responses.size(); ++i) {
    const fem::HarmonicResponse& at = responses[i];
    std::complex<double> current = 0; // of all driven electrodes together
    for (const std::size_t port : driven) current += at.current[static_cast<Eigen::Index>(port)];
    std::vector<double> row{hertz[i]};
    append_polar(row, (output.transpose() * at.displacement).value());
    for (const std::size_t port : driven) append_polar(row, at.voltage[static_cast<Eigen::Index>(port)]);
    append_polar(row, current);
    append_polar(row, current == 0.0 ? none : 1.0 / current); // where nothing flows
    if (bias != 0) row.push_back(row[1] / (2 * std::abs(bias)));
    analysis.rows.push_back(std::move(row));
    if (analysis.rows.back()[1] > analysis.rows[strongest][1]) strongest = i;
  }
  const std::string where = fmt::format("at {:.6g} Hz", hertz[strongest]);
  const Eigen::VectorXcd& peak = responses[strongest].displacement;
  const auto shape = [&](const std::string& phase, const Eigen::VectorXd& along) {
    const fem::DofMap& dofs = device.model.dofs;
    analysis.shapes.push_back(
        {phase + where, fem::displacements(dofs, at_rest, along), fem::spins(dofs, at_rest, along)});
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

std::string no_response(const std::string& quantity, std::string_view key, bool device_moves) {
  if (device_moves)
    return fmt::format("{} does not move, though the device does: let {} name what moves", quantity, key);
  return "nothing moves: a film feels the square of its voltage, and here none swings about one; take a step "
         "of kind \"voltage\" before, and see that the source is not at its current_limit";
}

void require_rest(fem::Equilibrium& equilibrium, const fem::State& state) {
  if (const std::string found = fem::unrest(equilibrium, state); !found.empty())
    throw AnalysisError(fmt::format(
        "small vibrations go about a state at rest, and here {}; let it come to rest before, by a "
        "hold or a step of kind \"relax\"",
        found));
  if (fem::skew_stiffness(equilibrium, state) > fem::negligible_skew)
    throw AnalysisError(
        "moments about axes that stay act on what turns about several axes: its stiffness is not "
        "symmetric, which modes, responses and linear models do not know; fix the turns about the "
        "other axes, or follow small motions in a step of kind \"transient\"");
}

void require_stable(fem::Equilibrium& equilibrium, const fem::State& state) {
  fem::State at = fem::relaxed(state);
  if (!equilibrium.factor(at)) return;
  if (const int unstable = equilibrium.tangent().unstable_modes(); unstable > 0)
    throw AnalysisError(fmt::format("small motions go about a stable state, and this one has {} unstable "
                                    "mode{} at the voltages of its sources: "
                                    "a device would leave it; a step of kind \"modes\" shows how",
                                    unstable, unstable == 1 ? "" : "s"));
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
                                      device.model.ports[port].name));
    drive.source[static_cast<Eigen::Index>(port)] = 1;
  }
  return drive;
}

fem::State operating_point(const Device& device, fem::State state, const std::vector<std::size_t>& driven) {
  for (std::size_t e = 0; e < device.model.ports.size(); ++e) {
    const auto& circuit = device.model.ports[e].circuit;
    if (!circuit) continue;
    if (fem::is_isolated(state.supply[e])) {
      if (std::ranges::find(driven, e) == driven.end()) {
        if (circuit->leakage > 0) state.supply[e] = fem::Supply::leak;
        continue;
      }
      state.source[e] = circuit->holding_source(state.voltage[e]);
    }
    state.supply[e] = fem::Supply::circuit;
  }
  return state;
}

Analysis analyse(const Case& one, const Device& device, fem::Equilibrium& equilibrium,
                 const fem::State& state, const Step& step) {
  require_rest(equilibrium, state);
  try {
    return step.kind == StepKind::modes ? modes(one, device, equilibrium, state, step)
                                        : harmonic(one, device, equilibrium, state, step);
  } catch (const std::domain_error& error) {
    throw AnalysisError(error.what());
  }
}

} // namespace dielast::cases
