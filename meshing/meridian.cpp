// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/meridian.hpp"

#include "meshing/graded_steps.hpp"

#include "meshing/middle_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace dielast::meshing {

namespace {

void validate_radii(double inside, double outside, const char* names) {
  if (!(inside > 0 && outside > inside) || !std::isfinite(outside))
    throw std::invalid_argument(
        fmt::format("{} must be positive and ascending, not {:.6g} m and {:.6g} m", names, inside, outside));
}

void validate(int elements, int fewest, int order) {
  if (elements < fewest)
    throw std::invalid_argument(
        fmt::format("at least {} elements are needed along a meridian, not {}", fewest, elements));
  if (order != 1 && order != 2)
    throw std::invalid_argument(fmt::format("the order of a mesh is 1 or 2, not {}", order));
}

/// Cells through curve(parameter) at these parameters, the middle nodes half way between.
template<class Curve>
Mesh chain(const std::vector<double>& parameters, int order, Curve curve) {
  Mesh mesh;
  for (const double t : parameters) mesh.nodes.push_back(curve(t));
  CellBlock film{order == 2 ? CellType::meridian3 : CellType::meridian2, {}};
  for (std::size_t i = 0; i + 1 < parameters.size(); ++i) {
    const int corner = static_cast<int>(i);
    film.nodes.insert(film.nodes.end(), {corner, corner + 1});
    if (order == 1) continue;
    film.nodes.push_back(mesh.node_count());
    mesh.nodes.push_back(curve(std::midpoint(parameters[i], parameters[i + 1])));
  }
  mesh.blocks.push_back(std::move(film));
  return mesh;
}

Mesh flat_chain(const std::vector<double>& radii, int order) {
  return chain(radii, order, [](double r) { return Eigen::Vector3d(r, 0, 0); });
}

void name_cells(Mesh& mesh, const std::string& place, int first, int end) {
  std::vector<int> cells(static_cast<std::size_t>(end - first));
  std::iota(cells.begin(), cells.end(), first);
  mesh.cell_sets[place] = {0, std::move(cells)};
  mesh.node_sets[place] = nodes_of(mesh, mesh.cell_sets[place]);
}

/// Appends `count` steps from `from` to `to`, without the last point.
void append_steps(std::vector<double>& points, double from, double to, int count) {
  for (int i = 0; i < count; ++i) points.push_back(std::lerp(from, to, static_cast<double>(i) / count));
}

} // namespace

Mesh disc_meridian(double radius, double electrode_radius, int elements, int order) {
  const bool covered = electrode_radius == radius;
  validate_radii(covered ? radius / 2 : electrode_radius, radius, "the radii of electrode and disc");
  validate(elements, 2, order);
  const int inside = covered ? elements
                             : std::clamp(static_cast<int>(std::lround(elements * electrode_radius / radius)),
                                          1, elements - 1);
  const int outside = elements - inside;
  std::vector<double> radii;
  append_steps(radii, radius, electrode_radius, outside);
  append_steps(radii, electrode_radius, 0, inside);
  radii.push_back(0);

  Mesh mesh = flat_chain(radii, order);
  name_cells(mesh, "film", 0, elements);
  if (!covered) name_cells(mesh, "passive", 0, outside);
  name_cells(mesh, "electrode", outside, elements);
  mesh.node_sets["rim"] = {0};
  mesh.node_sets["electrode_edge"] = {outside};
  mesh.node_sets["centre"] = {elements};
  return mesh;
}

Mesh annulus_meridian(double inner_radius, double outer_radius, int elements, int order, double grading) {
  validate_radii(inner_radius, outer_radius, "the inner and outer radius of an annulus");
  validate(elements, 1, order);
  std::vector<double> radii = graded_steps(inner_radius, outer_radius, elements, grading);
  std::ranges::reverse(radii);

  Mesh mesh = flat_chain(radii, order);
  name_cells(mesh, "film", 0, elements);
  mesh.node_sets["outer"] = {0};
  mesh.node_sets["inner"] = {elements};
  return mesh;
}

Mesh balloon_meridian(double radius, int elements, int order) {
  if (!(radius > 0) || !std::isfinite(radius))
    throw std::invalid_argument(
        fmt::format("the radius of a balloon must be positive, not {:.6g} m", radius));
  validate(elements, 1, order);
  elements += elements % 2;
  std::vector<double> latitudes;
  append_steps(latitudes, -std::numbers::pi / 2, std::numbers::pi / 2, elements);
  latitudes.push_back(std::numbers::pi / 2);

  Mesh mesh = chain(latitudes, order, [radius](double latitude) {
    return Eigen::Vector3d(radius * std::cos(latitude), 0, radius * std::sin(latitude));
  });
  // A pole lies on the axis exactly, not to rounding.
  for (const int pole : {0, elements}) mesh.nodes[static_cast<std::size_t>(pole)].x() = 0;
  name_cells(mesh, "film", 0, elements);
  mesh.node_sets["south"] = {0};
  mesh.node_sets["equator"] = {elements / 2};
  mesh.node_sets["north"] = {elements};
  return mesh;
}

Mesh roll_meridian(double length, double radius, double electrode_length, int elements, int order) {
  if (!(length > 0 && radius > 0 && electrode_length > 0) || electrode_length > length * (1 + 1e-9))
    throw std::invalid_argument(
        "a roll needs a length and a radius above 0, and its electrode lies within it");
  validate(elements, 2, order);
  const double margin = (length - electrode_length) / 2;
  const bool covered = margin <= 1e-9 * length;
  const int beside = covered ? 0 : std::max(1, static_cast<int>(std::lround(elements * margin / length)));
  const int under = std::max(1, elements - 2 * beside);
  std::vector<double> heights;
  append_steps(heights, 0, covered ? 0 : margin, beside);
  append_steps(heights, covered ? 0 : margin, covered ? length : length - margin, under);
  append_steps(heights, length - margin, length, beside);
  heights.push_back(length);
  Mesh mesh = chain(heights, order, [radius](double z) { return Eigen::Vector3d(radius, 0, z); });
  const int all = 2 * beside + under;
  name_cells(mesh, "film", 0, all);
  name_cells(mesh, "electrode", beside, beside + under);
  if (!covered) {
    std::vector<int>& cells = mesh.cell_sets["passive"].cells;
    for (int cell = 0; cell < all; ++cell)
      if (cell < beside || cell >= beside + under) cells.push_back(cell);
    mesh.node_sets["passive"] = nodes_of(mesh, mesh.cell_sets["passive"]);
  }
  mesh.node_sets["lower_end"] = {0};
  mesh.node_sets["upper_end"] = {all};
  return mesh;
}

} // namespace dielast::meshing
