// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace dielast::post {

/// Where a step is.
struct Moment {
  double load_factor = 0;       ///< 0..1 within the step
  double time = 0;              ///< s
  std::vector<double> voltages; ///< V, one per electrode
};

/// Something a user must know about an accepted state.
struct Event {
  std::string kind;               ///< such as "loss of tension", "breakdown", "limit point", "branches meet"
  std::string place;              ///< named place, e.g. "cell[2,3]"; empty when it is everywhere
  std::string message;            ///< one sentence with numbers and units
  std::optional<Moment> before{}; ///< where it was on the way to the record that tells of it
  bool branches_off = false;      ///< a critical point that is a bifurcation, whatever `kind` calls it
};

/// The value of the largest magnitude that a quantity has had, and when.
struct Peak {
  double value = 0, time = 0; ///< SI, s
};

/// One accepted increment of one step.
struct StepRecord {
  int index = 0;                ///< 0 is the state in which the mesh was drawn
  std::string step;             ///< name of the step, e.g. "release"
  double load_factor = 0;       ///< 0..1 within the step
  double time = 0;              ///< s
  std::vector<double> voltages; ///< V, one per electrode
  int iterations = 0;           ///< Newton iterations that this increment took
  double residual = 0;          ///< relative norm on acceptance
  int unstable_modes = 0;       ///< under the control of the electrodes; 0 is a stable state
  std::vector<Event> events;
  bool jumped = false; ///< the loads have jumped at this time: the record before is of the moment before

  /// The voltage of the largest magnitude, with its sign; 0 without electrodes.
  double largest_voltage() const {
    double largest = 0;
    for (const double voltage : voltages)
      if (std::abs(voltage) > std::abs(largest)) largest = voltage;
    return largest;
  }
};

} // namespace dielast::post
