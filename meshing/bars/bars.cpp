// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/bars/bars.hpp"

#include "meshing/middle_nodes.hpp"
#include "meshing/parts/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace dielast::meshing {

namespace {

Mesh row(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int elements, CellType type,
         const char* place) {
  if (elements < 1 || from == to)
    throw std::invalid_argument("a line needs elements, and must end elsewhere than it starts");
  Mesh mesh;
  mesh.blocks = {{type, {}}};
  for (int n = 0; n <= elements; ++n) {
    const double part = static_cast<double>(n) / elements;
    mesh.nodes.emplace_back((1 - part) * from + part * to);
    if (n == 0) continue;
    mesh.blocks[0].nodes.insert(mesh.blocks[0].nodes.end(), {n - 1, n});
    mesh.cell_sets[place].cells.push_back(n - 1);
  }
  mesh.node_sets["start"] = {0};
  mesh.node_sets["end"] = {elements};
  return mesh;
}

} // namespace

Mesh line_mesh(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int elements, int order) {
  Mesh mesh = row(from, to, elements, CellType::line2, "line");
  if (order == 2) add_middle_nodes(mesh);
  add_node_sets(mesh);
  return mesh;
}

Mesh rod_mesh(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Mesh mesh = row(from, to, 1, CellType::rod2, "film");
  add_node_sets(mesh);
  return mesh;
}

Mesh rolls_mesh(const RollsShape& shape, int elements, int order) {
  if (!(shape.arm < shape.ribbon_length))
    throw std::invalid_argument("the arm must be shorter than the ribbon, which leads from it to the roll");
  const double reach = std::sqrt(shape.ribbon_length * shape.ribbon_length - shape.arm * shape.arm);
  const double inner = shape.hinge_thickness / 2 + shape.arm, outer = inner + shape.arm;
  const double tip = -shape.hinge_length, joint = tip + reach;
  Mesh mesh;
  append(mesh, line_mesh({0, 0, 0}, {tip, 0, 0}, elements, order), "hinge");
  for (const auto& [side, y] : {std::pair{"upper", 1.0}, std::pair{"lower", -1.0}}) {
    const std::string roll = side, ribbon = roll + "_ribbon";
    append(mesh, rod_mesh({joint + shape.roll_length, y * outer, 0}, {joint, y * outer, 0}), roll);
    append(mesh, line_mesh({tip, y * inner, 0}, {joint, y * outer, 0}, elements, order), ribbon);
    join(mesh, roll + ".end", ribbon + ".end");
    mesh.cell_sets[roll] = mesh.cell_sets.at(roll + ".film");
    mesh.cell_sets[ribbon] = mesh.cell_sets.at(ribbon + ".line");
  }
  mesh.cell_sets["hinge"] = mesh.cell_sets.at("hinge.line");
  mesh.cell_sets["film"] = {mesh.cell_sets.at("upper").block, {0, 1}};
  const auto unite = [&mesh](const std::string& place, std::initializer_list<const char*> parts) {
    std::vector<int>& nodes = mesh.node_sets[place];
    for (const char* part : parts) {
      const std::vector<int>& own = mesh.node_sets.at(part);
      nodes.insert(nodes.end(), own.begin(), own.end());
    }
    std::ranges::sort(nodes);
  };
  unite("film", {"upper", "lower"});
  unite("base", {"hinge.start"});
  unite("tip_ends", {"hinge.end", "upper_ribbon.start", "lower_ribbon.start"});
  unite("joints", {"upper.end", "lower.end"});
  unite("roots", {"upper.start", "lower.start"});
  return mesh;
}

} // namespace dielast::meshing
