// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace dielast::materials {

/// Four doubles that are computed at once, one per lane of a vector register.
using Pack = double __attribute__((vector_size(32)));

constexpr int pack_lanes = static_cast<int>(sizeof(Pack) / sizeof(double));

// A pack is not a class, so that no function is found through its namespace: templates of this room call
// these without a prefix, for doubles as well.
using std::cbrt;
using std::exp;
using std::log;
using std::log1p;
using std::pow;
using std::sqrt;

template<class Function>
inline Pack for_each_lane(const Pack& x, const Function& function) {
  Pack y{};
  for (int l = 0; l < pack_lanes; ++l) y[l] = function(x[l]);
  return y;
}

inline Pack sqrt(const Pack& x) {
  return for_each_lane(x, [](double a) { return std::sqrt(a); });
}
inline Pack cbrt(const Pack& x) {
  return for_each_lane(x, [](double a) { return std::cbrt(a); });
}
inline Pack log(const Pack& x) {
  return for_each_lane(x, [](double a) { return std::log(a); });
}
inline Pack log1p(const Pack& x) {
  return for_each_lane(x, [](double a) { return std::log1p(a); });
}
inline Pack exp(const Pack& x) {
  return for_each_lane(x, [](double a) { return std::exp(a); });
}
inline Pack pow(const Pack& x, double exponent) {
  return for_each_lane(x, [exponent](double a) { return std::pow(a, exponent); });
}

} // namespace dielast::materials
