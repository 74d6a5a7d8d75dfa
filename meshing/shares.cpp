// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/shares.hpp"

#include "meshing/middle_nodes.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>

namespace dielast::meshing {

namespace {

using Index = Eigen::Index;

bool has_middles(CellType type) { return nodes_per_cell(type) > corners_per_cell(type); }

/// The type of lines, triangles or tetrahedra with these numbers of nodes.
CellType simplex(int corners, bool middles) {
  if (corners == 2) return middles ? CellType::line3 : CellType::line2;
  if (corners == 3) return middles ? CellType::triangle6 : CellType::triangle3;
  return middles ? CellType::tetrahedron10 : CellType::tetrahedron4;
}

/// What bounds the cells of a block, each piece once: faces of tetrahedra, sides of triangles, and edges.
struct Bounds {
  CellBlock pieces;
  std::vector<char> outer; ///< it belongs to one cell only
};

Bounds bounds_of(const CellBlock& cells, int corners) {
  struct Keyed {
    std::array<int, 3> key;
    std::vector<int> nodes;
  };
  std::vector<Keyed> all;
  const auto own_corners = static_cast<std::size_t>(corners_per_cell(cells.type));
  const bool middles = has_middles(cells.type);
  for (int c = 0; c < cells.size(); ++c) {
    const auto cell = cells.cell(c);
    for (unsigned chosen = 0; chosen < 1U << own_corners; ++chosen) {
      std::vector<std::size_t> own;
      for (std::size_t k = 0; k < own_corners; ++k)
        if ((chosen >> k & 1U) != 0) own.push_back(k);
      if (std::ssize(own) != corners) continue;
      Keyed piece{{-1, -1, -1}, {}};
      for (std::size_t k = 0; k < own.size(); ++k) {
        piece.nodes.push_back(cell[own[k]]);
        piece.key.at(k) = piece.nodes.back();
      }
      std::ranges::sort(piece.key);
      for (std::size_t k = 0; middles && k < (corners == 2 ? 1U : 3U); ++k) {
        const auto [a, b] = std::minmax(own[side_ends[k][0]], own[side_ends[k][1]]);
        const auto side = std::ranges::find_if(side_ends, [a = a, b = b](const auto& e) {
          return std::min(e[0], e[1]) == a && std::max(e[0], e[1]) == b;
        });
        piece.nodes.push_back(cell[own_corners + static_cast<std::size_t>(side - side_ends.begin())]);
      }
      all.push_back(std::move(piece));
    }
  }
  std::ranges::stable_sort(all, {}, &Keyed::key);
  Bounds bounds{{simplex(corners, middles), {}}, {}};
  for (std::size_t i = 0; i < all.size();) {
    std::size_t next = i + 1;
    while (next < all.size() && all[next].key == all[i].key) ++next;
    bounds.pieces.nodes.insert(bounds.pieces.nodes.end(), all[i].nodes.begin(), all[i].nodes.end());
    bounds.outer.push_back(next == i + 1);
    i = next;
  }
  return bounds;
}

/// A point of a cell: shape functions, their derivatives by the coordinates of corners 1, 2, .., and the
/// point's weight.
struct Point {
  Eigen::VectorXd shape;
  Eigen::MatrixXd slope;
  double weight;
};

/// Three Gauss points along each coordinate of a line, square or cube that is collapsed to the cell: exact to
/// the degree 3 in tetrahedra, 4 in triangles.
std::vector<Point> points_in(CellType type) {
  const double off = std::sqrt(0.6) / 2;
  const std::array<double, 3> at{0.5 - off, 0.5, 0.5 + off}, weight{5.0 / 18, 8.0 / 18, 5.0 / 18};
  const int corners = corners_per_cell(type), dimension = corners - 1;
  std::vector<Point> points;
  for (int number = 0; number < std::lround(std::pow(3, dimension)); ++number) {
    Eigen::VectorXd bary(corners);
    double left = 1, w = 1;
    for (int d = 0, rest = number; d < dimension; ++d, rest /= 3) {
      const auto k = static_cast<std::size_t>(rest % 3);
      w *= weight[k] * left;
      bary[d + 1] = left * at[k];
      left -= bary[d + 1];
    }
    bary[0] = left;
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(corners, dimension);
    change.row(0).setConstant(-1);
    change.bottomRows(dimension).setIdentity();
    Point point{bary, change, w};
    if (has_middles(type)) {
      const int nodes = nodes_per_cell(type);
      point.shape.resize(nodes);
      point.slope.resize(nodes, dimension);
      for (int a = 0; a < corners; ++a) {
        point.shape[a] = bary[a] * (2 * bary[a] - 1);
        point.slope.row(a) = (4 * bary[a] - 1) * change.row(a);
      }
      for (int m = corners; m < nodes; ++m) {
        const auto [a, b] = side_ends[static_cast<std::size_t>(m - corners)];
        point.shape[m] = 4 * bary[a] * bary[b];
        point.slope.row(m) = 4 * (bary[a] * change.row(b) + bary[b] * change.row(a));
      }
    }
    points.push_back(std::move(point));
  }
  return points;
}

using Corners = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 10>;
using Tangent = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// Cells of a block that make a place.
struct Cells {
  const CellBlock* block;
  std::vector<int> numbers;
};

/// Length, area or volume per that of the coordinates.
double measure(const Tangent& t) {
  if (t.cols() == 1) return t.col(0).norm();
  const Eigen::Vector3d a = t.col(0), normal = a.cross(Eigen::Vector3d(t.col(1)));
  return t.cols() == 2 ? normal.norm() : std::abs(normal.dot(t.col(2)));
}

/// use(nodes, point, size) for all points of the cells; `turned`: sizes times the radius.
template<class Use>
void for_each_point(const Mesh& mesh, const Cells& cells, bool turned, const Use& use) {
  const std::vector<Point> points = points_in(cells.block->type);
  for (const int number : cells.numbers) {
    const auto nodes = cells.block->cell(number);
    Corners x(3, std::ssize(nodes));
    for (Index a = 0; a < x.cols(); ++a)
      x.col(a) = mesh.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])];
    for (const Point& point : points) {
      double size = point.weight * measure(x.lazyProduct(point.slope));
      if (turned) size *= x.row(0).dot(point.shape);
      use(nodes, point, size);
    }
  }
}

/// Integrals of the shape functions per node of the mesh; `turned`: times the radius.
Eigen::VectorXd integrals(const Mesh& mesh, const Cells& cells, bool turned) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mesh.node_count());
  for_each_point(mesh, cells, turned, [&](std::span<const int> nodes, const Point& point, double size) {
    for (std::size_t a = 0; a < nodes.size(); ++a) sum[nodes[a]] += size * point.shape[static_cast<Index>(a)];
  });
  return sum;
}

class Sharing {
 public:
  Sharing(const Mesh& mesh, bool of_revolution)
      : mesh_(mesh), of_revolution_(of_revolution), radius_(mesh.bounds().max().x()) {}

  Shares in(const std::string& place, const std::vector<int>& nodes) {
    const auto count = static_cast<double>(nodes.size());
    const Shares even{.of_nodes = std::vector<double>(nodes.size(), 1 / count)};
    if (nodes.size() < 2) return even;
    const std::optional<Cells> cells = cells_of(place, nodes);
    if (!cells) return even;
    if (marks_of(*cells) != marks(nodes)) return {.of_nodes = even.of_nodes, .mixed = true};
    Eigen::VectorXd share = integrals(mesh_, *cells, is_turned(*cells));
    Shares found{.size = share.sum()};
    share /= found.size;
    const double largest = share.cwiseAbs().maxCoeff();
    for (const int node : nodes) // zero without round-off, which is no mass
      found.of_nodes.push_back(std::abs(share[node]) < round_off * largest ? 0 : share[node]);
    return found;
  }

  std::vector<CommonShare> common_in(const std::string& place, const std::vector<int>& nodes) {
    const std::optional<Cells> cells = nodes.size() < 2 ? std::nullopt : cells_of(place, nodes);
    if (!cells || marks_of(*cells) != marks(nodes)) return {};
    std::map<std::array<int, 2>, double> products;
    double all = 0;
    for_each_point(mesh_, *cells, is_turned(*cells),
                   [&](std::span<const int> own, const Point& point, double size) {
                     all += size;
                     for (std::size_t a = 0; a < own.size(); ++a)
                       for (std::size_t b = 0; b < a; ++b)
                         products[{std::min(own[a], own[b]), std::max(own[a], own[b])}] +=
                             size * point.shape[static_cast<Index>(a)] * point.shape[static_cast<Index>(b)];
                   });
    std::vector<CommonShare> found;
    for (const auto& [pair, product] : products) found.push_back({pair, product / all});
    return found;
  }

 private:
  static constexpr double on_axis = 1e-12, round_off = 1e-12;

  /// Whether the cells are those of the full turn; what lies on the axis is a line.
  bool is_turned(const Cells& cells) const {
    return of_revolution_ &&
           integrals(mesh_, cells, true).sum() > on_axis * integrals(mesh_, cells, false).sum() * radius_;
  }

  std::vector<char> marks(std::span<const int> nodes) const {
    std::vector<char> marked(mesh_.nodes.size());
    for (const int node : nodes) marked[static_cast<std::size_t>(node)] = 1;
    return marked;
  }
  std::vector<char> marks_of(const Cells& cells) const {
    std::vector<char> marked(mesh_.nodes.size());
    for (const int cell : cells.numbers)
      for (const int node : cells.block->cell(cell)) marked[static_cast<std::size_t>(node)] = 1;
    return marked;
  }

  /// What bounds the film and has so many corners; edges of tetrahedra are many, and few places need them.
  const Bounds& bounds(int corners) {
    const auto [found, fresh] = bounds_.try_emplace(corners);
    if (fresh) found->second = bounds_of(*mesh_.film(), corners);
    return found->second;
  }

  std::optional<Cells> cells_of(const std::string& place, const std::vector<int>& nodes) {
    if (const auto set = mesh_.cell_sets.find(place); set != mesh_.cell_sets.end())
      return Cells{&mesh_.blocks[static_cast<std::size_t>(set->second.block)], set->second.cells};
    if (const auto film = mesh_.cell_sets.find(place + ".film"); film != mesh_.cell_sets.end()) // a part
      return Cells{&mesh_.blocks[static_cast<std::size_t>(film->second.block)], film->second.cells};
    const std::vector<char> there = marks(nodes);
    const auto all_marked = [](const std::vector<char>& marked, std::span<const int> own) {
      return std::ranges::all_of(own, [&](int node) { return marked[static_cast<std::size_t>(node)] != 0; });
    };
    const CellBlock* film = mesh_.film();
    if (!film || !(is_triangle(film->type) || is_tetrahedron(film->type))) return std::nullopt;
    for (int corners = corners_per_cell(film->type) - 1; corners > 1; --corners) {
      const auto& [pieces, outer] = bounds(corners);
      Cells found{&pieces, {}};
      for (int p = 0; p < pieces.size(); ++p)
        if (outer[static_cast<std::size_t>(p)] != 0 && all_marked(there, pieces.cell(p)))
          found.numbers.push_back(p);
      // A side from one part of the outline to another is none of it: inner ones are where no outer one is.
      const std::vector<char> covered = marks_of(found);
      for (int p = 0; p < pieces.size(); ++p)
        if (outer[static_cast<std::size_t>(p)] == 0 && all_marked(there, pieces.cell(p)) &&
            !all_marked(covered, pieces.cell(p)))
          found.numbers.push_back(p);
      if (is_triangle(film->type)) leave_out_chords(found, outer);
      if (!found.numbers.empty()) return found;
    }
    return std::nullopt;
  }

  /// Where a line within film turns by two sides of one element the third has both ends on it, too: the one
  /// that would end where most others do, or the longest.
  void leave_out_chords(Cells& sides, const std::vector<char>& outer) const {
    const auto pair = [](int a, int b) { return std::array{std::min(a, b), std::max(a, b)}; };
    std::map<std::array<int, 2>, int> inner;
    std::map<int, int> ends;
    for (const int p : sides.numbers) {
      const auto own = sides.block->cell(p);
      for (const int node : own.first(2)) ++ends[node];
      if (outer[static_cast<std::size_t>(p)] == 0 && own.size() == 2) inner[pair(own[0], own[1])] = p;
    }
    const CellBlock& film = *mesh_.film();
    std::set<int> chords, seen;
    for (int cell = 0; cell < film.size() && inner.size() > 2; ++cell) {
      const auto own = film.cell(cell);
      std::array<std::array<int, 2>, 3> of{pair(own[0], own[1]), pair(own[1], own[2]), pair(own[2], own[0])};
      if (!std::ranges::all_of(of, [&](const auto& side) { return inner.contains(side); })) continue;
      const auto length = [&](const std::array<int, 2>& side) {
        return (mesh_.nodes[static_cast<std::size_t>(side[0])] -
                mesh_.nodes[static_cast<std::size_t>(side[1])])
            .norm();
      };
      const auto chord = std::ranges::max_element(of, {}, [&](const auto& side) {
        return std::pair(ends.at(side[0]) + ends.at(side[1]), length(side));
      });
      chords.insert(inner.at(*chord));
      for (const auto& side : of)
        if (!seen.insert(inner.at(side)).second) return; // elements side by side: an area, not a line
    }
    std::erase_if(sides.numbers, [&](int p) { return chords.contains(p); });
  }

  const Mesh& mesh_;
  bool of_revolution_;
  double radius_;                ///< the largest, m
  std::map<int, Bounds> bounds_; ///< of the film, by their corners
};

} // namespace

std::map<std::string, Shares> shares(const Mesh& mesh, bool of_revolution) {
  Sharing sharing(mesh, of_revolution);
  std::map<std::string, Shares> all;
  for (const auto& [place, nodes] : mesh.node_sets) all[place] = sharing.in(place, nodes);
  return all;
}

std::vector<CommonShare> common_shares(const Mesh& mesh, bool of_revolution, const std::string& place) {
  return Sharing(mesh, of_revolution).common_in(place, mesh.node_sets.at(place));
}

} // namespace dielast::meshing
