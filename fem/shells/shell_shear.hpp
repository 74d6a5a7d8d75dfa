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
/// its integration points: a spring of k_i = 5/6 sum mu H s_i^2 along x and y, s_i a layer's extra stretch
/// (see ShellSection), so that each is sheared by g as seen in its own unstretched film; and for each branch
/// of the layers a linear Maxwell element of 5/6 mu_b H s_i^2 and the branch's rate mu_b/eta_b, mu_b the
/// initial modulus of its spring. Energy over a step, with the viscous shear q at its end (a0 q - h = dt rate
/// (g - q), see TimeScheme) taken as the one that makes it stationary:
///   1/2 k g^2 + sum_b 1/2 k_b (1 + dt rate/a0) (g - q)^2,  k g^2 = k_x g_x^2 + k_y g_y^2.
/// Nominal dashpots, which know of no shear, flow in it, too. Branches of one rate are one. Squares are taken
/// with ShellPoint::shear, per undeformed area.
class ShellShear {
 public:
  using Stiffness = std::array<double, 2>; ///< along x and y, N/m

  /// H: the layer's depth before the prestretch, m; its extra stretch.
  void add_layer(const materials::Material& material, double H, const std::array<double, 2>& extra_stretch);

  /// Of the relaxed shell, the mean, N/m.
  double stiffness() const { return (stiffness_[0] + stiffness_[1]) / 2; }

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
    Stiffness stiffness;
    double rate; ///< 1/s
  };
  std::size_t place(int point, std::size_t branch) const {
    return static_cast<std::size_t>(first_) +
           2 * (static_cast<std::size_t>(point) * branches_.size() + branch);
  }

  Stiffness stiffness_{};
  std::vector<Branch> branches_;
  int first_ = 0;
};

} // namespace dielast::fem
