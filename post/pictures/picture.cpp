// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/picture.hpp"

#include "post/pictures/legend.hpp"
#include "post/pictures/raster.hpp"

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

/// Of a line of two nodes, or of three, the last in its middle.
void add_path(cairo_t* cr, const CellBlock& block, int cell, const std::vector<Eigen::Vector3d>& positions) {
  const auto n = block.cell(cell);
  const auto at = [&](int node) { return positions[static_cast<std::size_t>(node)]; };
  cairo_move_to(cr, at(n[0]).x(), at(n[0]).y());
  if (n.size() > 2) cairo_line_to(cr, at(n[2]).x(), at(n[2]).y());
  cairo_line_to(cr, at(n[1]).x(), at(n[1]).y());
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

/// Values at the nodes of triangles: means over the triangles of one region that share a node.
class NodeValues {
 public:
  NodeValues(const meshing::Mesh& mesh, const Panel& panel) : panel_(panel), nodes_(mesh.nodes.size()) {
    if (panel.values.empty()) return;
    const int regions = panel.regions.empty() ? 1 : std::ranges::max(panel.regions) + 1;
    sums_.resize(static_cast<std::size_t>(regions) * nodes_);
    std::size_t number = 0;
    for (const CellBlock& block : mesh.blocks) {
      if (is_line(block.type)) continue;
      for (int cell = 0; cell < block.size(); ++cell, ++number)
        if (const double value = panel.values[number]; std::isfinite(value))
          for (const int node : block.cell(cell)) {
            auto& [sum, count] = sums_[place(number, node)];
            sum += value;
            ++count;
          }
    }
  }
  /// Of a node of triangle `number`; not a number where the triangle has no value.
  double at(std::size_t number, int node) const {
    if (panel_.values.empty() || !std::isfinite(panel_.values[number])) return NAN;
    const auto& [sum, count] = sums_[place(number, node)];
    return sum / count;
  }

 private:
  std::size_t place(std::size_t number, int node) const {
    const auto region = static_cast<std::size_t>(panel_.regions.empty() ? 0 : panel_.regions[number]);
    return region * nodes_ + static_cast<std::size_t>(node);
  }

  const Panel& panel_;
  std::size_t nodes_;
  std::vector<std::pair<double, int>> sums_; ///< by region and node
};

/// Light comes along z, so that flat film has its full colours.
constexpr double darkest = 0.55;

/// Of px, y downwards.
double light_on(const std::array<Eigen::Vector3d, 6>& x, const Eigen::Vector3d& towards) {
  const Eigen::Vector3d normal = (x[1] - x[0]).cross(x[2] - x[0]);
  const Eigen::Vector3d light(towards.x(), -towards.y(), towards.z());
  return darkest + (1 - darkest) * std::abs(normal.dot(light)) / std::max(normal.norm(), 1e-300);
}

constexpr int parts_of_side = 3;

/// A triangle of six nodes, perhaps with curved sides, as `parts`^2 flat ones.
void draw_triangle(Raster& raster, const std::array<Eigen::Vector3d, 6>& x,
                   const std::array<double, 6>& value, int parts, const Palette& palette, double light) {
  const auto corner = [&](int i, int j) {
    const double r = static_cast<double>(i) / parts, s = static_cast<double>(j) / parts, t = 1 - r - s;
    const std::array<double, 6> N{t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1),
                                  4 * r * t,       4 * r * s,       4 * s * t};
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    double v = 0;
    for (std::size_t a = 0; a < 6; ++a) {
      p += N[a] * x[a];
      v += N[a] * value[a];
    }
    return Corner{p.head<2>(), p.z(), v};
  };
  for (int j = 0; j < parts; ++j)
    for (int i = 0; i < parts - j; ++i) {
      raster.draw({corner(i, j), corner(i + 1, j), corner(i, j + 1)}, palette, light);
      if (i + j + 1 < parts)
        raster.draw({corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)}, palette, light);
    }
}

/// From a state's positions to px of a canvas, y downwards, z towards the viewer.
struct Placement {
  double scale;
  Eigen::Vector3d centre; ///< in the middle of the canvas
  Eigen::Vector2d size;   ///< of the canvas
  Eigen::Vector3d light;  ///< unit vector towards it

  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d p = scale * (x - centre);
    return {size.x() / 2 + p.x(), size.y() / 2 - p.y(), p.z()};
  }
};

Raster film_raster(const meshing::Mesh& mesh, const Panel& panel, std::pair<double, double> range,
                   const Placement& place) {
  Raster raster(static_cast<int>(place.size.x()), static_cast<int>(place.size.y()));
  const NodeValues values(mesh, panel);
  const Palette palette = panel.values.empty() ? Palette(plain_film) : Palette(range);
  std::size_t number = 0;
  for (const CellBlock& block : mesh.blocks) {
    if (is_line(block.type)) continue;
    for (int cell = 0; cell < block.size(); ++cell, ++number) {
      if (!is_triangle(block.type)) continue;
      const auto nodes = block.cell(cell);
      std::array<Eigen::Vector3d, 6> x;
      std::array<double, 6> value{};
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        x[a] = place(panel.positions[static_cast<std::size_t>(nodes[a])]);
        value[a] = values.at(number, nodes[a]);
      }
      if (nodes.size() == 3)
        raster.draw({Corner{x[0].head<2>(), x[0].z(), value[0]}, Corner{x[1].head<2>(), x[1].z(), value[1]},
                     Corner{x[2].head<2>(), x[2].z(), value[2]}},
                    palette, light_on(x, place.light));
      else
        draw_triangle(raster, x, value, parts_of_side, palette, light_on(x, place.light));
    }
  }
  return raster;
}

/// Rods have no section in the mesh.
void stroke_rods(cairo_t* cr, const meshing::Mesh& mesh, const Panel& panel,
                 std::pair<double, double> range) {
  cairo_set_line_width(cr, rod_width * extent(mesh, panel, 0).sizes().norm());
  std::size_t number = 0;
  for (const CellBlock& block : mesh.blocks) {
    if (is_line(block.type)) continue;
    for (int cell = 0; cell < block.size(); ++cell, ++number) {
      if (is_triangle(block.type)) continue;
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
                std::pair<double, double> range, const Eigen::Vector3d& light, double scale, double left,
                double top, double width, double height) {
  const Box box = extent(mesh, panel, picture.wall_width);
  const Eigen::Vector2d size(std::ceil(width) * supersampling, std::ceil(height) * supersampling);
  const Placement place{scale * supersampling, {box.center().x(), box.center().y(), 0}, size, light};
  Raster film = film_raster(mesh, panel, range, place);
  const Surface surface(cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(film.pixels()),
                                                            CAIRO_FORMAT_ARGB32, film.width(), film.height(),
                                                            4 * film.width()),
                        cairo_surface_destroy);
  cairo_save(cr);
  cairo_translate(cr, left, top);
  cairo_save(cr);
  cairo_scale(cr, 1.0 / supersampling, 1.0 / supersampling);
  cairo_set_source_surface(cr, surface.get(), 0, 0);
  cairo_paint(cr);
  cairo_restore(cr);
  cairo_translate(cr, std::ceil(width) / 2, std::ceil(height) / 2);
  cairo_scale(cr, scale, -scale);
  cairo_translate(cr, -box.center().x(), -box.center().y());
  stroke_rods(cr, mesh, panel, range);
  stroke_walls(cr, mesh, panel, std::max(picture.wall_width, 1 / scale));
  cairo_restore(cr);
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

/// A device that is not flat is seen from aside and above, along z otherwise: rows are right, up and towards
/// the viewer.
Eigen::Matrix3d view_of(const Picture& picture) {
  constexpr double flat = 0.02; ///< height over width
  constexpr double turned = 0.45, raised = 0.5;
  Eigen::AlignedBox3d box;
  for (const Panel& panel : picture.panels)
    for (const Eigen::Vector3d& x : panel.positions) box.extend(x);
  if (box.isEmpty() || box.sizes().z() <= flat * box.sizes().head<2>().norm())
    return Eigen::Matrix3d::Identity();
  const double c = std::cos(turned), s = std::sin(turned), up = std::sin(raised), aside = std::cos(raised);
  Eigen::Matrix3d axes;
  axes << c, s, 0, -s * up, c * up, aside, s * aside, -c * aside, up;
  return axes;
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

std::string render_png(const meshing::Mesh& mesh, Picture picture) {
  check(mesh, picture);
  const Eigen::Matrix3d view = view_of(picture);
  for (Panel& panel : picture.panels)
    for (Eigen::Vector3d& x : panel.positions) x = view * x;
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
    draw_panel(cr, mesh, picture, panel, range, view.col(2), scale, left, panel_top, panel_width,
               panel_height);
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
