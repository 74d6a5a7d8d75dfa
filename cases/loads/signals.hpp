// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/quantities/measurement.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace dielast::cases {

/// A time of a step, or the moment before it.
struct Instant {
  double t = 0; ///< s
  bool before = false;

  double of(const Waveform& wave) const { return before ? wave.before(t) : wave.at(t); }
};

/// What a load is in a transient, by the time of the step, instead of what the case says of it.
class Signal {
 public:
  virtual ~Signal() = default;
  virtual double at(Instant t) const = 0; ///< SI
  /// Times from 0 to `duration` at which it jumps or turns, s.
  virtual std::vector<double> kinks(double duration) const = 0;

  /// A step begins that takes this time, s.
  virtual void begin(double duration) = 0;
  /// Whether it wants to see the state that was accepted at this time of the step; always its beginning.
  virtual bool samples(double t) const = 0;
  /// Sees that state; `said`: of the load by what holds the device in this step, see said_of(). Says what is
  /// wrong with it, nothing where it can go on.
  virtual std::string sample(double t, const Waveform* said, const Measured& measured,
                             const Measurement& measurement) = 0;
  /// What it keeps between states; with it, it goes on bit for bit.
  virtual std::vector<double> memory() const = 0;
  virtual void recall(const std::vector<double>& memory) = 0;
};

using Signals = std::map<DrivenLoad, std::unique_ptr<Signal>>;
Signals signals_of(const Case& one);

/// What the case says of a load; null: nothing.
const Waveform* said_of(const Case& one, const DrivenLoad& load);

} // namespace dielast::cases
