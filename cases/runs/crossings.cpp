// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/runs/crossings.hpp"

#include "fem/model/contact_block.hpp"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

namespace dielast::cases {

namespace {

constexpr std::size_t most_points = 4; ///< that a polynomial goes through
constexpr int most_unknowns = 200'000; ///< of models in which a state on the way is worth its time

/// The load factor up to `to` at which a path has that parameter, in which it is monotonic.
double load_factor_at(const fem::LoadPath& path, double parameter, double to) {
  const auto beyond = [&](double s) { return path.parameter(s) - parameter; };
  const double first = beyond(0), last = beyond(to);
  if (!(first * last < 0)) return std::abs(first) < std::abs(last) ? 0 : to;
  std::uintmax_t tries = 100;
  return boost::math::tools::toms748_solve(
             beyond, 0.0, to, first, last, [](double low, double high) { return high - low <= 1e-14; }, tries)
      .second;
}

/// What a field does to magnitudes has a corner where its voltage changes its sign.
bool turns_over(const fem::PathPoint& one, const fem::PathPoint& other) {
  for (std::size_t p = 0; p < one.state.voltage.size(); ++p)
    if (one.state.voltage[p] * other.state.voltage[p] < 0) return true;
  return false;
}

double beyond_in(const fem::State& state, const Device& device, const Threshold& threshold) {
  const fem::Samples samples = device.model.sample(state);
  const post::WantedScalars wanted({std::string(threshold.field)});
  return threshold.beyond(post::Extremes(samples, wanted).find(threshold.field, threshold.extreme)->value);
}

/// Of the polynomial through the values at all points.
template<class Value>
double value_at(double parameter, std::span<const fem::PathPoint> points, Value&& value) {
  const std::vector<double> weights = fem::weights_at(points, parameter);
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * value(i);
  return sum;
}

} // namespace

/// States on the way, one behind the other, and how far they are beyond a threshold: it is passed between
/// those before and at `after`.
struct Crossings::Course {
  const Threshold& threshold;
  std::vector<fem::PathPoint> points;
  std::vector<double> beyond;
  std::size_t after;
  double from, to; ///< load factors of the two

  void add(fem::PathPoint point, double load_factor, double how_far) {
    const auto at = static_cast<std::ptrdiff_t>(after);
    points.insert(points.begin() + at, std::move(point));
    beyond.insert(beyond.begin() + at, how_far);
    if (how_far < 0) ++after;
    (how_far < 0 ? from : to) = load_factor;
    if (points.size() <= most_points) return;
    const bool first = after >= 2; // the others are nearer
    points.erase(first ? points.begin() : points.end() - 1);
    beyond.erase(first ? beyond.begin() : beyond.end() - 1);
    if (first) --after;
  }
};

Crossings::Crossings(const Device& device, const Passage& passage) : device_(device), passage_(passage) {
  points_ = passage.points.last(std::min(passage.points.size(), most_points));
  while (points_.size() >= 2 && turns_over(points_.front(), points_.back())) points_ = points_.subspan(1);
}

double Crossings::parameter_at(double load_factor) const {
  return passage_.timed ? load_factor : passage_.path.parameter(load_factor);
}

/// Whether states depend on the way to them: branches that have had all the time they need do not.
bool Crossings::remembers() const { return passage_.timed && points_.back().state.history; }

fem::State Crossings::state_at(const Course& course, double load_factor) const {
  const double parameter = parameter_at(load_factor);
  fem::State there = fem::extrapolate(course.points, parameter);
  passage_.path.apply(there, load_factor);
  if (!passage_.timed && !passage_.options.instantaneous) there.scheme = materials::TimeScheme::relaxed();
  for (std::size_t p = 0; p < there.voltage.size(); ++p)
    if (there.supply[p] != fem::Supply::voltage)
      there.voltage[p] = value_at(parameter, course.points,
                                  [&](std::size_t i) { return course.points[i].state.voltage[p]; });
  if (passage_.timed)
    there.time =
        value_at(parameter, points_.last(2), [&](std::size_t i) { return points_.last(2)[i].state.time; });
  device_.model.balance_fields(there);
  return there;
}

double Crossings::root_of(const Course& course) const {
  constexpr double accuracy = 1e-9; // of the step
  const auto beyond_at = [&](double at) {
    // of the shape there: what is largest may be elsewhere than in these states
    return remembers()
               ? value_at(parameter_at(at), course.points, [&](std::size_t i) { return course.beyond[i]; })
               : beyond_in(state_at(course, at), device_, course.threshold);
  };
  std::uintmax_t tries = 100;
  return boost::math::tools::toms748_solve(
             beyond_at, course.from, course.to, course.beyond[course.after - 1], course.beyond[course.after],
             [](double low, double high) { return high - low <= accuracy; }, tries)
      .second;
}

std::optional<Crossings::Place> Crossings::find(const Threshold& threshold) {
  constexpr double same = 1e-6; // of the step
  constexpr int most_solved = 4;
  if (points_.size() < 2) return std::nullopt;
  Course course{threshold, {points_.begin(), points_.end()}, {}, points_.size() - 1};
  for (const fem::PathPoint& point : points_)
    course.beyond.push_back(beyond_in(point.state, device_, threshold));
  if (!(course.beyond[course.after - 1] < 0 && course.beyond[course.after] > 0)) return std::nullopt;
  const double before = points_[course.after - 1].parameter;
  course.from = passage_.timed ? before : load_factor_at(passage_.path, before, passage_.to);
  course.to = passage_.to;
  double found = root_of(course);
  const fem::State& last = points_.back().state;
  const bool is_solved = !remembers() && !last.motion && !fem::has_friction(device_.model) &&
                         device_.model.dofs.free_count() <= most_unknowns;
  for (int solved = 0; is_solved && solved < most_solved; ++solved) {
    if (found - course.from <= same || course.to - found <= same) break;
    if (!equilibrium_) equilibrium_.emplace(device_.model, passage_.threads);
    fem::State there = state_at(course, found);
    if (equilibrium_->solve(there, passage_.options.newton).outcome != fem::Outcome::converged) break;
    const double how_far = beyond_in(there, device_, threshold);
    if (!(std::abs(how_far) > 0)) break; // 0, or not a number
    course.add({parameter_at(found), std::move(there)}, found, how_far);
    found = root_of(course);
  }
  return Place{found, state_at(course, found)};
}

} // namespace dielast::cases
