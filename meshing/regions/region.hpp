// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <span>
#include <string>
#include <vector>

namespace dielast::meshing {

/// A straight line, or an arc about the origin.
struct Edge {
  Eigen::Vector2d from, to; ///< m
  int turn = 0;             ///< 0: straight; 1: arc counter-clockwise, -1: clockwise

  double length() const;
  /// At a fraction 0..1 of its length.
  Eigen::Vector2d at(double fraction) const;
  /// Where along it, as a fraction of its length, a point is that lies within `tolerance` (m) of it; -1 for
  /// other points.
  double fraction_of(const Eigen::Vector2d& point, double tolerance) const;
};

/// A named part of a film's plane: closed chains of edges around it and its holes.
struct Region {
  std::string name;
  std::vector<std::vector<Edge>> loops;

  /// For points that are not on an edge.
  bool contains(const Eigen::Vector2d& point) const;
};

/// A film between two circles about the origin, m; inner radius 0: a disc.
struct RoundFilm {
  double inner_radius = 0, outer_radius = 0;
};

/// Between two radii (m) and two directions (rad, counter-clockwise from x, less than a full turn apart),
/// both of its straight sides moved inwards by `gap_beside`, its arcs by `gap_along` (m). The shapes below
/// are moved inwards by `gap`. All throw std::invalid_argument, with a reason, where nothing is left.
Region sector(std::string name, const RoundFilm& between, double from, double to, double gap_beside,
              double gap_along);
Region ring(std::string name, const RoundFilm& between, double gap);
/// Corners in any direction; its sides may not cross.
Region polygon(std::string name, std::vector<Eigen::Vector2d> corners, double gap);

struct RegionFault {
  int region; ///< the later one of two
  std::string reason;
};

/// Regions that are not within the film, or that overlap with one before them.
std::vector<RegionFault> faults(const RoundFilm& film, std::span<const Region> regions);

} // namespace dielast::meshing
