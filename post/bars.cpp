// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/bars.hpp"

namespace dielast::post {

Bars::Bars(const meshing::Mesh& mesh, const meshing::CellBlock& lines, std::span<const double> widths,
           std::span<const double> heights) {
  for (int line = 0; line < lines.size(); ++line) {
    const auto nodes = lines.cell(line);
    std::vector<int> course{nodes[0], nodes[1]};
    if (nodes.size() > 2) course.insert(course.begin() + 1, nodes[2]);
    const auto at = [&](std::size_t i) -> const Eigen::Vector3d& {
      return mesh.nodes[static_cast<std::size_t>(course[i])];
    };
    const double width = widths[static_cast<std::size_t>(line)],
                 height = heights[static_cast<std::size_t>(line)];
    for (std::size_t i = 0; i < course.size(); ++i) {
      // A line's three nodes may lie on a curve: its section is across the chords beside the node.
      const Eigen::Vector3d along = at(std::min(i + 1, course.size() - 1)) - at(i == 0 ? 0 : i - 1);
      Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(along);
      if (across.norm() <= 1e-9 * along.norm()) across = Eigen::Vector3d::UnitX(); // a cable along z
      across.normalize();
      const Eigen::Vector3d up = along.cross(across).normalized();
      const Eigen::Vector3d wide = width / 2 * across, high = height / 2 * up;
      for (const Eigen::Vector3d& arm : {Eigen::Vector3d(-wide - high), Eigen::Vector3d(wide - high),
                                         Eigen::Vector3d(wide + high), Eigen::Vector3d(-wide + high)})
        points.push_back({course[i], arm});
    }
    const int end = static_cast<int>(points.size());
    for (int first = end - 4 * static_cast<int>(course.size()); first + 4 < end; first += 4)
      hexahedra.push_back(
          {{first, first + 1, first + 2, first + 3, first + 4, first + 5, first + 6, first + 7}, line});
  }
}

} // namespace dielast::post
