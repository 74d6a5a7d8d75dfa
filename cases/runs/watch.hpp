// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/runs/crossings.hpp"
#include "fem/contact/wall_contact.hpp"
#include "fem/paths/energy_balance.hpp"
#include "post/step_record.hpp"

#include <array>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// Below this a stress is round-off, Pa: 1e-8 of the stiffest film's shear modulus, at least 1e-3.
double smallest_stress(const Case& one);
/// Film of which less than so many times that is left in a critical state, and more was before, is critical
/// for want of tension.
inline constexpr double no_tension = 1e3;

/// Watches accepted states for what a designer must know: loss of tension, wrinkled film that is pushed,
/// breakdown, yielding walls, walls that touch, film that passes through itself, fins that turn far, leaks
/// that steady voltages leave out, unstable equilibrium. An event is told when its condition begins, not
/// again while it lasts.
class Watch {
 public:
  /// Those of which extremes are needed.
  static constexpr std::array scalars{"tension_state", "min_principal_stress", "breakdown_ratio",
                                      "yield_ratio"};

  /// Of a case's device, which must outlive this.
  Watch(const Case& one, const Device& device);
  /// After the device was built anew, for other supports.
  void prepare();

  /// `ends`: the state is one that a step leads to; whether film passes through itself is asked of these.
  /// `gives_way`: no path leads on from it, as where film leaves its surface that has no tension left.
  std::vector<post::Event> check(const fem::State& state, const post::Extremes& extremes, int unstable_modes,
                                 bool ends, bool gives_way);

  /// Tells of those events that begin at a threshold where it was passed on the way to their state.
  void locate(std::vector<post::Event>& events, const Passage& passage) const;

  /// Kinds of the conditions that hold now; stored with a checkpoint.
  std::set<std::string> active;

 private:
  void tell(post::Event& event, const Passage& passage, const Crossings::Place& place) const;
  std::string cell_of(int line, int other) const;
  std::string place_of_triangle(int triangle) const;
  std::string place_of_line(int line) const;
  std::string place_of_element(std::span<const int> nodes) const;

  const Device& device_;
  double smallest_stress_;
  std::optional<fem::WallContactSearch> contacts_;
  std::vector<std::string> kept_apart_; ///< surfaces between which there is contact
};

/// A step is about voltages, and the case has none.
std::optional<post::Event> no_voltage(const Case& one, const Step& step);
/// The energy balance is not known well enough in one of the `steps`; `sudden`: what a support was asked for
/// that masses cannot do.
post::Event poor_energy(const fem::EnergyBalance::Resolution& energy, std::span<const Step> steps,
                        const std::string& sudden);
/// A support has struck masses; `sudden`: as above.
post::Event struck(const std::string& sudden);
/// Inertia was left out of a motion whose kinetic energy would be `ratio` times the work that it takes.
post::Event left_out(double ratio, const Step& step);
/// What a jump set free, of which a step that cuts the device free says nothing. `unseen`: the step leaves
/// out inertia, and what it has done before the jump is not judged.
post::Event jumped(const std::optional<fem::EnergyBalance::JumpRelease>& release, bool unseen);

} // namespace dielast::cases
