// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"
#include "meshing/mesh_error.hpp"
#include "tests/fuzz/target.hpp"

#include <algorithm>
#include <dlfcn.h>

namespace dielast::fuzz {

/// Loaded here, the gmsh module need not be loaded by every process that reads.
inline void load_gmsh() {
  static const void* const loaded = dlopen(
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "dielast_gmsh.so").c_str(), RTLD_NOW);
  if (!loaded) fail("the gmsh module is missing");
}

/// `read` gives a mesh whose cells and places are of nodes that it has, or a MeshError.
template<class Read>
void expect_mesh(const Read& read) {
  try {
    const meshing::Mesh mesh = read();
    const auto exists = [&](int node) { return node >= 0 && node < mesh.node_count(); };
    for (const meshing::CellBlock& block : mesh.blocks)
      if (!std::ranges::all_of(block.nodes, exists)) fail("a cell has a node that is not there");
    for (const auto& [name, nodes] : mesh.node_sets)
      if (!std::ranges::all_of(nodes, exists)) fail("a place has a node that is not there");
    for (const auto& [name, set] : mesh.cell_sets) {
      if (set.block < 0 || set.block >= static_cast<int>(mesh.blocks.size())) fail("a place has no block");
      const int size = mesh.blocks[static_cast<std::size_t>(set.block)].size();
      if (!std::ranges::all_of(set.cells, [&](int cell) { return cell >= 0 && cell < size; }))
        fail("a place has a cell that is not there");
    }
  } catch (const meshing::MeshError&) {
  } catch (const std::exception& error) {
    fail(std::string("an error without a place: ") + error.what());
  }
}

} // namespace dielast::fuzz
