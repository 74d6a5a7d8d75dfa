// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/gmsh_reader.hpp"
#include "meshing/mesh_error.hpp"
#include "meshing/quality.hpp"
#include "tests/sanitized.hpp"
#include "tests/scratch_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

namespace dielast::meshing::gmsh_reader_test {
namespace {

/// A unit square of two triangles, the second one clockwise; line "rim" at the bottom, point "corner", and a
/// node without a cell. Broken variants are made by replacing parts of the text.
std::string square(int order) {
  const std::string head =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
      "$PhysicalNames\n3\n0 1 \"corner\"\n1 2 \"rim\"\n2 3 \"left half\"\n$EndPhysicalNames\n"
      "$Entities\n1 1 2 0\n"
      "1 0 0 0 1 1\n"
      "1 0 0 0 1 0 0 1 2 0\n"
      "1 0 0 0 1 1 0 1 3 0\n"
      "2 0 0 0 1 1 0 1 4 0\n"
      "$EndEntities\n";
  if (order == 1)
    return head + "$Nodes\n1 5 1 9\n2 1 0 5\n1\n2\n3\n4\n9\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n7 7 0\n$EndNodes\n"
                  "$Elements\n4 4 1 4\n0 1 15 1\n1 1\n1 1 1 1\n2 1 2\n2 1 2 1\n3 1 3 4\n2 2 2 1\n4 1 3 "
                  "2\n$EndElements\n";
  return head +
         "$Nodes\n1 10 1 10\n2 1 0 10\n1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n"
         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 0 0\n1 0.5 0\n0.5 1 0\n0 0.5 0\n7 7 0\n0.5 0.5 0\n$EndNodes\n"
         "$Elements\n4 4 1 4\n0 1 15 1\n1 1\n1 1 8 1\n2 1 2 5\n2 1 9 1\n3 1 3 4 10 7 8\n"
         "2 2 9 1\n4 1 3 2 10 6 5\n$EndElements\n";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

class GmshReader : public testing::Test {
 protected:
  Mesh read(const std::string& text) const {
    std::ofstream(path_) << text;
    return read_gmsh(path_);
  }
  void expect_error(const std::string& text, const std::string& part) const {
    try {
      read(text);
      ADD_FAILURE() << "no error: " << part;
    } catch (const MeshError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(path_.string()), std::string::npos) << error.what();
    }
  }

  const test::ScratchFolder folder_;
  const std::filesystem::path path_ = folder_ / "mesh.msh";
};

TEST_F(GmshReader, ReadsBothOrders) {
  for (const int order : {1, 2}) {
    testing::internal::CaptureStdout();
    const Mesh mesh = read(square(order));
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(mesh.node_count(), order == 1 ? 4 : 9);
    const QualityReport report = quality(mesh);
    EXPECT_EQ(report.triangles, 2);
    EXPECT_EQ(report.inverted, 0);
    EXPECT_NEAR(report.area, 1, 1e-15);

    EXPECT_EQ(mesh.node_sets.at("corner"), std::vector<int>{0});
    EXPECT_FALSE(mesh.cell_sets.contains("corner"));
    const CellSet& rim = mesh.cell_sets.at("rim");
    EXPECT_EQ(mesh.blocks[rim.block].type, order == 1 ? CellType::line2 : CellType::line3);
    EXPECT_EQ(rim.cells, std::vector<int>{0});
    for (const int node : mesh.node_sets.at("rim")) EXPECT_EQ(mesh.nodes[node].y(), 0);
    EXPECT_EQ(mesh.node_sets.at("rim").size(), order == 1 ? 2u : 3u);
    EXPECT_EQ(mesh.cell_sets.at("left half").cells, std::vector<int>{0});
    EXPECT_EQ(mesh.cell_sets.at("surface 4").cells, std::vector<int>{1});
    EXPECT_EQ(mesh.cell_sets.at("film").cells, (std::vector<int>{0, 1}));
    EXPECT_EQ(mesh.node_sets.at("film").size(), mesh.nodes.size());
  }
}

TEST_F(GmshReader, PutsMiddleNodesBetweenTheirCorners) {
  const Mesh mesh = read(square(2));
  for (const CellBlock& block : mesh.blocks)
    for (int c = 0; c < block.size(); ++c) {
      const auto nodes = block.cell(c);
      const std::size_t corners = block.type == CellType::line3 ? 2 : 3;
      for (std::size_t k = corners; k < nodes.size(); ++k)
        EXPECT_EQ(mesh.nodes[nodes[k]],
                  (mesh.nodes[nodes[k - corners]] + mesh.nodes[nodes[(k - corners + 1) % corners]]) / 2);
    }
}

TEST_F(GmshReader, SaysWhatIsWrongWithAFile) {
  expect_error(replaced(square(1),
                        "4 4 1 4\n0 1 15 1\n1 1\n1 1 1 1\n2 1 2\n2 1 2 1\n3 1 3 4\n2 2 2 1\n4 1 3 2\n",
                        "2 2 1 2\n0 1 15 1\n1 1\n1 1 1 1\n2 1 2\n"),
               "no triangles");
  expect_error(replaced(square(2), "1 1 8 1\n2 1 2 5\n", "1 1 1 1\n2 1 2\n"),
               "mixes elements of order 1 and 2");
  expect_error(replaced(square(1), "2 1 2 1\n3 1 3 4\n", "2 1 3 1\n3 1 2 3 4\n"), "\"Quadrilateral 4\"");
  expect_error(replaced(square(1), "\"left half\"", "\"rim\""), "two physical groups have the name \"rim\"");
  expect_error(replaced(square(1), "2 3 \"left half\"", "2 3 \"half\"\n2 4 \"half\""),
               "two physical groups have the name \"half\"");
  expect_error(replaced(square(1), "0 1 15 1\n1 1\n", "0 1 15 1\n1 9\n"),
               "the point \"corner\" is not a node");
  expect_error(replaced(square(1), "3 1 3 4\n", "3 1 3 99\n"), "99");
  for (const char* text : {"not a mesh\n", "", "$MeshFormat\n", "$MeshFormat\n1 0 8\n", "$NOD\n0\n$ENDNOD\n"})
    expect_error(text, "does not begin with $MeshFormat and the version 4.1 or 2.2");
}

/// A square of two triangles, each in a physical group of its own, as a file of version 2.2 has it.
std::string two_groups(bool binary, std::array<int, 2> entities) {
  std::string text = std::string("$MeshFormat\n2.2 ") + (binary ? "1" : "0") + " 8\n";
  const auto put = [&](auto number, const char* after) {
    if (binary)
      text.append(reinterpret_cast<const char*>(&number), sizeof number);
    else
      text += fmt::format("{}{}", number, after);
  };
  if (binary) {
    put(1, "");
    text += "\n";
  }
  text += "$EndMeshFormat\n$PhysicalNames\n2\n2 5 \"lower\"\n2 6 \"upper\"\n$EndPhysicalNames\n$Nodes\n4\n";
  for (int n = 0; n < 4; ++n) {
    put(n + 1, " ");
    put(n % 2 == 0 ? 0.0 : 1.0, " ");
    put(n < 2 ? 0.0 : 1.0, " ");
    put(0.0, "\n");
  }
  text += binary ? "\n$EndNodes\n$Elements\n2\n" : "$EndNodes\n$Elements\n2\n";
  for (int e = 0; e < 2; ++e) {
    if (binary)
      for (const int head : {2, 1, 2}) put(head, "");
    put(e + 1, " ");
    if (!binary)
      for (const int head : {2, 2}) put(head, " ");
    for (const int word : {5 + e, entities[static_cast<std::size_t>(e)], e + 1, 2}) put(word, " ");
    put(e == 0 ? 3 : 4, "\n");
  }
  return text + (binary ? "\n$EndElements\n" : "$EndElements\n");
}

/// gmsh puts all elements of an entity into all of its groups: each was the whole film.
TEST_F(GmshReader, RefusesGroupsThatShareAnEntity) {
  for (const bool binary : {false, true}) {
    const Mesh mesh = read(two_groups(binary, {5, 6}));
    EXPECT_EQ(mesh.cell_sets.at("lower").cells, std::vector<int>{0});
    EXPECT_EQ(mesh.cell_sets.at("upper").cells, std::vector<int>{1});
    for (const int entity : {0, 5})
      expect_error(
          two_groups(binary, {entity, entity}),
          fmt::format("elements of the surface {} are in different physical groups, 5 and 6", entity));
  }
}

TEST_F(GmshReader, SurvivesDamagedFiles) {
  if (!test::sanitized) // else the memory that gmsh 4.8 overwrites is somewhere else
    expect_error(replaced(square(1), "1 5 1 9", "1 0 1 9"), "gmsh crashes on this mesh file");
  const std::string text = square(1);
  for (std::size_t length = 0; length + 13 < text.size(); length += 37) {
    try {
      read(text.substr(0, length));
    } catch (const MeshError&) { // every file that is not whole must end here or as a mesh
    }
  }
}

// What gmsh finds in a damaged file is not believed. Of a tag beyond the range of int the lower bits were
// taken: the cell got another node.
TEST_F(GmshReader, RefusesContentsThatDoNotFitTogether) {
  const GmshContents whole{.error = "",
                           .node_tags = {1, 2, 3},
                           .coordinates = {0, 0, 0, 1, 0, 0, 0, 1, 0},
                           .elements = {{2, 1, "Triangle 3", 3, {1, 2, 3}}},
                           .groups = {{2, 1, "sheet", {1}}}};
  EXPECT_EQ(mesh_of(whole).node_sets.at("sheet").size(), 3u);
  const auto refused = [&](auto&& change) {
    GmshContents contents = whole;
    change(contents);
    try {
      mesh_of(contents);
    } catch (const MeshError& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  constexpr std::size_t far = (std::size_t{1} << 32) + 1;
  EXPECT_EQ(refused([](auto& c) { c.elements[0].nodes[2] = far; }),
            "an element names node 4294967297, which the file does not have");
  EXPECT_EQ(refused([](auto& c) { c.elements[0].nodes[2] = c.node_tags[2] = far; }),
            "node 4294967297 has too large a number; let gmsh renumber the mesh");
  EXPECT_EQ(refused([](auto& c) { c.node_tags[2] = 2; }), "two nodes have the number 2");
  const std::string damaged = "what gmsh finds in it does not fit together; it is damaged, write it again";
  EXPECT_EQ(refused([](auto& c) { c.elements[0].nodes_each = 0; }), damaged);
  EXPECT_EQ(refused([](auto& c) { c.elements[0].nodes.pop_back(); }), damaged);
  EXPECT_EQ(refused([](auto& c) { c.elements[0].nodes_each = 1; }), damaged);
  EXPECT_EQ(refused([](auto& c) { c.elements[0].dimension = 4; }), damaged);
  EXPECT_EQ(refused([](auto& c) { c.groups[0].dimension = -1; }), damaged);
}

// A node that was moved past its neighbours: triangles are turned one by one, and two then lie on each other.
TEST_F(GmshReader, RefusesAFilmThatLiesOnItself) {
  GmshContents contents{.error = "",
                        .node_tags = {1, 2, 3, 4},
                        .coordinates = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0},
                        .elements = {{2, 1, "Triangle 3", 3, {1, 2, 3, 1, 3, 4}}},
                        .groups = {}};
  EXPECT_EQ(mesh_of(contents).film()->size(), 2);
  contents.coordinates[9] = 0.9, contents.coordinates[10] = 0.2; // to the other side of the diagonal
  try {
    mesh_of(contents);
    FAIL() << "accepted";
  } catch (const MeshError& error) {
    EXPECT_NE(std::string(error.what()).find("the film lies on itself"), std::string::npos) << error.what();
  }
}

TEST_F(GmshReader, LosesNoElements) {
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n",
                    nodes =
                        "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0.5 0\n6 0.5 1 0\n$EndNodes\n",
                    two = "1 2 2 1 1 1 2 3\n2 2 2 1 1 1 3 4\n$EndElements\n";
  EXPECT_EQ(read(head + nodes + "$Elements\n2\n" + two).film()->size(), 2);
  expect_error(head + nodes + "$Elements\n1\n" + two, "it says that it has 1 elements, and 2 stand there");
  // of two orders on one surface
  expect_error(replaced(head + nodes, "$Nodes\n6", "$Nodes\n7")
                       .replace(head.size() + nodes.size() - 10, 0, "7 0.5 0.5 0\n") +
                   "$Elements\n2\n1 2 2 1 1 1 2 3\n" + "2 9 2 1 1 1 3 4 7 6 5\n$EndElements\n",
               "mixes elements of order 1 and 2");
}

TEST_F(GmshReader, RefusesWhatItsMiddleNodesFold) {
  GmshContents contents{.error = "",
                        .node_tags = {1, 2, 3, 4, 5, 6},
                        .coordinates = {0, 0, 0, 3, 0, 0, 0, 3, 0, 0.8, 0, 0, 1.5, 1.5, 0, 0, 1.5, 0},
                        .elements = {{2, 1, "Triangle 6", 6, {1, 2, 3, 4, 5, 6}}},
                        .groups = {}};
  EXPECT_EQ(mesh_of(contents).film()->size(), 1);
  contents.coordinates[9] = 0.7;
  try {
    mesh_of(contents);
    FAIL() << "accepted";
  } catch (const MeshError& error) {
    EXPECT_NE(std::string(error.what()).find("the triangle about (1, 1, 0) is folded"), std::string::npos)
        << error.what();
  }
}

// A node's tag of 9e18 makes gmsh reserve memory and count without an end.
TEST_F(GmshReader, ComesToAnEndWithDamagedCounts) {
  EXPECT_THROW(read_gmsh(DIELAST_SOURCE_DIR "/tests/fuzz/corpus/gmsh/endless_binary.msh"), MeshError);
}

// gmsh takes a text that it does not know for a script, whatever the file's name.
TEST_F(GmshReader, RunsNoCommandsOfAFile) {
  const std::filesystem::path mark = path_.string() + ".run";
  const std::string command = "SystemCall \"touch " + mark.string() + "\";\n";
  for (const std::string head : {"", "\n", "$MeshFormat4.1 0 8\n", "// $MeshFormat\n4.1 0 8\n"}) {
    expect_error(head + command, "does not begin with $MeshFormat");
    EXPECT_FALSE(std::filesystem::exists(mark)) << head;
  }
  try {
    read(square(1) + command);
  } catch (const MeshError&) { // what follows the mesh may be refused, but not run
  }
  EXPECT_FALSE(std::filesystem::exists(mark));
}

// gmsh runs the commands in a neighbour of that name, and its window system leaves settings in the home.
TEST_F(GmshReader, OpensNothingButTheFile) {
  const std::filesystem::path home = path_.string() + ".home", mark = home / "run",
                              options = path_.string() + ".opt";
  std::filesystem::create_directory(home);
  setenv("HOME", home.c_str(), 1);
  const std::string command = "SystemCall \"touch " + mark.string() + "\";\n";
  std::ofstream(options) << command;
  EXPECT_EQ(read(square(1)).node_count(), 4);
  EXPECT_TRUE(std::filesystem::is_empty(home));
  for (const char* name : {".gmshrc", ".gmsh-options"}) std::ofstream(home / name) << command;
  EXPECT_EQ(read(square(1)).node_count(), 4);
  EXPECT_FALSE(std::filesystem::exists(mark));
}

TEST_F(GmshReader, ReadsTheOlderFormatAndLineEndings) {
  const std::string older =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
      "$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n";
  EXPECT_EQ(read(older).node_count(), 3);
  std::string returns;
  for (const char letter : square(1)) returns += letter == '\n' ? "\r\n" : std::string(1, letter);
  EXPECT_EQ(read(returns).node_count(), 4);
}

TEST_F(GmshReader, NamesTheMissingFile) {
  try {
    read_gmsh("no/such.msh");
    FAIL();
  } catch (const MeshError& error) {
    EXPECT_STREQ(error.what(), "no/such.msh: there is no such mesh file");
  }
  EXPECT_THROW(read_gmsh(std::filesystem::temp_directory_path()), MeshError);
}

} // namespace
} // namespace dielast::meshing::gmsh_reader_test
