// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/mesh_warnings.hpp"

#include "cases/case/quantity_kind.hpp"
#include "meshing/quality.hpp"
#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

namespace dielast::cases {

std::vector<std::string> mesh_warnings(const Case& one, const meshing::Mesh& mesh) {
  constexpr double largest = 1; // m, of the templates' dimensions
  std::vector<std::string> warnings;
  if (one.dimension == fem::Dimension::spatial && one.any_geometry<HollowSphere>())
    warnings.push_back("hollow_sphere: in space its eighth at x, y, z >= 0 is computed; volumes, charges, "
                       "capacitances, energies and masses are those of the eighth");
  if (!one.geometry<MeshFile>()) return warnings;
  if (const int cut = one.parts.size() == 1 ? meshing::nodes_on_others(mesh) : 0)
    warnings.push_back(fmt::format(
        "the film is cut: {} of its nodes lie on others; let gmsh fragment the drawing to join its parts",
        cut));
  const Eigen::Vector3d size = mesh.bounds().sizes();
  const bool has_unit = one.unnamed()->mesh.unit.has_value();
  if (!has_unit || size.maxCoeff() > largest)
    warnings.push_back(fmt::format("mesh.unit{}: the film is {} x {}",
                                   has_unit ? "" : " is missing, one unit of the mesh file is taken for 1 m",
                                   post::engineering(size.x(), "m"), post::engineering(size.y(), "m")));
  return warnings;
}

std::vector<std::string> thickness_warnings(const Case& one, const meshing::Mesh& mesh,
                                            std::span<const int> parts) {
  constexpr double thin = 5; // times its thickness a film is wide at least
  const meshing::CellBlock& cells = *mesh.film();
  const bool meridian = meshing::is_meridian(cells.type);
  if (!meridian && !meshing::is_triangle(cells.type)) return {};
  std::vector<Eigen::AlignedBox3d> bounds(one.parts.size());
  for (int c = 0; c < cells.size(); ++c)
    for (const int node : cells.cell(c))
      bounds[static_cast<std::size_t>(parts[static_cast<std::size_t>(c)])].extend(
          mesh.nodes[static_cast<std::size_t>(node)]);
  std::vector<std::string> warnings;
  for (std::size_t p = 0; p < one.parts.size(); ++p) {
    const std::optional<Film>& film = one.parts[p].film;
    if (!film || film->is_solid() || bounds[p].isEmpty() ||
        std::holds_alternative<Patch>(one.parts[p].geometry))
      continue;
    Eigen::Vector3d size = bounds[p].sizes();
    std::ranges::sort(size, std::greater<>());
    const auto drawn = [](const auto& layer) {
      return layer.thickness / (layer.prestretch[0] * layer.prestretch[1]);
    };
    const double width = meridian ? size[0] : size[1];
    double thickness = drawn(*film);
    for (const Layer& layer : film->further_layers) thickness += drawn(layer);
    if (width < thin * thickness)
      warnings.push_back(
          fmt::format("{}film.thickness: the film is {} thick and {} wide; membranes and shells are "
                      "of thin films, section = \"solid\" of thick ones",
                      one.parts[p].name.empty() ? "" : "part." + one.parts[p].name + ".",
                      post::engineering(thickness, "m"), post::engineering(width, "m")));
  }
  return warnings;
}

std::vector<std::string> share_warnings(const Case& one,
                                        const std::map<std::string, meshing::Shares>& shares) {
  std::set<std::string> places;
  for (const Load& load : one.loads) places.insert(load.place);
  for (const PointMass& mass : one.point_masses) places.insert(mass.place);
  for (const Spring& spring : one.springs) places.insert(spring.between.begin(), spring.between.end());
  for (const Linkage& linkage : one.linkages) places.insert(linkage.between.begin(), linkage.between.end());
  for (const Quantity& quantity : one.quantities) {
    places.insert(quantity.between.begin(), quantity.between.end());
    const std::string& word = quantity.kind->word;
    if (word == "displacement" || word == "radius" || word == "stiffness") places.insert(quantity.of);
    if (word == "coupling") places.insert(quantity.place);
  }
  std::vector<std::string> warnings;
  for (const std::string& place : places)
    if (const auto found = shares.find(place); found != shares.end() && found->second.mixed)
      warnings.push_back(
          fmt::format("\"{}\" has nodes beside the cells, faces or sides that make it: each of its {} nodes "
                      "has the same share in loads and means; name its parts apart",
                      place, found->second.of_nodes.size()));
  return warnings;
}

} // namespace dielast::cases
