// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/fastest_rate.hpp"

#include "fem/model/dofs.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

namespace dielast::cases {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

double highest(const Sweep& sweep) {
  return full_turn * (sweep.at.empty() ? std::max(sweep.from, sweep.to) : std::ranges::max(sweep.at));
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
    for (int c = 0; c < fem::DofMap::components; ++c)
      if (const Waveform* wave = load.component(c)) add(*wave);
  if (one.chamber) add(one.chamber->pressure), add(one.chamber->volume);
  return fastest;
}

double fastest_rate(const Case& one) {
  double fastest = one.linearise ? highest(one.linearise->sweep) : 0;
  bool timed = false;
  for (const Step& step : one.steps) {
    if (step.kind == StepKind::harmonic) fastest = std::max(fastest, highest(step.sweep));
    if (step.duration) timed = true, fastest = std::max(fastest, 1 / *step.duration);
  }
  return timed ? std::max(fastest, fastest_wave(one)) : fastest;
}

} // namespace

void tell_fastest_rate(Case& one) {
  const double rate = fastest_rate(one);
  for (Part& part : one.parts) {
    if (!part.film) continue;
    part.film->material.fastest_rate = rate;
    for (Layer& layer : part.film->further_layers) layer.material.fastest_rate = rate;
  }
}

} // namespace dielast::cases
