// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <vector>

namespace dielast::fem {

/// A function of a place on a surface, with its derivatives by one coordinate.
struct Ramp {
  double value = 1, first = 0, second = 0;
};

/// By the distance t from where a surface ends, in lengths over which the ramp rises: nearly 0 at the end, 1
/// from t = 1 on, a quintic between.
inline Ramp end_ramp(double t) {
  if (!(t < 1)) return {};
  constexpr double least = 1e-3, high = 1 - least; // nothing gets through where the other one counts alone
  return {least + high * t * t * t * (10 - 15 * t + 6 * t * t), high * 30 * t * t * (1 - t) * (1 - t),
          high * 60 * t * (1 - t) * (1 - 2 * t)};
}

/// Where a surface of 3-node sides ends, as drawn. The contact of two surfaces is the mean of two integrals,
/// of either over the distance to the other. A point of the one that an end of the other passes would take
/// its load from one moment to the next: it would catch on the end as on a step, with forces along the
/// surfaces that are none of friction. So towards an end the integral of the surface that ends counts alone,
/// that of the other fades.
class SurfaceEnds {
 public:
  SurfaceEnds() = default;
  /// `goes_on`: whether a node is no end, as it is on the axis of revolution or a plane of symmetry. `over`:
  /// length along which the ramp rises from an end, m; at most half of the surface.
  SurfaceEnds(const meshing::CellBlock& sides, const std::vector<Eigen::Vector3d>& drawn,
              const std::function<bool(int)>& goes_on, double over) {
    std::map<int, int> first_at, last_at; // sides by their ends
    for (int i = 0; i < sides.size(); ++i) {
      first_at[sides.cell(i)[0]] = i;
      last_at[sides.cell(i)[1]] = i;
    }
    const auto at = [&](int node) { return drawn[static_cast<std::size_t>(node)]; };
    const auto length = [&](int i) { return (at(sides.cell(i)[0]) - at(sides.cell(i)[1])).norm(); };
    // from the end 0 or 1 of a side on to where the surface ends
    const auto rest = [&](int i, std::size_t end) {
      constexpr double far = std::numeric_limits<double>::infinity();
      double way = 0;
      for (int passed = 0; passed <= sides.size(); ++passed) {
        const int node = sides.cell(i)[end];
        const auto& next_at = end == 0 ? last_at : first_at;
        const auto next = next_at.find(node);
        if (next == next_at.end()) return goes_on(node) ? far : way;
        i = next->second;
        way += length(i);
      }
      return far; // it goes round
    };
    for (int i = 0; i < sides.size(); ++i) {
      const double before = rest(i, 0), behind = rest(i, 1);
      sides_.push_back({before, length(i), behind, std::min(over, (before + length(i) + behind) / 2)});
    }
  }

  /// At a place of a side, by its s = 0..1.
  Ramp at(int side, double s) const {
    const auto& [before, length, behind, over] = sides_[static_cast<std::size_t>(side)];
    const double from_first = before + s * length, from_last = behind + (1 - s) * length;
    const Ramp ramp = end_ramp(std::min(from_first, from_last) / over);
    const double rate = (from_first < from_last ? 1 : -1) * length / over;
    return {ramp.value, ramp.first * rate, ramp.second * rate * rate};
  }

 private:
  struct Side {
    double before, length, behind, over; ///< m; to the surface's ends from its own, and of the ramp
  };
  std::vector<Side> sides_;
};

/// What a surface's integral counts of both at a point with the ramp `own`, where the other's is `other`: the
/// share of the surface, less near its other one's end; both together are 1.
inline Ramp shared(double share, double own, double share_of_other, const Ramp& other) {
  if (own == 1 && other.value == 1) return {share, 0, 0};
  const double b = share_of_other * own, sum = share * other.value + b;
  const double slope = share * b / (sum * sum), bend = -2 * share * slope / sum;
  return {share * other.value / sum, slope * other.first,
          slope * other.second + bend * other.first * other.first};
}

} // namespace dielast::fem
