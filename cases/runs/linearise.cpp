// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/runs/linearise.hpp"

#include "cases/case/quantities.hpp"
#include "cases/console/as_warning.hpp"
#include "cases/console/terminal.hpp"
#include "cases/devices/pins.hpp"
#include "cases/runs/simulation.hpp"
#include "fem/algebra/dense_algebra.hpp"
#include "fem/linear/balanced_truncation.hpp"
#include "fem/linear/harmonic.hpp"
#include "post/engineering.hpp"
#include "post/files/report_files.hpp"
#include "post/files/results_folder.hpp"
#include "post/pictures/bode.hpp"
#include "post/pictures/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace dielast::cases {
namespace {

using Complex = std::complex<double>;

/// The models over the same frequencies: everything that the outputs tell.
struct Linearised {
  fem::StateSpace model;
  std::string output, unit;        ///< m or rad
  std::vector<std::string> driven; ///< electrodes whose sources are the input together
  std::vector<double> voltage;     ///< of these at the operating point, V
  std::vector<double> source;      ///< of their sources there, V: more where an electrode leaks
  double error = 0;                ///< largest, relative to the full response
  std::vector<double> frequency;   ///< Hz
  std::vector<Complex> full, reduced;
  struct Enough {
    int order;
    double error;
  };
  std::optional<Enough> enough;               ///< more states, with which it would be good
  std::vector<std::vector<Complex>> compared; ///< as in the case
};

/// Beyond this part of the full response a linear model is none of it.
constexpr double poor = 0.1;

/// Below this it is good, and nothing better is looked for.
constexpr double good = 0.01;

/// Times the highest frequency: modes below that take part, faster ones follow statically. One that lies
/// little above is needed, those far above take states that others need.
constexpr std::array bands{1.0, 2.0, 4.0, 8.0, 16.0};
/// From there on for models alone that have fewer states than are asked for.
constexpr double wide = 8;

Complex polynomial(const std::vector<double>& coefficients, Complex s) {
  Complex value = 0;
  for (const double c : coefficients) value = value * s + c;
  return value;
}

Linearised linearise(const Case& one, Simulation& simulation) {
  require_rest(simulation.equilibrium(), simulation.state());
  const Quantity& output = *response_quantity(one, one.linearise->output);
  const std::vector<std::size_t> driven = driven_ports(one, one.linearise->driven);
  const std::optional<fem::State> lying = upright(simulation.device(), simulation.state());
  const fem::State at_rest =
      operating_point(simulation.device(), lying ? *lying : simulation.state(), driven);
  require_rest(simulation.equilibrium(), at_rest);
  require_stable(simulation.equilibrium(), at_rest);
  WithoutPins loose(one, simulation.device(), simulation.equilibrium(), at_rest);
  const Device& device = loose.device();
  const fem::State& state = loose.state();
  const fem::HarmonicDrive drive = common_drive(device, state, driven);
  const fem::Channels channels{driven, response_row(one, device, state, output).transpose(), {}};
  Linearised result{.output = output.name,
                    .unit = unit_of(output, one.quantities),
                    .frequency = frequencies(one.linearise->sweep)};
  for (const std::size_t port : driven) {
    result.driven.push_back(device.model.ports[port].name);
    result.voltage.push_back(state.voltage[port]);
    result.source.push_back(device.model.ports[port].circuit ? state.source[port] : state.voltage[port]);
  }
  std::vector<double> omega = result.frequency;
  for (double& w : omega) w *= 2 * std::numbers::pi;
  const fem::Linearisation full(loose.equilibrium(), state, loose.drifts());
  bool moves = false;
  auto responses = fem::harmonic_response(full, drive, omega);
  loose.take_off_drift(responses);
  for (const auto& at : responses) {
    result.full.push_back((channels.rows.row(0) * at.displacement).value());
    moves = moves || !at.displacement.isZero(0);
  }
  if (std::ranges::all_of(result.full, [](const Complex& y) { return y == 0.0; }))
    throw AnalysisError(no_response(output.name, "linearise.output", moves));
  for (const double band : bands) {
    if (band != bands.front() && result.error < good) break;
    if (band >= wide && result.model.order() >= one.linearise->order) break;
    fem::StateSpace large =
        fem::state_space(loose.equilibrium(), state, channels,
                         {.highest_frequency = band * omega.back(), .drifts = loose.drifts()});
    large.B = large.B.rowwise().sum().eval(); // the sources swing together: one input
    large.D = large.D.rowwise().sum().eval();
    std::vector<Complex> reduced;
    const auto error_of = [&](const fem::StateSpace& model) {
      reduced.clear();
      double error = 0;
      for (std::size_t i = 0; i < omega.size(); ++i) {
        reduced.push_back(model.transfer(Complex(0, omega[i]))(0, 0));
        const double there = std::abs(reduced[i] - result.full[i]) / std::abs(result.full[i]);
        if (!(there <= error)) error = there; // nor is what is no number a good model
      }
      return std::isnan(error) ? std::numeric_limits<double>::infinity() : error;
    };
    const fem::StateSpace model = fem::balanced_truncation(large, one.linearise->order);
    const double error = error_of(model);
    if (band == bands.front() || error < result.error) {
      result.model = model;
      result.reduced = reduced;
      result.error = error;
    }
    const auto most = static_cast<int>(std::min<Eigen::Index>(large.order(), one.linearise->order + 20));
    for (int order = one.linearise->order + 1; error >= good && !result.enough && order <= most; ++order)
      if (const double less = error_of(fem::balanced_truncation(large, order)); less < good)
        result.enough = {order, less};
  }
  for (const TransferFunction& other : one.linearise->compare) {
    auto& response = result.compared.emplace_back();
    for (const double w : omega)
      response.push_back(polynomial(other.numerator, Complex(0, w)) /
                         polynomial(other.denominator, Complex(0, w)));
  }
  return result;
}

nlohmann::json rows_of(const Eigen::MatrixXd& matrix) {
  auto rows = nlohmann::json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    auto row = nlohmann::json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

nlohmann::ordered_json one_or_all(const std::vector<double>& values) {
  return values.size() == 1 ? nlohmann::ordered_json(values.front()) : nlohmann::ordered_json(values);
}

nlohmann::ordered_json model_json(const Case& one, const Linearised& found) {
  auto poles = nlohmann::json::array();
  for (const Complex& pole : fem::eigenvalues(found.model.A)) poles.push_back({pole.real(), pole.imag()});
  return {{"program", "dielast " DIELAST_VERSION},
          {"title", one.title},
          {"input", {{"name", "source voltage"}, {"unit", "V"}, {"electrodes", found.driven}}},
          {"output", {{"name", found.output}, {"unit", found.unit}}},
          {"operating_voltage_V", one_or_all(found.voltage)},
          {"operating_source_voltage_V", one_or_all(found.source)},
          {"order", found.model.order()},
          {"largest_relative_error", found.error},
          {"compared_from_Hz", found.frequency.front()},
          {"compared_to_Hz", found.frequency.back()},
          {"poles_1_per_s", poles},
          {"A", rows_of(found.model.A)},
          {"B", rows_of(found.model.B)},
          {"C", rows_of(found.model.C)},
          {"D", rows_of(found.model.D)}};
}

std::string matlab_matrix(const char* name, const Eigen::MatrixXd& matrix) {
  std::string text = fmt::format("{} = [", name);
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      text += fmt::format("{}{:.17g}", j > 0 ? ", " : i > 0 ? ";\n  " : "", matrix(i, j));
  return text + "];\n";
}

std::string matlab_script(const Case& one, const Linearised& found) {
  std::string title = one.title;
  std::ranges::replace(title, '\n', ' ');
  std::string point;
  for (std::size_t e = 0; e < found.driven.size(); ++e)
    point += fmt::format("{}{:.10g} V at {}{}", e ? ", " : "", found.voltage[e], found.driven[e],
                         found.source[e] == found.voltage[e]
                             ? ""
                             : fmt::format(" ({:.10g} V of its source)", found.source[e]));
  return fmt::format(
      "% {}\n% x' = A x + B u, y = C x + D u, time in s\n"
      "% u: change of the source voltage of {} (V), y: change of {} ({}), both from the state at\n"
      "% the end of the case's steps, with {}\n"
      "% largest relative error {:.3g} from {:.6g} to {:.6g} Hz\n{}{}{}{}"
      "% with a control toolbox: model = ss(A, B, C, D);\n",
      title, fmt::join(found.driven, ", "), found.output, found.unit, point, found.error,
      found.frequency.front(), found.frequency.back(), matlab_matrix("A", found.model.A),
      matlab_matrix("B", found.model.B), matlab_matrix("C", found.model.C),
      matlab_matrix("D", found.model.D));
}

post::Report report_of(const Case& one, const Linearised& found) {
  std::vector<post::FrequencyResponse> curves{
      {"full model", found.frequency, found.full, post::Series::Style::points},
      {fmt::format("order {}", found.model.order()), found.frequency, found.reduced}};
  for (std::size_t c = 0; c < found.compared.size(); ++c)
    curves.push_back({one.linearise->compare[c].name, found.frequency, found.compared[c]});
  post::Section plots{"Response", {}};
  plots.add(post::draw(post::bode(found.output, fmt::format("{} [{}/V]", found.output, found.unit), curves)));
  post::Table gains{{"model", fmt::format("gain at {:.4g} Hz [{}/V]", found.frequency.front(), found.unit)},
                    {}};
  for (const post::FrequencyResponse& curve : curves)
    gains.rows.push_back({curve.label, fmt::format("{:.6g}", std::copysign(std::abs(curve.value.front()),
                                                                           curve.value.front().real()))});
  plots.blocks.push_back(std::move(gains));
  post::Table poles{{"pole [1/s]", "frequency [rad/s]", "damping ratio"}, {}};
  for (const Complex& pole : fem::eigenvalues(found.model.A))
    poles.rows.push_back({fmt::format("{:.6g} {:+.6g} i", pole.real(), pole.imag()),
                          fmt::format("{:.6g}", std::abs(pole)),
                          fmt::format("{:.4g}", -pole.real() / std::abs(pole))});
  std::string voltages;
  for (const double voltage : found.voltage)
    voltages += (voltages.empty() ? "" : ", ") + post::engineering(voltage, "V");
  return {.title = one.title,
          .subtitle = one.source.filename().string(),
          .status = found.error > poor ? post::Cell{"not the device's response", post::Tone::warning}
                                       : post::Cell{"linear model", post::Tone::good},
          .highlights = {{"order", std::to_string(found.model.order()), ""},
                         {"largest error", fmt::format("{:.3g} %", 100 * found.error),
                          fmt::format("of the full response, {:.4g} to {:.4g} Hz", found.frequency.front(),
                                      found.frequency.back())},
                         {"operating point", voltages,
                          "source of " + fmt::format("{}", fmt::join(found.driven, ", "))},
                         {"static gain",
                          fmt::format("{:.4g} {}/V", found.model.transfer(0)(0, 0).real(), found.unit), ""}},
          .sections = {std::move(plots), {"Poles", {std::move(poles)}}},
          .footer = "dielast " DIELAST_VERSION};
}

} // namespace

ExitCode linearise_case(const Case& one, const LineariseSettings& settings) {
  if (one.electrodes.empty()) throw one.error_at("linearise", "needs an electrode");
  const std::string& output = one.linearise->output;
  if (!response_quantity(one, output)) {
    const std::string wanted = "a quantity of kind " + response_kinds(" with a direction");
    throw output.empty()
        ? one.error_at("linearise", "needs " + wanted)
        : one.error_at("linearise.output", fmt::format("found \"{}\", allowed {}", output, wanted));
  }
  post::ResultsFolder folder(settings.directory, "linearise");
  folder.begin();
  Simulation simulation(one, settings.threads);
  for (const std::string& warning : simulation.warnings()) say(stderr, "{}\n", as_warning(warning));
  const Outcome outcome = simulation.run({});
  if (outcome.ending != Ending::complete) {
    say(stderr, "error: {}\n", outcome.message);
    return ExitCode::not_converged;
  }
  try {
    const Linearised found = linearise(one, simulation);
    folder.write("linear_model.m", matlab_script(one, found));
    post::write_report(folder, report_of(one, found));
    folder.write("linear_model.json", model_json(one, found).dump(2) + "\n");
    const ExitCode code = found.error > poor ? ExitCode::check_failed : ExitCode::ok;
    folder.set_complete(static_cast<int>(code));
    say("order {}, largest error {:.3g} % of the full response, static gain {:.6g} {}/V of the source of "
        "{}\n",
        found.model.order(), 100 * found.error, found.model.transfer(0)(0, 0).real(), found.unit,
        fmt::format("{}", fmt::join(found.driven, ", ")));
    const bool enough = found.enough && found.error >= good;
    const bool all_states = found.model.order() < one.linearise->order && !enough;
    if (all_states) say("the response tells no more than {} states apart\n", found.model.order());
    if (enough)
      say("with linearise.order = {} it is {:.3g} %\n", found.enough->order, 100 * found.enough->error);
    if (found.error > poor)
      say(stderr,
          "error: the linear model does not answer as the device does up to {:.4g} Hz; {} (linearise.to)\n",
          found.frequency.back(),
          all_states ? "it has all the states of its modes: a higher one takes in more of these"
                     : "ask for a larger linearise.order, or for a lower frequency");
    say("written to {}\n", settings.directory.string());
    return code;
  } catch (const AnalysisError& error) {
    say(stderr, "error: {}\n", error.what());
    return ExitCode::not_converged;
  } catch (const std::domain_error& error) {
    say(stderr, "error: {}\n", error.what());
    return ExitCode::not_converged;
  }
}

} // namespace dielast::cases
