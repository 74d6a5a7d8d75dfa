// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/legend.hpp"

#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dielast::post {

namespace {

/// The largest of 1, 2 and 5 times a power of ten that is not above `limit`.
double round_down(double limit) {
  const double power = std::pow(10, std::floor(std::log10(limit)));
  return (limit >= 5 * power ? 5 : limit >= 2 * power ? 2 : 1) * power;
}

} // namespace

void set_colour(cairo_t* cr, const Colour& colour) {
  cairo_set_source_rgb(cr, colour.red, colour.green, colour.blue);
}

double text_width(cairo_t* cr, const std::string& text, double size, cairo_font_weight_t weight) {
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, weight);
  cairo_set_font_size(cr, size);
  cairo_text_extents_t extents;
  cairo_text_extents(cr, text.c_str(), &extents);
  return extents.x_advance;
}

void draw_text(cairo_t* cr, const std::string& text, double x, double y, double size, const Colour& colour,
               Align align, cairo_font_weight_t weight) {
  const double width = text_width(cr, text, size, weight), shift = align == Align::centre ? width / 2 : 0;
  set_colour(cr, colour);
  cairo_move_to(cr, x - shift, y);
  cairo_show_text(cr, text.c_str());
}

std::string tick_label(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && text.starts_with('-') ? text.substr(1) : text;
}

void draw_scale_bar(cairo_t* cr, double scale, double left, double y) {
  const double length = round_down(200 / scale);
  cairo_set_line_width(cr, 3);
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
  set_colour(cr, ink);
  cairo_move_to(cr, left, y - 6);
  cairo_rel_line_to(cr, 0, 12);
  cairo_move_to(cr, left, y);
  cairo_rel_line_to(cr, length * scale, 0);
  cairo_rel_move_to(cr, 0, -6);
  cairo_rel_line_to(cr, 0, 12);
  cairo_stroke(cr);
  draw_text(cr, significant(length * 1e3, 1) + " mm", left + length * scale / 2, y + 32, 18, ink,
            Align::centre);
}

void draw_colour_bar(cairo_t* cr, const std::string& quantity, const std::string& unit,
                     std::pair<double, double> range, double left, double y, double width) {
  const auto [low, high] = range;
  const double height = 16;
  cairo_pattern_t* gradient = cairo_pattern_create_linear(left, 0, left + width, 0);
  for (int i = 0; i <= 40; ++i) {
    const Colour colour = viridis(i / 40.0);
    cairo_pattern_add_color_stop_rgb(gradient, i / 40.0, colour.red, colour.green, colour.blue);
  }
  cairo_rectangle(cr, left, y, width, height);
  cairo_set_source(cr, gradient);
  cairo_fill(cr);
  cairo_pattern_destroy(gradient);

  const ScaledUnit scaled = scaled_unit(std::max(std::abs(low), std::abs(high)), unit);
  draw_text(cr, quantity + (scaled.unit.empty() ? "" : " (" + scaled.unit + ")"), left, y - 12, 18, ink);
  const double step = round_down((high - low) * scaled.factor / 3.5);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  cairo_set_line_width(cr, 1.5);
  for (double k = std::ceil(low * scaled.factor / step - 1e-9);
       k * step <= high * scaled.factor * (1 + 1e-12); ++k) {
    const double x = left + width * (k * step / scaled.factor - low) / (high - low);
    set_colour(cr, faint_ink);
    cairo_move_to(cr, x, y + height);
    cairo_rel_line_to(cr, 0, 6);
    cairo_stroke(cr);
    draw_text(cr, tick_label(k * step, decimals), x, y + height + 25, 17, faint_ink, Align::centre);
  }
}

} // namespace dielast::post
