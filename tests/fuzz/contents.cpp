// SPDX-License-Identifier: GPL-3.0-or-later
// Edits of what gmsh finds in a mesh file, as a damaged file may make it write anything there: refused with a
// message, or a mesh whose cells have nodes. Without gmsh itself, whose process takes a tenth of a second.
#include "meshing/gmsh/gmsh_reader.hpp"
#include "tests/fuzz/mesh_property.hpp"

#include <array>
#include <limits>
#include <type_traits>
#include <vector>

using namespace dielast;

namespace {

using Contents = meshing::GmshContents;

constexpr std::array<long, 16> values{0,
                                      1,
                                      2,
                                      3,
                                      4,
                                      5,
                                      6,
                                      9,
                                      -1,
                                      -7,
                                      99,
                                      1L << 31,
                                      (1L << 32) + 1,
                                      std::numeric_limits<int>::max(),
                                      std::numeric_limits<long>::max(),
                                      std::numeric_limits<long>::min()};

template<class Number>
void edit(Number& number, int how) {
  const long value = values[static_cast<std::size_t>(how) % values.size()];
  using Wide = std::conditional_t<std::is_integral_v<Number>, unsigned long, Number>; // wraps round
  const Wide before = how < 128 ? Wide{} : static_cast<Wide>(number);
  number = static_cast<Number>(before + static_cast<Wide>(value));
}

/// Changes, leaves out or doubles one of a list.
template<class Item, class Edit>
void edit_one(std::vector<Item>& list, int which, int how, const Edit& change) {
  if (list.empty()) return;
  const auto at = list.begin() + which % static_cast<int>(list.size());
  if (how == 254)
    list.erase(at);
  else if (how == 255)
    list.push_back(Item(*at));
  else
    change(*at);
}

void edit(Contents& contents, int field, int which, int inner, int how) {
  const auto number = [&](auto& one) { edit(one, how); };
  switch (field % 10) {
  case 0:
    return edit_one(contents.node_tags, which, how, number);
  case 1:
    return edit_one(contents.coordinates, which, how,
                    [&](double& x) { x = how == 77 ? std::numeric_limits<double>::quiet_NaN() : how; });
  case 2:
    return edit_one(contents.elements, which, how, [&](auto& one) { edit(one.dimension, how); });
  case 3:
    return edit_one(contents.elements, which, how, [&](auto& one) { edit(one.entity, how); });
  case 4:
    return edit_one(contents.elements, which, how, [&](auto& one) { edit(one.nodes_each, how); });
  case 5:
    return edit_one(contents.elements, which, 0, [&](auto& one) { edit_one(one.nodes, inner, how, number); });
  case 6:
    return edit_one(contents.elements, which, how,
                    [&](auto& one) { one.type = how % 2 ? "Triangle 3" : "Triangle 6"; });
  case 7:
    return edit_one(contents.groups, which, how, [&](auto& one) { edit(one.dimension, how); });
  case 8:
    return edit_one(contents.groups, which, how, [&](auto& one) { one.name.assign(how % 5, 'a'); });
  default:
    return edit_one(contents.groups, which, 0,
                    [&](auto& one) { edit_one(one.entities, inner, how, number); });
  }
}

} // namespace

/// A byte for the file, and four for each edit: a field, two places, what to do there.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<Contents> files = [] {
    fuzz::load_gmsh();
    std::vector<Contents> all;
    for (const char* name : {"order1_41.msh", "order2_41.msh", "order1_22.msh", "order2_22.msh"}) {
      all.push_back(meshing::read_gmsh_contents(fuzz::source_folder / "tests/fuzz/corpus/gmsh" / name));
      if (!all.back().error.empty()) fuzz::fail(all.back().error);
    }
    return all;
  }();
  if (size == 0) return 0;
  Contents contents = files[data[0] % files.size()];
  for (++data, --size; size >= 4; data += 4, size -= 4) edit(contents, data[0], data[1], data[2], data[3]);
  fuzz::expect_mesh([&] { return meshing::mesh_of(std::move(contents)); });
  return 0;
}
