// Any bytes as a mesh file: refused with a message, or a mesh whose cells have nodes.
#include "meshing/gmsh_reader.hpp"
#include "meshing/mesh_error.hpp"
#include "tests/fuzz/target.hpp"

#include <algorithm>
#include <dlfcn.h>

using namespace dielast;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path file = fuzz::scratch() / "mesh.msh";
  // Loaded here, it need not be loaded by every process that reads.
  static const void* const loaded = dlopen(
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "dielast_gmsh.so").c_str(), RTLD_NOW);
  if (!loaded) fuzz::fail("the gmsh module is missing");
  fuzz::write(file, fuzz::text_of(data, size));
  try {
    const meshing::Mesh mesh = meshing::read_gmsh(file);
    const auto exists = [&](int node) { return node >= 0 && node < mesh.node_count(); };
    for (const meshing::CellBlock& block : mesh.blocks)
      if (!std::ranges::all_of(block.nodes, exists)) fuzz::fail("a cell has a node that is not there");
    for (const auto& [name, nodes] : mesh.node_sets)
      if (!std::ranges::all_of(nodes, exists)) fuzz::fail("a place has a node that is not there");
  } catch (const meshing::MeshError&) {
  } catch (const std::exception& error) {
    fuzz::fail(std::string("an error without a place: ") + error.what());
  }
  return 0;
}
