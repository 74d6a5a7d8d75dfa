// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "post/pictures/colour_map.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace dielast::post {

/// A corner of what is drawn: place in px, y downwards; the larger its depth, the nearer to the viewer.
struct Corner {
  Eigen::Vector2d place;
  double depth = 0;
  double value = 0; ///< what is coloured
  double light = 1; ///< that dims it, besides that on the whole triangle
};

/// Colours 0xAARRGGBB of values, looked up.
class Palette {
 public:
  /// viridis from range.first to range.second.
  explicit Palette(std::pair<double, double> range);
  /// One for all values.
  explicit Palette(const Colour& colour);

  std::uint32_t operator()(double value) const {
    const double part = (value - low_) * steps_; // not a number: missing
    if (!(part == part)) return missing_;
    return colours_[static_cast<std::size_t>(part <= 0 ? 0 : part >= last ? last : part)];
  }
  /// The colours of value, value + change, value + 2 change, ...
  void paint(double value, double change, std::span<std::uint32_t> row) const {
    const double part = (value - low_) * steps_, step = change * steps_;
    if (step == 0 || !(std::abs(part + step) < 1e300)) {
      std::ranges::fill(row, (*this)(value));
      return;
    }
    double number = 0;
    for (std::uint32_t& pixel : row)
      pixel = colours_[static_cast<std::size_t>(std::clamp(part + step * number++, 0.0, double(last)))];
  }

 private:
  static constexpr int last =
      253; ///< with those of missing film and of none a PNG file numbers them by bytes
  double low_ = 0, steps_ = 0;
  std::array<std::uint32_t, last + 1> colours_{};
  std::uint32_t missing_ = 0;
};

/// Pixels that triangles are drawn into, each with the values of its corners between them. What is nearer
/// hides what is farther; neighbours leave no seam.
class Raster {
 public:
  /// `flat`: nothing lies before anything else, and what is drawn later is seen.
  Raster(int width, int height, bool flat = false);

  /// `light`: by which the colours are multiplied, 0..1.
  void draw(const std::array<Corner, 3>& corners, const Palette& palette, double light = 1);

  /// Of half the width and height: means of four pixels, the colours multiplied by the opacity.
  Raster halved() const;

  /// Rows of width() pixels 0xAARRGGBB; what is not drawn is transparent.
  std::uint32_t* pixels() { return pixels_.data(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int width_, height_;
  std::vector<std::uint32_t> pixels_;
  std::vector<float> depth_; ///< empty: flat
};

} // namespace dielast::post
