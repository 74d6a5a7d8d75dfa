// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/quantities/measurement.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dielast::cases {

/// A time of a step, or the moment before it.
struct Instant {
  double t = 0; ///< s
  bool before = false;

  double of(const Waveform& wave) const { return before ? wave.before(t) : wave.at(t); }
};

/// What the source of an electrode gives in a transient, by the time of the step.
class Signal {
 public:
  virtual ~Signal() = default;
  virtual double at(Instant t) const = 0; ///< V
  /// Times from 0 to `duration` at which it jumps or turns, s.
  virtual std::vector<double> kinks(double duration) const = 0;

  // What few have: a value that follows from the states that are reached.
  /// A step begins that takes this time, s.
  virtual void begin(double) {}
  /// Whether it wants to see the state that was accepted at this time of the step; always its beginning.
  virtual bool samples(double) const { return false; }
  /// Sees that state. Says what is wrong with it, nothing where it can go on.
  virtual std::string sample(double, const Measured&, const Measurement&) { return ""; }
  /// What it keeps between states; with it, it goes on bit for bit.
  virtual std::vector<double> memory() const { return {}; }
  virtual void recall(const std::vector<double>&) {}
};

/// Of each electrode, by its number; null: no voltage is said of it.
using Signals = std::vector<std::unique_ptr<Signal>>;
Signals signals_of(const Case& one);

} // namespace dielast::cases
