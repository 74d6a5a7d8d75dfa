// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/fastest_rate.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

namespace dielast::cases {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

double highest(const Sweep& sweep) {
  double hertz = std::max(sweep.from, sweep.to);
  for (const double at : sweep.at) hertz = std::max(hertz, at);
  return full_turn * hertz;
}

double fastest_wave(const Case& one) {
  double fastest = 0;
  const auto add = [&fastest](const std::optional<Waveform>& wave) {
    if (wave) fastest = std::max(fastest, full_turn / wave->period());
  };
  for (const auto& [electrode, drive] : one.drives) add(drive.voltage), add(drive.charge);
  for (const Support& support : one.supports)
    for (const auto& wave : support.motion) add(wave);
  for (const Load& load : one.loads)
    for (int c = 0; c < 6; ++c)
      if (const Waveform* wave = load.component(c)) add(*wave);
  if (one.chamber) add(one.chamber->pressure), add(one.chamber->volume);
  return fastest;
}

} // namespace

double fastest_rate(const Case& one) {
  double fastest = one.linearise ? highest(one.linearise->sweep) : 0;
  for (const Step& step : one.steps) {
    if (step.kind == StepKind::harmonic) fastest = std::max(fastest, highest(step.sweep));
    if (step.duration) fastest = std::max({fastest, 1 / *step.duration, fastest_wave(one)});
  }
  return fastest;
}

} // namespace dielast::cases
