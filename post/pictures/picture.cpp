// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/picture.hpp"

#include "post/engineering.hpp"
#include "post/pictures/film_raster.hpp"
#include "post/pictures/legend.hpp"
#include "post/pictures/png.hpp"

#include <Eigen/Geometry>
#include <cairo-svg.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

namespace dielast::post {

namespace {

using meshing::CellBlock;
using meshing::CellType;
using Box = Eigen::AlignedBox2d;

constexpr double margin = 44, gap = 40, legend_height = 96, tallest_panel = 1400; // px
constexpr Colour wall_colour{0.16, 0.18, 0.22}, fin_colour{0.72, 0.76, 0.80};

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

struct Canvas {
  Canvas(int width, int height)
      : surface(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height), cairo_surface_destroy),
        context(cairo_create(surface.get()), cairo_destroy) {}
  Surface surface;
  Context context;
};

/// Of a line of two nodes, or of three, the last in its middle; `goes_on`: from where the path has come.
void add_path(cairo_t* cr, const CellBlock& block, int cell, const std::vector<Eigen::Vector3d>& positions,
              bool goes_on = false) {
  const auto n = block.cell(cell);
  const auto at = [&](int node) { return positions[static_cast<std::size_t>(node)]; };
  if (!goes_on) cairo_move_to(cr, at(n[0]).x(), at(n[0]).y());
  if (n.size() > 2) cairo_line_to(cr, at(n[2]).x(), at(n[2]).y());
  cairo_line_to(cr, at(n[1]).x(), at(n[1]).y());
}

Box extent(const meshing::Mesh& mesh, const Picture& picture, const Panel& panel, double wall_width) {
  Box box;
  for (const std::array<int, 4>& fin : picture.fins)
    for (const int node : fin) box.extend(panel.positions[static_cast<std::size_t>(node)].head<2>());
  for (const CellBlock& block : mesh.blocks)
    for (const int node : block.nodes) box.extend(panel.positions[static_cast<std::size_t>(node)].head<2>());
  if (box.isEmpty()) throw std::invalid_argument("nothing to draw");
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(wall_width / 2);
  return {box.min() - half, box.max() + half};
}

/// How the film's edges are drawn: slides are many.
enum class Edges { smooth, hard };
/// Drawn width of a rod, over the diagonal of all that is drawn: its section is not in the mesh.
constexpr double rod_width = 0.01;

/// Rods have no section in the mesh.
void stroke_rods(cairo_t* cr, const meshing::Mesh& mesh, const Picture& picture, const Panel& panel,
                 std::pair<double, double> range) {
  cairo_set_line_width(cr, rod_width * extent(mesh, picture, panel, 0).sizes().norm());
  std::size_t number = 0;
  for (const CellBlock& block : mesh.blocks) {
    if (is_line(block.type)) continue;
    for (int cell = 0; cell < block.size(); ++cell, ++number) {
      if (is_triangle(block.type) || is_tetrahedron(block.type)) continue;
      add_path(cr, block, cell, panel.positions);
      set_colour(cr, panel.values.empty()
                         ? plain_film
                         : viridis((panel.values[number] - range.first) / (range.second - range.first)));
      cairo_stroke(cr);
    }
  }
}

void stroke_walls(cairo_t* cr, const meshing::Mesh& mesh, const Panel& panel, double width) {
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(cr, width);
  set_colour(cr, wall_colour);
  constexpr int most_together = 8; // Cairo's time grows faster than the length of a path
  for (const CellBlock& block : mesh.blocks) {
    if (!is_line(block.type)) continue;
    for (int cell = 0, together = 0; cell < block.size(); ++cell) {
      const bool goes_on =
          together > 0 && together < most_together && block.cell(cell)[0] == block.cell(cell - 1)[1];
      if (together > 0 && !goes_on) cairo_stroke(cr);
      together = goes_on ? together + 1 : 1;
      add_path(cr, block, cell, panel.positions, goes_on);
    }
    cairo_stroke(cr);
  }
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

/// The name stands in the middle of a mark that fills an area, else beside the outermost dot, on its left
/// where it would not end before `right`, below names that it would overlap. `to_px`: from the view to px.
template<class ToPixels>
void draw_marks(cairo_t* cr, const std::vector<Mark>& marks, const Panel& panel,
                const Eigen::Vector2d& centre, double right, const ToPixels& to_px) {
  constexpr double dot = 3.5, size = 20, line = 26;
  constexpr std::array<Colour, 6> colours{{{0.76, 0.16, 0.24},
                                           {0.15, 0.39, 0.66},
                                           {0.10, 0.50, 0.29},
                                           {0.56, 0.29, 0.66},
                                           {0.66, 0.38, 0.0},
                                           {0.11, 0.14, 0.18}}};
  const auto at = [&](int node) -> Eigen::Vector2d {
    return panel.positions[static_cast<std::size_t>(node)].head<2>();
  };
  for (std::size_t m = 0; m < marks.size(); ++m) {
    set_colour(cr, colours[m % colours.size()]);
    for (const int node : marks[m].nodes) {
      const Eigen::Vector2d p = to_px(at(node));
      cairo_arc(cr, p.x(), p.y(), dot, 0, 2 * std::numbers::pi);
      cairo_fill(cr);
    }
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
      return Box(beside - Eigen::Vector2d(0, size), beside + Eigen::Vector2d(advance, line - size));
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

/// Fins seen from their edge are lines.
void fill_fins(cairo_t* cr, const Picture& picture, const Panel& panel, double width) {
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(cr, width);
  for (const std::array<int, 4>& fin : picture.fins) {
    cairo_new_path(cr);
    for (const int node : fin) {
      const Eigen::Vector3d& at = panel.positions[static_cast<std::size_t>(node)];
      cairo_line_to(cr, at.x(), at.y());
    }
    cairo_close_path(cr);
    set_colour(cr, fin_colour);
    cairo_fill_preserve(cr);
    set_colour(cr, wall_colour);
    cairo_stroke(cr);
  }
}

void require_drawn(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cannot draw a picture: ") + cairo_status_to_string(status));
}

/// The bytes of a PNG file with what is drawn.
std::string png_of(cairo_surface_t* surface) {
  require_drawn(cairo_surface_status(surface));
  cairo_surface_flush(surface);
  const int width = cairo_image_surface_get_stride(surface) / 4;
  return png(
      {reinterpret_cast<const std::uint32_t*>(cairo_image_surface_get_data(surface)),
       static_cast<std::size_t>(width) * static_cast<std::size_t>(cairo_image_surface_get_height(surface))},
      width);
}

/// Files hold these bytes instead of compressing the pixels again.
void keep_as_png(cairo_surface_t* surface) {
  auto bytes = std::make_unique<std::string>(png_of(surface));
  const auto* data = reinterpret_cast<const unsigned char*>(bytes->data());
  const auto forget = [](void* kept) { delete static_cast<std::string*>(kept); };
  require_drawn(
      cairo_surface_set_mime_data(surface, CAIRO_MIME_TYPE_PNG, data, bytes->size(), forget, bytes.get()));
  bytes.release();
}

/// Draws a panel with its box centred in the rectangle at (left, top), y upwards. `film`: as large.
void draw_panel(cairo_t* cr, const meshing::Mesh& mesh, const Picture& picture, const Panel& panel,
                std::pair<double, double> range, double scale, Raster& film, double left, double top,
                double width, double height) {
  const Box box = extent(mesh, picture, panel, picture.wall_width);
  const Surface surface(cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(film.pixels()),
                                                            CAIRO_FORMAT_ARGB32, film.width(), film.height(),
                                                            4 * film.width()),
                        cairo_surface_destroy);
  if (cairo_surface_supports_mime_type(cairo_get_target(cr), CAIRO_MIME_TYPE_PNG)) keep_as_png(surface.get());
  cairo_save(cr);
  cairo_translate(cr, left, top);
  cairo_set_source_surface(cr, surface.get(), 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST); // whole pixels
  cairo_paint(cr);
  cairo_translate(cr, std::ceil(width) / 2, std::ceil(height) / 2);
  cairo_scale(cr, scale, -scale);
  cairo_translate(cr, -box.center().x(), -box.center().y());
  fill_fins(cr, picture, panel, std::max(picture.wall_width, 1 / scale));
  stroke_rods(cr, mesh, picture, panel, range);
  stroke_walls(cr, mesh, panel, std::max(picture.wall_width, 1 / scale));
  cairo_restore(cr);
  const Eigen::Vector2d middle(left + std::ceil(width) / 2, top + std::ceil(height) / 2);
  draw_marks(cr, picture.marks, panel, box.center(), left + width + margin,
             [&](const Eigen::Vector2d& x) -> Eigen::Vector2d {
               return middle + scale * (x - box.center()).cwiseProduct(Eigen::Vector2d(1, -1));
             });
}

std::pair<double, double> value_range(const Picture& picture) {
  std::pair<double, double> range{INFINITY, -INFINITY};
  for (const Panel& panel : picture.panels)
    for (const double value : panel.values)
      if (std::isfinite(value)) range = {std::min(range.first, value), std::max(range.second, value)};
  if (range.first > range.second) return {0, 1};
  // A uniform field differs by what elements and rounding leave: show it as one colour.
  constexpr double uniform = 2e-4;
  const double largest = std::max(std::abs(range.first), std::abs(range.second));
  if (range.second - range.first <= uniform * largest) {
    const double half = largest > 0 ? 0.1 * largest : 0.5;
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
        (!panel.values.empty() && panel.values.size() != triangles) ||
        (!panel.regions.empty() && panel.regions.size() != triangles))
      throw std::invalid_argument("a panel needs a position per node, a value and a region per triangle");
  for (const Mark& mark : picture.marks)
    if (mark.nodes.empty()) throw std::invalid_argument("a mark needs a node");
}

cairo_status_t append_bytes(void* target, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(target)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

/// Draws panels of a picture side by side, `together` of them at a time, always to one scale.
class Drawing {
 public:
  /// Moves the picture's positions into the view.
  Drawing(const meshing::Mesh& mesh, Picture& picture, std::size_t together)
      : mesh_(mesh), picture_(picture), range_((check(mesh, picture), value_range(picture))) {
    view_ = view_of(picture.panels);
    for (Panel& panel : picture.panels)
      for (Eigen::Vector3d& x : panel.positions) x = view_.axes * x;
    const auto panels = static_cast<double>(together);
    panel_width_ = (picture.width - 2 * margin - gap * (panels - 1)) / panels;
    Eigen::Vector2d largest(1e-12, 1e-12);
    for (const Panel& panel : picture.panels)
      largest = largest.cwiseMax(extent(mesh, picture, panel, picture.wall_width).sizes());
    scale_ = std::min(panel_width_ / largest.x(), tallest_panel / largest.y());
    panel_height_ = largest.y() * scale_;
    const bool titled =
        std::ranges::any_of(picture.panels, [](const Panel& panel) { return !panel.title.empty(); });
    panel_title_ = picture.title.empty() ? margin : margin + 54; // baseline
    panel_top_ = titled ? panel_title_ + 22 : panel_title_;
    legend_top_ = panel_top_ + panel_height_ + 64;
    coloured_ = std::ranges::any_of(picture.panels, [](const Panel& panel) { return !panel.values.empty(); });
  }

  /// The films of panels, each as large as a panel's rectangle.
  std::vector<Raster> films(std::span<const Panel> panels, Edges edges) const {
    const int finer = edges == Edges::smooth ? 2 : 1;
    const Eigen::Vector2d size(std::ceil(panel_width_), std::ceil(panel_height_));
    std::vector<Raster> films;
    for (const Panel& panel : panels) {
      const Box box = extent(mesh_, picture_, panel, picture_.wall_width);
      Raster film = film_raster(
          mesh_, panel, range_,
          {finer * scale_, {box.center().x(), box.center().y(), 0}, finer * size, view_.light, view_.relief});
      films.push_back(edges == Edges::smooth ? film.halved() : std::move(film));
    }
    return films;
  }
  std::string png(std::span<const Panel> panels, std::vector<Raster>& films) const {
    const Canvas canvas(picture_.width, height());
    draw(canvas.context.get(), panels, films);
    return png_of(canvas.surface.get());
  }
  std::string svg(std::span<const Panel> panels, std::vector<Raster>& films) const {
    std::string text;
    const Surface surface(cairo_svg_surface_create_for_stream(append_bytes, &text, picture_.width, height()),
                          cairo_surface_destroy);
    {
      const Context context(cairo_create(surface.get()), cairo_destroy);
      draw(context.get(), panels, films);
    }
    cairo_surface_finish(surface.get());
    require_drawn(cairo_surface_status(surface.get()));
    return text;
  }
  /// See report_script(); empty without colours.
  std::string readings() const {
    if (!coloured_) return {};
    const ScaledUnit scaled =
        scaled_unit(std::max(std::abs(range_.first), std::abs(range_.second)), picture_.unit);
    return nlohmann::json{{"range", {range_.first * scaled.factor, range_.second * scaled.factor}},
                          {"quantity", picture_.quantity},
                          {"unit", scaled.unit}}
        .dump();
  }

 private:
  int height() const { return static_cast<int>(std::ceil(legend_top_ + legend_height - margin / 2)); }
  void draw(cairo_t* cr, std::span<const Panel> panels, std::vector<Raster>& films) const {
    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_paint(cr);
    if (!picture_.title.empty())
      draw_text(cr, picture_.title, margin, margin + 12, 28, ink, Align::left, CAIRO_FONT_WEIGHT_BOLD);
    double left = margin;
    for (std::size_t p = 0; p < panels.size(); ++p) {
      const Panel& panel = panels[p];
      draw_text(cr, panel.title, left + panel_width_ / 2, panel_title_, 20, faint_ink, Align::centre);
      draw_panel(cr, mesh_, picture_, panel, range_, scale_, films[p], left, panel_top_, panel_width_,
                 panel_height_);
      left += panel_width_ + gap;
    }
    draw_scale_bar(cr, scale_, margin, legend_top_ + 8);
    const double bar_width = std::min(560.0, picture_.width / 2.0 - margin);
    if (coloured_)
      draw_colour_bar(cr, picture_.quantity, picture_.unit, range_, picture_.width - margin - bar_width,
                      legend_top_, bar_width);
  }

  const meshing::Mesh& mesh_;
  const Picture& picture_;
  std::pair<double, double> range_;
  View view_;
  double scale_ = 1, panel_width_ = 0, panel_height_ = 0, panel_title_ = 0, panel_top_ = 0, legend_top_ = 0;
  bool coloured_ = false;
};

} // namespace

std::string render_png(const meshing::Mesh& mesh, Picture picture) {
  const Drawing drawing(mesh, picture, picture.panels.size());
  std::vector<Raster> films = drawing.films(picture.panels, Edges::smooth);
  return drawing.png(picture.panels, films);
}

Image draw(const meshing::Mesh& mesh, Picture picture, const std::string& name) {
  const Drawing drawing(mesh, picture, picture.panels.size());
  std::vector<Raster> films = drawing.films(picture.panels, Edges::smooth);
  return {.data = drawing.png(picture.panels, films),
          .name = name,
          .drawing = name.empty() ? "" : drawing.svg(picture.panels, films),
          .readings = drawing.readings()};
}

Slides draw_slides(const meshing::Mesh& mesh, Picture picture) {
  const Drawing drawing(mesh, picture, 1);
  Slides slides{.readings = drawing.readings()};
  for (const Panel& panel : picture.panels) {
    std::vector<Raster> film = drawing.films({&panel, 1}, Edges::hard);
    slides.pictures.push_back(drawing.png({&panel, 1}, film));
  }
  return slides;
}

} // namespace dielast::post
