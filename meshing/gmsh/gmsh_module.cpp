// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/gmsh_contents.hpp"

#include <gmsh.h>

#include <exception>

namespace dielast::meshing {

namespace {

void collect(const std::string& path, GmshContents& contents) {
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::open(path);
  std::vector<double> parameters;
  gmsh::model::mesh::getNodes(contents.node_tags, contents.coordinates, parameters, -1, -1, false, false);

  gmsh::vectorpair entities, groups;
  gmsh::model::getEntities(entities);
  for (const auto& [dimension, entity] : entities) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, dimension, entity);
    for (std::size_t i = 0; i < types.size(); ++i) {
      GmshContents::Elements block{
          .dimension = dimension, .entity = entity, .type = {}, .nodes = std::move(nodes[i])};
      int type_dimension, order, corners;
      std::vector<double> local;
      gmsh::model::mesh::getElementProperties(types[i], block.type, type_dimension, order, block.nodes_each,
                                              local, corners);
      contents.elements.push_back(std::move(block));
    }
  }

  // Of elements of two orders on one entity gmsh hands out those of the first one's.
  const auto counted = [](const char* of) {
    double number = 0;
    gmsh::option::getNumber(of, number);
    return number;
  };
  for (const auto& [dimension, in_all] :
       {std::pair{2, counted("Mesh.NbTriangles") + counted("Mesh.NbQuadrangles")},
        {3, counted("Mesh.NbTetrahedra")}}) {
    double found = 0;
    for (const GmshContents::Elements& block : contents.elements)
      if (block.dimension == dimension) found += static_cast<double>(block.nodes.size()) / block.nodes_each;
    if (in_all > found)
      contents.error =
          "it mixes elements of order 1 and 2; save the whole mesh with one order (gmsh -order 1 or "
          "-order 2)";
  }

  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dimension, tag] : groups) {
    GmshContents::PhysicalGroup group{.dimension = dimension, .tag = tag, .name = {}, .entities = {}};
    gmsh::model::getPhysicalName(dimension, tag, group.name);
    gmsh::model::getEntitiesForPhysicalGroup(dimension, tag, group.entities);
    contents.groups.push_back(std::move(group));
  }
}

} // namespace

} // namespace dielast::meshing

extern "C" void dielast_read_gmsh_contents(const char* path, dielast::meshing::GmshContents* contents) {
  using dielast::meshing::collect;
  try {
    gmsh::initialize(0, nullptr, false);
    collect(path, *contents);
  } catch (const std::string& message) { // what gmsh throws
    contents->error = "gmsh cannot read this mesh file: " + message;
  } catch (const std::exception& error) {
    contents->error = std::string("gmsh cannot read this mesh file: ") + error.what();
  } catch (...) {
    contents->error = "gmsh cannot read this mesh file";
  }
}
