// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/face_ends.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

namespace dielast::fem {

namespace {

using Eigen::Vector3d;

double distance(const Vector3d& point, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = to - from;
  const double t = std::clamp(along.dot(point - from) / along.squaredNorm(), 0.0, 1.0);
  return (point - from - t * along).norm();
}

} // namespace

FaceEnds::FaceEnds(const meshing::CellBlock& faces, const std::vector<Vector3d>& drawn, double over) {
  std::map<std::pair<int, int>, std::pair<int, int>> edges; // corners: the middle, how many faces have it
  for (int i = 0; i < faces.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const auto cell = faces.cell(i);
      auto& [middle, count] = edges[std::minmax(cell[a], cell[(a + 1) % 3])];
      middle = cell[3 + a];
      ++count;
    }
  const auto at = [&](int node) { return drawn[static_cast<std::size_t>(node)]; };
  std::vector<std::array<Vector3d, 2>> ends;
  for (const auto& [corners, edge] : edges) {
    if (edge.second > 1) continue;
    ends.push_back({at(corners.first), at(edge.first)});
    ends.push_back({at(edge.first), at(corners.second)});
  }
  std::map<int, double> away;
  for (const int node : faces.nodes) {
    const auto [place, fresh] = away.try_emplace(node, std::numeric_limits<double>::max());
    if (!fresh) continue;
    for (const auto& [from, to] : ends) place->second = std::min(place->second, distance(at(node), from, to));
  }
  double farthest = 0;
  for (const auto& [node, least] : away) farthest = std::max(farthest, least);
  over = std::min(over, farthest);
  for (int i = 0; i < faces.size(); ++i) {
    Eigen::Vector<double, 6>& own = faces_.emplace_back();
    for (int a = 0; a < 6; ++a)
      own[a] = ends.empty() ? 1 : away.at(faces.cell(i)[static_cast<std::size_t>(a)]) / over;
  }
}

} // namespace dielast::fem
