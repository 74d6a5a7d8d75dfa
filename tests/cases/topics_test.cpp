// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

namespace dielast::test {
namespace {

class Topics : public CommandTest {};

TEST_F(Topics, HelpAndVersion) {
  const Ended help = dielast({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"run", "check", "mesh", "study", "info", "schema", "Exit codes:"})
    EXPECT_NE(help.out.find(command), std::string::npos) << command;
  const Ended version = dielast({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.out.starts_with("dielast 0.")) << version.out;
  for (const char* command : {"run", "check", "mesh", "study", "info", "schema"})
    EXPECT_EQ(dielast({command, "--help"}).exit_code, 0) << command;
}

TEST_F(Topics, InfoExplainsWhatACaseMaySay) {
  const std::vector<std::pair<const char*, const char*>> words{
      {"overview", "materials"},    {"materials", "VHB 4910 (honeycomb)"},
      {"laws", "arruda-boyce"},     {"laws", "dashpot"},
      {"devices", "patch"},         {"steps", "transient"},
      {"waves", "unipolar sine"},   {"devices", "corner_top"},
      {"quantities", "elongation"}, {"steps", "release"},
      {"keys", "prestretch"},       {"units", "voltage"}};
  for (const auto& [topic, word] : words) {
    const Ended ended = dielast({"info", topic});
    EXPECT_EQ(ended.exit_code, 0) << topic;
    EXPECT_NE(ended.out.find(word), std::string::npos) << topic;
  }
  EXPECT_EQ(dielast({"info"}).out, dielast({"info", "overview"}).out);
}

TEST_F(Topics, TheMaterialsPageIsWhatTheTablesSay) {
  EXPECT_EQ(dielast({"info", "materials.md"}).out, text_of(source_folder / "docs/materials.md"))
      << "make it again: dielast info materials.md > docs/materials.md";
}

TEST_F(Topics, SchemaIsJson) {
  const Ended ended = dielast({"schema"});
  EXPECT_EQ(ended.exit_code, 0);
  const nlohmann::json schema = nlohmann::json::parse(ended.out, nullptr, false);
  ASSERT_TRUE(schema.is_object());
  EXPECT_TRUE(schema.contains("$schema"));
  for (const char* section :
       {"film", "honeycomb", "disc", "patch", "mesh", "drive", "spring", "step", "check"})
    EXPECT_TRUE(schema["properties"].contains(section)) << section;
}

TEST_F(Topics, MeshIsWrittenAndItsPlacesListed) {
  const Ended ended = dielast({"mesh", "small.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  for (const char* place : {"film", "walls", "boundary", "cell[1,0]", "wall[1]", "left_apex", "corner_top"})
    EXPECT_NE(ended.out.find(std::string("  ") + place + " "), std::string::npos) << place << ended.out;
  EXPECT_NE(content("out/small-mesh.pvd").find("</VTKFile>"), std::string::npos);
  EXPECT_NE(content("out/small-mesh_film_0000.vtu").find("</VTKFile>"), std::string::npos);
  EXPECT_NE(content("out/small-mesh_walls_0000.vtu").find("</VTKFile>"), std::string::npos);
}

TEST_F(Topics, CheckPrintsSizesAndWritesNothing) {
  const Ended ended = dielast({"check", "small.toml"});
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_TRUE(ended.out.starts_with("small.toml: valid\n")) << ended.out;
  EXPECT_NE(ended.out.find("a free body"), std::string::npos) << ended.out;
  EXPECT_FALSE(exists("small-results"));
  EXPECT_EQ(dielast({"check", "disc.toml"}).out.find("a free body"), std::string::npos);
}

TEST_F(Topics, TangentsPassTheirCheck) {
  for (const char* file : {"small.toml", "disc.toml"})
    for (const char* model : {"model=planar", "model=3d"})
      for (const char* order : {"mesh.order=1", "mesh.order=2"}) {
        const Ended ended = dielast({"check", file, "--tangent", "--set", model, "--set", order});
        EXPECT_EQ(ended.exit_code, 0) << file << " " << model << " " << order << "\n"
                                      << ended.out << ended.err;
        EXPECT_NE(ended.out.find(": passed\n"), std::string::npos) << ended.out;
      }
}

} // namespace
} // namespace dielast::test
