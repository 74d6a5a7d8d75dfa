// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace dielast::meshing {

/// Triangles that bound volumes, counter-clockwise seen from outside, or from within a cavity; in the file's
/// unit of length. Smooth faces end where two triangles meet at more than 30 degrees; `face` is that of each
/// triangle, from 0 on.
struct Surface {
  std::string file; ///< for messages
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> face;
};

/// Whether a file is one of surfaces, by its extension: .stl, .ply or .off.
bool is_surface_file(const std::filesystem::path& path);

/// Reads a closed surface. Points that coincide are joined. Throws MeshError saying what to change: a file
/// that cannot be read, without triangles or with too many, degenerate triangles, edges of more than two
/// triangles or of one, surfaces that intersect, or the outer one inside out.
Surface read_surface(const std::filesystem::path& path);

} // namespace dielast::meshing
