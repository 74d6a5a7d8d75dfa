// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "post/pictures/image.hpp"

#include <string>
#include <vector>

namespace dielast::post {

/// A curve or a cloud of points; a point that is not finite leaves a gap.
struct Series {
  enum class Style { line, points, line_and_points };

  std::string label; ///< empty: not in the key
  std::vector<double> x{}, y{};
  Style style = Style::line;
};

/// On a logarithmic axis a point that is not positive leaves a gap.
struct Plot {
  std::string title, x_label, y_label;
  std::vector<Series> series{};
  bool log_x = false, log_y = false;
  double y_step = 0;       ///< between ticks of a linear y axis that is longer than two of them; 0: any
  bool equal_axes = false; ///< a unit is as long on y as on x
  double least_extent = 0; ///< of linear axes, about the middle of what is drawn, so that rounding fills none
  std::string heading{};   ///< what stands above the axes; empty: the title, which names the image
};

/// The plots as SVG documents with their points as readings, named by their titles
/// (without one by their y labels), by one call of gnuplot.
/// None where gnuplot is missing or failed: a
/// run's results do not depend on it.
std::vector<Image> draw(const std::vector<Plot>& plots);

} // namespace dielast::post
