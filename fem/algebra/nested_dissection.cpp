// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/nested_dissection.hpp"

#include "fem/algebra/cholmod_session.hpp"

#include <algorithm>
#include <new>
#include <numeric>
#include <span>
#include <tuple>

namespace dielast::fem {

namespace {

/// Times the neighbours of what it covers an equation may have: one that is joined to all (a rigid plate)
/// would cover all, and leave nothing to dissect.
constexpr std::size_t widest_cover = 4;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Neighbours of every vertex, itself among them, ascending.
struct Graph {
  std::vector<int> start{0}, neighbours;

  int size() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> of(int v) const {
    return std::span(neighbours).subspan(at(start[at(v)]), at(start[at(v) + 1] - start[at(v)]));
  }
};

Graph graph_of(const SparseSymmetric& matrix) {
  Graph graph;
  graph.start.resize(at(matrix.size) + 1);
  matrix.for_each_entry([&](std::size_t, int column, int row) {
    ++graph.start[at(column) + 1];
    if (row != column) ++graph.start[at(row) + 1];
  });
  std::partial_sum(graph.start.begin(), graph.start.end(), graph.start.begin());
  graph.neighbours.resize(at(graph.start.back()));
  std::vector<int> next(graph.start.begin(), graph.start.end() - 1);
  // A vertex meets those before it, then itself, then those behind.
  matrix.for_each_entry([&](std::size_t, int column, int row) {
    graph.neighbours[at(next[at(column)]++)] = row;
    if (row != column) graph.neighbours[at(next[at(row)]++)] = column;
  });
  return graph;
}

/// The graph of some vertices, with numbers of their own; -1 in `number` for the others.
Graph part_of(const Graph& graph, const std::vector<int>& number) {
  Graph part;
  for (int v = 0; v < graph.size(); ++v) {
    if (number[at(v)] < 0) continue;
    for (const int u : graph.of(v))
      if (number[at(u)] >= 0) part.neighbours.push_back(number[at(u)]);
    part.start.push_back(static_cast<int>(part.neighbours.size()));
  }
  return part;
}

} // namespace

std::vector<int> metis_positions(const std::vector<int>& start, const std::vector<int>& neighbours) {
  CholmodSession session;
  cholmod_sparse pattern = cholmod_pattern(start, neighbours);
  std::vector<int> order(start.size() - 1), position(order.size());
  if (!cholmod_metis(&pattern, nullptr, 0, 1, order.data(), &session.common)) throw std::bad_alloc();
  for (std::size_t k = 0; k < order.size(); ++k) position[at(order[k])] = static_cast<int>(k);
  return position;
}

std::vector<int> nested_dissection(const SparseSymmetric& matrix) {
  const Graph equations = graph_of(matrix);
  // Those of one neighbourhood are one vertex.
  std::vector<int> vertex(at(matrix.size)), first(at(matrix.size), -1);
  int vertices = 0;
  for (int e = 0; e < matrix.size; ++e) {
    const auto twin = std::ranges::find_if(equations.of(e), [&](int other) {
      return other == e ||
             (first[at(other)] >= 0 && std::ranges::equal(equations.of(other), equations.of(e)));
    });
    vertex[at(e)] = *twin == e ? first[at(e)] = vertices++ : vertex[at(*twin)];
  }
  const Graph graph = part_of(equations, first);

  std::vector<std::pair<int, int>> covers; // who is covered, by whom
  std::vector<int> kept(at(vertices), -1);
  int kept_vertices = 0;
  for (int v = 0; v < vertices; ++v) {
    const std::size_t before = covers.size();
    for (const int other : graph.of(v)) {
      const auto own = graph.of(v), wider = graph.of(other);
      if (wider.size() > own.size() && wider.size() <= widest_cover * own.size() &&
          std::ranges::includes(wider, own))
        covers.emplace_back(v, other);
    }
    if (covers.size() == before) kept[at(v)] = kept_vertices++;
  }

  const Graph of_kept = part_of(graph, kept);
  const std::vector<int> kept_positions = metis_positions(of_kept.start, of_kept.neighbours);
  std::vector<int> position(at(vertices), kept_vertices);
  for (int v = 0; v < vertices; ++v)
    if (kept[at(v)] >= 0) position[at(v)] = kept_positions[at(kept[at(v)])];
  for (const auto& [v, other] : covers)
    if (kept[at(other)] >= 0) position[at(v)] = std::min(position[at(v)], position[at(other)]);

  std::vector<std::tuple<int, std::size_t, int, int>> places;
  for (int e = 0; e < matrix.size; ++e) {
    const int v = vertex[at(e)]; // what is covered has fewer neighbours
    places.emplace_back(position[at(v)], graph.of(v).size(), v, e);
  }
  std::ranges::sort(places);
  std::vector<int> order;
  for (const auto& [place, neighbours, v, e] : places) order.push_back(e);
  return order;
}

} // namespace dielast::fem
