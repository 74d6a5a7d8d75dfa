// SPDX-License-Identifier: GPL-3.0-or-later
// How large parts of the film are.
#include "cases/quantities/positions.hpp"
#include "cases/quantities/probing.hpp"
#include "fem/films/meridian.hpp"
#include "fem/films/triangle.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <numbers>

namespace dielast::cases {
namespace {

using meshing::CellType;

/// Adds an element's area, m^2, at these positions of its nodes and its derivative by them, m.
template<int Nodes>
double triangle_area(const Eigen::Matrix<double, 3, Nodes>& x, Eigen::Matrix<double, 3, Nodes>& slope) {
  double area = 0;
  for (const fem::TrianglePoint& point : fem::triangle_rule(Nodes == 3 ? 1 : 6)) {
    const auto gradients = fem::shape_gradients<Nodes>(point.xi, point.eta);
    const Eigen::Matrix<double, 3, 2> t = x * gradients;
    const Eigen::Vector3d normal = t.col(0).cross(t.col(1));
    const Eigen::Vector3d unit = normal.normalized();
    area += point.weight * normal.norm();
    slope += point.weight * (t.col(1).cross(unit) * gradients.col(0).transpose() +
                             unit.cross(t.col(0)) * gradients.col(1).transpose());
  }
  return area;
}

/// Likewise, of the full turn.
template<int Nodes>
double turned_area(const Eigen::Matrix<double, 3, Nodes>& x, Eigen::Matrix<double, 3, Nodes>& slope) {
  double area = 0;
  for (const fem::MeridianPoint& point : fem::meridian_rule(3)) {
    const auto shape = fem::meridian_shape<Nodes>(point.xi), by = fem::meridian_slope<Nodes>(point.xi);
    const Eigen::Vector3d along = x * by;
    const double radius = x.row(0).dot(shape), turn = 2 * std::numbers::pi * point.weight;
    area += turn * radius * along.norm();
    slope += turn * radius * along.normalized() * by.transpose();
    slope.row(0) += turn * along.norm() * shape.transpose();
  }
  return area;
}

template<int Nodes, class Element>
double sum_over(const meshing::CellBlock& film, const std::vector<int>& cells, const meshing::Mesh& mesh,
                const fem::State& state, Element element, const auto& add_slope) {
  double area = 0;
  for (const int cell : cells) {
    const auto nodes = film.cell(cell);
    Eigen::Matrix<double, 3, Nodes> x, slope = Eigen::Matrix<double, 3, Nodes>::Zero();
    for (int a = 0; a < Nodes; ++a) x.col(a) = position(mesh, nodes[static_cast<std::size_t>(a)], state);
    area += element(x, slope);
    for (int a = 0; a < Nodes; ++a) add_slope(nodes[static_cast<std::size_t>(a)], slope.col(a));
  }
  return area;
}

/// The area of cells of the film, whose derivative by the place of each node goes to `add_slope`.
double area_of(const std::vector<int>& cells, const meshing::Mesh& mesh, const fem::State& state,
               const auto& add_slope) {
  const meshing::CellBlock& film = *mesh.film();
  switch (film.type) {
  case CellType::triangle3:
    return sum_over<3>(film, cells, mesh, state, triangle_area<3>, add_slope);
  case CellType::triangle6:
    return sum_over<6>(film, cells, mesh, state, triangle_area<6>, add_slope);
  case CellType::meridian2:
    return sum_over<2>(film, cells, mesh, state, turned_area<2>, add_slope);
  case CellType::meridian3:
    return sum_over<3>(film, cells, mesh, state, turned_area<3>, add_slope);
  default:
    return no_value;
  }
}

const std::vector<int>& cells_of(const Probing& probing) {
  const meshing::Mesh& mesh = probing.device.mesh;
  const std::vector<int>* cells = mesh.cells_of(probing.quantity.of, mesh.film());
  if (!cells || cells->empty())
    probing.refuse("of",
                   fmt::format("found \"{}\": only a part of the film has an area", probing.quantity.of));
  if (!meshing::is_triangle(mesh.film()->type) && !meshing::is_meridian(mesh.film()->type))
    probing.refuse(
        "of", fmt::format("found \"{}\": a film that is rolled to a bar shows no area", probing.quantity.of));
  return *cells;
}

Shape area(const Probing& probing) {
  return [&mesh = probing.device.mesh, cells = cells_of(probing)](const fem::State& state) {
    return area_of(cells, mesh, state, [](int, const auto&) {});
  };
}

Eigen::VectorXd area_gradient(const Probing& probing, const fem::State& state) {
  const fem::DofMap& dofs = probing.device.model.dofs;
  Eigen::VectorXd row = Eigen::VectorXd::Zero(dofs.count());
  area_of(cells_of(probing), probing.device.mesh, state, [&](int node, const auto& slope) {
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(node, c); e != fem::DofMap::absent) row[e] += slope[c];
  });
  return row;
}

Key part_key() { return of_key("the part of the film, such as an electrode").refers_to(Reference::place); }

} // namespace

std::vector<QuantityKind> area_kinds() {
  return {
      {.word = "area",
       .meaning = "of a part of the film as it lies, folds and wrinkles left out (m^2)",
       .unit = "m^2",
       .keys = [] { return std::vector<Key>{part_key()}; },
       .in_words = [](const Quantity& q) { return fmt::format("area of {}{}", q.of, at_words(q)); },
       .shape = area,
       .gradient = area_gradient,
       .of_solids = false},
      {.word = "areal strain",
       .meaning = "relative change of the area of a part of the film (-)",
       .unit = "1",
       .keys =
           [] {
             return std::vector<Key>{part_key(), since_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("areal strain of {}, since {}{}", q.of, since_words(q), at_words(q));
           },
       .shape = area,
       .since = change,
       .relative = true,
       .of_solids = false},
  };
}

} // namespace dielast::cases
