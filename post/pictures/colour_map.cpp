// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/colour_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dielast::post {

Colour viridis(double value) {
  if (std::isnan(value)) return {0.75, 0.75, 0.75};
  // Linear between these points the map stays within 1 % of the original.
  static constexpr std::array<Colour, 11> points{{{0.267, 0.005, 0.329},
                                                  {0.283, 0.141, 0.458},
                                                  {0.254, 0.265, 0.530},
                                                  {0.207, 0.372, 0.553},
                                                  {0.164, 0.471, 0.558},
                                                  {0.128, 0.567, 0.551},
                                                  {0.135, 0.659, 0.518},
                                                  {0.267, 0.749, 0.441},
                                                  {0.478, 0.821, 0.318},
                                                  {0.741, 0.873, 0.150},
                                                  {0.993, 0.906, 0.144}}};
  const double position = std::clamp(value, 0.0, 1.0) * (points.size() - 1);
  const auto index = std::min(static_cast<std::size_t>(position), points.size() - 2);
  const double t = position - static_cast<double>(index);
  const Colour &a = points[index], &b = points[index + 1];
  return {std::lerp(a.red, b.red, t), std::lerp(a.green, b.green, t), std::lerp(a.blue, b.blue, t)};
}

} // namespace dielast::post
