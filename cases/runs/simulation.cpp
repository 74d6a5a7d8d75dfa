// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/runs/simulation.hpp"

#include "cases/case/sudden_motion.hpp"
#include "cases/devices/pins.hpp"
#include "cases/devices/sections.hpp"
#include "cases/language/conditions.hpp"
#include "cases/quantities/film_values.hpp"
#include "cases/runs/phases.hpp"
#include "cases/warnings/load_warnings.hpp"
#include "fem/linear/rest.hpp"
#include "fem/paths/held_masses.hpp"
#include "fem/paths/homotopy.hpp"
#include "fem/paths/renumbering.hpp"
#include "post/engineering.hpp"
#include "post/files/checkpoint_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace dielast::cases {

namespace {

/// Forces below this fraction of the film's own leave the drawn state in equilibrium.
constexpr double balanced = 1e-9, balanced_shells = 1e-2;

const std::string drawn = "drawn"; ///< name of the state before the first step

/// Those of which extremes are needed.
post::WantedScalars wanted(const Measurement& measurement) {
  std::vector<std::string> names = measurement.scalars();
  for (const char* scalar : Watch::scalars)
    if (std::ranges::count(names, scalar) == 0) names.emplace_back(scalar);
  return post::WantedScalars(std::move(names));
}

} // namespace

Simulation::Simulation(const Case& one, int threads)
    : case_(one), threads_(threads), holding_(holding_in(one, one.steps, 0)), now_(held_by(one, holding_)),
      device_(build_device(now_)), measurement_(one, device_), signals_(signals_of(one)),
      watch_(one, device_), scalars_(wanted(measurement_)), steps_(one.steps),
      results_(one.quantities.size(), std::numeric_limits<double>::quiet_NaN()),
      rises_(one.quantities.size(), 0) {
  require_one_motion(one, device_.mesh, device_.model.dofs);
  equilibrium_.emplace(device_.model, threads);
  frame_ = frame_force();
  const auto film_force = [this] {
    double largest = 0;
    for (int b = 0; b < device_.films; ++b)
      largest =
          std::max(largest, equilibrium_->assembler().block_residuals()[static_cast<std::size_t>(b)].norm());
    return largest;
  };
  double force = film_force();
  Eigen::VectorXd of_films = Eigen::VectorXd::Zero(frame_.size());
  for (int b = 0; b < device_.films; ++b)
    of_films += equilibrium_->assembler().block_residuals()[static_cast<std::size_t>(b)];
  fem::State wider = device_.model.initial_state(); // film without tension is at rest within its rounding
  for (std::size_t n = 0; n < wider.displacement.size(); ++n)
    wider.displacement[n] = 1e-3 * device_.model.drawn[n];
  Eigen::VectorXd residual;
  equilibrium_->assembler().residual(wider, residual);
  force = std::max(force, film_force());
  const double rest = std::max(balanced * force, equilibrium_->round_off());
  const bool at_rest = frame_.norm() <= rest;
  // Next to curved sides the strains of shells, which are interpolated, are not quite in balance.
  const bool shells = device_.bears_compression && !device_.solid;
  const double nearly_rest = shells ? std::max(rest, balanced_shells * force) : rest;
  const auto is_held = [&](Eigen::VectorXd forces) { // where the film pulls at bodies only, these may hold it
    device_.model.dofs.gather(device_.model.initial_state(), forces);
    return forces.head(device_.model.dofs.free_count()).norm() <= nearly_rest;
  };
  // A film drawn in tension with free edges must find its equilibrium before it can be driven.
  const bool settles = !at_rest && (steps_.empty() || steps_.front().kind != StepKind::release);
  if (settles) {
    if (const auto taken = std::ranges::find(steps_, "settle", &Step::name); taken != steps_.end()) {
      throw one.error_at(
          fmt::format("step[{}].name", taken - steps_.begin() + 1),
          "\"settle\" is taken by the step that cuts the film free before the first; call this "
          "one otherwise, or say so by a first [[step]] of kind \"release\"");
    }
    steps_.insert(steps_.begin(), {StepKind::release, "settle", 1});
  }
  if (holding_in(case_, steps_, 0) != holding_) {
    enter(0);
    frame_ = frame_force();
  }
  require_devices(one, steps_, holding_);
  for (const Diagnostic& warning : one.warnings) warnings_.push_back(warning.text());
  for (const std::string& warning : device_.warnings) warnings_.push_back(warning);
  if (settles && !is_held(frame_) && !one.any_geometry<Patch>())
    warnings_.push_back(settle_warning(one, is_held(of_films)));
  fem::State drawn_state = device_.model.initial_state();
  drawn_state.dead_force = frame_;
  in_step_.ramp.points = {{0, std::move(drawn_state)}};
  loads_.emplace(now_, device_, steps_, signals_, frame_);
}

double Simulation::error_of_course(const Quantity& quantity) const {
  return measurement_.error_of_course(quantity);
}

/// What has moved comes to rest at the beginning of a step without inertia: the step goes on from there.
/// False where there is no rest; refusal_ says so.
bool Simulation::come_to_rest(fem::State& state) {
  const Step& step = steps_[static_cast<std::size_t>(step_)];
  if (step.inertia || !state.motion) return true;
  const bool moves = fem::moves_on(*equilibrium_, state);
  const double kinetic = energy_.parts().kinetic;
  std::optional<fem::State> rest = fem::at_rest(*equilibrium_, state, loads_->options(step_));
  if (!rest) {
    refusal_ = {
        Ending::gave_up, "no equilibrium",
        fmt::format("step \"{0}\" is without inertia and begins in motion, and no equilibrium was found "
                    "where the device would come to rest; give \"{0}\" inertia = true, or let it come "
                    "to rest before by damping",
                    step.name)};
    return false;
  }
  state = *std::move(rest);
  come_to(state);
  const auto release = energy_.add_after_jump(fem::energy_point(*equilibrium_, state, 1, held_));
  measurement_.all({device_, *equilibrium_, state, energy_, scalars_, &held_}); // courses go on from there
  if (moves)
    news_.push_back(
        {"came to rest", "",
         fmt::format("step \"{}\" is without inertia and begins in motion ({} of kinetic energy): it "
                     "goes on from where the device comes to rest; {} were released",
                     step.name, post::engineering(kinetic, "J"), post::engineering(release.energy, "J")),
         post::Moment{0, state.time, voltages(state)}});
  return true;
}

Eigen::VectorXd Simulation::frame_force() {
  Eigen::VectorXd force;
  equilibrium_->assembler().residual(device_.model.initial_state(), force); // on tied nodes where they are
  force.segment(device_.model.dofs.free_count(), device_.model.dofs.held_count()).setZero();
  return force;
}

void Simulation::lead_to(const std::vector<double>& voltages, int increments) {
  steps_.back().increments = increments;
  for (std::size_t e = 0; e < voltages.size(); ++e) {
    const auto& circuit = device_.model.ports[e].circuit; // what leaks divides the source's voltage
    now_.drives[case_.electrodes[e].name].voltage =
        Waveform::constant_at(circuit ? circuit->holding_source(voltages[e]) : voltages[e]);
  }
}

/// The state is the last one that is accounted for.
void Simulation::come_to(const fem::State& state) {
  accounted_ = state;
  held_ = fem::holding(*equilibrium_, state);
}

void Simulation::account(const fem::State& state, const fem::Increment& increment, Reached reached) {
  if (increment.turns) energy_.corner();
  const fem::State before = accounted_;
  const double energy_before = held_.energy;
  come_to(state);
  fem::EnergyPoint point = fem::energy_point(*equilibrium_, state, increment.length, held_);
  point.flowed = increment.flowed;
  if (!energy_.empty()) {
    point.flow = fem::flow_heat(*equilibrium_, before, energy_before, state, held_.energy);
    if (increment.turns) point.impulses = fem::work_of_impulses(device_.model, before, state);
    if (point.impulses != 0 && watch_.active.insert("sudden motion").second)
      news_.push_back(struck(sudden_motion_so_far(case_, steps_, step_)));
    fem::follow_spins(device_.model.dofs, before, state, energy_.record().points.back().mechanical.coordinate,
                      point.mechanical.coordinate);
  }
  time_steps_.count += increment.time_error > 0 ? 1 : 0;
  time_steps_.error += increment.time_error;
  std::optional<fem::EnergyBalance::JumpRelease> release;
  if (records_ > 0 && steps_[static_cast<std::size_t>(step_)].kind == StepKind::release) {
    point.mechanical.force.head(state.dead_force.size()) -= loads_->cut(step_, in_step_.ramp.start, state);
    energy_.add_cut_free(std::move(point));
  } else if (reached == Reached::by_jump)
    release = energy_.add_after_jump(std::move(point));
  else
    energy_.add(std::move(point));
  taken_ = {taken_.states + 1, taken_.iterations + increment.newton.iterations};
  if (records_ == 0) return;
  const Step& step = steps_[static_cast<std::size_t>(step_)];
  const bool unseen = step.duration && !step.inertia && device_.model.inertia().mass.nonZeros() > 0;
  if (reached == Reached::by_jump) {
    news_.push_back(jumped(release, unseen));
    unseen_ = {}; // neither the jump nor the way to the limit before it has a speed that time steps resolve
  } else if (unseen) {
    unseen_.pass(device_.model, before, state);
  }
}

/// Whether there is a reason; refusal_ says so then.
bool Simulation::refuses(const Step& step, double load_factor, const char* kind, const std::string& why) {
  if (why.empty()) return false;
  refusal_ = {Ending::gave_up, kind,
              fmt::format("step \"{}\" stopped: at load factor {:.4g} {}", step.name, load_factor, why)};
  return true;
}

/// Whether film can be in that state, wherever it comes from; otherwise refusal_ says why not.
bool Simulation::admits(const Step& step, double load_factor, const fem::State& state) {
  refusal_.reset();
  return !refuses(step, load_factor, "loss of permittivity", permittivity_limit(case_, device_, state));
}

/// Whether an increment may lead there from the last accepted state; otherwise refusal_ says why not.
bool Simulation::leads(const Step& step, double load_factor, const fem::State& state) {
  return admits(step, load_factor, state) &&
         !refuses(step, load_factor, "limit point", snap_of_wrinkles(device_, accounted_, state));
}

/// Shows the state to the signals that want to see it; otherwise refusal_ says which cannot go on.
bool Simulation::sample(const Step& step, double load_factor, Measured& measured) {
  if (step.kind != StepKind::transient) return true;
  const double t = load_factor * *step.duration;
  for (const auto& [load, signal] : signals_) {
    if (!signal->samples(t)) continue;
    measured.may_rest = false;
    const std::string wrong = signal->sample(t, said_of(now_, load), measured, measurement_);
    if (wrong.empty()) continue;
    refusal_ = {Ending::gave_up, "no measurement", fmt::format("step \"{}\" stopped: {}", step.name, wrong)};
    return false;
  }
  return true;
}

/// Looks for events and peaks in every accepted state, whatever is recorded.
bool Simulation::accept(const SimulationObserver& observer, const Step& step, const fem::State& state,
                        const fem::Increment& increment, Reached reached) {
  const double s = increment.load_factor;
  if (!admits(step, s, state) ||
      (!step.inertia && refuses(step, s, "slack ribbon", pushed_ribbon(case_, device_, state)))) {
    unrecorded_.reset(); // the state is not one of the run
    return false;
  }
  account(state, increment, reached);
  unrecorded_ = increment;
  if (increment.lands && (step.duration || increment.load_factor >= 1) && pins_bear(state)) return false;
  Measured measured(device_, *equilibrium_, state, energy_, scalars_, &held_);
  if (!sample(step, increment.load_factor, measured)) return false;
  if (increment.lands) return record(observer, step, measured, increment, reached);
  measured.may_rest = !step.duration;
  measurement_.all(measured);
  for (post::Event& event : events(step, measured, increment, reached)) {
    if (std::ranges::count(news_, event.kind, &post::Event::kind) > 0) continue; // one of a kind for a record
    if (!event.before) {
      event.before = {increment.load_factor, state.time, voltages(state)};
      if (step.duration) event.message += fmt::format(" (at {})", post::engineering(state.time, "s"));
    }
    news_.push_back(std::move(event));
  }
  return !observer.goes_on || observer.goes_on();
}

/// What begins at an accepted state, and where on the way to it.
std::vector<post::Event> Simulation::events(const Step& step, const Measured& measured,
                                            const fem::Increment& increment, Reached reached, bool ends) {
  std::vector<post::Event> events =
      watch_.check(measured.state, measured.extremes, increment.newton.unstable_modes, ends,
                   reached == Reached::to_its_end);
  if (!events.empty() && records_ > 0 && reached == Reached::along_path && !increment.jumped &&
      !in_step_.followed) {
    const fem::RampProgress& ramp = in_step_.ramp;
    const fem::LoadPath path = loads_->path(step_, ramp.start);
    const fem::RampOptions options = loads_->options(step_);
    watch_.locate(events,
                  {ramp.points, path, increment.load_factor, step.duration.has_value(), options, threads_});
  }
  return events;
}

std::vector<double> Simulation::voltages(const fem::State& state) const {
  std::vector<double> voltages;
  for (std::size_t p = 0; p < state.voltage.size(); ++p)
    if (device_.model.ports[p].is_electrode()) voltages.push_back(state.voltage[p]);
  return voltages;
}

bool Simulation::record(const SimulationObserver& observer, const Step& step, Measured& measured,
                        const fem::Increment& increment, Reached reached) {
  unrecorded_.reset();
  const bool is_drawn = records_ == 0;
  const bool ends = !is_drawn && increment.load_factor >= 1;
  const fem::State& state = measured.state;
  measured.may_rest = ends || !step.duration;
  if (ends) measurement_.step_ended(step.name, measured);
  const std::vector<double> values = measurement_.all(measured);
  for (std::size_t q = 0; q < values.size(); ++q) {
    const std::string& at = case_.quantities[q].at;
    if (!at.empty() && !(ends && at == step.name)) continue;
    results_[q] = values[q];
    if (ends) rises_[q] = measurement_.rise(q, measured);
  }
  const fem::NewtonResult& newton = increment.newton;
  energy_.judge(equilibrium_->energy_scale(), records_, step_);
  if (const auto energy = energy_.worst(); ends && energy.is_poor())
    news_.push_back(poor_energy(energy, steps_, sudden_motion_so_far(case_, steps_, step_)));
  const double negligible = 1e-12 * std::max(energy_.record().exchanged, equilibrium_->energy_scale());
  if (ends && unseen_.kinetic > negligible) {
    constexpr double notable = 0.02; // the square of a frequency over the lowest natural one
    const double work = unseen_.work(equilibrium_->assembler(), state);
    if (work > 0 && unseen_.kinetic > notable * work) news_.push_back(left_out(unseen_.kinetic / work, step));
  }
  std::vector<post::Event> news = std::exchange(news_, {});
  std::ranges::move(events(step, measured, increment, reached, ends), std::back_inserter(news));
  const post::StepRecord record{.index = records_++,
                                .step = is_drawn ? drawn : step.name,
                                .load_factor = increment.load_factor,
                                .time = state.time,
                                .voltages = voltages(state),
                                .iterations = newton.iterations,
                                .residual = newton.residual,
                                .unstable_modes = newton.unstable_modes,
                                .events = std::move(news),
                                .jumped = increment.jumped};
  return !observer.on_accept ||
         observer.on_accept({record, measured, values, ends, reached == Reached::to_its_end});
}

Outcome Simulation::run(const SimulationObserver& observer) {
  fem::RampProgress& ramp = in_step_.ramp;
  if (records_ == 0 && !accept(observer, {}, ramp.points.back().state, {}, Reached::along_path))
    return {Ending::interrupted};
  for (; step_ < static_cast<int>(steps_.size()); ++step_) {
    const Step& step = steps_[static_cast<std::size_t>(step_)];
    if (observer.on_step) observer.on_step(step);
    if (step.is_analysis()) {
      if (!observer.on_analysis) continue;
      try {
        const std::optional<fem::State> lying = upright(device_, state());
        const fem::State& at = lying ? *lying : state();
        observer.on_analysis(analyse(case_, device_, *equilibrium_, at, step), at);
      } catch (const AnalysisError& error) {
        return {Ending::gave_up, "no vibration", fmt::format("step \"{}\": {}", step.name, error.what())};
      }
      continue;
    }
    if (ramp.load_factor >= 1 || ramp.increment == 0) {
      fem::State state = ramp.points.back().state;
      if (device_.free_body && device_.pins.empty())
        change_supports(state); // what drifts has no place to rest
      if (!come_to_rest(state)) return *std::exchange(refusal_, std::nullopt);
      change_supports(state);
      loads_->begin(step_, state);
      if (device_.model.ports.any_circuit())
        energy_.reconnect(fem::energy_point(*equilibrium_, state, 0, held_));
      unseen_ = {};
      in_step_.jumps = 0;
      in_step_.folds.clear();
      ramp = fem::RampProgress::begin(state, device_.model.dofs, loads_->options(step_));
      if (step.kind == StepKind::release) energy_.cut(loads_->cut(step_, ramp.start, state));
      for (const auto& [load, signal] : signals_) signal->begin(step.duration.value_or(0));
      if (const auto event = no_voltage(case_, step)) news_.push_back(*event);
      if (step.kind == StepKind::transient && !signals_.empty()) {
        Measured measured(device_, *equilibrium_, ramp.points.back().state, energy_, scalars_);
        if (!sample(step, 0, measured)) return *std::exchange(refusal_, std::nullopt);
      }
    }
    const fem::RampOptions options = loads_->options(step_);
    const fem::LoadPath path = loads_->path(step_, ramp.start);
    const StepObserver watcher{
        observer.on_try,
        observer.on_iteration,
        observer.on_cutback,
        [&](const fem::CriticalPoint& critical, const post::Event& event) {
          news_.push_back(event);
          news_.back().before = {critical.load_factor, critical.state.time, voltages(critical.state)};
          if (observer.on_critical) observer.on_critical(critical, event);
        },
        [&](double s, const fem::State& state) { return leads(step, s, state); },
        [this](const fem::State& state) { return law_limit(case_, device_, state); },
        [&](const fem::State& state, const fem::Increment& increment, Reached reached) {
          return accept(observer, step, state, increment, reached);
        },
        observer.goes_on};
    const Outcome outcome = StepRun(*equilibrium_, step, path, options, in_step_, watcher,
                                    {.follow = may_follow(case_, step), .jump = may_jump(case_)})
                                .run();
    if ((outcome.ending == Ending::gave_up || refusal_) && unrecorded_) {
      Measured measured(device_, *equilibrium_, state(), energy_, scalars_, &held_);
      record(observer, step, measured, *unrecorded_);
    }
    if (refusal_) return *std::exchange(refusal_, std::nullopt);
    if (outcome.ending != Ending::complete) return outcome;
  }
  const auto last = // Clang 14 knows no views of ranges
      std::find_if(steps_.rbegin(), steps_.rend(), [](const Step& step) { return !step.is_analysis(); });
  return last == steps_.rend() || last->inertia ? Outcome{} : end_at_rest(*equilibrium_, state());
}

} // namespace dielast::cases
