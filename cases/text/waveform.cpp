// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/waveform.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::cases {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// Times closer than this part of a wave's own length are the same: t = n / f is never exact.
constexpr double same_time = 1e-9;
constexpr double rounding = 1e-15; ///< of times that were computed in other ways

double turn(double cycles) { return 2 * std::numbers::pi * cycles; }

/// Adds `first`, `first` + period, ... as far as they lie between t0 and t1.
void add_kinks(std::vector<double>& times, double first, double period, double t0, double t1) {
  const double n = std::isfinite(period) ? std::max(0.0, std::floor((t0 - first) / period)) : 0;
  for (double i = n;; ++i) {
    const double t = i == 0 ? first : first + i * period;
    if (t >= t1) break;
    if (t > t0) times.push_back(t);
    if (!std::isfinite(period)) break;
  }
}

} // namespace

Waveform Waveform::constant_at(double value) {
  Waveform wave;
  wave.to = value;
  return wave;
}

std::array<double, 2> Waveform::extremes() const {
  std::array<double, 2> ends{from, to};
  switch (kind) {
  case Kind::constant:
    ends = {to, to};
    break;
  case Kind::sine:
  case Kind::sweep:
    ends = {mean - amplitude, mean + amplitude};
    break;
  case Kind::unipolar_sine:
    ends = {from, from + amplitude};
    break;
  case Kind::file:
    ends = {samples.front()[1], samples.front()[1]};
    for (const auto& sample : samples) ends = {std::min(ends[0], sample[1]), std::max(ends[1], sample[1])};
    break;
  case Kind::ramp:
  case Kind::step:
  case Kind::trapezoid:
  case Kind::square:
    break;
  }
  return {std::min(ends[0], ends[1]), std::max(ends[0], ends[1])};
}

double Waveform::at(double t) const { return value(t, same_time); }
double Waveform::before(double t) const { return value(t, -same_time); }

double Waveform::value(double t, double side) const {
  switch (kind) {
  case Kind::constant:
    return to;
  case Kind::ramp:
    return from + (to - from) * std::clamp((t - start) / duration, 0.0, 1.0);
  case Kind::step:
    return (side > 0 ? t >= start * (1 - side) : t > start * (1 - side)) ? to : from;
  case Kind::trapezoid: {
    const double length = rise + hold + fall;
    const double shift = side * length + std::copysign(rounding * std::max(std::abs(t), start), side);
    double since = t - start;
    if (since + shift < 0) return from;
    if (repeat > 0) since -= std::floor((since + shift) / repeat) * repeat;
    // the part of the wave is chosen beside a jump, its value is that at t itself
    const double beside = since + shift;
    if (beside < rise) return from + (to - from) * std::clamp(since / rise, 0.0, 1.0);
    if (beside < rise + hold) return to;
    if (beside < length) return to + (from - to) * std::clamp((since - rise - hold) / fall, 0.0, 1.0);
    return from;
  }
  case Kind::sine:
    return mean + amplitude * std::sin(turn(frequency * t) + phase);
  case Kind::unipolar_sine:
    return from + 0.5 * amplitude * (1 - std::cos(turn(frequency * t)));
  case Kind::square: {
    const double cycles = frequency * t + side;
    return cycles - std::floor(cycles) < duty ? to : from;
  }
  case Kind::sweep: {
    const double swept = std::min(t, duration);
    const double cycles = frequency * swept + (end_frequency - frequency) * swept * swept / (2 * duration) +
                          end_frequency * (t - swept);
    return mean + amplitude * std::sin(turn(cycles));
  }
  case Kind::file: {
    const auto next = std::upper_bound(samples.begin(), samples.end(), t,
                                       [](double time, const auto& sample) { return time < sample[0]; });
    if (next == samples.begin()) return samples.front()[1];
    if (next == samples.end()) return samples.back()[1];
    const auto& [t0, v0] = *(next - 1);
    const auto& [t1, v1] = *next;
    return v0 + (v1 - v0) * (t - t0) / (t1 - t0);
  }
  }
  return to;
}

std::vector<double> Waveform::kinks(double t0, double t1) const {
  std::vector<double> times;
  const auto add = [&](double first, double period = infinite) { add_kinks(times, first, period, t0, t1); };
  switch (kind) {
  case Kind::ramp:
    add(start);
    add(start + duration);
    break;
  case Kind::step:
    add(start);
    break;
  case Kind::trapezoid:
    for (const double after : {0.0, rise, rise + hold, rise + hold + fall})
      add(start + after, repeat > 0 ? repeat : infinite);
    break;
  case Kind::square:
    add(0, 1 / frequency);
    add(duty / frequency, 1 / frequency);
    break;
  case Kind::sweep:
    add(duration);
    break;
  case Kind::file:
    for (const auto& sample : samples) add(sample[0]);
    break;
  case Kind::constant:
  case Kind::sine:
  case Kind::unipolar_sine:
    break;
  }
  std::ranges::sort(times);
  const auto same = [&](double a, double b) { return b - a <= same_time * (t1 - t0); };
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
  return times;
}

double Waveform::period() const {
  switch (kind) {
  case Kind::sine:
  case Kind::unipolar_sine:
  case Kind::square:
    return 1 / frequency;
  case Kind::sweep:
    return 1 / std::max(frequency, end_frequency);
  case Kind::trapezoid:
    return repeat > 0 ? repeat : infinite;
  case Kind::constant:
  case Kind::ramp:
  case Kind::step:
  case Kind::file:
    break;
  }
  return infinite;
}

Waveform Waveform::affine(double factor, double offset) const {
  Waveform wave = *this;
  for (double* level : {&wave.from, &wave.to, &wave.mean}) *level = factor * *level + offset;
  wave.amplitude *= factor;
  for (auto& sample : wave.samples) sample[1] = factor * sample[1] + offset;
  return wave;
}

} // namespace dielast::cases
