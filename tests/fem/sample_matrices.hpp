// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/algebra/sparse_matrix.hpp"

#include <Eigen/Core>

#include <random>

namespace dielast::fem::test {

/// Springs between the neighbours of a square grid of `side` nodes a side, each held by a weak one: entries
/// of 1 + noise.
inline SparseSymmetric grid(int side, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> stiffness(0.5, 1.5);
  SparseSymmetric matrix{.size = side * side, .column_start = {0}, .rows = {}, .values = {}};
  std::vector<double> diagonal(static_cast<std::size_t>(matrix.size), 1e-3);
  for (int node = 0; node < matrix.size; ++node) {
    matrix.rows.push_back(node);
    matrix.values.push_back(0);
    for (const int neighbour : {node + 1, node + side}) {
      if (neighbour >= matrix.size || (neighbour == node + 1 && neighbour % side == 0)) continue;
      const double spring = stiffness(random);
      matrix.rows.push_back(neighbour);
      matrix.values.push_back(-spring);
      diagonal[static_cast<std::size_t>(node)] += spring;
      diagonal[static_cast<std::size_t>(neighbour)] += spring;
    }
    matrix.column_start.push_back(static_cast<int>(matrix.rows.size()));
  }
  for (int node = 0; node < matrix.size; ++node)
    matrix.values[static_cast<std::size_t>(matrix.column_start[static_cast<std::size_t>(node)])] =
        diagonal[static_cast<std::size_t>(node)];
  return matrix;
}

inline Eigen::VectorXd times(const SparseSymmetric& matrix, const Eigen::VectorXd& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(matrix.size);
  for (int c = 0; c < matrix.size; ++c)
    for (int k = matrix.column_start[static_cast<std::size_t>(c)];
         k < matrix.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int r = matrix.rows[static_cast<std::size_t>(k)];
      y[r] += matrix.values[static_cast<std::size_t>(k)] * x[c];
      if (r != c) y[c] += matrix.values[static_cast<std::size_t>(k)] * x[r];
    }
  return y;
}

} // namespace dielast::fem::test
