// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/nested_dissection.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace dielast::fem::nested_dissection_test {
namespace {

/// Squares of two 6-node triangles, `side` a side, two unknowns a node; `hub`: an equation that all join.
SparseSymmetric triangles(int side, bool hub) {
  const int nodes_a_side = 2 * side + 1, hubs = hub ? 1 : 0;
  std::vector<std::set<int>> below(static_cast<std::size_t>(2 * nodes_a_side * nodes_a_side + hubs));
  const auto join = [&](std::initializer_list<int> nodes) {
    for (const int a : nodes)
      for (const int b : nodes)
        for (const int i : {2 * a, 2 * a + 1})
          for (const int k : {2 * b, 2 * b + 1})
            if (k >= i) below[static_cast<std::size_t>(i)].insert(k);
  };
  for (int y = 0; y < 2 * side; y += 2)
    for (int x = 0; x < 2 * side; x += 2) {
      const int n = y * nodes_a_side + x, up = nodes_a_side;
      join({n, n + 1, n + 2, n + up + 1, n + up + 2, n + 2 * up + 2});
      join({n, n + up, n + 2 * up, n + up + 1, n + 2 * up + 1, n + 2 * up + 2});
    }
  if (hub)
    for (std::set<int>& column : below) column.insert(static_cast<int>(below.size()) - 1);
  SparseSymmetric matrix{
      .size = static_cast<int>(below.size()), .column_start = {0}, .rows = {}, .values = {}};
  for (const std::set<int>& column : below) {
    matrix.rows.insert(matrix.rows.end(), column.begin(), column.end());
    matrix.column_start.push_back(static_cast<int>(matrix.rows.size()));
  }
  return matrix;
}

/// Products that the columns of L take: a column has the matrix's entries, and those of the columns whose
/// first entry below is in it.
double work_of_factor(const SparseSymmetric& matrix, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
  std::vector<std::set<int>> columns(order.size());
  matrix.for_each_entry([&](std::size_t, int c, int r) {
    const auto [first, last] =
        std::minmax(place[static_cast<std::size_t>(c)], place[static_cast<std::size_t>(r)]);
    columns[static_cast<std::size_t>(first)].insert(last);
  });
  double work = 0;
  for (std::set<int>& column : columns) {
    work += static_cast<double>(column.size() * column.size());
    column.erase(column.begin());
    if (!column.empty())
      columns[static_cast<std::size_t>(*column.begin())].insert(column.begin(), column.end());
    column.clear();
  }
  return work;
}

std::vector<int> minimum_degree(const SparseSymmetric& matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  matrix.for_each_entry([&](std::size_t, int c, int r) {
    entries.emplace_back(r, c, 1);
    if (r != c) entries.emplace_back(c, r, 1);
  });
  Eigen::SparseMatrix<double> A(matrix.size, matrix.size);
  A.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(A, order);
  return {order.indices().begin(), order.indices().end()};
}

// Minimum degree is at its best on a regular grid.
TEST(NestedDissection, keeps_up_with_minimum_degree_on_a_regular_grid) {
  const SparseSymmetric matrix = triangles(80, false);
  const std::vector<int> order = nested_dissection(matrix);
  std::vector<int> sorted = order, all(static_cast<std::size_t>(matrix.size));
  std::ranges::sort(sorted);
  std::iota(all.begin(), all.end(), 0);
  ASSERT_EQ(sorted, all);
  EXPECT_LT(work_of_factor(matrix, order), 1.05 * work_of_factor(matrix, minimum_degree(matrix)));
}

TEST(NestedDissection, is_not_led_astray_by_an_equation_that_all_join) {
  const SparseSymmetric without = triangles(20, false), with = triangles(20, true);
  EXPECT_LT(work_of_factor(with, nested_dissection(with)),
            1.5 * work_of_factor(without, nested_dissection(without)));
}

TEST(NestedDissection, takes_what_has_nothing_to_dissect) {
  EXPECT_EQ(nested_dissection({.size = 1, .column_start = {0, 1}, .rows = {0}, .values = {}}),
            std::vector<int>{0});
  EXPECT_EQ(
      nested_dissection({.size = 3, .column_start = {0, 1, 2, 3}, .rows = {0, 1, 2}, .values = {}}).size(),
      3U);
}

} // namespace
} // namespace dielast::fem::nested_dissection_test
