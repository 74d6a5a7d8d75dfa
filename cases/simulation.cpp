#include "cases/simulation.hpp"

#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace dielast::cases {

namespace {

/// Forces below this fraction of the film's own leave the drawn state in equilibrium.
constexpr double balanced = 1e-9;

const std::string drawn = "drawn"; ///< name of the state before the first step

} // namespace

Simulation::Simulation(const Case& one, int threads)
    : case_(one), device_(build_device(one)), equilibrium_(device_.model, threads),
      measurement_(one, device_), watch_(device_), steps_(one.steps),
      results_(one.quantities.size(), std::numeric_limits<double>::quiet_NaN()) {
  frame_force_ = frame_force();
  const double film_force = equilibrium_.assembler().block_residuals().front().norm();
  const bool at_rest = frame_force_.norm() <= std::max(balanced * film_force, equilibrium_.round_off());
  // A film drawn in tension with free edges must find its equilibrium before it can be driven.
  if (!at_rest && (steps_.empty() || steps_.front().kind != StepKind::release))
    steps_.insert(steps_.begin(), {StepKind::release, "settle", 1});
  fem::State drawn_state = device_.model.initial_state();
  drawn_state.dead_force = frame_force_;
  ramp_.points = {{0, std::move(drawn_state)}};
}

Eigen::VectorXd Simulation::frame_force() {
  Eigen::VectorXd force;
  equilibrium_.internal_force(device_.model.initial_state(), force);
  force.tail(force.size() - device_.model.dofs.free_count()).setZero();
  return force;
}

/// The frame's forces until a release, the loads from the first step that applies them, the drives from the
/// first voltage step.
fem::RampTarget Simulation::target(int number, const fem::RampTarget& start) const {
  bool released = false, loaded = false, driven = false;
  for (int i = 0; i <= number; ++i) {
    const StepKind kind = steps_[static_cast<std::size_t>(i)].kind;
    released |= kind == StepKind::release;
    loaded |= kind == StepKind::force;
    driven |= kind == StepKind::voltage;
  }
  fem::RampTarget target{start.voltage, released ? device_.rest.dead_force : frame_force_};
  if (loaded) target.dead_force += device_.loads;
  for (std::size_t e = 0; driven && e < case_.electrodes.size(); ++e)
    if (const auto drive = case_.drives.find(case_.electrodes[e].name); drive != case_.drives.end())
      target.voltage[e] = drive->second;
  return target;
}

fem::RampOptions Simulation::options(const Step& step) const {
  return {{case_.solver.tolerance, case_.solver.max_iterations},
          step.increments,
          case_.solver.smallest_increment};
}

SimulationProgress Simulation::progress() const {
  return {step_, records_, ramp_, measurement_.rest_lengths, watch_.active};
}

void Simulation::resume(const SimulationProgress& progress) {
  step_ = progress.step + (progress.ramp.load_factor >= 1 ? 1 : 0); // that step is done
  records_ = progress.records;
  ramp_ = progress.ramp;
  measurement_.rest_lengths = progress.rest_lengths;
  watch_.active = progress.active_events;
}

bool Simulation::accept(const SimulationObserver& observer, const Step& step, const fem::State& state,
                        double load_factor, const fem::NewtonResult& newton) {
  const bool is_drawn = records_ == 0;
  const bool ends = !is_drawn && load_factor >= 1;
  const fem::Samples samples = device_.model.sample(state);
  Eigen::VectorXd force;
  equilibrium_.internal_force(state, force);
  const post::Extremes extremes(samples);
  const Measured measured{state, samples, extremes, force};
  if (ends) measurement_.step_ended(step.name, measured);
  const std::vector<double> values = measurement_.all(measured);
  for (std::size_t q = 0; q < values.size(); ++q) {
    const std::string& at = case_.quantities[q].at;
    if (at.empty() || (ends && at == step.name)) results_[q] = values[q];
  }
  const post::StepRecord record{.index = records_++,
                                .step = is_drawn ? drawn : step.name,
                                .load_factor = load_factor,
                                .voltages = state.voltage,
                                .iterations = newton.iterations,
                                .residual = newton.residual,
                                .negative_pivots = newton.negative_pivots,
                                .events = watch_.check(state, extremes, newton.negative_pivots)};
  return !observer.on_accept || observer.on_accept({record, measured, values, ends});
}

Outcome Simulation::run(const SimulationObserver& observer) {
  if (records_ == 0 && !accept(observer, {}, ramp_.points.back().state, 0, {})) return {Ending::interrupted};
  for (; step_ < static_cast<int>(steps_.size()); ++step_) {
    const Step& step = steps_[static_cast<std::size_t>(step_)];
    if (observer.on_step) observer.on_step(step);
    if (ramp_.load_factor >= 1 || ramp_.increment == 0)
      ramp_ = fem::RampProgress::begin(ramp_.points.back().state, options(step));
    const fem::RampTarget goal = target(step_, ramp_.start);
    const fem::RampObserver watcher{observer.on_try, observer.on_iteration, observer.on_cutback,
                                    [&](const fem::RampProgress& now, const fem::Increment& increment) {
                                      return accept(observer, step, now.points.back().state,
                                                    increment.load_factor, increment.newton);
                                    }};
    const fem::RampResult result = fem::ramp(equilibrium_, goal, options(step), ramp_, watcher);
    if (result.end == fem::RampEnd::stopped) return {Ending::interrupted};
    if (result.end == fem::RampEnd::gave_up) return failure(step, result, goal);
  }
  return {Ending::complete};
}

Outcome Simulation::failure(const Step& step, const fem::RampResult& result,
                            const fem::RampTarget& goal) const {
  if (result.failure.outcome == fem::Outcome::singular)
    return {
        Ending::gave_up, "singular tangent",
        fmt::format(
            "step \"{}\" stopped at load factor {:.4g}: the tangent is singular. Part of the device can move "
            "freely: hold it with [[support]]; an unstretched film in space has no stiffness normal to "
            "itself: stretch it or use model = \"planar\"",
            step.name, ramp_.load_factor)};
  if (step.kind == StepKind::voltage && ramp_.load_factor > 0) {
    const auto& from = ramp_.start.voltage;
    std::size_t leading = 0; // the electrode whose voltage changes most
    for (std::size_t e = 0; e < from.size(); ++e)
      if (std::abs(goal.voltage[e] - from[e]) > std::abs(goal.voltage[leading] - from[leading])) leading = e;
    const auto at = [&](double s) {
      return post::engineering((1 - s) * from[leading] + s * goal.voltage[leading], "V", post::Ratio::plain,
                               3);
    };
    return {Ending::gave_up, "limit point",
            fmt::format("limit point near {}: equilibrium found up to {}, none at {}. Lower drive.voltage, "
                        "or stiffen the "
                        "device or stretch the film more, to stay below it",
                        at(ramp_.load_factor), at(ramp_.load_factor), at(result.failed_at))};
  }
  return {Ending::gave_up, "no equilibrium",
          fmt::format(
              "step \"{}\" stopped at load factor {:.4g}: no equilibrium found at {:.4g} after cutting the "
              "increment to {:.2g}. Try more increments, a finer mesh, or a smaller prestretch",
              step.name, ramp_.load_factor, result.failed_at, case_.solver.smallest_increment)};
}

} // namespace dielast::cases
