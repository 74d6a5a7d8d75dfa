// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/profile.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <stdexcept>

namespace dielast::post {

namespace {

/// Nodes along the meridian, middle ones in their places; -1 where it is interrupted.
std::vector<int> course(const meshing::CellBlock& meridians) {
  std::vector<int> nodes;
  for (int c = 0; c < meridians.size(); ++c) {
    const auto cell = meridians.cell(c);
    if (nodes.empty() || nodes.back() != cell[0]) {
      if (!nodes.empty()) nodes.push_back(-1);
      nodes.push_back(cell[0]);
    }
    for (const int middle : cell.subspan(2)) nodes.push_back(middle);
    nodes.push_back(cell[1]);
  }
  return nodes;
}

constexpr double flattest_to_scale = 0.2; // height over width, or width over height
constexpr double flattest = 0.1;          // to be drawn as anything but a line: over the larger of both

} // namespace

Plot profile_plot(const meshing::Mesh& mesh, const std::string& title, const std::vector<Panel>& states) {
  const meshing::CellBlock* film = mesh.film();
  if (film == nullptr || !meshing::is_meridian(film->type))
    throw std::invalid_argument("only a film of revolution has a profile");
  const std::vector<int> nodes = course(*film);
  Plot plot{.title = title, .x_label = "r (mm)", .y_label = "z (mm)"};
  Eigen::AlignedBox2d box;
  for (const Panel& state : states) {
    if (state.positions.size() != mesh.nodes.size())
      throw std::invalid_argument("a profile needs a position per node");
    Series curve{.label = state.title};
    for (const int node : nodes) {
      Eigen::Vector2d at(NAN, NAN);
      if (node >= 0) {
        const Eigen::Vector3d& position = state.positions[static_cast<std::size_t>(node)];
        at = 1e3 * Eigen::Vector2d(position.x(), position.z());
        box.extend(at);
      }
      curve.x.push_back(at.x());
      curve.y.push_back(at.y());
    }
    plot.series.push_back(std::move(curve));
  }
  if (box.isEmpty()) return plot;
  const double least = box.sizes().minCoeff(), most = box.sizes().maxCoeff();
  plot.equal_axes = least > flattest_to_scale * most;
  constexpr double rounding = 1e-6; // of the size: what lies flat is drawn so
  if (least < rounding * most) plot.least_extent = flattest * most;
  return plot;
}

} // namespace dielast::post
