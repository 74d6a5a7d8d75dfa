// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"
#include "post/pictures/image.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace dielast::post {

/// One state of the actuator: seen along z, or from aside and above where it is not flat.
struct Panel {
  std::string title{};
  std::vector<Eigen::Vector3d> positions; ///< of every mesh node in this state, m
  /// One per triangle, blocks one after another; empty: a plain film. Not a number: grey.
  std::vector<double> values;
  std::vector<int>
      regions{}; ///< one per triangle, from 0: values are smoothed within them; empty: one region
};

/// Nodes with a name, shown by dots and the name beside them.
struct Mark {
  std::string name;
  std::vector<int> nodes;
};

/// Panels side by side, with one scale of length and one of colour, so that they can be compared.
struct Picture {
  std::string title{};
  std::string quantity{};                 ///< what the colours mean, e.g. "True electric field"
  std::string unit{};                     ///< of `values`, SI; "1" when it has none
  std::vector<double> wall_widths{};      ///< of the mesh's lines, drawn true to scale, m; empty: lines
  std::vector<std::array<int, 4>> fins{}; ///< flat, the nodes of their corners
  std::vector<Panel> panels{};
  std::vector<Mark> marks{}; ///< in every panel
  int width = 1280;          ///< px, a fifth more than a page shows; the height follows from the shapes

  double widest_wall() const { return wall_widths.empty() ? 0 : std::ranges::max(wall_widths); }
  double narrowest_wall() const { return wall_widths.empty() ? 0 : std::ranges::min(wall_widths); }
};

// None of these needs a display. Each throws std::invalid_argument when a panel does not fit the mesh and for
// a mesh of meridians (post/pictures/profile.hpp draws those), std::runtime_error when it cannot be drawn.

/// The picture's pixels as the bytes of a PNG file: what is tested of the drawings below.
std::string render_png(const meshing::Mesh& mesh, Picture picture);

/// The picture for a page and, with a name, a file beside it, with its values as readings: texts and walls
/// are curves, the film is pixels.
Image draw(const meshing::Mesh& mesh, Picture picture, const std::string& name = "");

/// A picture of each panel alone, of the picture's width, all to one scale of length and one of colour.
Slides draw_slides(const meshing::Mesh& mesh, Picture picture);

} // namespace dielast::post
