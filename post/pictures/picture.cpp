// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/picture.hpp"

#include "post/pictures/legend.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

namespace dielast::post {

namespace {

using meshing::CellBlock;
using meshing::CellType;
using Box = Eigen::AlignedBox2d;

constexpr double margin = 44, gap = 40, legend_height = 96, tallest_panel = 1400; // px
constexpr Colour wall_colour{0.16, 0.18, 0.22}, plain_film{0.86, 0.89, 0.92};

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

struct Canvas {
  Canvas(int width, int height)
      : surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height), cairo_surface_destroy),
        context(cairo_create(surface.get()), cairo_destroy) {}
  Surface surface;
  Context context;
};

/// A cell's nodes in the order in which its outline, or the line itself, passes them.
std::array<int, 6> outline(CellType type, std::span<const int> n) {
  switch (type) {
  case CellType::line2:
  case CellType::rod2:
    return {n[0], n[1]};
  case CellType::line3:
    return {n[0], n[2], n[1]};
  case CellType::triangle3:
    return {n[0], n[1], n[2]};
  case CellType::triangle6:
    return {n[0], n[3], n[1], n[4], n[2], n[5]};
  case CellType::meridian2:
  case CellType::meridian3:
    break;
  }
  return {};
}

void add_path(cairo_t* cr, const CellBlock& block, int cell, const std::vector<Eigen::Vector3d>& positions) {
  const auto nodes = outline(block.type, block.cell(cell));
  for (int i = 0; i < meshing::nodes_per_cell(block.type); ++i) {
    const Eigen::Vector3d& p = positions[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])];
    (i == 0 ? cairo_move_to : cairo_line_to)(cr, p.x(), p.y());
  }
}

Box extent(const meshing::Mesh& mesh, const Panel& panel, double wall_width) {
  Box box;
  for (const CellBlock& block : mesh.blocks)
    for (const int node : block.nodes) box.extend(panel.positions[static_cast<std::size_t>(node)].head<2>());
  if (box.isEmpty()) throw std::invalid_argument("nothing to draw");
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(wall_width / 2);
  return {box.min() - half, box.max() + half};
}

/// The film without seams: neighbours share hard edges on a canvas that is finer than the picture by this
/// factor.
constexpr int supersampling = 2;
/// Drawn width of a rod, over the diagonal of all that is drawn: its section is not in the mesh.
constexpr double rod_width = 0.01;

void fill_film(cairo_t* cr, const meshing::Mesh& mesh, const Panel& panel, std::pair<double, double> range) {
  cairo_set_antialias(cr, CAIRO_ANTIALIAS_NONE);
  cairo_set_line_width(cr, rod_width * extent(mesh, panel, 0).sizes().norm());
  std::size_t value = 0;
  for (const CellBlock& block : mesh.blocks) {
    if (is_line(block.type)) continue;
    for (int cell = 0; cell < block.size(); ++cell) {
      add_path(cr, block, cell, panel.positions);
      set_colour(cr, panel.values.empty()
                         ? plain_film
                         : viridis((panel.values[value++] - range.first) / (range.second - range.first)));
      (is_triangle(block.type) ? cairo_fill : cairo_stroke)(cr);
    }
  }
}

void stroke_walls(cairo_t* cr, const meshing::Mesh& mesh, const Panel& panel, double width) {
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(cr, width);
  set_colour(cr, wall_colour);
  for (const CellBlock& block : mesh.blocks) {
    if (!is_line(block.type)) continue;
    // One stroke per cell: Cairo's time grows faster than the length of a path.
    for (int cell = 0; cell < block.size(); ++cell) {
      add_path(cr, block, cell, panel.positions);
      cairo_stroke(cr);
    }
  }
}

/// Draws a panel with its box centred in the rectangle at (left, top), y upwards.
void draw_panel(cairo_t* cr, const meshing::Mesh& mesh, const Picture& picture, const Panel& panel,
                std::pair<double, double> range, double scale, double left, double top, double width,
                double height) {
  const Box box = extent(mesh, panel, picture.wall_width);
  const auto place = [&](cairo_t* target) {
    cairo_translate(target, width / 2, height / 2);
    cairo_scale(target, scale, -scale);
    cairo_translate(target, -box.center().x(), -box.center().y());
  };
  const Canvas film(static_cast<int>(std::ceil(width)) * supersampling,
                    static_cast<int>(std::ceil(height)) * supersampling);
  cairo_scale(film.context.get(), supersampling, supersampling);
  place(film.context.get());
  fill_film(film.context.get(), mesh, panel, range);

  cairo_save(cr);
  cairo_translate(cr, left, top);
  cairo_save(cr);
  cairo_scale(cr, 1.0 / supersampling, 1.0 / supersampling);
  cairo_set_source_surface(cr, film.surface.get(), 0, 0);
  cairo_paint(cr);
  cairo_restore(cr);
  place(cr);
  stroke_walls(cr, mesh, panel, std::max(picture.wall_width, 1 / scale));
  cairo_restore(cr);
}

std::pair<double, double> value_range(const Picture& picture) {
  std::pair<double, double> range{INFINITY, -INFINITY};
  for (const Panel& panel : picture.panels)
    for (const double value : panel.values)
      if (std::isfinite(value)) range = {std::min(range.first, value), std::max(range.second, value)};
  if (range.first > range.second) return {0, 1};
  // A uniform field differs by rounding only: show it as one colour.
  const double spread = 1e-6 * std::max(std::abs(range.first), std::abs(range.second));
  if (range.second - range.first <= spread) {
    const double half = spread > 0 ? 1e5 * spread : 0.5;
    return {range.first - half, range.second + half};
  }
  return range;
}

void check(const meshing::Mesh& mesh, const Picture& picture) {
  std::size_t triangles = 0;
  for (const CellBlock& block : mesh.blocks)
    if (is_meridian(block.type))
      throw std::invalid_argument("a film of revolution is drawn by its profile");
    else if (!is_line(block.type))
      triangles += static_cast<std::size_t>(block.size());
  if (picture.panels.empty()) throw std::invalid_argument("nothing to draw");
  for (const Panel& panel : picture.panels)
    if (panel.positions.size() != mesh.nodes.size() ||
        (!panel.values.empty() && panel.values.size() != triangles))
      throw std::invalid_argument("a panel needs a position per node and a value per triangle");
}

std::string png_bytes(cairo_surface_t* surface) {
  std::string bytes;
  const auto append = [](void* target, const unsigned char* data, unsigned length) {
    static_cast<std::string*>(target)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface, append, &bytes);
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cannot draw a picture: ") + cairo_status_to_string(status));
  return bytes;
}

} // namespace

std::string render_png(const meshing::Mesh& mesh, const Picture& picture) {
  check(mesh, picture);
  const auto panels = static_cast<double>(picture.panels.size());
  const double panel_width = (picture.width - 2 * margin - gap * (panels - 1)) / panels;
  Eigen::Vector2d largest(1e-12, 1e-12);
  for (const Panel& panel : picture.panels)
    largest = largest.cwiseMax(extent(mesh, panel, picture.wall_width).sizes());
  const double scale = std::min(panel_width / largest.x(), tallest_panel / largest.y());
  const double panel_height = largest.y() * scale;

  const bool titled = std::any_of(picture.panels.begin(), picture.panels.end(),
                                  [](const Panel& panel) { return !panel.title.empty(); });
  const double panel_title = picture.title.empty() ? margin : margin + 54; // baseline
  const double panel_top = titled ? panel_title + 22 : panel_title;
  const double legend_top = panel_top + panel_height + 64;

  const Canvas canvas(picture.width, static_cast<int>(std::ceil(legend_top + legend_height - margin / 2)));
  cairo_t* cr = canvas.context.get();
  cairo_set_source_rgb(cr, 1, 1, 1);
  cairo_paint(cr);
  if (!picture.title.empty())
    draw_text(cr, picture.title, margin, margin + 12, 28, ink, Align::left, CAIRO_FONT_WEIGHT_BOLD);

  const auto range = value_range(picture);
  double left = margin;
  for (const Panel& panel : picture.panels) {
    draw_text(cr, panel.title, left + panel_width / 2, panel_title, 20, faint_ink, Align::centre);
    draw_panel(cr, mesh, picture, panel, range, scale, left, panel_top, panel_width, panel_height);
    left += panel_width + gap;
  }
  draw_scale_bar(cr, scale, margin, legend_top + 8);
  const bool coloured = std::any_of(picture.panels.begin(), picture.panels.end(),
                                    [](const Panel& panel) { return !panel.values.empty(); });
  const double bar_width = std::min(560.0, picture.width / 2.0 - margin);
  if (coloured)
    draw_colour_bar(cr, picture.quantity, picture.unit, range, picture.width - margin - bar_width, legend_top,
                    bar_width);
  return png_bytes(canvas.surface.get());
}

} // namespace dielast::post
