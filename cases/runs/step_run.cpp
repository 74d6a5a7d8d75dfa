// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/runs/step_run.hpp"

#include "cases/loads/load_text.hpp"
#include "fem/model/contact_block.hpp"
#include "fem/paths/held_masses.hpp"
#include "fem/paths/jump.hpp"
#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace dielast::cases {

namespace {

constexpr int most_jumps = 100;
/// Loads beyond a limit point at which the device jumps, as a part of the step.
constexpr double beyond = 1e-6;
/// Those beyond a bifurcation: the branch on which it lands may leave tangentially, and be one with the path
/// within round-off until the loads have gone on.
constexpr std::array further{1e-2, 1e-1};
/// Displacements along a mode at which another branch is looked for, over the model's extent: those of thin
/// films are less than their thickness.
constexpr std::array branch_amplitudes{1e-3, 1e-4, 1e-5};
/// Load factors and lengths along a path between what is located twice as one limit point.
constexpr double same_load = 1e-8, same_place = 1e-4;
/// Eigenvalue of the lowest mode, over the stiffness as drawn, below which a timed step has come to a limit.
constexpr double critical_in_time = 1e-3;

const char* word(fem::Instability kind) {
  return kind == fem::Instability::limit_point ? "limit point" : "bifurcation";
}

} // namespace

bool is_critical(const std::string& kind) {
  return kind == word(fem::Instability::limit_point) || kind == word(fem::Instability::bifurcation);
}

/// Loads of s, and dashpots that do what they do in this step.
fem::State StepRun::loaded(fem::State state, double s) const {
  path_.apply(state, s);
  state.scheme =
      timed() || options_.instantaneous ? materials::TimeScheme::frozen() : materials::TimeScheme::relaxed();
  return state;
}

std::string StepRun::load_text(const fem::State& at, double s) const {
  return cases::load_text(model(), path_, at, s, timed());
}

std::string StepRun::load_text(double s) const {
  fem::State at = last();
  path_.apply(at, s);
  return load_text(at, s);
}

/// A critical point at which the step ends is called what the step's failure() is.
void StepRun::announce(const fem::CriticalPoint& critical, bool ends) {
  if (!observer_.on_critical) return;
  const bool branches_off = critical.kind == fem::Instability::bifurcation;
  const double s = critical.load_factor;
  const std::string load = timed() ? load_text(critical.state, s) : load_text(s);
  post::Event event{.kind = word(ends ? fem::Instability::limit_point : critical.kind),
                    .branches_off = branches_off};
  event.message = fmt::format("{} {} {}{}", event.kind, ends ? "near" : "at", load,
                              ends && branches_off ? " (a bifurcation)" : "");
  observer_.on_critical(critical, event);
}

/// The last equilibrium before stability is lost is a result of its own. An interrupt waits for what comes of
/// it, or for the next step of the jump from there.
void StepRun::accept_critical(const fem::CriticalPoint& critical) {
  fem::RampProgress& ramp = progress_.ramp;
  const double length = critical.load_factor - ramp.load_factor;
  if (length <= 0) return;
  ramp.load_factor = critical.load_factor;
  ramp.slope.reset();
  ramp.points = {{0, model().settled(critical.state)}};
  accept(ramp.points.back().state, {ramp.load_factor, {}, true, length}, Reached::to_its_end);
}

bool StepRun::accept(const fem::State& state, const fem::Increment& increment, Reached reached) {
  accepted_ = {increment.load_factor, state};
  return !observer_.on_accept || observer_.on_accept(state, increment, reached);
}

/// Whether the path is followed by arclength from such a point on: that finds its critical points, too.
bool StepRun::finds_by_arclength(fem::Instability kind) const {
  return step_.on_instability == OnInstability::follow &&
         (kind == fem::Instability::limit_point || step_.on_bifurcation == OnBifurcation::follow);
}

/// The critical point between the last accepted state and the load factor s, where Newton's method has found
/// `another` state, less stable or not of this path, or none.
std::optional<fem::CriticalPoint> StepRun::locate(double s, bool another) {
  const double reached = progress_.ramp.load_factor;
  return fem::locate_by_load_control(equilibrium_, path_, loaded(last(), reached), reached, s,
                                     options_.newton, another, [this] { return goes_on(); });
}

/// The last accepted state, where it is about to lose its stability at the pace of the step; with inertia,
/// that of what has no mass.
std::optional<fem::CriticalPoint> StepRun::limit_in_time() const {
  fem::State state = last(); // with its own loads: those of this load factor may not all act yet
  state.scheme = materials::TimeScheme::frozen();
  if (options_.inertia) state = fem::with_masses_held(equilibrium_, std::move(state));
  auto mode = fem::lowest_mode(equilibrium_, state);
  if (!mode || std::abs(mode->eigenvalue) > critical_in_time) return std::nullopt;
  return fem::CriticalPoint{fem::Instability::limit_point, progress_.ramp.load_factor, std::move(state),
                            std::move(*mode)};
}

/// A state under load control. Where stability was lost on the way, the critical point is located; a step
/// that leaves its path there does not accept the unstable state, nor one that stops at instabilities any.
/// Where loads jump, and dashpots flow at the beginning of a step, states follow at one load factor.
bool StepRun::on_ramp(const fem::RampProgress& now, const fem::Increment& increment) {
  int unstable = increment.newton.unstable_modes;
  const auto loses = [&] { return increment.unstable_before >= 0 && unstable > increment.unstable_before; };
  if (loses() && !timed() && equilibrium_.factor(loaded(now.points.back().state, increment.load_factor)))
    unstable = equilibrium_.tangent().unstable_modes(); // Newton's method may know that of a step before
  const bool lost = loses();
  const bool switches = step_.on_bifurcation == OnBifurcation::switch_branch;
  const bool jumps = step_.on_instability == OnInstability::jump;
  const bool begins_unstable = jumps && !lost && unstable > 0;
  const bool leaves = stops() ? unstable > 0 : begins_unstable || (lost && (switches || jumps));
  if (!leaves && (timed() || !lost)) return accept(now.points.back().state, increment, Reached::along_path);
  Trouble trouble{{fem::RampEnd::gave_up, increment.load_factor, increment.newton}, {}, unstable};
  // back to the last stable state
  const fem::RampProgress beyond_it = progress_.ramp;
  progress_.ramp.unstable_modes = increment.unstable_before;
  const bool in_place = increment.load_factor == accepted_.parameter;
  if (in_place)
    progress_.ramp.points = {{now.points.back().parameter, accepted_.state}};
  else if (now.points.size() > 1)
    progress_.ramp.points.pop_back();
  progress_.ramp.load_factor = accepted_.parameter;
  if (lost && timed())
    trouble.critical = limit_in_time();
  else if (lost && !in_place)
    trouble.critical = locate(increment.load_factor, true);
  const bool passes = trouble.critical && trouble.critical->is_none;
  if (interrupted_ || passes || (leaves && (trouble.critical || stops() || begins_unstable || in_place))) {
    leaving_ = std::move(trouble);
    return false;
  }
  progress_.ramp = beyond_it;
  if (trouble.critical) {
    trouble.critical->kind = fem::Instability::bifurcation; // the path goes on: the load does not turn
    announce(*trouble.critical, false);
  }
  return accept(now.points.back().state, increment, Reached::along_path);
}

Outcome StepRun::run() {
  fem::RampObserver watcher{observer_.on_try, observer_.on_iteration, observer_.on_cutback, observer_.admits,
                            [this](const fem::RampProgress& now, const fem::Increment& increment) {
                              return on_ramp(now, increment);
                            }};
  while (progress_.followed || progress_.ramp.load_factor < 1) {
    if (progress_.followed) {
      if (const auto outcome = follow()) return *outcome;
      continue;
    }
    Trouble trouble{fem::ramp(equilibrium_, path_, options_, progress_.ramp, watcher)};
    if (trouble.ramp.end == fem::RampEnd::complete) break;
    if (trouble.ramp.end == fem::RampEnd::endless)
      return {Ending::gave_up, "no end", endless_text(step_.name, progress_.ramp.load_factor, options_)};
    if (trouble.ramp.end == fem::RampEnd::stopped) {
      if (!leaving_) return {Ending::interrupted};
      trouble = *std::exchange(leaving_, std::nullopt);
    } else if (trouble.ramp.failure.outcome == fem::Outcome::refused) {
      return {Ending::gave_up}; // whoever refuses says why
    } else if (const std::string limit = observer_.law_limit(last()); !limit.empty()) {
      return {Ending::gave_up, "stretch limit",
              fmt::format("step \"{}\" stopped at {}: {}", step_.name, load_text(progress_.ramp.load_factor),
                          limit)};
    } else if (timed()) {
      trouble.critical = limit_in_time();
    } else if (trouble.ramp.failure.outcome != fem::Outcome::singular && !is_slack()) {
      const bool another = progress_.ramp.beside || trouble.ramp.failure.outcome == fem::Outcome::converged;
      trouble.critical = locate(trouble.ramp.failed_at, another);
      if (trouble.critical && !trouble.critical->beyond && finds_by_arclength(trouble.critical->kind))
        trouble.critical.reset();
    }
    if (interrupted_) return {Ending::interrupted, between_states};
    if (trouble.critical && trouble.critical->beyond) {
      if (!pass(std::move(*trouble.critical))) return {Ending::interrupted};
      continue;
    }
    if (const auto outcome = leave(trouble)) return *outcome;
  }
  return {};
}

/// Goes on where nothing loses its stability, as where a branch has come back to the path that it had left.
bool StepRun::pass(fem::CriticalPoint critical) {
  if (observer_.on_critical && !critical.is_none)
    observer_.on_critical(critical, {.kind = "branches meet",
                                     .message = fmt::format("the path goes on along the stable one, from {}",
                                                            load_text(critical.load_factor))});
  fem::RampProgress& ramp = progress_.ramp;
  const double s = critical.beyond->parameter, length = s - ramp.load_factor;
  ramp.load_factor = s;
  ramp.slope.reset();
  ramp.beside = false;
  ramp.points = {{0, model().settled(std::move(critical.beyond->state))}};
  return accept(ramp.points.back().state, {s, {}, true, length}, Reached::along_path);
}

/// Load control has ended; nothing where the step goes on.
std::optional<Outcome> StepRun::leave(const Trouble& trouble) {
  // What meets no stiffness before either loses its stability by rounding.
  if (trouble.critical && !timed() &&
      fem::moves_freely(equilibrium_, loaded(last(), progress_.ramp.load_factor)))
    return singular();
  const bool branches_off = trouble.critical && trouble.critical->kind == fem::Instability::bifurcation;
  const bool switches = branches_off && step_.on_bifurcation == OnBifurcation::switch_branch;
  const bool jumps = step_.on_instability == OnInstability::jump || step_.kind == StepKind::release;
  const bool ends = !switches && !jumps && (step_.on_instability == OnInstability::stop || timed());
  if (trouble.critical) announce(*trouble.critical, ends);
  if (switches) {
    for (const double amplitude : branch_amplitudes) {
      if (progress_.followed) break;
      progress_.followed =
          fem::switch_branch(equilibrium_, path_, *trouble.critical, amplitude * model().extent, arcs());
      // A branch that is unstable from its beginning is none that a device takes.
      if (jumps && progress_.followed && progress_.followed->newton.unstable_modes > 0)
        progress_.followed.reset();
    }
    if (progress_.followed) return std::nullopt;
  }
  if (jumps) return jump(trouble);
  if (ends || switches) {
    if (trouble.critical) accept_critical(*trouble.critical);
    return failure(trouble);
  }
  const double s = progress_.ramp.load_factor;
  progress_.followed = fem::begin_continuation(equilibrium_, path_, loaded(last(), s), s, arcs());
  if (!progress_.followed) return failure(trouble);
  return std::nullopt;
}

/// Loads that may change their direction lead back beyond the step's beginning, as those of what snaps from
/// one stable shape to another; a field has none, it pulls as (-Phi)^2.
fem::ContinuationOptions StepRun::arcs() const {
  const bool of_field = step_.kind == StepKind::voltage || step_.kind == StepKind::charge;
  return {.newton = options_.newton, .lowest = of_field ? 0.0 : -1.0};
}

/// Whether the followed path has passed this critical point before, as a path passes each limit point once
/// only unless it is a closed loop.
bool StepRun::comes_back(const fem::ContinuationProgress& now, const fem::CriticalPoint& critical) {
  if (critical.kind != fem::Instability::limit_point) return false;
  const bool known = std::ranges::any_of(progress_.folds, [&](const fem::PathPoint& fold) {
    return std::abs(fold.parameter - critical.load_factor) <= same_load &&
           fem::distance(equilibrium_, now, fold.state, critical.state) <= same_place;
  });
  if (!known) progress_.folds.push_back({critical.load_factor, critical.state});
  return known;
}

std::optional<Outcome> StepRun::follow() {
  bool interrupted = false, loops = false;
  fem::ContinuationObserver watcher;
  std::optional<fem::CriticalPoint> critical;
  // Where a mode or the load turns the path has passed a critical point; a step without one led to another.
  watcher.admits = [&](const fem::ContinuationProgress& from, const fem::ContinuationProgress& to) {
    critical.reset();
    const bool changes = from.newton.unstable_modes != to.newton.unstable_modes;
    if (changes) critical = fem::locate(equilibrium_, path_, from, to, options_.newton);
    const bool turns = from.load_direction * to.load_direction < 0;
    return critical || (!changes && !turns) ||
           std::abs(to.last_arc) <= fem::ContinuationOptions::largest_corner;
  };
  watcher.on_accept = [&](const fem::ContinuationProgress& now) {
    if (critical) {
      announce(*critical, false);
      loops = comes_back(now, *critical);
    }
    fem::State state = model().settled(now.state);
    progress_.followed = now;
    progress_.ramp.points = {{0, state}};
    progress_.ramp.load_factor = std::min(now.load_factor, std::nextafter(1.0, 0.0)); // until the end
    interrupted = !accept(state, {now.load_factor, now.newton, true, now.last_arc}, Reached::along_path);
    return !interrupted && !loops;
  };
  watcher.on_cutback = [this](double) {
    if (observer_.on_cutback) observer_.on_cutback(progress_.followed->load_factor, {});
  };
  fem::ContinuationProgress progress = *progress_.followed;
  const fem::ContinuationEnd end = fem::continuation(equilibrium_, path_, arcs(), progress, watcher);
  if (interrupted) return Outcome{Ending::interrupted};
  const double s = progress.load_factor;
  if (loops)
    return Outcome{
        Ending::gave_up, "no equilibrium",
        fmt::format("step \"{}\": the path is a closed loop: after {} states, at {}, it is where it was "
                    "before; it does not lead to the loads at the step's end",
                    step_.name, progress.steps, load_text(s))};
  progress_.followed.reset();
  if (end == fem::ContinuationEnd::reached_load && s >= 1) {
    progress_.ramp.load_factor = 1;
    return end_of_branch(progress.newton.unstable_modes);
  }
  return Outcome{Ending::gave_up, "no equilibrium",
                 end == fem::ContinuationEnd::reached_load
                     ? fmt::format("step \"{}\": the path led back to the loads at the step's beginning{}",
                                   step_.name, s < 0 ? ", and as far beyond them" : "")
                     : fmt::format("step \"{}\": the path was followed through {} states, to {}; there it {}",
                                   step_.name, progress.steps, load_text(s),
                                   end == fem::ContinuationEnd::gave_up ? "could not be followed any further"
                                                                        : "was left: that is the most")};
}

/// A branch that was switched to may be unstable where the step ends: where modes lie next to one another
/// others lose their stability with that of the branch.
std::optional<Outcome> StepRun::end_of_branch(int unstable_modes) {
  if (step_.on_bifurcation != OnBifurcation::switch_branch || step_.on_instability == OnInstability::follow ||
      unstable_modes == 0 || equilibrium_.is_neutral(loaded(last(), 1), 0, options_.newton))
    return std::nullopt;
  if (step_.on_instability == OnInstability::jump)
    return jump({{fem::RampEnd::gave_up, 1}, {}, unstable_modes});
  return Outcome{
      Ending::gave_up, "instability",
      fmt::format("step \"{}\": the branch that it was switched to is unstable at its end ({} unstable "
                  "mode{}): a device would leave it; on_instability = \"jump\" leads to where it would go",
                  step_.name, unstable_modes, unstable_modes == 1 ? "" : "s")};
}

/// Where a film cannot be let go slowly, as its frame gives way under dead forces, it is let go at once: it
/// follows the frame's pull, or where that keeps a symmetry that the device loses, the critical mode.
std::vector<StepRun::Departure> StepRun::departures(const Trouble& trouble) {
  const auto& critical = trouble.critical;
  std::vector<Departure> all;
  if (step_.kind == StepKind::release) {
    fem::Balance pull;
    fem::State released = loaded(last(), 1);
    equilibrium_.balance(released, pull);
    all.push_back({1, std::move(released), -pull.force.head(model().dofs.free_count())});
    if (critical) all.push_back({1, loaded(critical->state, 1), critical->mode.direction});
  } else if (critical) {
    const bool branches_off = critical->kind == fem::Instability::bifurcation && !timed();
    for (const double more : branches_off ? std::span<const double>(further) : std::span(&beyond, 1)) {
      const double s = std::min(1.0, critical->load_factor + more);
      all.push_back({s, loaded(critical->state, s), critical->mode.direction});
    }
  } else if (const auto mode = fem::lowest_mode(equilibrium_, loaded(last(), progress_.ramp.load_factor))) {
    const double s = trouble.ramp.failed_at;
    all.push_back({s, loaded(last(), s), mode->direction});
  }
  return all;
}

std::optional<Outcome> StepRun::jump(const Trouble& trouble) {
  if (++progress_.jumps > most_jumps) return failure(trouble);
  fem::RampProgress& ramp = progress_.ramp;
  std::vector<Departure> ways = departures(trouble);
  if (ways.empty()) return failure(trouble);
  if (step_.kind != StepKind::release && trouble.critical) accept_critical(*trouble.critical);
  const fem::State before = last();
  fem::JumpResult result{.end = fem::JumpEnd::stuck};
  fem::State state;
  double s = 0;
  for (Departure& way : ways) {
    s = way.load_factor;
    state =
        options_.inertia ? fem::with_masses_held(equilibrium_, std::move(way.state)) : std::move(way.state);
    result = fem::jump(equilibrium_, state, way.direction,
                       {.newton = options_.newton, .goes_on = observer_.goes_on});
    if (result.end != fem::JumpEnd::stuck) break;
  }
  if (result.end == fem::JumpEnd::interrupted) return Outcome{Ending::interrupted, between_states};
  if (result.end != fem::JumpEnd::landed) {
    Outcome outcome = cause(trouble, {.follow = ways_on_.follow});
    outcome.message += fmt::format(". No stable state was found to jump to: the device {}",
                                   result.end == fem::JumpEnd::ran_away ? "runs away" : "is stuck");
    return outcome;
  }
  if (options_.inertia) state = fem::with_masses_let_go(model(), std::move(state), before);
  state = model().settled(std::move(state));
  if (timed()) state.time = before.time + (s - ramp.load_factor) * options_.duration;
  ramp.load_factor = s;
  ramp.increment = 1.0 / options_.increments;
  ramp.at_break = ramp.turns = true;
  ramp.beside = false;
  ramp.unstable_modes = result.newton.unstable_modes;
  ramp.slope.reset();
  ramp.points = {{0, state}};
  if (!accept(state, {s, result.newton}, Reached::by_jump)) return Outcome{Ending::interrupted};
  return std::nullopt;
}

} // namespace dielast::cases
