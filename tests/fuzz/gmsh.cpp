// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a mesh file: refused with a message, or a mesh whose cells have nodes.
#include "meshing/gmsh/gmsh_reader.hpp"
#include "tests/fuzz/mesh_property.hpp"

using namespace dielast;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path file = fuzz::scratch() / "mesh.msh";
  fuzz::load_gmsh();
  fuzz::write(file, fuzz::text_of(data, size));
  fuzz::expect_mesh([] { return meshing::read_gmsh(file); });
  return 0;
}
