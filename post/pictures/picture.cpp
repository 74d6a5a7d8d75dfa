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

using Way = std::vector<Eigen::Vector2d>;

/// Of a line of two nodes, or of three, the last in its middle; from where the way has come, if it has.
void add_cell(Way& way, const CellBlock& block, int cell, const std::vector<Eigen::Vector3d>& positions) {
  const auto n = block.cell(cell);
  const auto add = [&](int node) { way.push_back(positions[static_cast<std::size_t>(node)].head<2>()); };
  if (way.empty()) add(n[0]);
  if (n.size() > 2) add(n[2]);
  add(n[1]);
}

/// Without points that lie as `near` as this to the straight line between those before and behind them.
void stroke(cairo_t* cr, const Way& way, double near) {
  const auto misses = [&](std::size_t from, std::size_t to) {
    const Eigen::Vector2d line = way[to] - way[from];
    const double square = line.squaredNorm();
    for (std::size_t i = from + 1; i < to; ++i) {
      const Eigen::Vector2d p = way[i] - way[from];
      const double part = square > 0 ? std::clamp(p.dot(line) / square, 0.0, 1.0) : 0;
      if ((p - part * line).squaredNorm() > near * near) return true;
    }
    return false;
  };
  std::size_t last = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (i > 0 && i + 1 < way.size() && !misses(last, i + 1)) continue;
    cairo_line_to(cr, way[i].x(), way[i].y());
    last = i;
  }
  cairo_stroke(cr);
}

Box extent(const meshing::Mesh& mesh, const Picture& picture, const Panel& panel) {
  Box box;
  for (const std::array<int, 4>& fin : picture.fins)
    for (const int node : fin) box.extend(panel.positions[static_cast<std::size_t>(node)].head<2>());
  for (const CellBlock& block : mesh.blocks)
    for (const int node : block.nodes) box.extend(panel.positions[static_cast<std::size_t>(node)].head<2>());
  if (box.isEmpty()) throw std::invalid_argument("nothing to draw");
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(picture.widest_wall() / 2);
  return {box.min() - half, box.max() + half};
}

/// How the film's edges are drawn: as means of four pixels, by whole pixels (slides are many), or where walls
/// hide them, by larger pixels, between which the colour of the film changes gradually.
enum class Edges { smooth, hard, hidden };

/// Whether walls are drawn over all edges at which the colour of the film jumps.
bool hides_edges(const meshing::Mesh& mesh, const Picture& picture) {
  return is_framed(mesh) && std::ranges::all_of(picture.panels, [](const Panel& panel) {
           const auto is_first = [&](int region) { return region == panel.regions.front(); };
           const auto is_level = [&](const Eigen::Vector3d& x) { return x.z() == panel.positions[0].z(); };
           return std::ranges::all_of(panel.regions, is_first) &&
                  std::ranges::all_of(panel.positions, is_level) &&
                  std::ranges::all_of(panel.values, [](double value) { return std::isfinite(value); });
         });
}

/// Drawn width of a rod, over the diagonal of all that is drawn: its section is not in the mesh.
constexpr double rod_width = 0.01;

/// Rods have no section in the mesh.
void stroke_rods(cairo_t* cr, const meshing::Mesh& mesh, const Picture& picture, const Panel& panel,
                 std::pair<double, double> range) {
  cairo_set_line_width(cr, rod_width * extent(mesh, picture, panel).sizes().norm());
  std::size_t number = 0;
  for (const CellBlock& block : mesh.blocks) {
    if (is_line(block.type)) continue;
    for (int cell = 0; cell < block.size(); ++cell, ++number) {
      if (is_triangle(block.type) || is_tetrahedron(block.type)) continue;
      Way way;
      add_cell(way, block, cell, panel.positions);
      set_colour(cr, panel.values.empty()
                         ? plain_film
                         : viridis((panel.values[number] - range.first) / (range.second - range.first)));
      stroke(cr, way, 0);
    }
  }
}

void stroke_walls(cairo_t* cr, const meshing::Mesh& mesh, const Picture& picture, const Panel& panel,
                  double px) {
  cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  set_colour(cr, wall_colour);
  constexpr int most_together = 32; // cells: Cairo's time grows faster than the length of a path
  const double unseen = px / 5;
  double width = px;
  std::size_t line = 0;
  for (const CellBlock& block : mesh.blocks) {
    if (!is_line(block.type)) continue;
    Way way;
    for (int cell = 0, together = 0; cell < block.size(); ++cell, ++line) {
      const double before =
          std::exchange(width, std::max(picture.wall_widths.empty() ? 0 : picture.wall_widths[line], px));
      const bool goes_on = together > 0 && together < most_together && width == before &&
                           block.cell(cell)[0] == block.cell(cell - 1)[1];
      together = goes_on ? together + 1 : 1;
      if (!goes_on) {
        stroke(cr, way, unseen);
        way.clear();
        cairo_set_line_width(cr, width);
      }
      add_cell(way, block, cell, panel.positions);
    }
    stroke(cr, way, unseen);
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

/// Draws a panel with its box centred in the rectangle at (left, top), y upwards. `film`: as large, its
/// pixels `pixel` px wide.
void draw_panel(cairo_t* cr, const meshing::Mesh& mesh, const Picture& picture, const Panel& panel,
                std::pair<double, double> range, double scale, Raster& film, double pixel, double left,
                double top, double width, double height) {
  const Box box = extent(mesh, picture, panel);
  const Surface surface(cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(film.pixels()),
                                                            CAIRO_FORMAT_ARGB32, film.width(), film.height(),
                                                            4 * film.width()),
                        cairo_surface_destroy);
  const bool is_svg = cairo_surface_supports_mime_type(cairo_get_target(cr), CAIRO_MIME_TYPE_PNG) != 0;
  if (is_svg) keep_as_png(surface.get());
  cairo_save(cr);
  cairo_translate(cr, left, top);
  cairo_save(cr);
  cairo_scale(cr, pixel, pixel);
  cairo_set_source_surface(cr, surface.get(), 0, 0);
  if (!is_svg && pixel == 1)
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST); // whole ones
  cairo_paint(cr);
  cairo_restore(cr);
  cairo_translate(cr, std::ceil(width) / 2, std::ceil(height) / 2);
  cairo_scale(cr, scale, -scale);
  cairo_translate(cr, -box.center().x(), -box.center().y());
  fill_fins(cr, picture, panel, std::max(picture.widest_wall(), 1 / scale));
  stroke_rods(cr, mesh, picture, panel, range);
  stroke_walls(cr, mesh, picture, panel, 1 / scale);
  cairo_restore(cr);
  const Eigen::Vector2d middle(left + std::ceil(width) / 2, top + std::ceil(height) / 2);
  draw_marks(cr, picture.marks, panel.positions, box.center(), left + width + margin,
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
  std::size_t triangles = 0, lines = 0;
  for (const CellBlock& block : mesh.blocks)
    if (is_meridian(block.type))
      throw std::invalid_argument("a film of revolution is drawn by its profile");
    else
      (is_line(block.type) ? lines : triangles) += static_cast<std::size_t>(block.size());
  if (!picture.wall_widths.empty() && picture.wall_widths.size() != lines)
    throw std::invalid_argument("a picture needs a width per line");
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
  Drawing(const meshing::Mesh& mesh, Picture& picture, std::size_t together, Edges smoothness = Edges::smooth)
      : mesh_(mesh), picture_(picture), range_((check(mesh, picture), value_range(picture))) {
    view_ = view_of(picture.panels);
    for (Panel& panel : picture.panels)
      for (Eigen::Vector3d& x : panel.positions) x = view_.axes * x;
    const auto panels = static_cast<double>(together);
    panel_width_ = (picture.width - 2 * margin - gap * (panels - 1)) / panels;
    Eigen::Vector2d largest(1e-12, 1e-12);
    for (const Panel& panel : picture.panels)
      largest = largest.cwiseMax(extent(mesh, picture, panel).sizes());
    scale_ = std::min(panel_width_ / largest.x(), tallest_panel / largest.y());
    panel_height_ = largest.y() * scale_;
    const bool titled =
        std::ranges::any_of(picture.panels, [](const Panel& panel) { return !panel.title.empty(); });
    panel_title_ = picture.title.empty() ? margin : margin + 54; // baseline
    panel_top_ = titled ? panel_title_ + 22 : panel_title_;
    legend_top_ = panel_top_ + panel_height_ + 64;
    // A film's pixel may end as far as its width on either side of where it should.
    constexpr double least = 2, most = 3; // px
    const double within = std::min(std::floor(scale_ * picture.narrowest_wall() / 2), most);
    edges_ = within >= least && hides_edges(mesh, picture) ? Edges::hidden : smoothness;
    if (edges_ == Edges::hidden) pixel_ = within;
    coloured_ = std::ranges::any_of(picture.panels, [](const Panel& panel) { return !panel.values.empty(); });
  }

  /// The films of panels, each as large as a panel's rectangle.
  std::vector<Raster> films(std::span<const Panel> panels) const {
    const double finer = edges_ == Edges::smooth ? 2 : 1 / pixel_;
    const Eigen::Vector2d size(std::ceil(panel_width_), std::ceil(panel_height_));
    std::vector<Raster> films;
    for (const Panel& panel : panels) {
      const Box box = extent(mesh_, picture_, panel);
      Raster film = film_raster(
          mesh_, panel, range_,
          {finer * scale_, {box.center().x(), box.center().y(), 0}, finer * size, view_.light, view_.relief});
      films.push_back(edges_ == Edges::smooth ? film.halved() : std::move(film));
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
      draw_panel(cr, mesh_, picture_, panel, range_, scale_, films[p], pixel_, left, panel_top_, panel_width_,
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
  Edges edges_ = Edges::smooth;
  double pixel_ = 1; ///< of the film, px
  bool coloured_ = false;
};

} // namespace

std::string render_png(const meshing::Mesh& mesh, Picture picture) {
  const Drawing drawing(mesh, picture, picture.panels.size());
  std::vector<Raster> films = drawing.films(picture.panels);
  return drawing.png(picture.panels, films);
}

Image draw(const meshing::Mesh& mesh, Picture picture, const std::string& name) {
  const Drawing drawing(mesh, picture, picture.panels.size());
  std::vector<Raster> films = drawing.films(picture.panels);
  return {.svg = drawing.svg(picture.panels, films), .name = name, .readings = drawing.readings()};
}

Slides draw_slides(const meshing::Mesh& mesh, Picture picture) {
  const Drawing drawing(mesh, picture, 1, Edges::hard);
  Slides slides{.readings = drawing.readings()};
  for (const Panel& panel : picture.panels) {
    std::vector<Raster> film = drawing.films({&panel, 1});
    slides.pictures.push_back(drawing.svg({&panel, 1}, film));
  }
  return slides;
}

} // namespace dielast::post
