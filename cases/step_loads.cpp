#include "cases/step_loads.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::cases {

namespace {

/// Shortest relaxation time of the film's branches, s; infinite without branches.
double shortest_relaxation(const materials::Material& material) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const materials::Branch& branch : material.branches)
    shortest = std::min(shortest, branch.viscosity / materials::initial_shear_modulus(branch.law));
  return shortest;
}

} // namespace

StepLoads::StepLoads(const Case& one, const Device& device, const std::vector<Step>& steps,
                     Eigen::VectorXd frame_force)
    : case_(one), device_(device), steps_(steps), frame_force_(std::move(frame_force)) {}

const Drive* StepLoads::drive(std::size_t electrode) const {
  const auto found = case_.drives.find(case_.electrodes[electrode].name);
  return found == case_.drives.end() ? nullptr : &found->second;
}

bool StepLoads::isolates(const Step& step, std::size_t electrode) const {
  if (step.kind == StepKind::charge) return drive(electrode) && drive(electrode)->charge;
  return step.kind != StepKind::voltage && step.kind != StepKind::release && step.control == Control::charge;
}

void StepLoads::begin(int number, fem::State& state) const {
  const Step& step = steps_[static_cast<std::size_t>(number)];
  const std::vector<double> held = device_.model.charges(state, false).charge;
  for (std::size_t e = 0; e < case_.electrodes.size(); ++e) {
    const bool isolated = isolates(step, e);
    if (isolated && !state.isolated[e]) state.charge[e] = held[e];
    state.isolated[e] = isolated;
  }
}

bool StepLoads::happened(int step, StepKind kind) const {
  return std::any_of(steps_.begin(), steps_.begin() + step + 1,
                     [kind](const Step& s) { return s.kind == kind; });
}

/// The frame's forces until a release, the loads from the first step that applies them.
Eigen::VectorXd StepLoads::dead_force(int step, double t) const {
  const fem::DofMap& dofs = device_.model.dofs;
  Eigen::VectorXd force = frame_force_;
  if (happened(step, StepKind::release)) force.setZero();
  if (!happened(step, StepKind::force) && !happened(step, StepKind::transient)) return force;
  for (const Load& load : case_.loads) {
    const auto& nodes = device_.mesh.node_sets.at(load.place);
    for (int c = 0; c < 3; ++c)
      for (const int node : nodes)
        if (const int e = dofs.equation(node, c); e != fem::DofMap::absent)
          force[e] += load.force[static_cast<std::size_t>(c)].at(t) / static_cast<double>(nodes.size());
  }
  return force;
}

void StepLoads::move(Eigen::VectorXd& held, double t) const {
  const fem::DofMap& dofs = device_.model.dofs;
  for (const Support& support : case_.supports)
    for (int c = 0; c < 3; ++c)
      if (const auto& motion = support.motion[static_cast<std::size_t>(c)])
        for (const int node : device_.mesh.node_sets.at(support.place))
          if (const int e = dofs.equation(node, c); e >= dofs.free_count())
            held[e - dofs.free_count()] = motion->at(t);
}

/// The loads that the step leads to (a ramp, t = 0) or has at t (a transient).
fem::Loads StepLoads::at(int number, const fem::Loads& start, double t) const {
  const Step& step = steps_[static_cast<std::size_t>(number)];
  fem::Loads loads = start;
  const auto does = [&step](StepKind kind) { return step.kind == kind || step.kind == StepKind::transient; };
  if (does(StepKind::force) || step.kind == StepKind::release) loads.dead_force = dead_force(number, t);
  if (does(StepKind::move)) move(loads.held, t);
  for (std::size_t e = 0; e < case_.electrodes.size(); ++e) {
    const Drive* source = drive(e);
    if (!source) continue;
    if (does(StepKind::voltage) && source->voltage && !isolates(step, e))
      loads.voltage[e] = source->voltage->at(t);
    if (does(StepKind::charge) && source->charge && isolates(step, e))
      loads.charge[e] = source->charge->at(t);
  }
  return loads;
}

std::vector<double> StepLoads::kinks(const Step& step) const {
  std::vector<double> all;
  const auto add = [&](const Waveform& wave) {
    for (const double t : wave.kinks(0, *step.duration)) all.push_back(t / *step.duration);
  };
  for (const auto& [name, source] : case_.drives)
    for (const auto& wave : {source.voltage, source.charge})
      if (wave) add(*wave);
  for (const Load& load : case_.loads)
    for (const Waveform& wave : load.force) add(wave);
  for (const Support& support : case_.supports)
    for (const auto& wave : support.motion)
      if (wave) add(*wave);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

fem::LoadPath StepLoads::path(int number, const fem::Loads& start) const {
  const Step& step = steps_[static_cast<std::size_t>(number)];
  if (step.kind != StepKind::transient)
    return fem::linear_path(device_.model.dofs, start, at(number, start, 0));
  fem::LoadPath path;
  path.apply = [this, number, start, duration = *step.duration](fem::State& state, double s) {
    at(number, start, s * duration).apply(state, device_.model.dofs);
  };
  path.breaks = kinks(step);
  return path;
}

fem::RampOptions StepLoads::options(int number) const {
  const Step& step = steps_[static_cast<std::size_t>(number)];
  fem::RampOptions options{.newton = {case_.solver.tolerance, case_.solver.max_iterations},
                           .increments = step.increments,
                           .smallest_increment = case_.solver.smallest_increment,
                           .instantaneous = step.response == Response::instantaneous,
                           .time_tolerance = case_.solver.time_tolerance};
  if (!step.duration) return options;
  options.duration = *step.duration;
  if (step.record) options.landing = *step.record / *step.duration;
  // One backward Euler step of h errs by (h / tau)^2 / 2 of what is left to relax.
  const double shortest = shortest_relaxation(case_.film.material);
  if (std::isfinite(shortest)) options.first_time_step = std::sqrt(2 * options.time_tolerance) * shortest;
  return options;
}

} // namespace dielast::cases
