// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

namespace dielast::test::installation_test {
namespace {

class Installation : public CommandTest {};

// Installed anywhere and moved from there, the program reads mesh files: it finds its module of gmsh.
TEST_F(Installation, WorksInAnyPlace) {
  const auto shell = [&](const std::string& line) {
    const int status = std::system(("cd '" + directory.string() + "' && " + line + " > log 2>&1").c_str());
    return status == 0 ? std::string() : line + "\n" + content("log");
  };
  ASSERT_EQ(shell("'" DIELAST_CMAKE "' --install '" DIELAST_BINARY_DIR "' --prefix first"), "");
  std::filesystem::rename(directory / "first", directory / "second");
  for (const char* file :
       {"share/man/man1/dielast.1", "share/bash-completion/completions/dielast",
        "share/zsh/vendor-completions/_dielast", "share/fish/vendor_completions.d/dielast.fish",
        "share/dielast/gallery/honeycomb/case.toml", "share/doc/dielast/docs/guide.md",
        "share/doc/dielast/README.md"})
    EXPECT_GT(content("second/" + std::string(file)).size(), 100u) << file;
  EXPECT_FALSE(exists("second/bin/dielast_gmsh.so"));
  EXPECT_EQ(shell("second/bin/dielast mesh second/share/dielast/gallery/own_mesh/slider.toml"), "");
  EXPECT_NE(content("log").find("places:"), std::string::npos) << content("log");
}

} // namespace
} // namespace dielast::test::installation_test
