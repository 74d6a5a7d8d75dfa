#include "fem/ramp.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace dielast::fem {

namespace {

constexpr std::size_t most_points = 4; ///< of the predictor
constexpr double round_off = 1e-9;     ///< in load factors

/// A ramp's loads at a load factor.
class Path {
 public:
  Path(const RampTarget& from, const RampTarget& to) : from_(from), to_(to) {
    double largest = 0;
    for (std::size_t i = 0; i < from.voltage.size(); ++i)
      if (const double change = std::abs(to.voltage[i] - from.voltage[i]); change > largest) {
        largest = change;
        leading_ = i;
      }
  }

  void apply(State& state, double s) const {
    for (std::size_t i = 0; i < state.voltage.size(); ++i) state.voltage[i] = voltage(i, s);
    state.dead_force = (1 - s) * from_.dead_force + s * to_.dead_force;
  }
  /// Monotonic in s: Phi^2 of the electrode whose voltage changes most, s where none does.
  double parameter(double s) const {
    if (!leading_) return s;
    const double phi = voltage(*leading_, s);
    return phi * phi;
  }

 private:
  double voltage(std::size_t i, double s) const { return (1 - s) * from_.voltage[i] + s * to_.voltage[i]; }

  const RampTarget& from_;
  const RampTarget& to_;
  std::optional<std::size_t> leading_;
};

/// The next load factor to try: never past a multiple of the nominal increment, where the user expects a
/// result.
double next_load_factor(const RampProgress& progress, double nominal) {
  const double output = std::min(1.0, (std::floor(progress.load_factor / nominal + round_off) + 1) * nominal);
  const double s = progress.load_factor + progress.increment;
  return s > output - round_off ? output : s;
}

} // namespace

RampProgress RampProgress::begin(const State& state, const RampOptions& options) {
  return {.start = {state.voltage, state.dead_force},
          .increment = 1.0 / options.increments,
          .points = {{0, state}}};
}

RampResult ramp(Equilibrium& equilibrium, const RampTarget& target, const RampOptions& options,
                RampProgress& progress, const RampObserver& observer) {
  const Path path(progress.start, target);
  const double nominal = 1.0 / options.increments;
  progress.points.back().parameter = path.parameter(progress.load_factor);
  RampResult result;
  NewtonResult newton;
  const auto less_stable = [&] {
    return newton.outcome == Outcome::converged && progress.negative_pivots >= 0 &&
           newton.negative_pivots > progress.negative_pivots;
  };
  while (progress.load_factor < 1) {
    const double s = next_load_factor(progress, nominal);
    const double tried = s - progress.load_factor;
    if (observer.on_try) observer.on_try(s);
    const auto solve_from = [&](State state) {
      path.apply(state, s);
      newton = equilibrium.solve(state, options.newton, observer.on_iteration);
      return state;
    };
    State trial = solve_from(extrapolate(progress.points, path.parameter(s)));
    if ((newton.outcome != Outcome::converged || less_stable()) && progress.points.size() > 1)
      trial = solve_from(progress.points.back().state); // the predictor may have led astray
    if (newton.outcome != Outcome::converged || (less_stable() && tried >= 2 * options.smallest_increment)) {
      if (observer.on_cutback) observer.on_cutback(s, newton);
      result.failed_at = s;
      result.failure = newton;
      progress.increment = tried / 2;
      if (progress.increment < options.smallest_increment) {
        result.end = RampEnd::gave_up;
        return result;
      }
      continue;
    }
    progress.load_factor = s;
    progress.increment = std::min(nominal, 2 * std::max(progress.increment, tried));
    progress.negative_pivots = newton.negative_pivots;
    progress.points.push_back({path.parameter(s), std::move(trial)});
    if (progress.points.size() > most_points) progress.points.erase(progress.points.begin());
    if (observer.on_accept && !observer.on_accept(progress, {s, newton})) {
      result.end = RampEnd::stopped;
      return result;
    }
  }
  result.end = RampEnd::complete;
  return result;
}

} // namespace dielast::fem
