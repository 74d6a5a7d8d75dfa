// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/legend.hpp"

#include "post/engineering.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace dielast::post {

namespace {

using Box = Eigen::AlignedBox2d;

/// The largest of 1, 2 and 5 times a power of ten that is not above `limit`.
double round_down(double limit) {
  const double power = std::pow(10, std::floor(std::log10(limit)));
  return (limit >= 5 * power ? 5 : limit >= 2 * power ? 2 : 1) * power;
}

/// The middle of nodes that lie around it and there.
template<class Places>
std::optional<Eigen::Vector2d> middle_of_area(const std::vector<int>& nodes, const Places& at) {
  Box box;
  for (const int node : nodes) box.extend(at(node));
  const double near = 0.1 * box.diagonal().norm(); // thinner ones are lines
  const auto is_there = [&](int node) { return (at(node) - box.center()).norm() <= near; };
  if (box.sizes().minCoeff() <= 2 * near || std::ranges::none_of(nodes, is_there)) return std::nullopt;
  return box.center();
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
  cairo_new_path(cr); // the text's end is not the next line's beginning
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

void draw_marks(cairo_t* cr, const std::vector<Mark>& marks, const std::vector<Eigen::Vector3d>& positions,
                const Eigen::Vector2d& centre, double right,
                const std::function<Eigen::Vector2d(const Eigen::Vector2d&)>& to_px) {
  constexpr double dot = 3.5, size = 20, line = 26;
  constexpr std::array<Colour, 6> colours{{{0.76, 0.16, 0.24},
                                           {0.15, 0.39, 0.66},
                                           {0.10, 0.50, 0.29},
                                           {0.56, 0.29, 0.66},
                                           {0.66, 0.38, 0.0},
                                           {0.11, 0.14, 0.18}}};
  const auto at = [&](int node) -> Eigen::Vector2d {
    return positions[static_cast<std::size_t>(node)].head<2>();
  };
  for (std::size_t m = 0; m < marks.size(); ++m) {
    set_colour(cr, colours[m % colours.size()]);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_width(cr, 2 * dot);
    for (const int node : marks[m].nodes) { // lines without length: a tenth of what circles take in a file
      const Eigen::Vector2d p = to_px(at(node));
      cairo_move_to(cr, p.x(), p.y());
      cairo_line_to(cr, p.x(), p.y());
    }
    cairo_stroke(cr);
  }
  std::vector<Box> taken;
  for (std::size_t m = 0; m < marks.size(); ++m) {
    const int outermost = *std::ranges::max_element(
        marks[m].nodes, {}, [&](int node) { return (at(node) - centre).squaredNorm(); });
    const double advance = text_width(cr, marks[m].name, size);
    Eigen::Vector2d beside = to_px(at(outermost)) + Eigen::Vector2d(2 * dot, size / 3);
    if (beside.x() + advance > right) beside.x() -= 4 * dot + advance;
    if (const auto middle = middle_of_area(marks[m].nodes, at))
      beside = to_px(*middle) + Eigen::Vector2d(-advance / 2, size / 3);
    const auto box = [&] {
      return Box(beside - Eigen::Vector2d(0, size), beside + Eigen::Vector2d(advance, line - size - 1));
    };
    while (std::ranges::any_of(taken, [&](const Box& other) { return other.intersects(box()); }))
      beside.y() += line;
    taken.push_back(box());
    constexpr double halo = 3;
    for (const double dx : {-halo, 0.0, halo})
      for (const double dy : {-halo, 0.0, halo})
        draw_text(cr, marks[m].name, beside.x() + dx, beside.y() + dy, size, {1, 1, 1});
    draw_text(cr, marks[m].name, beside.x(), beside.y(), size, colours[m % colours.size()]);
  }
}

} // namespace dielast::post
