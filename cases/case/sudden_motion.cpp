// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/sudden_motion.hpp"

#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dielast::cases {
namespace {

constexpr double little = 1e-3;  ///< of the range of the motion, also per its length of time
constexpr double at_once = 2e-9; ///< of a step: time steps do not part what is nearer

/// How a support stands when a step begins.
struct Start {
  double place = 0, speed = 0; ///< m, m/s
};

double slope_before(const Waveform& wave, double t, double h) {
  return (wave.before(t) - wave.at(t - h)) / h;
}

/// As the steps before have left it; nothing where it has taken hold in them, or takes hold, wherever it was.
std::optional<Start> start_of(const Support& support, std::span<const Step> steps, const Waveform& wave,
                              double h) {
  std::optional<Start> start;
  if (support.from.empty()) start.emplace();
  bool holds = support.from.empty();
  for (const Step& before : steps) {
    holds = holds || before.name == support.from;
    if (!holds || before.is_analysis()) continue;
    if (start) start->speed = 0;
    if (before.kind == StepKind::move) start = {before.part(StepKind::move) * wave.before(0), 0};
    if (before.kind == StepKind::transient)
      start = {wave.before(*before.duration), before.inertia ? slope_before(wave, *before.duration, h) : 0};
  }
  return start;
}

/// Whether it holds in the last of these steps.
bool holds(const Support& support, std::span<const Step> steps) {
  const auto has = [&](const std::string& name) { return std::ranges::count(steps, name, &Step::name) > 0; };
  return (support.from.empty() || has(support.from)) &&
         (support.until.empty() || support.until == steps.back().name || !has(support.until));
}

} // namespace

std::optional<SuddenJump> sudden_jump(const Support& support, std::size_t axis, std::span<const Step> steps) {
  if (!support.motion[axis] || !holds(support, steps)) return std::nullopt;
  const Waveform& wave = *support.motion[axis];
  const double duration = *steps.back().duration;
  const auto [least, most] = wave.extremes();
  const double scale = most > least ? most - least : std::abs(most);
  const auto jump = [&](double t, double from) -> std::optional<SuddenJump> {
    const double by = wave.at(t + at_once * duration) - from;
    if (std::abs(by) <= little * scale) return std::nullopt;
    return SuddenJump{t, by};
  };
  if (const auto start = start_of(support, steps.first(steps.size() - 1), wave, 1))
    if (const auto found = jump(0, start->place)) return found;
  for (const double t : wave.kinks(0, duration))
    if (const auto found = jump(t, wave.before(t))) return found;
  return std::nullopt;
}

std::string sudden_motion(const Case& one, std::span<const Step> steps) {
  const Step& step = steps.back();
  if (step.kind != StepKind::transient || !step.inertia) return "";
  for (const Support& support : one.supports)
    for (std::size_t c = 0; c < support.motion.size(); ++c) {
      if (!support.motion[c] || !holds(support, steps)) continue;
      const Waveform& wave = *support.motion[c];
      const double length = std::min(*step.duration, wave.period()), h = 1e-6 * length;
      double low = wave.at(0), high = low;
      constexpr int looks = 64;
      for (int i = 1; i <= looks; ++i) {
        const double there = wave.before(i * length / looks);
        low = std::min(low, there), high = std::max(high, there);
      }
      const std::optional<Start> start = start_of(support, steps.first(steps.size() - 1), wave, h);
      std::vector<double> times = wave.kinks(0, *step.duration);
      if (start) times.insert(times.begin(), 0);
      for (const double t : times) {
        const double before = t == 0 ? start->speed : slope_before(wave, t, h);
        const double speed = (wave.at(t + h) - wave.at(t)) / h;
        if (std::abs(speed - before) * length > little * (high - low))
          return fmt::format("support \"{}\" is to {} {} along {} at once{}", support.place,
                             t == 0 && before == 0 ? "set out with" : "change its speed by",
                             post::engineering(std::abs(speed - before), "m/s"), "xyz"[c],
                             t == 0 ? "" : ", at " + post::engineering(t, "s"));
      }
    }
  return "";
}

std::string sudden_motion_so_far(const Case& one, std::span<const Step> steps, int step) {
  std::string sudden;
  for (std::size_t s = static_cast<std::size_t>(step) + 1; s > 0 && sudden.empty(); --s)
    sudden = sudden_motion(one, steps.first(s));
  return sudden;
}

} // namespace dielast::cases
