#include "fem/ramp.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr std::size_t most_points = 4; ///< of the predictor
constexpr double round_off = 1e-9;     ///< in load factors
constexpr double left_side = 1e-13;    ///< before a break, in load factors: the loads that hold until it
constexpr double most_growth = 2;      ///< of a time step: BDF2 is stable below 2.41
constexpr double safety = 0.9;
constexpr double jump_part = 1.0 / 8;      ///< of loads that jump
constexpr double smallest_in_time = 1e-10; ///< part of a step that takes time
constexpr double tiny = 1e-300;
constexpr double typical_motion = 1e-2; ///< of the extent, to which errors of the motion are compared

/// One step under load control.
class Ramp {
 public:
  Ramp(Equilibrium& equilibrium, const LoadPath& path, const RampOptions& options, RampProgress& progress,
       const RampObserver& observer)
      : equilibrium_(equilibrium), path_(path), options_(options), progress_(progress), observer_(observer),
        largest_(1.0 / options.increments), landing_(options.landing > 0 ? options.landing : largest_),
        smallest_(options.duration > 0 ? smallest_in_time : options.smallest_increment) {}

  RampResult run();

 private:
  bool timed() const { return options_.duration > 0; }
  const State& last() const { return progress_.points.back().state; }
  double parameter(double s) const { return timed() ? s : path_.parameter(s); }
  double next_break() const;
  double next_load_factor() const;
  materials::TimeScheme scheme(double dt) const;
  State solve(State state, double s);
  bool less_stable() const;
  bool pass_break();
  static double time_error(const History& past, const History& next);
  double motion_error(const GeneralisedAlpha& scheme, const Motion& past, const Motion& next) const;
  bool accept(State state, double s);
  bool notify(bool lands, double length);

  Equilibrium& equilibrium_;
  const LoadPath& path_;
  const RampOptions& options_;
  RampProgress& progress_;
  const RampObserver& observer_;
  double largest_, landing_, smallest_;
  NewtonResult newton_;
  bool jumped_ = false;  ///< at the last break
  double last_part_ = 0; ///< of that jump
};

double Ramp::next_break() const {
  for (const double at : path_.breaks)
    if (at > progress_.load_factor + round_off) return std::min(at, 1.0);
  return 1;
}

/// Steps end where results are wanted and at breaks; equal parts lead there, so that no sliver is left.
double Ramp::next_load_factor() const {
  const double s = progress_.load_factor;
  const double landing = (std::floor(s / landing_ + round_off) + 1) * landing_;
  const double goal = std::min(landing > 1 - round_off ? 1.0 : landing, next_break());
  const double parts = std::ceil((goal - s) / progress_.increment - round_off);
  return parts <= 1 ? goal : s + (goal - s) / parts;
}

materials::TimeScheme Ramp::scheme(double dt) const {
  if (!timed())
    return options_.instantaneous ? materials::TimeScheme::frozen() : materials::TimeScheme::relaxed();
  const double before = last().history ? last().history->step : 0;
  return before > 0 ? materials::TimeScheme::bdf2(dt, before) : materials::TimeScheme::backward_euler(dt);
}

State Ramp::solve(State state, double s) {
  const bool ends_at_break = std::abs(s - next_break()) < round_off && s < 1;
  path_.apply(state, ends_at_break || (timed() && s >= 1) ? s - left_side : s);
  const double dt = (s - progress_.load_factor) * options_.duration;
  state.history = last().history;
  state.time = last().time + dt;
  state.scheme = scheme(dt);
  if (options_.inertia) {
    state.motion = last().motion;
    state.motion_scheme = state.motion->step > 0 ? GeneralisedAlpha::of(dt, options_.high_frequencies)
                                                 : GeneralisedAlpha::backward_euler(dt);
  }
  newton_ = equilibrium_.solve(state, options_.newton, observer_.on_iteration);
  return state;
}

bool Ramp::less_stable() const {
  return newton_.outcome == Outcome::converged && progress_.unstable_modes >= 0 &&
         newton_.unstable_modes > progress_.unstable_modes;
}

/// Forgets the past, in which the loads went elsewhere, and lets loads that jump here act at once, in parts.
/// False where even the smallest part does not converge.
bool Ramp::pass_break() {
  progress_.at_break = false;
  progress_.turns = true;
  State state = last();
  if (state.history && state.history->step > 0)
    state.history = std::make_shared<const History>(History{state.history->now, {}, {}});
  const DofMap& dofs = equilibrium_.model().dofs;
  if (options_.inertia) {
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(dofs.count());
    Motion motion = state.motion ? *state.motion : Motion{position(state, dofs), rest, rest, rest};
    motion.acceleration = motion.unbalanced = rest;
    motion.step = 0;
    state.motion = std::make_shared<const Motion>(std::move(motion));
  }
  if (options_.first_time_step > 0)
    progress_.increment = std::min(largest_, options_.first_time_step / options_.duration);
  const Loads before = Loads::of(state, dofs);
  State goal = state;
  path_.apply(goal, progress_.load_factor);
  const Loads after = Loads::of(goal, dofs);
  state.scheme = materials::TimeScheme::frozen();
  const double at = parameter(progress_.load_factor);
  progress_.points = {{at, std::move(state)}};
  jumped_ = before != after;
  if (!jumped_) return true;
  const LoadPath jump = linear_path(dofs, before, after);
  double part = jump_part;
  for (double done = 0; done < 1;) {
    const double next = done + part > 1 - round_off ? 1.0 : done + part;
    State trial = last();
    jump.apply(trial, next);
    newton_ = {};
    if (options_.inertia)
      equilibrium_.conduct(trial);
    else
      newton_ = equilibrium_.solve(trial, options_.newton, observer_.on_iteration);
    if (newton_.outcome != Outcome::converged) {
      if ((part /= 2) < options_.smallest_increment) return false;
      continue;
    }
    progress_.points = {{at, std::move(trial)}};
    progress_.unstable_modes = newton_.unstable_modes;
    if (next < 1) notify(false, next - done);
    last_part_ = next - done;
    done = next;
  }
  return true;
}

/// Largest local error of the internal variables, relative; 0 where the past is too short to tell.
double Ramp::time_error(const History& past, const History& next) {
  if (past.step_before == 0) return 0;
  const double h = next.step, h1 = past.step, h2 = past.step_before;
  // Newton's polynomial through now, before, older at h after now
  const double scheme_error = h * h * (h + h1) * (h + h1) / (6 * (2 * h + h1));
  const double predictor_error = h * (h + h1) * (h + h1 + h2) / 6;
  const double share = scheme_error / (scheme_error + predictor_error);
  double largest = 0;
  for (std::size_t i = 0; i < next.now.size(); ++i) {
    const double slope = (past.now[i] - past.before[i]) / h1;
    const double slope_before = (past.before[i] - past.older[i]) / h2;
    const double curvature = (slope - slope_before) / (h1 + h2);
    const double predicted = past.now[i] + h * slope + h * (h + h1) * curvature;
    largest = std::max(largest, std::abs(next.now[i] - predicted) / std::max(1.0, std::abs(next.now[i])));
  }
  return share * largest;
}

double Ramp::motion_error(const GeneralisedAlpha& scheme, const Motion& past, const Motion& next) const {
  const Model& model = equilibrium_.model();
  const auto heavy = model.inertia.mass.diagonal().array() > 0;
  const bool starts = past.step == 0; // the whole acceleration is new to backward Euler
  const double factor = starts ? scheme.dt * scheme.dt / 2 : scheme.error_factor();
  const Eigen::VectorXd change = starts ? next.acceleration : next.acceleration - past.acceleration;
  return factor * heavy.select(change.array().abs(), 0).maxCoeff() / (typical_motion * model.extent);
}

bool Ramp::accept(State state, double s) {
  progress_.at_break = timed() && s < 1 && std::abs(s - next_break()) < round_off;
  const bool lands = std::abs(s / landing_ - std::round(s / landing_)) < round_off || s >= 1;
  const double length = s - progress_.load_factor;
  progress_.load_factor = s;
  progress_.unstable_modes = newton_.unstable_modes;
  progress_.points.push_back({parameter(s), std::move(state)});
  if (progress_.points.size() > most_points) progress_.points.erase(progress_.points.begin());
  return notify(lands, length);
}

/// Tells the observer; false when it wants to stop.
bool Ramp::notify(bool lands, double length) {
  const Increment increment{progress_.load_factor, newton_, lands, length, progress_.turns};
  progress_.turns = false;
  return !observer_.on_accept || observer_.on_accept(progress_, increment);
}

RampResult Ramp::run() {
  progress_.points.back().parameter = parameter(progress_.load_factor);
  while (progress_.load_factor < 1) {
    if (timed() && progress_.at_break) {
      if (!pass_break()) return {RampEnd::gave_up, progress_.load_factor, newton_};
      if (jumped_) {
        const bool goes_on = notify(true, last_part_);
        progress_.turns = true;
        if (!goes_on) return {RampEnd::stopped};
      }
    }
    const double s = next_load_factor();
    const double tried = s - progress_.load_factor;
    if (observer_.on_try) observer_.on_try(s);
    State trial = solve(extrapolate(progress_.points, parameter(s)), s);
    if ((newton_.outcome != Outcome::converged || less_stable()) && progress_.points.size() > 1)
      trial = solve(last(), s); // the predictor may have led astray
    if (newton_.outcome != Outcome::converged || (less_stable() && tried >= 2 * smallest_)) {
      if (observer_.on_cutback) observer_.on_cutback(s, newton_);
      progress_.increment = tried / 2;
      if (progress_.increment < smallest_) return {RampEnd::gave_up, s, newton_};
      continue;
    }
    State arrived = equilibrium_.model().settled(trial);
    if (!timed()) {
      progress_.increment = std::min(largest_, 2 * std::max(progress_.increment, tried));
    } else {
      double error = trial.history ? time_error(*trial.history, *arrived.history) : 0;
      if (options_.inertia)
        error = std::max(error, motion_error(trial.motion_scheme, *trial.motion, *arrived.motion));
      const double growth = safety * std::cbrt(options_.time_tolerance / std::max(error, tiny));
      progress_.increment = std::min(largest_, tried * std::clamp(growth, 0.2, most_growth));
      if (error > options_.time_tolerance && tried > smallest_) continue;
    }
    if (!accept(std::move(arrived), s)) return {RampEnd::stopped};
  }
  return {RampEnd::complete};
}

} // namespace

RampProgress RampProgress::begin(const State& state, const DofMap& dofs, const RampOptions& options) {
  const double largest = 1.0 / options.increments;
  return {.start = Loads::of(state, dofs), .increment = largest, .points = {{0, state}}};
}

RampResult ramp(Equilibrium& equilibrium, const LoadPath& path, const RampOptions& options,
                RampProgress& progress, const RampObserver& observer) {
  return Ramp(equilibrium, path, options, progress, observer).run();
}

} // namespace dielast::fem
