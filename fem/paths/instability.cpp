// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/instability.hpp"

#include "fem/model/contact_block.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace dielast::fem {

namespace {

constexpr double negligible = 1e-7;       ///< eigenvalue, over the largest seen on the way
constexpr double zero = 1e-3;             ///< likewise, of a bracket that has closed
constexpr double smallest_bracket = 1e-9; ///< over the first
constexpr double small_bracket = 1e-5;    ///< likewise, of one that cannot be made smaller
constexpr double least_reach = 1e-3;      ///< part of the way to a trial
constexpr double no_work = 1e-4;          ///< of the load on a mode: a bifurcation
constexpr double rounding = 1e-11;        ///< of that work, over mode and forces, reactions among them
constexpr int most_trials = 80;
constexpr int most_refused = 6; ///< steps along a path that end beyond what may be a critical point
/// Part of the step beyond a bracket that has closed, in which the eigenvalue must vanish. With friction it
/// leaps wherever a node starts or stops to slide: it must vanish closer by, and have fallen to this part.
constexpr double near = 1e-2, near_with_friction = 1e-5, fallen = 0.1;
constexpr double vanished = 1e-5;            ///< eigenvalue of a state from which no path leads on
constexpr double load_tolerance = 1e-7;      ///< of a critical load factor
constexpr double farthest_turn = 1e-6;       ///< beyond a bracket that has closed
constexpr double just_before_end = 1 - 1e-9; ///< a step that reaches a turn does not reach its end
/// Of the load factor, where a state is looked for: so little that the jump of an edge that slips shows.
constexpr std::array just_beyond{1e-5, 1e-4};
constexpr double nearer = 0.5;     ///< than before a critical point: states beyond that are joined with it
constexpr double along_mode = 0.7; ///< cosine between a mode and the way to the branch
constexpr double one_way = 0.99;   ///< cosine between changes of a slope that grows along one mode
/// Part of the way to the extrapolated critical load that the next trial goes.
constexpr double approach = 0.9;

/// A converged state under load control and what it says about the way to go.
struct LoadPoint {
  double s = 0;
  State state;
  std::optional<Mode> mode; ///< absent where many modes are next to one another
  Eigen::VectorXd slope;    ///< of the path
};

/// Of the load on a mode.
struct WorkOnMode {
  double share = 0; ///< |x . dR/ds| over |x| |dR/ds|, norms with D and its inverse
  bool is_rounding = false;
};

WorkOnMode work_on(const Mode& mode, Equilibrium& equilibrium, const LoadPath& path, const State& state,
                   double s) {
  const Eigen::VectorXd& D = equilibrium.stiffness();
  const Eigen::VectorXd& weight = equilibrium.weight();
  const Eigen::VectorXd forces = load_derivative(equilibrium, path, state, s);
  const Eigen::VectorXd load = forces.head(D.size());
  const double work = std::abs(mode.direction.dot(load));
  const double sizes =
      std::sqrt(mode.direction.dot(D.cwiseProduct(mode.direction)) * load.dot(load.cwiseQuotient(D)));
  // In film that is held all around the field does no work but on reactions: what else there is, is rounding.
  const double least = rounding * mode.direction.cwiseQuotient(weight.head(D.size())).norm() *
                       forces.cwiseProduct(weight).norm();
  return {sizes > 0 ? work / sizes : 0, work <= least};
}

} // namespace

Instability classify(Equilibrium& equilibrium, const LoadPath& path, const State& state, double s,
                     const Mode& mode) {
  const WorkOnMode work = work_on(mode, equilibrium, path, state, s);
  return work.share > no_work && !work.is_rounding ? Instability::limit_point : Instability::bifurcation;
}

std::optional<CriticalPoint> locate(Equilibrium& equilibrium, const LoadPath& path,
                                    const ContinuationProgress& before, const ContinuationProgress& after,
                                    const NewtonOptions& options) {
  struct End {
    double arc;
    std::optional<double> eigenvalue; ///< unknown at first: it may belong to another mode
  };
  const int modes = before.newton.unstable_modes;
  if (after.newton.unstable_modes == modes) return std::nullopt;
  End low{0, {}}, high{after.last_arc, {}};
  ContinuationProgress base = before; // arcs count from here
  std::optional<ContinuationProgress> nearer;
  std::optional<CriticalPoint> best;
  double largest = 0, reach = 1;
  int fewest = std::numeric_limits<int>::max(); ///< modes by which a state beyond differs
  int best_gained = 0;
  bool closed = false;
  for (int trial = 0; trial < most_trials && reach > least_reach && !closed; ++trial) {
    const double width = high.arc - low.arc;
    double part = 0.5;
    if (low.eigenvalue && high.eigenvalue && *low.eigenvalue * *high.eigenvalue < 0 && trial % 4 != 3)
      part = std::clamp(*low.eigenvalue / (*low.eigenvalue - *high.eigenvalue), 1e-4, 1 - 1e-4);
    const double arc = low.arc + reach * part * width;
    auto at = arc_step(equilibrium, path, base, arc, options);
    if (!at) { // too far: in shorter steps, from nearer by
      reach /= 2;
      if (nearer) base = *std::exchange(nearer, std::nullopt);
      high.arc -= std::exchange(low.arc, 0);
      continue;
    }
    reach = 1;
    closed = width <= smallest_bracket * after.last_arc;
    std::optional<double> eigenvalue;
    // Beyond several critical points the mode that is nearest to vanishing may be that of a later one.
    const int gained = std::abs(at->newton.unstable_modes - modes);
    if (gained > 0 && gained < fewest) {
      if (best_gained > gained) best.reset();
      fewest = gained;
    }
    if (auto mode = lowest_mode(equilibrium, at->state)) {
      eigenvalue = mode->eigenvalue;
      largest = std::max(largest, std::abs(*eigenvalue));
      closed = closed || (gained <= fewest && std::abs(*eigenvalue) <= negligible * largest);
      if (gained <= fewest && (!best || std::abs(*eigenvalue) < std::abs(best->mode.eigenvalue))) {
        best = CriticalPoint{{}, at->load_factor, at->state, *std::move(mode)};
        best_gained = gained;
      }
    }
    if (at->newton.unstable_modes == modes) {
      low = {arc, eigenvalue};
      nearer = std::move(at);
    } else {
      high = {arc, eigenvalue};
    }
  }
  // Where several modes vanish at once the path may not be followed through the last of the way.
  closed = closed || high.arc - low.arc <= small_bracket * after.last_arc;
  // A bracket that closes on no zero holds points of two paths.
  if (!closed || !best || std::abs(best->mode.eigenvalue) > zero * largest) return std::nullopt;
  // Whether the load turns tells what it is: modes that vanish close by make the one that is found a mixture.
  const bool turns = before.load_direction * after.load_direction < 0;
  const bool alone = std::abs(after.newton.unstable_modes - modes) == 1;
  best->kind = turns && !alone ? classify(equilibrium, path, best->state, best->load_factor, best->mode)
               : turns         ? Instability::limit_point
                               : Instability::bifurcation;
  return best;
}

namespace {

/// See CriticalPoint::beyond. On a branch the way that is left to the critical state goes with the square
/// root of the load that is left. `modes`: unstable ones before.
std::optional<PathPoint> find_beyond(Equilibrium& equilibrium, const LoadPath& path,
                                     const std::vector<LoadPoint>& points, double critical_load, int modes,
                                     const NewtonOptions& options) {
  const auto left = [&](const LoadPoint& point) { return std::sqrt(std::abs(critical_load - point.s)); };
  const LoadPoint& last = points.back();
  auto former = std::find_if(points.rbegin(), points.rend(),
                             [&](const LoadPoint& point) { return left(point) > 3 * left(last); });
  if (former == points.rend() && points.size() > 1 && left(points.front()) > left(last)) --former;
  if (former == points.rend()) return std::nullopt;
  const DofMap& dofs = equilibrium.model().dofs;
  const auto distance = [&](const State& from, const State& to) {
    const Eigen::VectorXd way = dofs.increment(from, to);
    return std::sqrt(way.dot(equilibrium.stiffness().cwiseProduct(way)));
  };
  const PathPoint past[] = {{-left(*former), former->state}, {-left(last), last.state}};
  State critical = extrapolate(past, 0);
  dofs.carry(critical);
  const double way = distance(former->state, critical) / left(*former);
  for (const double further : just_beyond) {
    State there = critical;
    const double s = critical_load + std::copysign(further, critical_load - former->s);
    path.apply(there, s);
    if (s > 1 || equilibrium.solve(there, options).outcome != Outcome::converged) continue;
    const auto mode = lowest_mode(equilibrium, there);
    if (mode && last.mode && mode->eigenvalue > std::abs(last.mode->eigenvalue) &&
        equilibrium.tangent().unstable_modes() <= modes &&
        distance(critical, there) < nearer * way * std::sqrt(further))
      return PathPoint{s, std::move(there)};
  }
  return std::nullopt;
}

/// The state at load factor `end` to which a path leads by arclength, if its load does not turn on the way
/// and no more than so many modes are unstable.
std::optional<PathPoint> reach(Equilibrium& equilibrium, const LoadPath& path, const LoadPoint& from,
                               double end, int modes, const NewtonOptions& newton) {
  if (end <= from.s) return std::nullopt;
  const ContinuationOptions options{
      .newton = newton, .most_steps = most_trials, .lowest = from.s, .highest = end};
  auto progress = begin_continuation(equilibrium, path, from.state, from.s, options);
  if (!progress) return std::nullopt;
  int refused = 0;
  const auto is_sound = [&](const ContinuationProgress& at) {
    return at.load_direction > 0 && at.newton.unstable_modes <= modes;
  };
  ContinuationObserver watcher;
  watcher.admits = [&](const ContinuationProgress&, const ContinuationProgress& to) {
    return is_sound(to) || ++refused > most_refused;
  };
  watcher.on_accept = is_sound;
  if (continuation(equilibrium, path, options, *progress, watcher) != ContinuationEnd::reached_load ||
      progress->load_factor < end || !is_sound(*progress))
    return std::nullopt;
  return PathPoint{end, progress->state};
}

/// Near a limit point the slope v of the path grows along the critical mode, as one over the root of the load
/// that is left: its changes from point to point are along that mode, of which K v = -dR/ds tells the
/// eigenvalue. So limit points are seen whose modes are hidden by others nearer to zero: those of a slender
/// device where film gives way in a cell, and where it gives way in two at once, that of their difference.
std::optional<CriticalPoint> find_turn(Equilibrium& equilibrium, const LoadPath& path,
                                       const std::vector<LoadPoint>& points) {
  const auto last = points.rbegin();
  if (points.size() < 3 ||
      std::any_of(last, last + 3, [](const LoadPoint& point) { return point.slope.size() == 0; }))
    return std::nullopt;
  const Eigen::VectorXd& D = equilibrium.stiffness();
  const auto product = [&D](const Eigen::VectorXd& u, const Eigen::VectorXd& v) {
    return u.dot(D.cwiseProduct(v));
  };
  Eigen::VectorXd mode = last[0].slope - last[1].slope;
  const Eigen::VectorXd before = last[1].slope - last[2].slope;
  if (!(product(mode, before) > one_way * std::sqrt(product(mode, mode) * product(before, before))))
    return std::nullopt;
  const auto eigenvalue = [&](const LoadPoint& at) {
    return -mode.dot(load_derivative(equilibrium, path, at.state, at.s).head(mode.size())) /
           product(mode, at.slope);
  };
  const double now = eigenvalue(last[0]), former = eigenvalue(last[1]);
  const double left = now * now * (last[0].s - last[1].s) / (former * former - now * now);
  const double ahead = std::copysign(1.0, last[0].s - last[1].s) * left;
  if (!(ahead >= -load_tolerance && ahead <= farthest_turn)) return std::nullopt;
  normalise(equilibrium.model().dofs, last->state, mode);
  CriticalPoint turn{{},
                     std::min(last->s + left, std::max(last->s, just_before_end)),
                     last->state,
                     {now, std::move(mode)},
                     {}};
  turn.kind = classify(equilibrium, path, turn.state, last->s, turn.mode);
  if (turn.kind == Instability::bifurcation) return std::nullopt; // what there is of the mode is of rounding
  return turn;
}

} // namespace

std::optional<CriticalPoint> locate_by_load_control(Equilibrium& equilibrium, const LoadPath& path,
                                                    const State& state, double s_before, double s_beyond,
                                                    const NewtonOptions& options, bool another,
                                                    const std::function<bool()>& goes_on) {
  std::vector<LoadPoint> points;
  int modes = -1;
  const auto attempt = [&](State trial, double s) {
    path.apply(trial, s);
    if (equilibrium.solve(trial, options).outcome != Outcome::converged) return false;
    auto mode = lowest_mode(equilibrium, trial);
    if (!mode && !equilibrium.factor(trial)) return false;
    // of the tangent in the state itself, where Newton's method may know that of a step before
    const int unstable = equilibrium.tangent().unstable_modes();
    if (modes >= 0 && unstable > modes) {
      another = true;
      return false;
    }
    const double length = points.empty() ? s - s_beyond : s - points.back().s;
    Eigen::VectorXd slope = slope_at(equilibrium, path, trial, s, -length);
    if (!points.empty()) {
      const LoadPoint& last = points.back();
      const Model& model = equilibrium.model();
      // Friction gives a path a corner wherever a node starts or stops to slide: its slopes tell nothing.
      if (is_turned_over(model.corners, model.drawn, last.state, trial) ||
          (!has_friction(model) && !is_joined(equilibrium, path, {last.state, last.s, last.slope},
                                              {trial, s, slope}, Steadiness::kinked()))) {
        another = true;
        return false;
      }
    }
    modes = unstable;
    points.push_back({s, std::move(trial), std::move(mode), std::move(slope)});
    return true;
  };
  if (equilibrium.model().dofs.free_count() == 0 || !attempt(state, s_before)) return std::nullopt;
  Instability kind{};
  double critical_load = s_beyond;
  const auto exponent = [&kind] { return kind == Instability::limit_point ? 2.0 : 1.0; };
  // Where the eigenvalue will vanish, extrapolated from the last two points; NaN where these do not tell.
  const auto extrapolated = [&] {
    if (points.size() < 2 || !points.back().mode || !points[points.size() - 2].mode)
      return std::numeric_limits<double>::quiet_NaN();
    const LoadPoint &last = points.back(), &former = points[points.size() - 2];
    const auto remains = [&](const LoadPoint& p) {
      return std::pow(std::abs(p.mode->eigenvalue), exponent());
    };
    return last.s + remains(last) * (last.s - former.s) / (remains(former) - remains(last));
  };
  /// Towards where the eigenvalue will vanish, through two points, as of a path whose way goes with that
  /// power of the load that is left.
  const auto foreseen = [&](const LoadPoint& former, double estimate, double s, double power) {
    const auto place = [&](double at) { return -std::pow(std::abs(estimate - at), power); };
    const PathPoint past[] = {{place(former.s), former.state}, {place(points.back().s), points.back().state}};
    State start = extrapolate(past, place(s));
    equilibrium.model().dofs.carry(start);
    return start;
  };
  const double end = s_beyond;
  for (int trial = 0; trial < most_trials && std::abs(s_beyond - points.back().s) > load_tolerance; ++trial) {
    if (goes_on && !goes_on()) return std::nullopt;
    const LoadPoint& last = points.back();
    double s = (last.s + s_beyond) / 2;
    State start = last.state;
    if (points.size() > 1 && last.mode) {
      kind = classify(equilibrium, path, last.state, last.s, *last.mode);
      const double estimate = extrapolated();
      const bool inside = (estimate - last.s) * (s_beyond - estimate) > 0;
      if (inside) {
        critical_load = estimate;
        if (std::abs(critical_load - last.s) < load_tolerance) break;
        s = last.s + approach * (critical_load - last.s);
        start = foreseen(points[points.size() - 2], estimate, s, 1 / exponent());
      } else if (const double further = last.s + approach * (estimate - last.s);
                 (estimate - s_beyond) * (s_beyond - last.s) > 0 && further <= 1) {
        // Newton's method has failed before the path ends. On a branch that comes back to the path that it
        // has left the way goes with the root, the eigenvalue with the load that is left.
        const bool other = another;
        const auto as_far = std::find_if(points.rbegin(), points.rend() - 1, [&](const LoadPoint& point) {
          return std::abs(last.s - point.s) >= std::abs(further - last.s);
        });
        if (attempt(foreseen(*as_far, estimate, further, 0.5), further)) {
          const double there = 2 * estimate - further;
          s_beyond = critical_load = end > s_before ? std::max(end, there) : std::min(end, there);
          continue;
        }
        another = other;
      }
    }
    if (!attempt(std::move(start), s) && !attempt(points.back().state, s)) s_beyond = critical_load = s;
  }
  const LoadPoint& last = points.back();
  if (std::min(std::abs(s_beyond - last.s), std::abs(critical_load - last.s)) > load_tolerance)
    return std::nullopt;
  const double first = points.front().mode ? std::abs(points.front().mode->eigenvalue) : 0;
  const bool falls = last.mode && std::abs(last.mode->eigenvalue) < fallen * first;
  const bool slides = has_friction(equilibrium.model());
  if (last.mode) kind = classify(equilibrium, path, last.state, last.s, *last.mode);
  // What rounding alone has moved along the mode is at a bifurcation; the first state tells, as it grows.
  if (!slides && another && last.mode && !(falls && kind == Instability::limit_point) &&
      !work_on(*last.mode, equilibrium, path, points.front().state, points.front().s).is_rounding)
    if (auto there = reach(equilibrium, path, last, end, modes, options))
      return CriticalPoint{{}, end, there->state, {}, std::move(there), true};
  if (!slides && !(falls && kind == Instability::limit_point))
    if (auto turn = find_turn(equilibrium, path, points)) {
      turn->beyond = find_beyond(equilibrium, path, points, turn->load_factor, modes, options);
      return turn;
    }
  if (!last.mode) return std::nullopt;
  CriticalPoint critical{kind, critical_load, last.state, *last.mode, {}};
  const auto is_close = [&] {
    const double ahead = std::copysign(1.0, end - s_before) * (extrapolated() - last.s);
    return ahead > -load_tolerance && ahead < (slides ? near_with_friction : near) && (!slides || falls);
  };
  const bool vanishes = points.size() > 1 ? is_close() : std::abs(last.mode->eigenvalue) < vanished;
  if (!vanishes && !another) attempt(State(last.state), s_beyond); // which may find another
  if (!vanishes && !another) return std::nullopt;
  critical.beyond = find_beyond(equilibrium, path, points, critical_load, modes, options);
  return critical;
}

std::optional<ContinuationProgress> switch_branch(Equilibrium& equilibrium, const LoadPath& path,
                                                  const CriticalPoint& critical, double amplitude,
                                                  const ContinuationOptions& options) {
  const Eigen::VectorXd& mode = critical.mode.direction;
  const double length =
      std::sqrt(mode.dot(equilibrium.stiffness().cwiseProduct(mode)) / equilibrium.energy_scale());
  ContinuationProgress across{.state = critical.state,
                              .load_factor = critical.load_factor,
                              .direction = std::copysign(1 / length, amplitude) * mode,
                              .arc = options.first_arc};
  // The load of a branch may rise so steeply that its tangent is soon next to normal to the mode; how far the
  // branch has gone along it tells.
  auto branch = arc_step(equilibrium, path, across, std::abs(amplitude) * length, options.newton, true);
  if (!branch) return branch;
  const auto product = [&D = equilibrium.stiffness()](const Eigen::VectorXd& u, const Eigen::VectorXd& v) {
    return u.dot(D.cwiseProduct(v));
  };
  const Eigen::VectorXd way = equilibrium.model().dofs.increment(critical.state, branch->state);
  if (std::abs(product(way, mode)) < along_mode * std::sqrt(product(way, way) * product(mode, mode)))
    return std::nullopt;
  branch->steps = 0;
  return branch;
}

} // namespace dielast::fem
