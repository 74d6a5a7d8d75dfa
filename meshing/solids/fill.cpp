// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/fill.hpp"

#include "meshing/mesh_error.hpp"
#include "meshing/middle_nodes.hpp"
#include "meshing/solids/sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#define TETLIBRARY
#include <tetgen.h>

namespace dielast::meshing {

namespace {

constexpr double most_tetrahedra = 3e6; ///< their mesh takes minutes, and no factor of it fits a machine
constexpr double most_of_mean = 2;      ///< the largest volume over the mean one, about

/// Marks every triangle with its number, from 1 on: 0 is none.
void give(const Surface& surface, const std::vector<Eigen::Vector3d>& cavities, tetgenio& in) {
  const auto copied = [](const std::vector<Eigen::Vector3d>& points) {
    auto* list = new REAL[3 * points.size()]; // TetGen deletes what it is given
    for (std::size_t n = 0; n < points.size(); ++n) std::copy_n(points[n].data(), 3, list + 3 * n);
    return list;
  };
  in.numberofpoints = static_cast<int>(surface.points.size());
  in.pointlist = copied(surface.points);
  in.numberoffacets = static_cast<int>(surface.triangles.size());
  in.facetlist = new tetgenio::facet[surface.triangles.size()];
  in.facetmarkerlist = new int[surface.triangles.size()];
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    tetgenio::facet& facet = in.facetlist[t];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(&facet.polygonlist[0]);
    facet.polygonlist[0].numberofvertices = 3;
    facet.polygonlist[0].vertexlist = new int[3];
    std::ranges::copy(surface.triangles[t], facet.polygonlist[0].vertexlist);
    in.facetmarkerlist[t] = static_cast<int>(t) + 1;
  }
  in.numberofholes = static_cast<int>(cavities.size());
  if (!cavities.empty()) in.holelist = copied(cavities);
}

void tetrahedralize(const Surface& surface, const std::vector<Eigen::Vector3d>& cavities,
                    std::string switches, tetgenio& out) {
  tetgenio in;
  give(surface, cavities, in);
  try {
    ::tetrahedralize(switches.data(), &in, &out);
  } catch (int code) {
    throw MeshError(fmt::format("{}: TetGen cannot fill it (its error {})", surface.file, code));
  }
  if (out.numberoftetrahedra == 0) throw MeshError(surface.file + ": TetGen finds no volume in it");
}

/// The surface's triangle that each side in it is a part of, by the side's corners in ascending order.
std::map<std::array<int, 3>, std::size_t> triangles_of(const tetgenio& out) {
  std::map<std::array<int, 3>, std::size_t> triangles;
  for (int t = 0; t < out.numberoftrifaces; ++t) {
    std::array<int, 3> corners{};
    std::copy_n(out.trifacelist + 3 * t, 3, corners.begin());
    std::ranges::sort(corners);
    triangles[corners] = static_cast<std::size_t>(out.trifacemarkerlist[t]) - 1;
  }
  return triangles;
}

/// A point in each of the cavities: where a triangle's outer side looks at. On its inner side each triangle
/// has what is filled.
std::vector<Eigen::Vector3d> cavities(const Surface& surface) {
  tetgenio out;
  tetrahedralize(surface, {}, "pAQ", out);
  const auto triangles = triangles_of(out);
  const auto point = [&](std::size_t n) -> const Eigen::Vector3d& { return surface.points[n]; };
  std::map<double, Eigen::Vector3d> empty; // a point of each such region
  std::set<double> full;
  std::set<std::size_t> filled_behind; // triangles
  for (int t = 0; t < out.numberoftetrahedra; ++t) {
    const int* own = out.tetrahedronlist + 4 * t;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) centre += Eigen::Vector3d(out.pointlist + 3 * own[k]) / 4;
    for (int opposite = 0; opposite < 4; ++opposite) {
      std::array<int, 3> corners{own[(opposite + 1) % 4], own[(opposite + 2) % 4], own[(opposite + 3) % 4]};
      std::ranges::sort(corners);
      const auto side = triangles.find(corners);
      if (side == triangles.end()) continue;
      const auto& [a, b, c] = surface.triangles[side->second];
      const auto n = [](int node) { return static_cast<std::size_t>(node); };
      const Eigen::Vector3d outwards = (point(n(b)) - point(n(a))).cross(point(n(c)) - point(n(a)));
      const double region = out.tetrahedronattributelist[t];
      if (outwards.dot(centre - point(n(a))) > 0) {
        empty[region] = centre;
      } else {
        full.insert(region);
        filled_behind.insert(side->second);
      }
    }
  }
  std::vector<Eigen::Vector3d> points;
  bool closed = filled_behind.size() == surface.triangles.size();
  for (const auto& [region, centre] : empty) {
    points.push_back(centre);
    closed = closed && !full.contains(region);
  }
  if (!closed)
    throw MeshError(
        fmt::format("{}: one of its surfaces is turned the wrong way round: triangles turn counter-clockwise "
                    "seen from outside, those of a cavity seen from within it",
                    surface.file));
  return points;
}

double volume(const Surface& surface) {
  double sixfold = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto x = [&](int n) -> const Eigen::Vector3d& {
      return surface.points[static_cast<std::size_t>(n)];
    };
    sixfold += x(a).dot(x(b).cross(x(c)));
  }
  return sixfold / 6;
}

void add_tetrahedra(const tetgenio& out, Mesh& mesh) {
  for (int n = 0; n < out.numberofpoints; ++n)
    mesh.nodes.emplace_back(out.pointlist[3 * n], out.pointlist[3 * n + 1], out.pointlist[3 * n + 2]);
  mesh.blocks = {{CellType::tetrahedron4, {}}};
  for (int t = 0; t < out.numberoftetrahedra; ++t) {
    std::array<int, 4> own{};
    std::copy_n(out.tetrahedronlist + 4 * t, 4, own.begin());
    const auto x = [&](std::size_t k) -> const Eigen::Vector3d& {
      return mesh.nodes[static_cast<std::size_t>(own[k])];
    };
    if ((x(1) - x(0)).cross(x(2) - x(0)).dot(x(3) - x(0)) < 0) std::swap(own[0], own[1]);
    mesh.blocks[0].nodes.insert(mesh.blocks[0].nodes.end(), own.begin(), own.end());
  }
}

} // namespace

Mesh filled(const Surface& surface, double size) {
  const double estimate = most_of_mean * volume(surface) / (size * size * size / (6 * std::sqrt(2.0)));
  if (estimate > most_tetrahedra)
    throw MeshError(fmt::format(
        "{}: sides of {:.3g} of its units would take about {:.2g} tetrahedra, at most {:.0e} are made; give "
        "mesh.size larger, or the file's unit by mesh.unit",
        surface.file, size, estimate, most_tetrahedra));
  tetgenio out;
  tetrahedralize(surface, cavities(surface),
                 fmt::format("pq1.4a{:.17g}Q", size * size * size / (6 * std::sqrt(2.0))), out);
  Mesh mesh;
  add_tetrahedra(out, mesh);
  const auto triangles = triangles_of(out);
  CellSet film{0, std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()))};
  std::iota(film.cells.begin(), film.cells.end(), 0);
  mesh.cell_sets["film"] = std::move(film);
  add_middle_nodes(mesh);
  add_node_sets(mesh);
  const Eigen::AlignedBox3d box = mesh.bounds();
  const double within = 1e-9 * box.diagonal().norm();
  std::map<std::string, std::set<int>> places;
  for (const OuterSide& side : outer_sides(mesh.blocks[0])) {
    const auto put = [&](const std::string& name) {
      places[name].insert(side.nodes().begin(), side.nodes().end());
    };
    put("surface");
    std::array<int, 3> corners{side.own[0], side.own[1], side.own[2]};
    std::ranges::sort(corners);
    put(fmt::format("face_{}", surface.face[triangles.at(corners)] + 1));
    for (int c = 0; c < 3; ++c)
      for (const auto& [name, end] : {std::pair{"min", box.min()[c]}, {"max", box.max()[c]}})
        if (std::ranges::all_of(side.nodes(), [&, at = end](int node) {
              return std::abs(mesh.nodes[static_cast<std::size_t>(node)][c] - at) <= within;
            }))
          put(fmt::format("{}_{}", "xyz"[c], name));
  }
  for (const auto& [name, nodes] : places) mesh.node_sets[name].assign(nodes.begin(), nodes.end());
  return mesh;
}

} // namespace dielast::meshing
