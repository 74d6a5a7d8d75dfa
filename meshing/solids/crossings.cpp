// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/crossings.hpp"

#include "meshing/solids/sides.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>

namespace dielast::meshing {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Corners = std::array<Eigen::Vector3d, 3>;

Kernel::Triangle_3 triangle(const Corners& x) {
  const auto point = [](const Eigen::Vector3d& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
  return {point(x[0]), point(x[1]), point(x[2])};
}

bool meet(const Corners& one, const Corners& other) {
  const Kernel::Triangle_3 a = triangle(one), b = triangle(other);
  return !a.is_degenerate() && !b.is_degenerate() && CGAL::do_intersect(a, b);
}

/// The axis along which all points have one coordinate; -1: there is none.
int normal_of(std::span<const Eigen::Vector3d> points) {
  for (int axis = 2; axis >= 0; --axis)
    if (std::ranges::all_of(points, [&](const auto& x) { return x[axis] == points.front()[axis]; }))
      return axis;
  return -1;
}

} // namespace

FilmSurface::FilmSurface(const Mesh& mesh, std::span<const int> parts,
                         std::span<const std::string> kept_apart)
    : drawn_(mesh.nodes), kept_apart_(mesh.nodes.size(), 0), parts_(parts.begin(), parts.end()) {
  for (const std::string& place : kept_apart)
    if (const auto found = mesh.node_sets.find(place); found != mesh.node_sets.end())
      for (const int node : found->second) kept_apart_[static_cast<std::size_t>(node)] = 1;
  const CellBlock* film = mesh.film();
  if (!film || film->type == CellType::rod2) return;
  for (int cell = 0; cell < film->size(); ++cell) {
    const auto part = static_cast<std::size_t>(parts_[static_cast<std::size_t>(cell)]);
    if (boxes_.size() <= part) boxes_.resize(part + 1);
    for (const int node : film->cell(cell)) boxes_[part].extend(drawn_[static_cast<std::size_t>(node)]);
    if (is_triangle(film->type)) add_triangle(cell, film->cell(cell));
    if (is_meridian(film->type)) add_line(cell, film->cell(cell));
  }
  if (is_meridian(film->type)) return;
  for (const OuterSide& side : outer_sides(*film))
    is_triangle(film->type) ? add_line(side.cell, side.nodes()) : add_triangle(side.cell, side.nodes());
}

void FilmSurface::add_line(int cell, std::span<const int> nodes) {
  if (nodes.size() == 2)
    lines_.push_back({cell, {nodes[0], nodes[1], -1}});
  else
    for (const int end : nodes.first(2)) lines_.push_back({cell, {end, nodes[2], -1}});
}

void FilmSurface::add_triangle(int cell, std::span<const int> nodes) {
  const auto n = [&](std::size_t k) { return nodes[k]; };
  if (nodes.size() == 3)
    triangles_.push_back({cell, {n(0), n(1), n(2)}});
  else
    for (const std::array<int, 3>& part : {std::array{n(0), n(3), n(5)}, std::array{n(3), n(1), n(4)},
                                           std::array{n(5), n(4), n(2)}, std::array{n(3), n(4), n(5)}})
      triangles_.push_back({cell, part});
}

bool FilmSurface::may_cross(const Piece& one, const Piece& other) const {
  const auto is_kept = [this](int node) { return node >= 0 && kept_apart_[static_cast<std::size_t>(node)]; };
  for (const int node : one.nodes)
    if (node >= 0 && std::ranges::count(other.nodes, node) > 0) return false;
  // What ends at such a surface lies beside its curved sides, not beside the straight ones between nodes.
  const auto ends_there = [&](const Piece& piece) { return std::ranges::any_of(piece.nodes, is_kept); };
  if (ends_there(one) && ends_there(other)) return false;
  const int a = parts_[static_cast<std::size_t>(one.cell)], b = parts_[static_cast<std::size_t>(other.cell)];
  const Eigen::AlignedBox3d &of_one = boxes_[static_cast<std::size_t>(a)],
                            &of_other = boxes_[static_cast<std::size_t>(b)];
  return a == b || of_one.exteriorDistance(of_other) > 1e-6 * of_one.diagonal().norm();
}

std::optional<FilmSurface::Crossing> FilmSurface::crossing(std::span<const Eigen::Vector3d> x) const {
  if (x.empty()) return std::nullopt;
  const int normal = normal_of(x);
  const bool in_plane = !lines_.empty() && normal >= 0 && normal == normal_of(drawn_);
  const std::vector<Piece>& pieces = in_plane ? lines_ : triangles_;
  /// A line in a plane stands for the triangle on it, which narrows across the plane: it meets where the line
  /// does.
  const auto corners = [&](const Piece& piece, std::span<const Eigen::Vector3d> at) {
    Corners found;
    for (std::size_t k = 0; k < 3; ++k)
      if (piece.nodes[k] >= 0) found[k] = at[static_cast<std::size_t>(piece.nodes[k])];
    if (in_plane)
      found[2] = (found[0] + found[1]) / 2 + (found[1] - found[0]).norm() * Eigen::Vector3d::Unit(normal);
    return found;
  };
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
  std::vector<Box> boxes;
  boxes.reserve(pieces.size());
  for (std::size_t p = 0; p < pieces.size(); ++p)
    boxes.emplace_back(triangle(corners(pieces[p], x)).bbox(), p);
  std::optional<std::array<std::size_t, 2>> first;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    const std::array<std::size_t, 2> pair{std::min(a.info(), b.info()), std::max(a.info(), b.info())};
    const Piece &one = pieces[pair[0]], &other = pieces[pair[1]];
    if ((first && *first < pair) || !may_cross(one, other)) return;
    if (meet(corners(one, x), corners(other, x)) && !meet(corners(one, drawn_), corners(other, drawn_)))
      first = pair;
  });
  if (!first) return std::nullopt;
  const Piece &one = pieces[(*first)[0]], &other = pieces[(*first)[1]];
  return Crossing{{one.cell, other.cell}, x[static_cast<std::size_t>(one.nodes[0])]};
}

} // namespace dielast::meshing
