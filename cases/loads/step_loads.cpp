// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/loads/step_loads.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace dielast::cases {

namespace {

/// Kinks closer than this part of the step are one break.
constexpr double same_break = 2e-9;

/// Where ramps lead: a wave that jumps at t = 0 jumps in the transient that follows it.
constexpr Instant just_before_start{0, true};

/// Of all that flows, s.
struct RelaxationTimes {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;

  void add(double time) {
    shortest = std::min(shortest, time);
    if (std::isfinite(time)) longest = std::max(longest, time);
  }
};

/// Adds those of the film's branches, of its circuits and of its sheets.
void add_relaxation(const materials::Material& material, const fem::Model& model, RelaxationTimes& times) {
  for (const materials::Branch& branch : material.branches)
    times.add(branch.viscosity / materials::initial_shear_modulus(branch.law));
  if (material.viscosity > 0) times.add(material.viscosity / materials::initial_shear_modulus(material.law));
  const fem::Charges drawn = model.charges(model.initial_state(), false);
  for (std::size_t p = 0; p < model.ports.size(); ++p) {
    const fem::Port& port = model.ports[p];
    if (port.circuit)
      times.add(std::min(port.circuit->resistance, 1 / port.circuit->leakage) * drawn.capacitance[p]);
    if (port.sheet) times.add(port.sheet->resistance * drawn.capacitance[p]);
  }
}

} // namespace

StepLoads::StepLoads(const Case& one, const Device& device, const std::vector<Step>& steps,
                     const Signals& signals, Eigen::VectorXd frame_force)
    : case_(one), device_(device), steps_(steps), signals_(signals), frame_force_(std::move(frame_force)) {}

const Drive* StepLoads::drive(std::size_t electrode) const {
  const auto found = case_.drives.find(case_.electrodes[electrode].name);
  return found == case_.drives.end() ? nullptr : &found->second;
}

std::optional<double> StepLoads::goal_of(const Step& step, const std::optional<Waveform>& wave, Instant t) {
  if (step.to) return step.to;
  return wave ? std::optional(t.of(*wave)) : std::nullopt;
}

std::optional<double> StepLoads::goal_of(const Step& step, std::size_t electrode,
                                         std::optional<Waveform> Drive::*part, Instant t) const {
  if (!step.electrode.empty() && step.electrode != case_.electrodes[electrode].name) return std::nullopt;
  const Drive* source = drive(electrode);
  return goal_of(step, source ? source->*part : std::nullopt, t);
}

const Signal* StepLoads::signal_of(const Step& step, const DrivenLoad& load) const {
  if (step.kind != StepKind::transient) return nullptr;
  const auto found = signals_.find(load);
  return found == signals_.end() ? nullptr : found->second.get();
}

/// An isolated electrode keeps its charge, or loses it through a leak while time passes.
fem::Supply StepLoads::isolated(const Step& step, std::size_t electrode) const {
  const auto& circuit = device_.model.ports[electrode].circuit;
  return step.duration && circuit && circuit->leakage > 0 ? fem::Supply::leak : fem::Supply::charge;
}

/// Circuits take time; without, an electrode is at its source's voltage.
fem::Supply StepLoads::supply(const Step& step, std::size_t electrode) const {
  const bool is_ramp = step.kind == StepKind::voltage || step.kind == StepKind::release;
  const bool isolates = !is_ramp && step.kind != StepKind::charge && step.control == Control::charge;
  const bool follows = step.kind == StepKind::charge || (isolates && step.kind == StepKind::transient);
  if (follows && goal_of(step, electrode, &Drive::charge, {})) return fem::Supply::charge;
  if (isolates) return isolated(step, electrode);
  return step.duration && device_.model.ports[electrode].circuit ? fem::Supply::circuit
                                                                 : fem::Supply::voltage;
}

/// A chamber stays open to its pressure or closed, as the last step that was about it has left it.
void StepLoads::connect_chamber(const Step& step, const fem::Charges& held, fem::State& state) const {
  if (!case_.chamber) return;
  const std::size_t port = device_.model.ports.chamber();
  if (step.kind == StepKind::pressure) state.supply[port] = fem::Supply::voltage;
  if (step.kind != StepKind::inflate) return;
  state.supply[port] = fem::Supply::charge;
  state.charge[port] = device_.model.ports[port].chamber->pumped(held.charge[port], state.voltage[port]);
}

void StepLoads::begin(int number, fem::State& state) const {
  const Step& step = steps_[static_cast<std::size_t>(number)];
  const fem::Charges held = device_.model.charges(state, false);
  bool connects = false;
  for (std::size_t e = 0; e < case_.electrodes.size(); ++e) {
    const bool is_about_it = step.electrode.empty() || step.electrode == case_.electrodes[e].name;
    const bool stays = !is_about_it && fem::is_isolated(state.supply[e]);
    const fem::Supply next = stays ? isolated(step, e) : supply(step, e);
    if (next == state.supply[e]) continue;
    state.charge[e] = held.charge[e];
    // A source that was connected stands where it stood, whatever the electrode has come to.
    const auto& circuit = device_.model.ports[e].circuit;
    if (circuit && fem::is_isolated(state.supply[e]) && !fem::is_isolated(next))
      state.source[e] = circuit->holding_source(state.voltage[e]);
    connects = connects || fem::flows(next);
    state.supply[e] = next;
  }
  connect_chamber(step, held, state);
  if (connects) device_.model.charge_circuits(state);
}

bool StepLoads::happened(int step, StepKind kind) const {
  return std::any_of(steps_.begin(), steps_.begin() + step + 1,
                     [kind](const Step& s) { return s.kind == kind; });
}

/// The frame's forces until a release, the loads from the first step that applies them.
Eigen::VectorXd StepLoads::dead_force(int number, Instant t) const {
  const Step& step = steps_[static_cast<std::size_t>(number)];
  const fem::DofMap& dofs = device_.model.dofs;
  Eigen::VectorXd force = frame_force_;
  if (happened(number, StepKind::release)) force.setZero();
  if (happened(number, StepKind::weight)) force += device_.weight;
  if (!happened(number, StepKind::force) && !happened(number, StepKind::transient)) return force;
  for (const Load& load : case_.loads) {
    const auto& nodes = device_.mesh.node_sets.at(load.place);
    const std::vector<double>& shares = device_.shares.at(load.place).of_nodes;
    for (int c = 0; c < fem::DofMap::components; ++c) {
      const Waveform* wave = load.component(c);
      if (!wave) continue;
      const Signal* signal = load.moment ? nullptr : signal_of(step, {Driven::force, load.place, c});
      const double whole = signal ? signal->at(t) : step.part(StepKind::force) * t.of(*wave);
      const auto acts = [&](int node) { return dofs.equation(node, c) != fem::DofMap::absent; };
      // Every node of a place moves, or none does; film among walls does not turn.
      double acting = 0;
      for (std::size_t n = 0; n < nodes.size(); ++n)
        if (acts(nodes[n])) acting += shares[n];
      for (std::size_t n = 0; n < nodes.size(); ++n)
        if (acts(nodes[n])) force[dofs.equation(nodes[n], c)] += whole * shares[n] / acting;
    }
  }
  return force;
}

void StepLoads::move(const Step& step, Eigen::VectorXd& held, Instant t) const {
  const fem::DofMap& dofs = device_.model.dofs;
  for (const Support& support : case_.supports)
    for (int c = 0; c < 3; ++c) {
      const auto& motion = support.motion[static_cast<std::size_t>(c)];
      const Signal* signal = support.fixed[static_cast<std::size_t>(c)]
                                 ? signal_of(step, {Driven::displacement, support.place, c})
                                 : nullptr;
      if (!motion && !signal) continue;
      const double moved = signal ? signal->at(t) : step.part(StepKind::move) * t.of(*motion);
      for (const int node : device_.mesh.node_sets.at(support.place))
        if (const int e = dofs.equation(node, c); dofs.is_held(e)) held[e - dofs.free_count()] = moved;
    }
}

/// The loads that the step leads to (a ramp: just before t = 0) or has at t (a transient).
fem::Loads StepLoads::at(int number, const fem::Loads& start, Instant t) const {
  const Step& step = steps_[static_cast<std::size_t>(number)];
  fem::Loads loads = start;
  const auto does = [&step](StepKind kind) { return step.kind == kind || step.kind == StepKind::transient; };
  const bool has_let_go = let_go.size() > 0;
  if (does(StepKind::force)) {
    loads.dead_force = dead_force(number, t);
  } else { // what no step is about stays where the one before has left it
    const auto is_first = [&](StepKind kind) { return step.kind == kind && !happened(number - 1, kind); };
    if (is_first(StepKind::release)) loads.dead_force -= frame_force_;
    if (is_first(StepKind::weight)) loads.dead_force += device_.weight;
    if (has_let_go) loads.dead_force -= let_go;
  }
  if (has_let_go) loads.dead_force += left(step, t) * let_go;
  if (does(StepKind::move)) move(step, loads.held, t);
  const auto goal = [&](const DrivenLoad& load, const auto& said) {
    const Signal* signal = signal_of(step, load);
    return signal ? std::optional(signal->at(t)) : said();
  };
  for (std::size_t e = 0; e < case_.electrodes.size(); ++e) {
    const bool isolated = fem::is_isolated(supply(step, e));
    const auto voltage = goal({Driven::voltage, case_.electrodes[e].name},
                              [&] { return goal_of(step, e, &Drive::voltage, t); });
    if (does(StepKind::voltage) && voltage && !isolated) {
      loads.source[e] = *voltage;
      const auto& circuit = device_.model.ports[e].circuit;
      loads.voltage[e] = circuit ? circuit->steady_voltage(loads.source[e]) : loads.source[e];
    }
    if (const auto charge = goal_of(step, e, &Drive::charge, t); does(StepKind::charge) && charge && isolated)
      loads.charge[e] = *charge;
    if (const auto& circuit = device_.model.ports[e].circuit;
        step.kind == StepKind::relax && circuit && !isolated)
      loads.voltage[e] = circuit->steady_voltage(loads.source[e]);
  }
  if (case_.chamber) {
    const std::size_t port = device_.model.ports.chamber();
    const auto pressure = goal({Driven::pressure}, [&] { return goal_of(step, case_.chamber->pressure, t); });
    if (does(StepKind::pressure) && pressure) loads.voltage[port] = *pressure;
    const auto volume = goal({Driven::volume}, [&] { return goal_of(step, case_.chamber->volume, t); });
    if (does(StepKind::inflate) && volume) loads.charge[port] = *volume;
  }
  return loads;
}

Eigen::VectorXd StepLoads::cut(int number, const fem::Loads& start, const fem::State& state) const {
  return state.dead_force - at(number, start, just_before_start).dead_force;
}

double StepLoads::left(const Step& step, Instant t) const {
  return step.kind == StepKind::transient ? 1 - t.t / *step.duration : 0;
}

std::vector<StepLoads::Break> StepLoads::breaks(const Step& step) const {
  std::vector<double> all{0.0, *step.duration};
  const auto add = [&](const Waveform& wave) {
    const std::vector<double> kinks = wave.kinks(0, *step.duration);
    all.insert(all.end(), kinks.begin(), kinks.end());
  };
  for (const auto& [load, signal] : signals_)
    std::ranges::copy(signal->kinks(*step.duration), std::back_inserter(all));
  for (const auto& [name, source] : case_.drives)
    for (const auto& wave : {source.voltage, source.charge})
      if (wave) add(*wave);
  for (const Load& load : case_.loads)
    for (int c = 0; c < fem::DofMap::components; ++c)
      if (const Waveform* wave = load.component(c)) add(*wave);
  for (const Support& support : case_.supports)
    for (const auto& wave : support.motion)
      if (wave) add(*wave);
  if (case_.chamber)
    for (const auto& wave : {case_.chamber->pressure, case_.chamber->volume})
      if (wave) add(*wave);
  std::ranges::sort(all);
  std::vector<Break> breaks;
  for (const double t : all)
    if (breaks.empty() || t - breaks.back().first > same_break * *step.duration)
      breaks.push_back({t, t});
    else
      breaks.back().last = t;
  return breaks;
}

void StepLoads::limit_sources(fem::LoadPath& path, const fem::Loads& from, const fem::Loads& to) const {
  constexpr double rounding = 1e-9; // of the voltage: an electrode that is not yet where it comes to in time
  for (std::size_t e = 0; e < case_.electrodes.size(); ++e) {
    const auto& circuit = device_.model.ports[e].circuit;
    if (!circuit) continue;
    const double a = from.source[e] * circuit->steady_share(), b = to.source[e] * circuit->steady_share();
    const double most = circuit->current_limit / circuit->steady_leakage();
    const double largest = std::max(std::abs(a), std::abs(b));
    const auto is_steady = [&](const fem::Loads& loads) {
      return std::abs(loads.voltage[e] - circuit->steady_voltage(loads.source[e])) <= rounding * largest;
    };
    if (largest <= most || !is_steady(from) || !is_steady(to)) continue;
    for (const double limit : {-most, most})
      if (const double s = (limit - a) / (b - a); s > same_break && s < 1 - same_break)
        path.breaks.push_back(s);
    path.parameter = [](double s) { return s; }; // voltages stand still
    path.apply = [apply = std::move(path.apply), e, circuit](fem::State& state, double s) {
      apply(state, s);
      if (state.supply[e] == fem::Supply::voltage)
        state.voltage[e] = circuit->steady_voltage(state.source[e]);
    };
  }
  std::ranges::sort(path.breaks);
  const auto is_same = [](double one, double next) { return next - one <= same_break; };
  path.breaks.erase(std::unique(path.breaks.begin(), path.breaks.end(), is_same), path.breaks.end());
}

fem::LoadPath StepLoads::path(int number, const fem::Loads& start) const {
  const Step& step = steps_[static_cast<std::size_t>(number)];
  if (step.kind != StepKind::transient) {
    const fem::Loads end = at(number, start, just_before_start);
    fem::LoadPath ramp = fem::linear_path(device_.model.dofs, start, end, &device_.model.ports);
    limit_sources(ramp, start, end);
    return ramp;
  }
  fem::LoadPath path;
  const double duration = *step.duration;
  const std::vector<Break> all = breaks(step);
  const auto apply = [this, number, start](fem::State& state, Instant instant) {
    at(number, start, instant).apply(state, device_.model.dofs);
  };
  // Beside a break waves are taken on the side of t, whatever they take for the same time.
  const auto instant = [all, duration](double s, bool before) {
    const double t = s * duration, tolerance = same_break / 2 * duration;
    const auto next = std::ranges::lower_bound(all, t - tolerance, {}, &Break::first);
    if (next == all.end()) return Instant{t, before};
    if (next->first <= t + tolerance) return Instant{before ? next->first : next->last, before};
    return Instant{t, next != all.begin() && next->first - t < t - std::prev(next)->last};
  };
  path.apply = [apply, instant](fem::State& state, double s) { apply(state, instant(s, false)); };
  path.apply_before = [apply, instant](fem::State& state, double s) { apply(state, instant(s, true)); };
  for (const Break& b : all)
    if (b.first > 0 && b.last < duration) path.breaks.push_back(b.first / duration);
  return path;
}

fem::RampOptions StepLoads::options(int number) const {
  const Step& step = steps_[static_cast<std::size_t>(number)];
  fem::RampOptions options{
      .newton = {case_.solver.tolerance, case_.solver.max_iterations, device_.tension_field},
      .increments = step.increments,
      .smallest_increment = case_.solver.smallest_increment,
      .stops = step.stops,
      .instantaneous = step.response == Response::instantaneous,
      .time_tolerance = case_.solver.time_tolerance};
  RelaxationTimes times;
  for (const materials::Material* material : case_.film_materials())
    add_relaxation(*material, device_.model, times);
  // One backward Euler step of h errs by (h / tau)^2 / 2 of what is left to relax.
  if (std::isfinite(times.shortest)) {
    options.first_time_step = std::sqrt(2 * options.time_tolerance) * times.shortest;
    options.shortest_relaxation = times.shortest;
  }
  options.longest_relaxation = times.longest;
  if (!step.duration) return options;
  options.duration = *step.duration;
  options.inertia = step.inertia && device_.model.inertia().mass.nonZeros() > 0;
  if (step.record) options.landing = *step.record / *step.duration;
  return options;
}

} // namespace dielast::cases
