// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/loads/sudden_motion.hpp"

#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dielast::cases {
namespace {

constexpr double little = 1e-3; ///< of the range of the motion, also per its length of time

/// How a support stands when a step begins.
struct Start {
  double place = 0, speed = 0; ///< m, m/s
};

double slope_before(const Waveform& wave, double t, double h) {
  return (wave.before(t) - wave.at(t - h)) / h;
}

/// As the steps before have left it.
Start start_of(std::span<const Step> steps, const Waveform& wave, double h) {
  Start start;
  for (const Step& before : steps) {
    if (before.is_analysis()) continue;
    start.speed = 0;
    if (before.kind == StepKind::move) start.place = wave.before(0);
    if (before.kind != StepKind::transient) continue;
    start.place = wave.before(*before.duration);
    if (before.inertia) start.speed = slope_before(wave, *before.duration, h);
  }
  return start;
}

} // namespace

std::string sudden_motion(const Case& one, std::span<const Step> steps) {
  const Step& step = steps.back();
  if (step.kind != StepKind::transient || !step.inertia) return "";
  for (const Support& support : one.supports)
    for (std::size_t c = 0; c < support.motion.size(); ++c) {
      if (!support.motion[c]) continue;
      const Waveform& wave = *support.motion[c];
      const double length = std::min(*step.duration, wave.period()), h = 1e-6 * length;
      double low = wave.at(0), high = low;
      constexpr int looks = 64;
      for (int i = 1; i <= looks; ++i) {
        const double there = wave.before(i * length / looks);
        low = std::min(low, there), high = std::max(high, there);
      }
      std::vector<double> times = wave.kinks(0, *step.duration);
      if (support.from.empty()) times.insert(times.begin(), 0); // what takes hold elsewhere stands as it is
      for (const double t : times) {
        const Start before = t == 0 ? start_of(steps.first(steps.size() - 1), wave, h)
                                    : Start{wave.before(t), slope_before(wave, t, h)};
        const double jump = wave.at(t) - before.place, speed = (wave.at(t + h) - wave.at(t)) / h;
        const double range = std::max(high - low, std::abs(jump));
        std::string what;
        if (std::abs(jump) > little * range)
          what = "move by " + post::engineering(std::abs(jump), "m");
        else if (std::abs(speed - before.speed) * length > little * range)
          what = (t == 0 && before.speed == 0 ? "set out with " : "change its speed by ") +
                 post::engineering(std::abs(speed - before.speed), "m/s");
        if (!what.empty())
          return fmt::format("support \"{}\" is to {} along {} at once{}", support.place, what, "xyz"[c],
                             t == 0 ? "" : ", at " + post::engineering(t, "s"));
      }
    }
  return "";
}

} // namespace dielast::cases
