// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/part.hpp"
#include "meshing/patch.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace dielast::cases {

namespace {

/// Nodes of both places, ascending.
std::vector<int> nodes_of_both(const std::vector<int>& one, const std::vector<int>& other) {
  std::vector<int> both;
  std::ranges::set_intersection(one, other, std::back_inserter(both));
  return both;
}

std::vector<int> nodes_of_either(const std::vector<int>& one, const std::vector<int>& other) {
  std::vector<int> either;
  std::ranges::set_union(one, other, std::back_inserter(either));
  return either;
}

/// The nodes nearest to the origin.
std::vector<int> middle_of(const meshing::Mesh& mesh) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& x : mesh.nodes) nearest = std::min(nearest, x.norm());
  std::vector<int> nodes;
  for (int n = 0; n < mesh.node_count(); ++n)
    if (mesh.nodes[static_cast<std::size_t>(n)].norm() <= nearest * (1 + 1e-9)) nodes.push_back(n);
  return nodes;
}

} // namespace

/// That of a strip, about the origin; it has sides instead of ends.
meshing::Mesh mesh_of(const Rectangle& r, const Drawing& drawing) {
  const MeshOptions& options = drawing.part.mesh;
  const double electrode_length = r.electrode_length.value_or(r.length),
               electrode_width = r.electrode_width.value_or(r.width);
  // A strip's elements are counted along x, those of a rectangle along y: it is drawn lying on its side.
  meshing::Mesh mesh = meshing::strip_mesh({r.length, r.width, electrode_length, electrode_width},
                                           options.across, options.order);
  for (Eigen::Vector3d& x : mesh.nodes) x = {-(x.y() + r.length / 2), x.x(), 0};
  auto& places = mesh.node_sets;
  const auto call = [&places](const char* strips, const char* place) {
    auto set = places.extract(strips);
    set.key() = place;
    places.insert(std::move(set));
  };
  call("left", "bottom"), call("right", "top");
  call("upper_end", "left"), call("lower_end", "right");
  places["frame"] = nodes_of_either(nodes_of_either(places.at("left"), places.at("right")),
                                    nodes_of_either(places.at("bottom"), places.at("top")));
  places["electrode_edge"] = mesh.cell_sets.contains("passive")
                                 ? nodes_of_both(places.at("electrode"), places.at("passive"))
                                 : places.at("frame");
  places["centre"] = middle_of(mesh);
  return mesh;
}

} // namespace dielast::cases
