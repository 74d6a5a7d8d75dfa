// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace dielast::cases {

/// A quantity over time t, in s from the start of the step that follows it:
///   constant       to
///   ramp           from, from t0 on straight to `to` within the duration
///   step           from, from t0 on `to`
///   trapezoid      from, from t0 on a rise to `to`, a hold and a fall back; again after every period, if any
///   sine           mean + amplitude sin(2 pi f t + phase)
///   unipolar sine  from + amplitude/2 (1 - cos(2 pi f t))
///   square         `to` during the part `duty` of every period 1/f, then from
///   sweep          mean + amplitude sin(2 pi (f t + (f_end - f) t^2 / (2 duration))), then f_end goes on
///   file           straight between the samples, and as at the ends outside
struct Waveform {
  enum class Kind { constant, ramp, step, trapezoid, sine, unipolar_sine, square, sweep, file };

  Kind kind = Kind::constant;
  double from = 0, to = 0, mean = 0, amplitude = 0;  ///< in the SI unit of the quantity
  double frequency = 0, end_frequency = 0;           ///< f, f_end, Hz
  double phase = 0;                                  ///< rad
  double start = 0;                                  ///< t0, s
  double duration = 0, rise = 0, hold = 0, fall = 0; ///< s
  double repeat = 0;                                 ///< period of a trapezoid, s; 0: it happens once
  double duty = 0.5;
  std::filesystem::path file;
  std::string column;                           ///< of the file; empty: its only one besides the time
  std::vector<std::array<double, 2>> samples{}; ///< time in s, value

  static Waveform constant_at(double value);
  bool operator==(const Waveform&) const = default;

  /// Value at t; where it jumps, the one after the jump.
  double at(double t) const;
  /// Value just before t.
  double before(double t) const;
  /// Times strictly between t0 and t1 at which the value jumps or its slope does, ascending.
  std::vector<double> kinks(double t0, double t1) const;
  /// The shortest period in it, s; infinite for a wave that does not repeat.
  double period() const;
  /// The least and the largest value that it can have.
  std::array<double, 2> extremes() const;
  bool constant() const { return kind == Kind::constant; }

  /// factor * this + offset.
  Waveform affine(double factor, double offset) const;

 private:
  double value(double t, double side) const;
};

} // namespace dielast::cases
