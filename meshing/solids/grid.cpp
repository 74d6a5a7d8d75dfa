// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/grid.hpp"

#include "meshing/middle_nodes.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::meshing {

std::vector<double> with_middles(const std::vector<double>& lines) {
  std::vector<double> all{lines.front()};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    all.push_back((lines[i - 1] + lines[i]) / 2);
    all.push_back(lines[i]);
  }
  return all;
}

std::vector<double> graded_line(const std::vector<double>& breaks, const std::vector<double>& fine,
                                double finest, double coarsest) {
  constexpr double growth = 0.25;
  constexpr int samples = 400;
  const auto step = [&](double x) {
    double size = coarsest;
    for (const double at : fine) size = std::min(size, finest + growth * std::abs(x - at));
    return size;
  };
  std::vector<double> places{breaks.front()};
  for (std::size_t b = 1; b < breaks.size(); ++b) {
    const double from = breaks[b - 1], length = breaks[b] - from;
    std::vector<double> count{0}; // of steps up to each sample
    for (int i = 0; i < samples; ++i)
      count.push_back(count.back() + length / samples / step(from + length * (i + 0.5) / samples));
    const int steps = std::max(1, static_cast<int>(std::lround(count.back())));
    for (int k = 1; k < steps; ++k) {
      const double wanted = count.back() * k / steps;
      const auto above = std::ranges::upper_bound(count, wanted);
      const auto i = static_cast<double>(above - count.begin() - 1);
      places.push_back(from + length / samples * (i + (wanted - *(above - 1)) / (*above - *(above - 1))));
    }
    places.push_back(breaks[b]);
  }
  return places;
}

TriangleGrid::TriangleGrid(std::vector<double> u, std::vector<double> v,
                           const std::function<Eigen::Vector3d(double u, double v)>& place)
    : u_(with_middles(u)), v_(with_middles(v)) {
  const auto columns = static_cast<int>(u_.size());
  for (const double y : v_)
    for (const double x : u_) mesh_.nodes.push_back(place(x, y));
  mesh_.blocks = {{CellType::triangle6, {}}};
  const auto node = [columns](int i, int j) { return j * columns + i; };
  std::vector<int>& nodes = mesh_.blocks[0].nodes;
  const auto add = [&](std::array<std::array<int, 2>, 3> corner) {
    for (const auto& [i, j] : corner) nodes.push_back(node(i, j));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &a = corner[k], &b = corner[(k + 1) % 3];
      nodes.push_back(node((a[0] + b[0]) / 2, (a[1] + b[1]) / 2));
    }
  };
  for (int j = 0; j + 2 < std::ssize(v_); j += 2)
    for (int i = 0; i + 2 < columns; i += 2) {
      const std::array<int, 2> a{i, j}, b{i + 2, j}, c{i + 2, j + 2}, d{i, j + 2};
      if ((i + j) % 4 == 0) { // diagonals meet at every other node
        add({a, b, c});
        add({a, c, d});
      } else {
        add({a, b, d});
        add({b, c, d});
      }
    }
}

void TriangleGrid::name_triangles(const std::string& name,
                                  const std::function<bool(double u, double v)>& such) {
  CellSet set{0, {}};
  const auto columns = static_cast<int>(u_.size());
  const CellBlock& block = mesh_.blocks[0];
  for (int cell = 0; cell < block.size(); ++cell) {
    double u = 0, v = 0;
    for (const int corner : block.cell(cell).first(3)) {
      u += u_[static_cast<std::size_t>(corner % columns)] / 3;
      v += v_[static_cast<std::size_t>(corner / columns)] / 3;
    }
    if (such(u, v)) set.cells.push_back(cell);
  }
  if (set.cells.empty()) return;
  mesh_.node_sets[name] = nodes_of(mesh_, set);
  mesh_.cell_sets[name] = std::move(set);
}

void TriangleGrid::name_nodes(const std::string& name, const std::function<bool(double u, double v)>& such) {
  std::vector<int>& nodes = mesh_.node_sets[name];
  int n = 0;
  for (const double v : v_)
    for (const double u : u_) {
      if (such(u, v)) nodes.push_back(n);
      ++n;
    }
}

} // namespace dielast::meshing
