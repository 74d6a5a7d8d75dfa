// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/solids/surface.hpp"

#include "meshing/mesh_error.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <sstream>

namespace dielast::meshing {

namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Polygon = std::vector<std::size_t>;
namespace pmp = CGAL::Polygon_mesh_processing;

/// More make volume meshes that no machine solves.
constexpr std::uint64_t most_triangles = 500'000;
constexpr double sharp = 30; ///< degrees

std::string extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Number of triangles that the head of a file tells of, 0 where it tells nothing: known before they are
/// read.
std::uint64_t announced(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (const std::string kind = extension(path); kind == ".stl") {
    std::array<char, 80> head{};
    std::uint32_t count = 0;
    file.read(head.data(), head.size());
    file.read(reinterpret_cast<char*>(&count), sizeof count);
    const bool binary = file && std::filesystem::file_size(path) == 84 + 50 * std::uint64_t{count};
    return binary ? count : 0;
  } else if (kind == ".off") {
    std::string word;
    std::uint64_t points = 0, faces = 0;
    file >> word >> points >> faces;
    return file ? faces : 0;
  }
  std::string line;
  for (int i = 0; i < 100 && std::getline(file, line) && !line.starts_with("end_header"); ++i) {
    std::istringstream words(line);
    std::string element, face;
    std::uint64_t count = 0;
    if (words >> element >> face >> count && element == "element" && face == "face") return count;
  }
  return 0;
}

void require_no_more_than_most(std::uint64_t count) {
  if (count > most_triangles)
    throw MeshError(
        fmt::format("it has {} triangles, at most {} are meshed; coarsen it", count, most_triangles));
}

void require_triangles(const std::vector<Point>& points, const std::vector<Polygon>& polygons) {
  if (polygons.empty()) throw MeshError("it has no triangles");
  require_no_more_than_most(polygons.size());
  for (std::size_t t = 0; t < polygons.size(); ++t) {
    const Polygon& polygon = polygons[t];
    if (polygon.size() != 3)
      throw MeshError(
          fmt::format("face {} has {} corners; split the faces into triangles", t + 1, polygon.size()));
    if (CGAL::collinear(points[polygon[0]], points[polygon[1]], points[polygon[2]]))
      throw MeshError(fmt::format(
          "triangle {} is degenerate: its corners lie on a line; remove it and close the gap", t + 1));
  }
}

SurfaceMesh checked(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw MeshError("there is no such surface file");
  if (!std::filesystem::is_regular_file(path)) throw MeshError("this is not a file");
  require_no_more_than_most(announced(path));
  std::vector<Point> points;
  std::vector<Polygon> polygons;
  if (std::filesystem::file_size(path) == 0) throw MeshError("it is empty");
  if (!CGAL::IO::read_polygon_soup(path.string(), points, polygons))
    throw MeshError("it cannot be read as a surface of triangles; it is damaged, write it again");
  for (const Point& p : points)
    if (!std::isfinite(p.x() + p.y() + p.z())) throw MeshError("it has a coordinate that is not a number");
  pmp::merge_duplicate_points_in_polygon_soup(points, polygons);
  require_triangles(points, polygons);
  if (!pmp::is_polygon_soup_a_polygon_mesh(polygons))
    throw MeshError("an edge belongs to more than two triangles, or neighbours turn against each other; a "
                    "surface that bounds a volume has neither");
  SurfaceMesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  const auto open = std::ranges::count_if(mesh.halfedges(), [&](const auto h) { return mesh.is_border(h); });
  if (open > 0)
    throw MeshError(fmt::format("it is open: {} edges belong to one triangle only; close its holes", open));
  if (pmp::does_self_intersect(mesh)) throw MeshError("it intersects itself; separate what crosses");
  if (!pmp::is_outward_oriented(mesh))
    throw MeshError("it is inside out: its triangles turn clockwise seen from outside; turn them round");
  return mesh;
}

} // namespace

bool is_surface_file(const std::filesystem::path& path) {
  const std::string kind = extension(path);
  return kind == ".stl" || kind == ".ply" || kind == ".off";
}

Surface read_surface(const std::filesystem::path& path) {
  try {
    SurfaceMesh mesh = checked(path);
    auto is_sharp = mesh.add_property_map<SurfaceMesh::Edge_index, bool>("e:sharp", false).first;
    auto face = mesh.add_property_map<SurfaceMesh::Face_index, int>("f:face", 0).first;
    pmp::sharp_edges_segmentation(mesh, sharp, is_sharp, face);
    Surface surface{.file = path.string()};
    for (const auto v : mesh.vertices()) {
      const Point& p = mesh.point(v);
      surface.points.emplace_back(p.x(), p.y(), p.z());
    }
    for (const auto f : mesh.faces()) {
      std::array<int, 3> corners{};
      std::size_t k = 0;
      for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
        corners.at(k++) = static_cast<int>(v.idx());
      surface.triangles.push_back(corners);
      surface.face.push_back(face[f] - 1); // CGAL counts from 1
    }
    return surface;
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

} // namespace dielast::meshing
