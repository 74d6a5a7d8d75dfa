// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/regions/region_mesh.hpp"

#include "meshing/mesh_error.hpp"
#include "meshing/middle_nodes.hpp"
#include "meshing/planar.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace dielast::meshing {

namespace {

using Eigen::Vector2d;
using Side = std::array<int, 2>;

/// Size of triangles by the distance from the middle, m.
struct Size {
  RoundFilm film;
  double innermost, outermost;

  Size(const RoundFilm& f, int rings, double grading) : film(f) {
    const double width = f.outer_radius - f.inner_radius;
    const double mean = grading > 1 + 1e-6 ? std::log(grading) / (grading - 1) : 1; // of 1 / size
    innermost = width / rings * mean;
    outermost = grading * innermost;
  }
  double operator()(const Vector2d& p) const {
    const double t = (p.norm() - film.inner_radius) / (film.outer_radius - film.inner_radius);
    return std::lerp(innermost, outermost, std::clamp(t, 0.0, 1.0));
  }
};

/// Edges of film and regions, each once, split where others end, in sides of the size wanted.
class Outlines {
 public:
  Outlines(const RoundFilm& film, std::span<const Region> regions, const Size& size)
      : tolerance_(1e-7 * film.outer_radius), size_(size) {
    for (const auto& loop : ring("", film, 0).loops)
      for (const Edge& edge : loop) add(edge, true);
    for (const Region& region : regions)
      for (const auto& loop : region.loops)
        for (const Edge& edge : loop) add(edge, false);
    split_at_ends();
    for (const Piece& piece : pieces_) divide(piece);
    keep_distances();
    if (film.inner_radius == 0) centre_ = point({0, 0});
  }

  /// The node in the middle of a disc.
  int centre() const { return centre_; }

  PlanarGraph graph() const {
    PlanarGraph graph{points_, {}};
    for (const Divided& side : sides_)
      (pieces_[static_cast<std::size_t>(side.piece)].of_film ? graph.outline : graph.inner)
          .push_back(side.ends);
    return graph;
  }

  /// Angle of the widest side of an arc, rad.
  double widest_side() const {
    double widest = 0;
    for (const Divided& side : sides_)
      if (const Edge& edge = pieces_[static_cast<std::size_t>(side.piece)].edge; edge.turn != 0)
        widest = std::max(widest, (side.to - side.from) * edge.length() / edge.from.norm());
    return widest;
  }

  /// Radii of the arcs that sides lie on.
  std::map<std::pair<int, int>, double> radii() const {
    std::map<std::pair<int, int>, double> radii;
    for (const Divided& side : sides_)
      if (const Edge& edge = pieces_[static_cast<std::size_t>(side.piece)].edge; edge.turn != 0)
        radii[std::minmax(side.ends[0], side.ends[1])] = edge.from.norm();
    return radii;
  }

 private:
  struct Piece {
    Edge edge;
    bool of_film;
  };
  struct Divided {
    Side ends;
    int piece;
    double from, to; ///< fractions of the piece
  };

  int point(const Vector2d& p) {
    for (std::size_t i = 0; i < points_.size(); ++i)
      if ((points_[i] - p).norm() <= tolerance_) return static_cast<int>(i);
    points_.push_back(p);
    return static_cast<int>(points_.size()) - 1;
  }

  void add(const Edge& edge, bool of_film) {
    point(edge.from);
    pieces_.push_back({edge, of_film});
  }

  /// Two edges that lie on one another become one.
  void split_at_ends() {
    std::vector<Piece> split;
    for (const Piece& piece : pieces_) {
      std::vector<std::pair<double, int>> stops;
      for (std::size_t i = 0; i < points_.size(); ++i)
        if (const double t = piece.edge.fraction_of(points_[i], tolerance_); t >= 0)
          stops.emplace_back(t, static_cast<int>(i));
      std::ranges::sort(stops);
      for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
        const Edge part{points_[static_cast<std::size_t>(stops[k].second)],
                        points_[static_cast<std::size_t>(stops[k + 1].second)], piece.edge.turn};
        const auto twin = std::ranges::find_if(split, [&](const Piece& other) {
          return (other.edge.at(0.5) - part.at(0.5)).norm() <= tolerance_ &&
                 std::abs(other.edge.length() - part.length()) <= 2 * tolerance_;
        });
        if (twin == split.end())
          split.push_back({part, piece.of_film});
        else
          twin->of_film = twin->of_film || piece.of_film;
      }
    }
    pieces_ = std::move(split);
  }

  /// Sides as long as the sizes where they are.
  void divide(const Piece& piece) {
    constexpr int samples = 64;
    constexpr double widest = 0.55; // rad, of an arc's chord
    const double length = piece.edge.length();
    std::vector<double> count{0};
    for (int k = 0; k < samples; ++k)
      count.push_back(count.back() + length / samples / size_(piece.edge.at((k + 0.5) / samples)));
    const double of_arc = piece.edge.turn == 0 ? 1 : length / piece.edge.from.norm() / widest;
    const int sides = std::max(1, static_cast<int>(std::ceil(std::max(count.back() - 1e-6, of_arc - 1e-6))));
    double last = 0;
    int from = point(piece.edge.from);
    for (int s = 1; s <= sides; ++s) {
      const double wanted = count.back() * s / sides;
      const auto above = std::ranges::lower_bound(count, wanted) - count.begin();
      const auto k = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above, 1, samples));
      const double t =
          s == sides ? 1
                     : (static_cast<double>(k) - (count[k] - wanted) / (count[k] - count[k - 1])) / samples;
      const int to = point(s == sides ? piece.edge.to : piece.edge.at(t));
      sides_.push_back({{from, to}, static_cast<int>(&piece - pieces_.data()), last, t});
      from = to;
      last = t;
    }
  }

  /// Halves sides that are long for their distance from points of others.
  void keep_distances() {
    constexpr int most = 8;
    for (int pass = 0; pass < most; ++pass) {
      std::vector<std::vector<int>> neighbours(points_.size());
      for (const Divided& side : sides_)
        for (const int k : {0, 1})
          neighbours[static_cast<std::size_t>(side.ends[static_cast<std::size_t>(k)])].push_back(
              side.ends[static_cast<std::size_t>(1 - k)]);
      const std::vector<Divided> sides = std::move(sides_);
      const std::size_t before = points_.size();
      sides_.clear();
      for (const Divided& side : sides) {
        if (!is_crowded(side, neighbours)) {
          sides_.push_back(side);
          continue;
        }
        const double middle = (side.from + side.to) / 2;
        const int p = point(pieces_[static_cast<std::size_t>(side.piece)].edge.at(middle));
        sides_.push_back({{side.ends[0], p}, side.piece, side.from, middle});
        sides_.push_back({{p, side.ends[1]}, side.piece, middle, side.to});
      }
      if (points_.size() == before) return;
    }
  }

  bool is_crowded(const Divided& side, const std::vector<std::vector<int>>& neighbours) const {
    const auto at = [this](int p) -> const Vector2d& { return points_[static_cast<std::size_t>(p)]; };
    const Vector2d middle = (at(side.ends[0]) + at(side.ends[1])) / 2;
    const double reach = 0.55 * (at(side.ends[1]) - at(side.ends[0])).norm();
    for (int p = 0; p < static_cast<int>(neighbours.size()); ++p) {
      if (p == side.ends[0] || p == side.ends[1] || (at(p) - middle).norm() >= reach) continue;
      const auto& near = neighbours[static_cast<std::size_t>(p)];
      if (std::ranges::none_of(side.ends, [&](int end) { return std::ranges::count(near, end) > 0; }))
        return true;
    }
    return false;
  }

  double tolerance_;
  const Size& size_;
  std::vector<Vector2d> points_;
  std::vector<Piece> pieces_;
  std::vector<Divided> sides_;
  int centre_ = -1;
};

/// The middle of the largest triangle of each piece.
std::vector<Vector2d> middles(const Triangulation& cut) {
  std::vector<Vector2d> middles;
  std::vector<double> largest;
  for (std::size_t t = 0; t < cut.triangles.size(); ++t) {
    const auto piece = static_cast<std::size_t>(cut.pieces[t]);
    if (piece >= middles.size()) middles.resize(piece + 1), largest.resize(piece + 1, 0);
    const auto& [a, b, c] = cut.triangles[t];
    const Vector2d &p = cut.points[static_cast<std::size_t>(a)], &q = cut.points[static_cast<std::size_t>(b)],
                   &r = cut.points[static_cast<std::size_t>(c)];
    const double area = (q - p).x() * (r - p).y() - (q - p).y() * (r - p).x();
    if (area > largest[piece]) largest[piece] = area, middles[piece] = (p + q + r) / 3;
  }
  return middles;
}

/// Names the triangles of the regions.
void name_regions(Mesh& mesh, const Triangulation& cut, std::span<const Region> regions) {
  std::vector<int> all(cut.triangles.size());
  std::iota(all.begin(), all.end(), 0);
  mesh.cell_sets["film"] = {0, std::move(all)};
  std::map<int, const Region*> owner;
  const std::vector<Vector2d> inside = middles(cut);
  for (const Region& region : regions) {
    CellSet& place = mesh.cell_sets[region.name];
    if (!place.cells.empty())
      throw MeshError(fmt::format("there is a place \"{}\" already; call the region otherwise", region.name),
                      region.name);
    std::vector<char> own(inside.size());
    for (std::size_t p = 0; p < inside.size(); ++p) {
      own[p] = region.contains(inside[p]);
      if (!own[p]) continue;
      if (const auto [other, fresh] = owner.try_emplace(static_cast<int>(p), &region); !fresh)
        throw MeshError(fmt::format("regions \"{}\" and \"{}\" overlap", other->second->name, region.name),
                        region.name);
    }
    for (std::size_t t = 0; t < cut.pieces.size(); ++t)
      if (own[static_cast<std::size_t>(cut.pieces[t])]) place.cells.push_back(static_cast<int>(t));
    if (place.cells.empty())
      throw MeshError(fmt::format("the region \"{}\" has no film", region.name), region.name);
  }
}

/// Puts the middle nodes of sides along arcs onto them.
void bend(Mesh& mesh, const std::map<std::pair<int, int>, double>& radii) {
  const CellBlock& triangles = mesh.blocks[0];
  for (int c = 0; c < triangles.size(); ++c) {
    const auto nodes = triangles.cell(c);
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto arc = radii.find(std::minmax(nodes[k], nodes[(k + 1) % 3])); arc != radii.end()) {
        auto& middle = mesh.nodes[static_cast<std::size_t>(nodes[3 + k])];
        middle *= arc->second / middle.norm();
      }
  }
}

} // namespace

int fewest_sides(const RoundFilm& film, std::span<const Region> regions, int rings, double grading) {
  const Size size(film, rings, grading);
  return static_cast<int>(std::lround(2 * std::numbers::pi / Outlines(film, regions, size).widest_side()));
}

Mesh region_mesh(const RoundFilm& film, std::span<const Region> regions, int rings, double grading,
                 int order) {
  if (order != 1 && order != 2)
    throw std::invalid_argument(fmt::format("the order of a mesh is 1 or 2, not {}", order));
  if (rings < 1) throw std::invalid_argument(fmt::format("at least 1 ring is needed, not {}", rings));
  if (!(grading >= 1) || !std::isfinite(grading))
    throw std::invalid_argument(fmt::format("the grading of a mesh is at least 1, not {:.6g}", grading));
  if (!(film.inner_radius >= 0 && film.outer_radius > film.inner_radius) || !std::isfinite(film.outer_radius))
    throw std::invalid_argument("the radii of a film must be ascending");
  const Size size(film, rings, grading);
  const Outlines outlines(film, regions, size);
  const Triangulation cut = triangulate(outlines.graph(), size);

  Mesh mesh;
  for (const Vector2d& p : cut.points) mesh.nodes.emplace_back(p.x(), p.y(), 0);
  mesh.blocks = {{CellType::triangle3, {}}};
  for (const auto& triangle : cut.triangles)
    mesh.blocks[0].nodes.insert(mesh.blocks[0].nodes.end(), triangle.begin(), triangle.end());
  name_regions(mesh, cut, regions);
  if (order == 2) {
    add_middle_nodes(mesh);
    bend(mesh, outlines.radii());
  }
  add_node_sets(mesh);
  const auto name_circle = [&](const char* place, double radius) {
    std::vector<int>& nodes = mesh.node_sets[place];
    if (!nodes.empty())
      throw MeshError(fmt::format("there is a place \"{}\" already; call the region otherwise", place),
                      place);
    for (int n = 0; n < mesh.node_count(); ++n)
      if (std::abs(mesh.nodes[static_cast<std::size_t>(n)].norm() - radius) <= 2e-7 * film.outer_radius)
        nodes.push_back(n);
  };
  if (film.inner_radius > 0) {
    name_circle("inner", film.inner_radius);
    name_circle("outer", film.outer_radius);
  } else {
    name_circle("rim", film.outer_radius);
    name_circle("centre", 0);
  }
  return mesh;
}

} // namespace dielast::meshing
