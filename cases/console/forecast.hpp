// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace dielast::cases {

/// Says now and then how far a step is and how long it will take at its pace: after half a minute, and
/// whenever the time that has passed has doubled since. One for each step.
class Forecast {
 public:
  /// What there is to say at a load factor that is being tried, `elapsed` s after the step began or went on;
  /// empty most of the time.
  std::string at(double load_factor, double elapsed);

 private:
  double begin_ = -1; ///< load factor at which the step began or went on; -1: not yet
  double next_ = 30;  ///< s
};

} // namespace dielast::cases
