// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace dielast::post {

/// What a page does: tables are sorted by a click on the head of a column and saved as CSV, slides have a
/// slider, and figures with readings (attribute data-readings, JSON) say the value under the pointer.
/// Readings of a plot:
/// {"size": [width, height], "frame": [left, right, top, bottom] (px of the size), "x": {"ends": [low, high],
/// "log": bool, "label"}, "y": likewise, "series": [{"label", "x": [...], "y": [...]}]}; of a picture, whose
/// colours are values: {"range": [low, high], "quantity", "unit"}.
std::string report_script();

} // namespace dielast::post
