// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/patch.hpp"

#include "meshing/middle_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace dielast::meshing {

namespace {

/// Names the nodes at which a coordinate has this value.
void name_side(Mesh& mesh, const char* place, int axis, double at) {
  std::vector<int>& nodes = mesh.node_sets[place];
  for (int n = 0; n < mesh.node_count(); ++n)
    if (mesh.nodes[static_cast<std::size_t>(n)][axis] == at) nodes.push_back(n);
}

/// Steps of about `size` from 0 to `length`, with a point at each end of the `inner` length in the middle,
/// and at least `fewest` steps between these; both halves are alike.
std::vector<double> steps_around(double length, double inner, double size, int fewest) {
  const double margin = (length - inner) / 2;
  std::vector<double> points{0};
  const auto append = [&](double from, double to) {
    const int count = std::max(fewest, static_cast<int>(std::lround((to - from) / size)));
    for (int i = 1; i < count; ++i) points.push_back(from + i * (to - from) / count);
    points.push_back(to);
  };
  if (margin > 0) append(0, margin);
  append(margin, margin + inner);
  if (margin > 0) append(margin + inner, length);
  return points;
}

} // namespace

Mesh patch_mesh(double length, double width, int order) {
  if (!(length > 0 && width > 0)) throw std::invalid_argument("a patch needs a length and a width above 0");
  Mesh mesh;
  mesh.nodes = {{0, 0, 0}, {length, 0, 0}, {length, width, 0}, {0, width, 0}};
  mesh.blocks = {{CellType::triangle3, {0, 1, 2, 0, 2, 3}}};
  mesh.cell_sets["film"] = {0, {0, 1}};
  if (order == 2) add_middle_nodes(mesh);
  add_node_sets(mesh);
  name_side(mesh, "left", 0, 0);
  name_side(mesh, "right", 0, length);
  name_side(mesh, "bottom", 1, 0);
  name_side(mesh, "top", 1, width);
  mesh.node_sets["centre"] = mesh.node_sets.at("film");
  return mesh;
}

Mesh strip_mesh(const StripShape& shape, int across, int order) {
  const auto& [length, width, covered_length, covered_width] = shape;
  if (!(covered_length > 0 && covered_width > 0 && covered_length <= length && covered_width <= width))
    throw std::invalid_argument("a strip needs sizes above 0, and its electrode lies within it");
  if (across < 1) throw std::invalid_argument("a strip needs an element from side to side");
  const int fewest = std::max(1, across / 4); // a short strip, or a narrow margin, is refined, too
  const std::vector<double> x = steps_around(width, covered_width, width / across, fewest);
  const std::vector<double> y = steps_around(length, covered_length, width / across, fewest);
  const int columns = static_cast<int>(x.size()) - 1, rows = static_cast<int>(y.size()) - 1;
  Mesh mesh;
  for (const double down : y)
    for (const double along : x) mesh.nodes.emplace_back(along - width / 2, -down, 0);
  CellBlock film{CellType::triangle3, {}};
  const auto inside = [](double from, double to, double length_of_all, double inner) {
    const double margin = (length_of_all - inner) / 2, middle = (from + to) / 2;
    return middle > margin && middle < length_of_all - margin;
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto c = static_cast<std::size_t>(i), r = static_cast<std::size_t>(j);
      const int a = (j + 1) * (columns + 1) + i, b = a + 1, d = a - columns - 1, e = d + 1;
      const bool rising = (2 * i < columns) == (2 * j < rows); // of the diagonals, as in a mirror
      const auto pair = rising ? std::array{a, b, e, a, e, d} : std::array{a, b, d, b, e, d};
      const bool charged =
          inside(x[c], x[c + 1], width, covered_width) && inside(y[r], y[r + 1], length, covered_length);
      for (int t = 0; t < 2; ++t) {
        mesh.cell_sets["film"].cells.push_back(film.size());
        mesh.cell_sets[charged ? "electrode" : "passive"].cells.push_back(film.size());
        film.nodes.insert(film.nodes.end(), pair.begin() + 3 * t, pair.begin() + 3 * t + 3);
      }
    }
  mesh.blocks = {std::move(film)};
  if (order == 2) add_middle_nodes(mesh);
  add_node_sets(mesh);
  name_side(mesh, "upper_end", 1, 0);
  name_side(mesh, "lower_end", 1, -length);
  name_side(mesh, "left", 0, -width / 2);
  name_side(mesh, "right", 0, width / 2);
  return mesh;
}

} // namespace dielast::meshing
