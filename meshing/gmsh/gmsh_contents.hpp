// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace dielast::meshing {

/// What the gmsh library finds in a file: the interface between gmsh_reader and the separately loaded gmsh
/// module.
struct GmshContents {
  struct Elements { ///< of one type on one entity
    int dimension = 0, entity = 0;
    std::string type; ///< gmsh's name, e.g. "Triangle 6"
    int nodes_each = 0;
    std::vector<std::size_t> nodes; ///< node tags
  };
  struct PhysicalGroup {
    int dimension = 0, tag = 0;
    std::string name; ///< may be empty
    std::vector<int> entities;
  };

  std::string error; ///< empty: the file could be read
  std::vector<std::size_t> node_tags;
  std::vector<double> coordinates; ///< x y z of each node
  std::vector<Elements> elements;
  std::vector<PhysicalGroup> groups;
};

/// By dimension.
inline constexpr std::array dimension_names{"point", "line", "surface", "volume"};

/// Calls gmsh in a child process: it costs a tenth of a second to load, keeps global state, and writes
/// outside its memory on some damaged files. It gets a copy of the file, and only of one that begins as a
/// mesh of MSH 4.1 or 2.2; the child process can neither start programs nor write files. `error` says why a
/// file cannot be read.
GmshContents read_gmsh_contents(const std::filesystem::path& path);

/// The only function of the gmsh module, which is loaded in that process; never throws.
using GmshModuleFunction = void(const char* path, GmshContents* contents);
inline constexpr const char* gmsh_module_function = "dielast_read_gmsh_contents";

} // namespace dielast::meshing
