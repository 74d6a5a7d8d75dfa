// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/analyses/radial_stretch.hpp"

#include "fem/films/meridian.hpp"
#include "fem/films/triangle.hpp"

#include <Eigen/QR>

#include <algorithm>

namespace dielast::cases {
namespace {

/// (1, xi, eta) at the integration points of a cell, one per row, and at its nodes; of meridians (1, xi).
struct Basis {
  Eigen::MatrixXd points, nodes;
};

Basis basis(const meshing::CellBlock& film, int points) {
  Basis basis;
  if (meshing::is_meridian(film.type)) {
    const auto rule = fem::meridian_rule(points);
    basis.points.resize(points, points > 1 ? 2 : 1);
    for (int p = 0; p < points; ++p) {
      basis.points(p, 0) = 1;
      if (points > 1) basis.points(p, 1) = rule[static_cast<std::size_t>(p)].xi;
    }
    basis.nodes = (Eigen::MatrixXd(3, 2) << 1, -1, 1, 1, 1, 0).finished().leftCols(basis.points.cols());
    return basis;
  }
  const auto rule = fem::triangle_rule(points);
  basis.points.resize(points, points > 1 ? 3 : 1);
  for (int p = 0; p < points; ++p) {
    const fem::TrianglePoint& at = rule[static_cast<std::size_t>(p)];
    basis.points.row(p) = Eigen::RowVector3d(1, at.xi, at.eta).head(basis.points.cols());
  }
  basis.nodes = (Eigen::MatrixXd(6, 3) << 1, 0, 0, 1, 1, 0, 1, 0, 1, 1, 0.5, 0, 1, 0.5, 0.5, 1, 0, 0.5)
                    .finished()
                    .leftCols(basis.points.cols());
  return basis;
}

} // namespace

double radial_stretch(const meshing::Mesh& mesh, const fem::Samples& samples, const std::string& place) {
  const meshing::CellBlock& film = *mesh.film();
  const int points = static_cast<int>(samples.film.size()) / film.size();
  const Basis at = basis(film, points);
  const Eigen::MatrixXd to_nodes =
      at.nodes * at.points.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(points, points));
  const auto& nodes = mesh.node_sets.at(place);
  double sum = 0;
  int count = 0;
  Eigen::VectorXd values(points);
  for (int cell = 0; cell < film.size(); ++cell) {
    const auto corners = film.cell(cell);
    for (std::size_t a = 0; a < corners.size(); ++a) {
      if (!std::binary_search(nodes.begin(), nodes.end(), corners[a])) continue;
      const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(corners[a])];
      const Eigen::Vector2d radius = x.head<2>().normalized();
      for (int p = 0; p < points; ++p)
        values[p] = (samples.film[static_cast<std::size_t>(cell * points + p)].F * radius).norm();
      sum += to_nodes.row(static_cast<int>(a)).dot(values);
      ++count;
    }
  }
  return sum / count;
}

} // namespace dielast::cases
