// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/contact/wall_contact.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace dielast::fem {

namespace {

using Eigen::Vector3d;

/// Cosine of the angle by which a wall may bend between two of its beams (20 deg).
constexpr double straight = 0.94;

/// Distance of two segments (Ericson, Real-Time Collision Detection, 5.1.9).
double segment_distance(const Vector3d& p1, const Vector3d& q1, const Vector3d& p2, const Vector3d& q2) {
  const Vector3d d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r), c = d1.dot(r), b = d1.dot(d2);
  const double denominator = a * e - b * b;
  double s = denominator > 0 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / a, 0.0, 1.0);
  }
  return (r + d1 * s - d2 * t).norm();
}

} // namespace

WallContactSearch::WallContactSearch(const meshing::Mesh& mesh, const meshing::CellBlock& lines,
                                     std::vector<double> widths)
    : mesh_(mesh), widths_(std::move(widths)), widest_(*std::ranges::max_element(widths_)) {
  std::vector<std::vector<int>> at(mesh.nodes.size()); // lines at each end node
  for (int l = 0; l < lines.size(); ++l) {
    lines_.push_back({{lines.cell(l)[0], lines.cell(l)[1]}, -1});
    for (const int n : lines_.back().node) at[static_cast<std::size_t>(n)].push_back(l);
  }
  // A joint also stands where two beams meet at an angle, as at the lattice's outline.
  const auto is_joint = [&](int node) {
    const auto& meeting = at[static_cast<std::size_t>(node)];
    if (meeting.size() != 2) return true;
    std::array<Vector3d, 2> away;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& ends = lines_[static_cast<std::size_t>(meeting[i])].node;
      const int other = ends[0] == node ? ends[1] : ends[0];
      away[i] = (mesh.nodes[static_cast<std::size_t>(other)] - mesh.nodes[static_cast<std::size_t>(node)])
                    .normalized();
    }
    return away[0].dot(away[1]) > -straight;
  };
  // Walks from an unvisited line in both directions until joints (or, on a closed chain, itself) stop it.
  for (int l = 0; l < lines.size(); ++l) {
    if (lines_[static_cast<std::size_t>(l)].wall >= 0) continue;
    const int wall = static_cast<int>(joints_.size());
    lines_[static_cast<std::size_t>(l)].wall = wall;
    auto& ends = joints_.emplace_back(lines_[static_cast<std::size_t>(l)].node);
    for (int& end : ends)
      for (bool walked = true; walked && !is_joint(end);) {
        walked = false;
        for (const int next : at[static_cast<std::size_t>(end)]) {
          Line& line = lines_[static_cast<std::size_t>(next)];
          if (line.wall >= 0) continue;
          line.wall = wall;
          end = line.node[0] == end ? line.node[1] : line.node[0];
          walked = true;
          break;
        }
      }
  }
}

bool WallContactSearch::share_joint(int wall, int other) const {
  const auto& a = joints_[static_cast<std::size_t>(wall)];
  const auto& b = joints_[static_cast<std::size_t>(other)];
  const auto meet = [&](int one, int another) { // ends of two parts are two nodes, drawn at one place
    constexpr double round_off = 1e-9;          // of the widest wall
    const Eigen::Vector3d apart =
        mesh_.nodes[static_cast<std::size_t>(one)] - mesh_.nodes[static_cast<std::size_t>(another)];
    return one == another || apart.norm() < round_off * widest_;
  };
  return wall == other || meet(a[0], b[0]) || meet(a[0], b[1]) || meet(a[1], b[0]) || meet(a[1], b[1]);
}

std::vector<WallContact> WallContactSearch::find(const State& state) const {
  struct Box {
    int line;
    Vector3d p, q, low, high;
  };
  std::vector<Box> boxes;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const auto position = [&](int n) -> Vector3d {
      return mesh_.nodes[static_cast<std::size_t>(n)] + state.displacement[static_cast<std::size_t>(n)];
    };
    const Vector3d p = position(lines_[l].node[0]), q = position(lines_[l].node[1]);
    boxes.push_back({static_cast<int>(l), p, q, p.cwiseMin(q), p.cwiseMax(q)});
  }
  std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.low.x() < b.low.x(); });

  std::map<std::array<int, 2>, WallContact> nearest; // by pair of walls
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j].low.x() < boxes[i].high.x() + widest_; ++j) {
      const Box &a = boxes[i], &b = boxes[j];
      if ((a.low.array() > b.high.array() + widest_).any() ||
          (b.low.array() > a.high.array() + widest_).any())
        continue;
      const int wall = lines_[static_cast<std::size_t>(a.line)].wall,
                other = lines_[static_cast<std::size_t>(b.line)].wall;
      if (share_joint(wall, other)) continue;
      const double distance = segment_distance(a.p, a.q, b.p, b.q);
      const double touching =
          (widths_[static_cast<std::size_t>(a.line)] + widths_[static_cast<std::size_t>(b.line)]) / 2;
      if (distance >= touching) continue;
      const std::array<int, 2> key{std::min(wall, other), std::max(wall, other)};
      const auto [entry, fresh] = nearest.try_emplace(key, WallContact{{a.line, b.line}, distance});
      if (!fresh && distance < entry->second.distance) entry->second = {{a.line, b.line}, distance};
    }
  std::vector<WallContact> contacts;
  for (const auto& [walls, contact] : nearest) contacts.push_back(contact);
  std::sort(contacts.begin(), contacts.end(),
            [](const WallContact& a, const WallContact& b) { return a.distance < b.distance; });
  return contacts;
}

} // namespace dielast::fem
