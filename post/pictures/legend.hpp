// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "post/pictures/colour_map.hpp"
#include "post/pictures/picture.hpp"

#include <cairo.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace dielast::post {

// What explains a picture. Places and sizes are in px, y downwards.

constexpr Colour ink{0.11, 0.14, 0.18}, faint_ink{0.36, 0.41, 0.47};

void set_colour(cairo_t* cr, const Colour& colour);

enum class Align { left, centre };

/// Sets the font; returns how far the text goes.
double text_width(cairo_t* cr, const std::string& text, double size,
                  cairo_font_weight_t weight = CAIRO_FONT_WEIGHT_NORMAL);

/// Text with its baseline at y.
void draw_text(cairo_t* cr, const std::string& text, double x, double y, double size, const Colour& colour,
               Align align = Align::left, cairo_font_weight_t weight = CAIRO_FONT_WEIGHT_NORMAL);

/// A tick's number with so many decimals; what is 0 then has no sign.
std::string tick_label(double value, int decimals);

/// A bar of a round length of at most 200 px with its length in mm; `scale` in px/m.
void draw_scale_bar(cairo_t* cr, double scale, double left, double y);

/// The colours of values (SI) from range.first to range.second, with ticks at round numbers in engineering
/// units.
void draw_colour_bar(cairo_t* cr, const std::string& quantity, const std::string& unit,
                     std::pair<double, double> range, double left, double y, double width);

/// Dots at the marks' nodes, which are at `positions`, and the names: in the middle of a mark that fills an
/// area, else beside the dot farthest from `centre`, on its left where it would not end before `right`, below
/// names that it would overlap. `to_px`: of a place.
void draw_marks(cairo_t* cr, const std::vector<Mark>& marks, const std::vector<Eigen::Vector3d>& positions,
                const Eigen::Vector2d& centre, double right,
                const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& to_px);

} // namespace dielast::post
