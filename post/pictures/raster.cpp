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

Raster::Raster(int width, int height, bool flat)
    : width_(width), height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0),
      depth_(flat ? 0 : pixels_.size(), -std::numeric_limits<float>::infinity()) {}

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
  // Barycentric coordinates change along a row by this from pixel to pixel.
  const std::array<double, 3> change{(ab.y() - ac.y()) / area, ac.y() / area, -ab.y() / area};
  const std::array<double, 3> to_side{1 / change[0], 1 / change[1], 1 / change[2]};
  const auto mean = [&](const std::array<double, 3>& weights, double Corner::*of) {
    return weights[0] * corners[0].*of + weights[1] * corners[1].*of + weights[2] * corners[2].*of;
  };
  const double depth_change = mean(change, &Corner::depth), value_change = mean(change, &Corner::value),
               light_change = mean(change, &Corner::light);
  const bool shaded = std::ranges::any_of(corners, [](const Corner& corner) { return corner.light != 1; });
  for (int y = top; y <= bottom; ++y) {
    const double p = 0.5 - a.x(), q = y + 0.5 - a.y(); // from the first corner to the row's first pixel
    const double v = (p * ac.y() - q * ac.x()) / area, w = (ab.x() * q - ab.y() * p) / area;
    const std::array<double, 3> first{1 - v - w, v, w};
    double from = left, to = right;
    for (std::size_t i = 0; i < 3; ++i) {
      const double side = (seam - first[i]) * to_side[i];
      if (change[i] > 0) from = std::max(from, std::ceil(side));
      if (change[i] < 0) to = std::min(to, std::floor(side));
      if (change[i] == 0 && first[i] < seam) to = -1;
    }
    if (!(from <= to)) continue; // sides may be crossed farther away than whole numbers reach
    const auto begin = static_cast<std::size_t>(from), end = static_cast<std::size_t>(to) + 1;
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    const double value = mean(first, &Corner::value), depth = mean(first, &Corner::depth);
    const double light_there = shaded ? mean(first, &Corner::light) : 1;
    if (depth_.empty() && light == 1 && !shaded) {
      palette.paint(value + from * value_change, value_change, {&pixels_[row + begin], end - begin});
      continue;
    }
    for (std::size_t x = begin; x < end; ++x) {
      if (!depth_.empty()) {
        const auto near = static_cast<float>(depth + static_cast<double>(x) * depth_change);
        if (near < depth_[row + x]) continue;
        depth_[row + x] = near;
      }
      const std::uint32_t colour = palette(value + static_cast<double>(x) * value_change);
      const double here = shaded ? light * (light_there + static_cast<double>(x) * light_change) : light;
      pixels_[row + x] = here == 1 ? colour : dimmed(colour, here);
    }
  }
}

Raster Raster::halved() const {
  Raster half(width_ / 2, height_ / 2, true);
  constexpr std::uint64_t apart = 0x00ff00ff00ff00ff, rounding = 0x0002000200020002;
  const auto spread = [](std::uint32_t pixel) { // a channel in every sixteen bits
    return (std::uint64_t{pixel} | std::uint64_t{pixel} << 24) & apart;
  };
  const auto width = static_cast<std::size_t>(width_);
  std::uint32_t* target = half.pixels_.data();
  for (int y = 0; y < half.height_; ++y) {
    const std::uint32_t* upper = pixels_.data() + 2 * static_cast<std::size_t>(y) * width;
    const std::uint32_t* lower = upper + width;
    for (int x = 0; x < half.width_; ++x, upper += 2, lower += 2) {
      const std::uint64_t mean =
          (spread(upper[0]) + spread(upper[1]) + spread(lower[0]) + spread(lower[1]) + rounding) >> 2 & apart;
      *target++ = static_cast<std::uint32_t>(mean | mean >> 24);
    }
  }
  return half;
}

} // namespace dielast::post
