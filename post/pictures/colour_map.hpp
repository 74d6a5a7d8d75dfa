// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace dielast::post {

/// Red, green and blue, 0..1.
struct Colour {
  double red = 0, green = 0, blue = 0;
};

/// The perceptually uniform map viridis at 0..1 (clamped); grey where the value is not a number.
Colour viridis(double value);

} // namespace dielast::post
