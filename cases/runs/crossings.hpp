// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/device.hpp"
#include "fem/equilibrium/equilibrium.hpp"
#include "fem/paths/load_path.hpp"
#include "fem/paths/ramp.hpp"
#include "post/reductions.hpp"

#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace dielast::cases {

/// A kind of event that begins when an extreme passes a limit.
struct Threshold {
  std::string_view kind, field;
  post::Extreme extreme;
  double limit;
  /// How far a value is beyond the limit, negative before it.
  double beyond(double value) const {
    return extreme == post::Extreme::minimum ? limit - value : value - limit;
  }
};
inline constexpr std::array thresholds{
    Threshold{"loss of tension", "min_principal_stress", post::Extreme::minimum, 0},
    Threshold{"breakdown", "breakdown_ratio", post::Extreme::maximum, 1},
    Threshold{"wall yield", "yield_ratio", post::Extreme::maximum, 1}};

/// The way to an accepted state from the one before, in one step under load control.
struct Passage {
  std::span<const fem::PathPoint> points; ///< accepted states of one smooth way, these two the last
  const fem::LoadPath& path;
  double to; ///< load factor of the last
  bool timed;
  const fem::RampOptions& options; ///< of states on the way that are solved for
  int threads;
};

/// Where a device passes thresholds on a passage: by states that are solved for there; in time, with friction
/// and in large models on the polynomial through up to four states, or, where material remembers in time,
/// through what these are beyond the threshold.
class Crossings {
 public:
  Crossings(const Device& device, const Passage& passage);

  struct Place {
    double load_factor;
    fem::State state; ///< there, as far as it is known
  };
  /// Nothing where the threshold is not passed between the last two states.
  std::optional<Place> find(const Threshold& threshold);

 private:
  struct Course;
  bool remembers() const;
  double parameter_at(double load_factor) const;
  fem::State state_at(const Course& course, double load_factor) const;
  double root_of(const Course& course) const;

  const Device& device_;
  const Passage& passage_;
  std::span<const fem::PathPoint> points_; ///< that polynomials go through at first
  std::optional<fem::Equilibrium> equilibrium_;
};

} // namespace dielast::cases
