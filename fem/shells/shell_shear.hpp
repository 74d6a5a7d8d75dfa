// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/lanes.hpp"
#include "fem/model/element_block.hpp"
#include "fem/shells/shell_kinematics.hpp"
#include "materials/material.hpp"

#include <array>
#include <vector>

namespace dielast::fem {

/// What a shell resists transverse shear g = gamma - gamma as drawn with (see make_shell_block()), at one of
/// its integration points: a spring of k = 5/6 sum mu H, and for each branch of its layers a linear Maxwell
/// element of 5/6 mu_b H and the branch's rate mu_b/eta_b, mu_b the initial modulus of its spring. Energy
/// over a step, with the viscous shear q at its end (a0 q - h = dt rate (g - q), see TimeScheme) taken as the
/// one that makes it stationary:
///   1/2 k |g|^2 + sum_b 1/2 k_b (1 + dt rate/a0) |g - q|^2.
/// Nominal dashpots, which know of no shear, flow in it, too. Branches of one rate are one. |g|^2 is taken
/// with ShellPoint::shear, per undeformed area.
class ShellShear {
 public:
  /// H: the layer's depth before the prestretch, m.
  void add_layer(const materials::Material& material, double H);

  double stiffness() const { return stiffness_; } ///< N/m, of the relaxed shell

  /// Energy of a pack's points, J, and its derivatives in gamma, into `stress`. `points`: their numbers; of
  /// the first `count` lanes.
  Lanes evaluate(const State& state, const std::array<int, lanes>& points, int count, const ShellPoint& here,
                 const ShellDeformation& f, ShellStress& stress) const;
  /// Adds sum_b weight(rate_b) k_b to `stress`.shear, see ElementBlock::add_relaxation().
  void add_relaxation(const RateWeight& weight, const ShellPoint& here, ShellStress& stress) const;
  void add_energies(const State& state, const std::array<int, lanes>& points, int count,
                    const ShellPoint& here, const ShellDeformation& f, EnergyParts& parts) const;

  // --- internal variables: q, point by point, branch by branch
  int history_size(int points) const { return points * 2 * static_cast<int>(branches_.size()); }
  void place_history(int first) { first_ = first; }
  void start_history(int points, std::vector<double>& all) const;
  void advance_history(const State& state, const std::array<int, lanes>& points, int count,
                       const ShellPoint& here, const ShellDeformation& f, std::vector<double>& all) const;

 private:
  struct Branch {
    double stiffness, rate; ///< N/m, 1/s
  };
  std::size_t place(int point, std::size_t branch) const {
    return static_cast<std::size_t>(first_) +
           2 * (static_cast<std::size_t>(point) * branches_.size() + branch);
  }

  double stiffness_ = 0;
  std::vector<Branch> branches_;
  int first_ = 0;
};

} // namespace dielast::fem
