// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/samples.hpp"
#include "meshing/mesh.hpp"

namespace dielast::post {

/// A point of a 1 mm film whose other numbers do not matter.
inline fem::MembraneSample film_sample(const Eigen::Matrix<double, 3, 2>& F,
                                       const Eigen::Matrix2d& S = Eigen::Matrix2d::Zero()) {
  fem::MembraneSample sample;
  sample.volume = 1;
  sample.F = F;
  sample.S = S;
  sample.thickness = 1e-3;
  sample.breakdown_field = 100e6;
  return sample;
}

inline Eigen::Matrix<double, 3, 2> stretched(double lambda_x, double lambda_y) {
  Eigen::Matrix<double, 3, 2> F;
  F << lambda_x, 0, 0, lambda_y, 0, 0;
  return F;
}

inline fem::BeamSample wall_sample(int cell, double length, double axial_force) {
  return {.cell = cell,
          .length = length,
          .force = {axial_force, 2, 3},
          .moment = {4, 5, 6},
          .strain = {0.1, 0, 0},
          .curvature = {7, 8, 9},
          .fibre_strain = 0.11,
          .yield_strain = 0.55};
}

/// Two 6-node triangles of a unit square (m), one 3-node wall on its diagonal, and one node that nothing
/// uses.
inline meshing::Mesh square_mesh() {
  meshing::Mesh mesh;
  mesh.nodes = {{9, 9, 9},   {0, 0, 0},   {1, 0, 0},     {1, 1, 0},   {0, 1, 0},
                {0.5, 0, 0}, {1, 0.5, 0}, {0.5, 0.5, 0}, {0.5, 1, 0}, {0, 0.5, 0}};
  mesh.blocks = {{meshing::CellType::line3, {1, 3, 7}},
                 {meshing::CellType::triangle6, {1, 2, 3, 5, 6, 7, 1, 3, 4, 7, 8, 9}}};
  return mesh;
}

} // namespace dielast::post
