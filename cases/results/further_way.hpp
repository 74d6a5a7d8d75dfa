// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/runs/simulation.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace dielast::cases {

/// A state on the way of all voltages from zero, in proportion.
struct Passed {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double factor = 0; ///< its voltages over those at the end of the run
  double breakdown = unknown, least_stress = unknown, yield = unknown;
  double slack = unknown;       ///< of film that may wrinkle: its tension_state
  bool on_the_way_back = false; ///< to no voltage, from the end of the run
  int record = -1;              ///< of the run; -1: none
};

/// A critical point that was located on such a way.
struct Critical {
  bool branches_off; ///< a bifurcation, otherwise a limit point
  double factor = 0;
  const char* kind() const { return branches_off ? "bifurcation" : "limit point"; }
};

/// The factor of a state's voltages; nothing where they are not in proportion to those at the end.
std::optional<double> factor_of(const std::vector<double>& voltages, const post::StepRecord& end);

/// Takes the device from its state at the end of a run, or from a place that was reached from there, to other
/// factors on its voltages.
class FurtherWay {
 public:
  FurtherWay(const Case& one, const Simulation& own, const post::StepRecord& end, int threads);
  FurtherWay(const FurtherWay&) = delete; // what it simulates is of its own case

  /// Begins at a state of the run before its end, which is gone to once more: no way leads back to it, as
  /// over a jump. False where it is not reached.
  bool begin_at(const Passed& state);
  /// The states up to those with `factor` times the voltages of the end; `stopped` says why it ends earlier.
  std::vector<Passed> to(double factor, std::string& stopped);
  const std::vector<Critical>& located() const { return located_; } ///< on the last way
  /// That state alone; nothing where it is not reached.
  std::optional<Passed> at(double factor);

 private:
  /// Where the voltages of the end of a run can be changed in proportion, everything else staying as it is.
  struct Place {
    double factor = 1;
    SimulationProgress progress;
  };

  Passed state_of(const Frame& frame) const;
  void begin(SimulationProgress progress, double factor);

  const Case& one_;
  Case further_;
  std::vector<Step> steps_; ///< of the run
  const post::StepRecord& end_;
  int threads_;
  std::vector<Place> places_; ///< that where it begins first
  std::vector<Critical> located_;
  std::optional<Simulation> simulation_; ///< of further_, for all that is solved from these places
};

} // namespace dielast::cases
