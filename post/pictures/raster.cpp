// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::post {

namespace {

std::uint32_t pixel(const Colour& colour) {
  const auto channel = [&](double part) { return static_cast<std::uint32_t>(std::lround(255 * part)); };
  return 0xff000000u | channel(colour.red) << 16 | channel(colour.green) << 8 | channel(colour.blue);
}

std::uint32_t dimmed(std::uint32_t colour, double light) {
  std::uint32_t result = colour & 0xff000000u;
  for (const int shift : {0, 8, 16})
    result |= static_cast<std::uint32_t>(std::lround(light * (colour >> shift & 0xff))) << shift;
  return result;
}

} // namespace

Palette::Palette(std::pair<double, double> range)
    : low_(range.first), steps_((last + 1) / (range.second - range.first)), missing_(pixel(viridis(NAN))) {
  for (int i = 0; i <= last; ++i)
    colours_[static_cast<std::size_t>(i)] = pixel(viridis(static_cast<double>(i) / last));
}

Palette::Palette(const Colour& colour) : missing_(pixel(colour)) { colours_.fill(missing_); }

Raster::Raster(int width, int height)
    : width_(width), height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0),
      depth_(pixels_.size(), -std::numeric_limits<float>::infinity()) {}

void Raster::draw(const std::array<Corner, 3>& corners, const Palette& palette, double light) {
  constexpr double seam = -1e-9; ///< of the triangle: edges belong to both neighbours
  const Eigen::Vector2d a = corners[0].place, ab = corners[1].place - a, ac = corners[2].place - a;
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  if (!(std::abs(area) > 0) || !std::isfinite(area)) return;
  Eigen::Vector2d low = a, high = a;
  for (const Corner& corner : corners) {
    low = low.cwiseMin(corner.place);
    high = high.cwiseMax(corner.place);
  }
  const int left = std::max(0, static_cast<int>(std::floor(low.x() - 0.5))),
            right = std::min(width_ - 1, static_cast<int>(std::ceil(high.x() - 0.5))),
            top = std::max(0, static_cast<int>(std::floor(low.y() - 0.5))),
            bottom = std::min(height_ - 1, static_cast<int>(std::ceil(high.y() - 0.5)));
  Eigen::Vector3d depths, values;
  for (int i = 0; i < 3; ++i) {
    depths[i] = corners[static_cast<std::size_t>(i)].depth;
    values[i] = corners[static_cast<std::size_t>(i)].value;
  }
  // Barycentric coordinates change along a row by this from pixel to pixel.
  const Eigen::Vector3d change = Eigen::Vector3d(ab.y() - ac.y(), ac.y(), -ab.y()) / area;
  const double depth_change = change.dot(depths), value_change = change.dot(values);
  for (int y = top; y <= bottom; ++y) {
    const Eigen::Vector2d p(0.5 - a.x(), y + 0.5 - a.y()); // the first pixel of the row
    const double v = (p.x() * ac.y() - p.y() * ac.x()) / area, w = (ab.x() * p.y() - ab.y() * p.x()) / area;
    const Eigen::Vector3d first(1 - v - w, v, w);
    double from = left, to = right;
    for (int i = 0; i < 3; ++i) {
      const double side = (seam - first[i]) / change[i];
      if (change[i] > 0) from = std::max(from, std::ceil(side));
      if (change[i] < 0) to = std::min(to, std::floor(side));
      if (change[i] == 0 && first[i] < seam) to = -1;
    }
    if (!(from <= to)) continue; // sides may be crossed farther away than whole numbers reach
    const double depth_first = first.dot(depths), value_first = first.dot(values);
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (int x = static_cast<int>(from); x <= static_cast<int>(to); ++x) {
      const std::size_t place = row + static_cast<std::size_t>(x);
      const auto depth = static_cast<float>(depth_first + x * depth_change);
      if (depth < depth_[place]) continue;
      depth_[place] = depth;
      const std::uint32_t colour = palette(value_first + x * value_change);
      pixels_[place] = light == 1 ? colour : dimmed(colour, light);
    }
  }
}

} // namespace dielast::post
