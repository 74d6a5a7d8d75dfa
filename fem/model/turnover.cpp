// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/turnover.hpp"

#include <algorithm>

namespace dielast::fem {

namespace {

/// Of the product of sides or areas as drawn: what a sliver between walls that cross may lose.
constexpr double sliver = 1e-3;

} // namespace

std::vector<ElementCorners> element_corners(const meshing::Mesh& mesh) {
  using Shape = ElementCorners::Shape;
  std::vector<ElementCorners> all;
  for (const meshing::CellBlock& block : mesh.blocks) {
    const Shape shape = meshing::is_tetrahedron(block.type) ? Shape::tetrahedron
                        : meshing::is_triangle(block.type)  ? Shape::triangle
                        : meshing::is_meridian(block.type)  ? Shape::meridian
                                                            : Shape::line;
    const auto corners = static_cast<std::size_t>(meshing::corners_per_cell(block.type));
    for (int c = 0; c < block.size(); ++c) {
      ElementCorners element{shape, {}};
      std::ranges::copy(block.cell(c).first(corners), element.node.begin());
      all.push_back(element);
    }
  }
  return all;
}

bool is_turned_over(const std::vector<ElementCorners>& elements, const std::vector<Eigen::Vector3d>& drawn,
                    const State& from, const State& to) {
  const auto place = [&](const State& state, int node) -> Eigen::Vector3d {
    const auto n = static_cast<std::size_t>(node);
    return drawn[n] + state.displacement[n];
  };
  return std::any_of(elements.begin(), elements.end(), [&](const ElementCorners& corners) {
    const auto& node = corners.node;
    /// Two sides or areas as drawn, before and after.
    const auto turns = [](const Eigen::Vector3d& whole, const Eigen::Vector3d& before,
                          const Eigen::Vector3d& after) {
      return before.dot(after) < -sliver * whole.squaredNorm();
    };
    const auto side = [&](const State& state, std::size_t a, std::size_t b) -> Eigen::Vector3d {
      return place(state, node[b]) - place(state, node[a]);
    };
    const auto drawn_side = [&](std::size_t a, std::size_t b) -> Eigen::Vector3d {
      return drawn[static_cast<std::size_t>(node[b])] - drawn[static_cast<std::size_t>(node[a])];
    };
    const auto side_turns = [&](std::size_t a, std::size_t b) {
      return turns(drawn_side(a, b), side(from, a, b), side(to, a, b));
    };
    if (side_turns(0, 1)) return true;
    switch (corners.shape) {
    case ElementCorners::Shape::line:
      return false;
    case ElementCorners::Shape::meridian: // beyond the axis it would go round the other way
      return std::min(place(to, node[0]).x(), place(to, node[1]).x()) < 0;
    case ElementCorners::Shape::triangle:
    case ElementCorners::Shape::tetrahedron:
      break;
    }
    if (corners.shape == ElementCorners::Shape::tetrahedron)
      return side_turns(1, 2) || side_turns(0, 2) || side_turns(0, 3) || side_turns(1, 3) || side_turns(2, 3);
    const auto area = [&](const State& state) -> Eigen::Vector3d {
      return side(state, 0, 1).cross(side(state, 0, 2));
    };
    return side_turns(1, 2) || side_turns(0, 2) ||
           turns(drawn_side(0, 1).cross(drawn_side(0, 2)), area(from), area(to));
  });
}

} // namespace dielast::fem
