// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/devices/device.hpp"
#include "post/pictures/plot.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace dielast::cases {

/// How the nodes of a place have moved, or what presses on them, in the order of their coordinate along the
/// axis in which the place is longest, as drawn.
struct ProfileTable {
  struct Row {
    Eigen::Vector3d place; ///< of the node, as drawn, m
    double value;          ///< displacement along the profile's axis, m; contact pressure, Pa
  };
  int abscissa = 0; ///< 0, 1, 2 = x, y, z
  std::vector<Row> rows;

  /// Columns x, y, z and the value, with their units.
  std::string csv(const Profile& profile) const;
  post::Plot plot(const Profile& profile) const;
};

/// `before`, `now`: displacements per node, m; before: of the state at which the profile is zero.
ProfileTable profile_table(const Device& device, const Profile& profile,
                           const std::vector<Eigen::Vector3d>& before,
                           const std::vector<Eigen::Vector3d>& now);

} // namespace dielast::cases
