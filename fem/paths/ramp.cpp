// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/ramp.hpp"

#include "fem/model/contact_block.hpp"
#include "fem/paths/held_masses.hpp"
#include "fem/paths/homotopy.hpp"
#include "fem/paths/predictor.hpp"
#include "fem/paths/time_error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::fem {

namespace {

constexpr double round_off = load_factor_round_off;
constexpr double most_growth = 2, safety = 0.9; ///< of a time step: BDF2 is stable below 2.41
constexpr int jump_parts = 8;                   ///< of loads that jump
constexpr double smallest_on_path = 1e-9;       ///< of the load factor, where other branches are found
constexpr double first_moment = 1e-3;   ///< of an increment in time: its start, with dashpots that flow
constexpr double enough_progress = 0.1; ///< of a step, within the most tries
constexpr double most_faster = 1.5, faster_if_shortened = 1.25, fastest = 3; ///< see is_foreseen()
constexpr double farthest_slope = 100; ///< of an increment, over the model's extent

/// One step under load control.
class Ramp {
 public:
  Ramp(Equilibrium& equilibrium, const LoadPath& path, const RampOptions& options, RampProgress& progress,
       const RampObserver& observer)
      : equilibrium_(equilibrium), path_(path), options_(options), progress_(progress), observer_(observer),
        largest_(1.0 / options.increments), smallest_(options.smallest()) {
    if (options.inertia) massless_ = stiffness_without_mass(equilibrium, last());
  }

  RampResult run();

 private:
  bool timed() const { return options_.duration > 0; }
  /// The part of an increment at which it is on its way: at its very start dashpots do not flow.
  double setting_out() const { return timed() ? first_moment : 0; }
  const State& last() const { return progress_.points.back().state; }
  double smallest_off_path() const { return std::min(smallest_, smallest_on_path); }
  double parameter(double s) const { return timed() ? s : path_.parameter(s); }
  double next_break() const;
  double next_load_factor() const;
  materials::TimeScheme scheme(double dt) const;
  State solve(State state, double s, bool from_last);
  bool less_stable() const;
  LoadPath within(double s) const;
  Eigen::VectorXd slope_of_start(const LoadPath& increment);
  bool follows(const State& predicted, const State& trial, double s) const;
  bool goes_on(const State& predicted, const State& trial, double s);
  bool detour(const LoadPath& path, State start, const RampOptions& options, bool tells);
  bool pass_break();
  std::optional<RampResult> flow();
  bool accept(State state, double s);
  enum class Then { goes_on, turns, flowed };
  bool notify(bool lands, double length, Then then = Then::goes_on, bool jumped = false);

  Equilibrium& equilibrium_;
  const LoadPath& path_;
  const RampOptions& options_;
  RampProgress& progress_;
  const RampObserver& observer_;
  double largest_, smallest_;
  Eigen::VectorXd massless_; ///< with inertia, see stiffness_without_mass()
  NewtonResult newton_;
  std::optional<Eigen::VectorXd> slope_; ///< at the trial state
  int unstable_before_ = -1;             ///< unstable modes before the increment that is being accepted
  bool jumped_ = false;                  ///< at the last break
  double last_part_ = 0;                 ///< of that jump
  double time_error_ = 0;                ///< of the last time step
};

double Ramp::next_break() const {
  const auto next = std::ranges::upper_bound(path_.breaks, progress_.load_factor + round_off);
  return next == path_.breaks.end() ? 1.0 : std::min(*next, 1.0);
}

/// Steps end where results are wanted and at breaks; equal parts lead there, so that no sliver is left.
double Ramp::next_load_factor() const {
  const double s = progress_.load_factor;
  const double landing = options_.next_landing(s), stop = next_break();
  const double goal = landing > stop - round_off ? stop : landing;
  const double parts = std::ceil((goal - s) / progress_.increment - round_off);
  return parts <= 1 ? goal : s + (goal - s) / parts;
}

materials::TimeScheme Ramp::scheme(double dt) const {
  if (!timed())
    return options_.instantaneous ? materials::TimeScheme::frozen() : materials::TimeScheme::relaxed();
  const double before = last().history ? last().history->step : 0;
  return before > 0 ? materials::TimeScheme::bdf2(dt, before) : materials::TimeScheme::backward_euler(dt);
}

/// From a state, or from the last accepted one, whose tangent does not tell whether the end is stable.
State Ramp::solve(State state, double s, bool from_last) {
  const bool before = s < 1 ? std::abs(s - next_break()) < round_off : timed(); // of a jump of loads there
  const bool is_free = apply_freely(equilibrium_.model(), state, [&](State& loaded) {
    before ? path_.before(loaded, s) : path_.apply(loaded, s);
  });
  const double dt = (s - progress_.load_factor) * options_.duration;
  state.history = last().history;
  state.time = last().time + dt;
  state.scheme = scheme(dt);
  if (options_.inertia) {
    state.motion = last().motion;
    state.motion_scheme = state.motion->step > 0 ? GeneralisedAlpha::of(dt, options_.high_frequencies)
                                                 : first_step_of_motion(dt);
  }
  if (has_friction(equilibrium_.model())) bound_friction(equilibrium_.model(), state, false);
  newton_ = is_free ? equilibrium_.solve(state, options_.newton, observer_.on_iteration)
                    : NewtonResult{.outcome = Outcome::infeasible};
  if (from_last && newton_.outcome == Outcome::converged && newton_.iterations > 0 &&
      equilibrium_.precondition(state))
    newton_.unstable_modes = equilibrium_.tangent().unstable_modes();
  if (less_stable() && equilibrium_.is_neutral(state, progress_.unstable_modes, options_.newton))
    newton_.unstable_modes = progress_.unstable_modes;
  return state;
}

bool Ramp::less_stable() const {
  return newton_.outcome == Outcome::converged && progress_.unstable_modes >= 0 &&
         newton_.unstable_modes > progress_.unstable_modes;
}

/// The loads and the time scheme of the increment to s as functions of the part of it, 0..1.
LoadPath Ramp::within(double s) const {
  LoadPath path;
  path.apply = [this, s](State& state, double part) {
    const double s0 = progress_.load_factor;
    if (timed() && part >= 1)
      path_.before(state, s);
    else
      path_.apply(state, s0 + part * (s - s0));
    state.scheme = scheme(part * (s - s0) * options_.duration);
  };
  return path;
}

/// Of the increment's path at the last accepted state, as the increment sets out from it.
Eigen::VectorXd Ramp::slope_of_start(const LoadPath& increment) {
  State start = last();
  increment.apply(start, setting_out());
  if (!equilibrium_.precondition(start)) return {};
  const int modes = equilibrium_.tangent().unstable_modes();
  Eigen::VectorXd slope = slope_at(equilibrium_, increment, start, setting_out(), 1);
  if (progress_.unstable_modes < 0)
    progress_.unstable_modes = modes > 0 && equilibrium_.is_neutral(start, 0, options_.newton) ? 0 : modes;
  // Across slack film there is no stiffness but what rounding leaves of it.
  const bool is_rounding = slope.size() > 0 &&
                           slope.cwiseAbs().maxCoeff() > farthest_slope * equilibrium_.model().extent &&
                           equilibrium_.is_slack(last());
  return is_rounding ? Eigen::VectorXd() : slope;
}

/// Whether what has no mass has followed what has one continuously; the motion itself has no other branch.
bool Ramp::follows(const State& predicted, const State& trial, double s) const {
  return massless_.size() == 0 || is_still(equilibrium_, massless_, last(), trial) ||
         is_foreseen(equilibrium_.model().dofs, massless_, progress_.points, parameter(s), predicted, trial,
                     fastest, true);
}

/// Whether a converged trial lies on the path through the last accepted states.
bool Ramp::goes_on(const State& predicted, const State& trial, double s) {
  slope_.reset();
  const Model& model = equilibrium_.model();
  if (is_turned_over(model.corners, model.drawn, last(), trial)) return false;
  if (options_.inertia) return follows(predicted, trial, s);
  const bool wrinkles_alone = options_.newton.wrinkles && equilibrium_.film_moves_all();
  if (wrinkles_alone && equilibrium_.is_slack(last()))
    return equilibrium_.is_slack(trial) || leads_back_to_slack(equilibrium_, within(s), trial, options_);
  const double length = s - progress_.load_factor;
  // Increments become shorter before limit points, where what is foretold runs away.
  const bool shortened = !timed() && length < largest_ - round_off;
  const double faster = wrinkles_alone ? fastest : shortened ? faster_if_shortened : most_faster;
  const auto& points = progress_.points;
  if (is_foreseen(model.dofs, equilibrium_.stiffness(), points, parameter(s), predicted, trial, faster))
    return true;
  const LoadPath increment = within(s);
  // as long as its tangent is there
  const Eigen::VectorXd end = slope_at(equilibrium_, increment, trial, 1, -1, equilibrium_.solved());
  Steadiness steadiness = Steadiness::of_length(length);
  if (options_.newton.wrinkles && (is_wrinkled(model, last()) || is_wrinkled(model, trial)))
    steadiness = Steadiness::wrinkled(steadiness);
  const PathEnd to{trial, 1, end, equilibrium_.solved()};
  const Eigen::VectorXd start = progress_.slope ? length * *progress_.slope : slope_of_start(increment);
  if (!is_joined(equilibrium_, increment, {last(), setting_out(), start}, to, steadiness)) {
    // Friction gives a path a corner wherever a node starts or stops to slide, film where it wrinkles.
    if ((steadiness.beside_film || has_friction(model)) && is_beside_corner(model, predicted, trial))
      return true;
    progress_.slope = start / length;
    return false;
  }
  slope_ = end / length;
  return true;
}

/// Takes the last state along a path of its own, on which no time passes; the observer hears of all of its
/// states but the last.
bool Ramp::detour(const LoadPath& path, State start, const RampOptions& options, bool tells) {
  const double at = parameter(progress_.load_factor);
  RampProgress progress = RampProgress::begin(start, equilibrium_.model().dofs, options);
  progress.unstable_modes = progress_.unstable_modes;
  RampObserver watcher;
  watcher.on_iteration = observer_.on_iteration;
  watcher.on_accept = [&](const RampProgress& now, const Increment& increment) {
    const State& reached = now.points.back().state;
    progress_.points = {
        {at, options_.inertia ? with_masses_let_go(equilibrium_.model(), reached, start) : reached}};
    progress_.unstable_modes = increment.newton.unstable_modes;
    newton_ = increment.newton;
    last_part_ = increment.length;
    if (tells && now.load_factor < 1) notify(false, last_part_);
    return true;
  };
  const RampResult result = Ramp(equilibrium_, path, options, progress, watcher).run();
  if (result.end != RampEnd::complete) newton_ = result.failure;
  return result.end == RampEnd::complete;
}

/// Forgets the past, in which the loads went elsewhere, and lets loads that jump here act at once, in parts.
/// False where even the smallest part does not converge.
bool Ramp::pass_break() {
  progress_.at_break = false;
  progress_.turns = true;
  progress_.slope.reset();
  State state = last();
  if (state.history && state.history->step > 0) state.history = without_past(*state.history);
  const DofMap& dofs = equilibrium_.model().dofs;
  if (options_.inertia) {
    const double s = progress_.load_factor, ds = std::min(largest_, next_break() - s);
    state.motion = motion_setting_out(equilibrium_.model(), state, path_, s, ds, options_.duration);
  }
  if (options_.first_time_step > 0)
    progress_.increment =
        std::clamp(options_.first_time_step / options_.duration, std::min(smallest_, largest_), largest_);
  const Loads before = Loads::of(state, dofs);
  State goal = state;
  path_.apply(goal, progress_.load_factor);
  const Loads after = Loads::of(goal, dofs);
  state.scheme = materials::TimeScheme::frozen();
  const double at = parameter(progress_.load_factor);
  std::vector<Loads> recent;
  for (const PathPoint& point : progress_.points) recent.push_back(Loads::of(point.state, dofs));
  jumped_ = differ(before, after, recent) &&
            (progress_.load_factor == 0 || path_.jumps(dofs, goal, progress_.load_factor));
  progress_.points = {{at, state}};
  if (!jumped_) return true;
  LoadPath jump = linear_path(dofs, before, after, &equilibrium_.model().ports);
  const bool follows = options_.inertia && massless_.size() > 0;
  if (follows) jump = with_masses_held(equilibrium_, std::move(jump), state);
  if (!options_.inertia || follows)
    return detour(jump, std::move(state),
                  {.newton = options_.newton,
                   .increments = jump_parts,
                   .smallest_increment = options_.smallest_increment,
                   .instantaneous = true},
                  true);
  newton_ = {}; // everything has a mass: nothing moves
  last_part_ = 1.0 / jump_parts;
  for (int part = 1; part <= jump_parts; ++part) {
    jump.apply(state, part * last_part_);
    if (!fem::follow(equilibrium_, last(), state)) newton_.outcome = Outcome::infeasible;
    if (newton_.outcome == Outcome::infeasible) return false;
    progress_.points = {{at, state}};
    if (part < jump_parts) notify(false, last_part_);
  }
  return true;
}

/// Lets dashpots that have been frozen flow, and charge spread along sheets, with the loads as they are: what
/// that changes of the forces is taken away in parts. Says how the ramp ends where that leads to no
/// equilibrium, or to one that the observer does not want.
std::optional<RampResult> Ramp::flow() {
  State state = last();
  const bool begins = progress_.load_factor == 0 && !timed();
  if (!begins || options_.instantaneous || !state.history || state.scheme.is_relaxed()) return {};
  state.scheme = scheme(0);
  equilibrium_.conduct(state);
  const auto fades = [&](State from) {
    from.scheme = scheme(0);
    equilibrium_.conduct(from);
    const LoadPath path = fading_imbalance(equilibrium_, from);
    path.apply(from, 0);
    return detour(path, std::move(from),
                  {.newton = options_.newton, .smallest_increment = options_.smallest_increment}, false);
  };
  Balance relaxed;
  equilibrium_.balance(state, relaxed);
  if (relaxed.norm <= std::max(options_.newton.tolerance * relaxed.scale, equilibrium_.round_off())) {
    State end = equilibrium_.model().settled(std::move(state));
    const auto alike = [](double x, double y) { return std::abs(x - y) <= round_off * (1 + std::abs(y)); };
    if (std::ranges::equal(end.history->now, last().history->now, alike)) return {};
    progress_.points = {{parameter(progress_.load_factor), std::move(end)}}; // the shape is held
    newton_ = {.unstable_modes = std::max(0, progress_.unstable_modes)};
  } else if (const State start = last(); !fades(start)) { // which leaves a state of its own
    const auto end = flown(equilibrium_, start, options_);
    if (!end || !fades(*end)) return RampResult{RampEnd::gave_up, 0, newton_};
  }
  if (notify(false, 1, Then::flowed)) return {};
  return RampResult{RampEnd::stopped};
}

bool Ramp::accept(State state, double s) {
  progress_.at_break = timed() && s < 1 && std::abs(s - next_break()) < round_off;
  const bool lands =
      !timed() || s >= 1 || std::abs(s - options_.next_landing(progress_.load_factor)) < round_off;
  const double length = s - progress_.load_factor;
  progress_.beside = progress_.beside && length < largest_ - round_off;
  progress_.load_factor = s;
  unstable_before_ = std::exchange(progress_.unstable_modes, newton_.unstable_modes);
  progress_.slope = std::exchange(slope_, std::nullopt);
  progress_.points.push_back({parameter(s), std::move(state)});
  if (progress_.points.size() > (timed() || has_friction(equilibrium_.model()) ? most_in_time : most_at_rest))
    progress_.points.erase(progress_.points.begin());
  return notify(lands, length);
}

/// Tells the observer; false when it wants to stop. What it is told may be stored: `then` is known by it.
bool Ramp::notify(bool lands, double length, Then then, bool jumped) {
  const bool turned = std::exchange(progress_.turns, then != Then::goes_on);
  const int before = std::exchange(unstable_before_, -1);
  const double error = std::exchange(time_error_, 0.0);
  const Increment increment{progress_.load_factor, newton_, lands, length, turned, jumped, before, error,
                            then == Then::flowed};
  return !observer_.on_accept || observer_.on_accept(progress_, increment);
}

RampResult Ramp::run() {
  progress_.points.back().parameter = parameter(progress_.load_factor);
  if (const auto end = flow()) return *end;
  const double from = progress_.load_factor;
  for (double tries = 0; progress_.load_factor < 1; ++tries) {
    if (tries >= options_.most_tries * std::max(1.0, (progress_.load_factor - from) / enough_progress))
      return {RampEnd::endless, progress_.load_factor, newton_};
    if (timed() && progress_.at_break) {
      if (!pass_break()) return {RampEnd::gave_up, progress_.load_factor, newton_};
      if (jumped_ && options_.inertia)
        progress_.points.back().state.motion = motion_behind_jump(equilibrium_, last());
      if (jumped_ && !notify(true, last_part_, Then::turns, true)) return {RampEnd::stopped};
    }
    const double s = next_load_factor(), tried = s - progress_.load_factor;
    if (observer_.on_try) observer_.on_try(s);
    State predicted = predict(progress_.points, parameter(s));
    equilibrium_.model().dofs.carry(predicted);
    const bool from_last =
        progress_.points.size() == 1 || free_way(equilibrium_.model(), last(), predicted) < 1;
    if (from_last) predicted = last();
    State trial = solve(predicted, s, from_last);
    if ((newton_.outcome != Outcome::converged || less_stable()) && !from_last)
      trial = solve(last(), s, true); // the predictor may have led astray
    if (newton_.outcome == Outcome::converged && !goes_on(predicted, trial, s) &&
        !(timed() && tried < 2 * smallest_off_path() &&
          is_reached_continuously(equilibrium_, last(), trial, options_)))
      newton_.outcome = Outcome::off_path;
    if (newton_.outcome == Outcome::converged && observer_.admits && !observer_.admits(s, trial))
      newton_.outcome = Outcome::refused;
    if (newton_.outcome != Outcome::converged || (less_stable() && tried >= 2 * smallest_)) {
      if (observer_.on_cutback) observer_.on_cutback(s, newton_);
      progress_.increment = tried / 2;
      const bool off_path = newton_.outcome == Outcome::off_path;
      progress_.beside = progress_.beside || off_path;
      const double smallest = off_path ? smallest_off_path() : options_.smallest(progress_.beside);
      if (progress_.increment < smallest) return {RampEnd::gave_up, s, newton_};
      continue;
    }
    const auto flow = trial.history;
    const auto motion = trial.motion;
    const GeneralisedAlpha motion_scheme = trial.motion_scheme;
    State arrived = equilibrium_.model().settled(std::move(trial));
    if (!timed()) {
      progress_.increment = std::min(largest_, 2 * std::max(progress_.increment, tried));
    } else {
      double error = flow ? history_error(*flow, *arrived.history) : 0;
      if (options_.inertia)
        error = std::max(error, motion_error(equilibrium_.model(), motion_scheme, *motion, *arrived.motion));
      const double growth = safety * std::cbrt(options_.time_tolerance / std::max(error, 1e-300));
      progress_.increment = std::min(largest_, tried * std::clamp(growth, 0.2, most_growth));
      if (error > options_.time_tolerance && tried > smallest_) continue;
      time_error_ = error == 0 && flow && flow->now != arrived.history->now ? options_.time_tolerance : error;
      if (options_.inertia)
        arrived.motion = motion_now(equilibrium_.model(), arrived, path_, s, tried, options_.duration);
      if (flow && options_.outruns(tried)) arrived.history = without_past(*arrived.history);
    }
    if (!accept(std::move(arrived), s)) return {RampEnd::stopped};
  }
  return {RampEnd::complete};
}

} // namespace

RampResult ramp(Equilibrium& equilibrium, const LoadPath& path, const RampOptions& options,
                RampProgress& progress, const RampObserver& observer) {
  return Ramp(equilibrium, path, options, progress, observer).run();
}

} // namespace dielast::fem
