// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/pack.hpp"
#include "materials/laws/plane_stress.hpp"

#include <array>
#include <cstddef>

namespace dielast::fem {

/// Film elements are computed `lanes` at a time, one per lane of a vector register.
using Lanes = materials::Pack;
constexpr int lanes = static_cast<int>(sizeof(Lanes) / sizeof(double));

/// value(lane), all at once: a pack whose lanes are written one by one cannot be read before they have
/// arrived.
template<class Value>
Lanes lanes_of(const Value& value) {
  static_assert(lanes == 4);
  return Lanes{value(0), value(1), value(2), value(3)};
}

/// What comparing lanes gives: all bits of a lane where it holds, none where it does not.
using LaneMask = decltype(Lanes{} > Lanes{});

inline bool all_lanes(const LaneMask& holds) {
  bool all = true;
  for (int l = 0; l < lanes; ++l) all &= holds[l] != 0;
  return all;
}

template<std::size_t size>
std::array<double, size> lane_of(const Lanes (&all)[size], int l) {
  std::array<double, size> one;
  for (std::size_t i = 0; i < size; ++i) one[i] = all[i][l];
  return one;
}

inline materials::InPlaneC<double> lane_of(const materials::InPlaneC<Lanes>& C, int l) {
  return {C.C11[l], C.C22[l], C.C12[l]};
}

inline materials::MembranePotential<double> lane_of(const materials::MembranePotential<Lanes>& p, int l) {
  materials::MembranePotential<double> q{p.value[l], {}, {}};
  for (std::size_t i = 0; i < q.first.size(); ++i) q.first[i] = p.first[i][l];
  for (std::size_t i = 0; i < q.second.size(); ++i) q.second[i] = p.second[i][l];
  return q;
}

inline void set_lane(materials::MembranePotential<Lanes>& p, int l,
                     const materials::MembranePotential<double>& q) {
  p.value[l] = q.value;
  for (std::size_t i = 0; i < q.first.size(); ++i) p.first[i][l] = q.first[i];
  for (std::size_t i = 0; i < q.second.size(); ++i) p.second[i][l] = q.second[i];
}

} // namespace dielast::fem
