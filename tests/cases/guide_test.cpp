// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <cstdlib>

// docs/guide.md, read as a user does: its files are written, its commands run, and what it shows of their
// output is there.
namespace dielast::test::guide_test {
namespace {

class Guide : public CommandTest {
 protected:
  struct Block {
    std::string language;           ///< behind the fence: toml, csv, sh, or nothing for output
    std::string before;             ///< the line before the fence
    std::vector<std::string> lines; ///< between the fences
  };

  static std::vector<Block> blocks() {
    std::vector<Block> blocks;
    bool inside = false;
    std::string before;
    for (const std::string& line : lines_of(text_of(source_folder / "docs/guide.md"))) {
      if (line.starts_with("```")) {
        inside = !inside;
        if (inside) blocks.push_back({line.substr(3), before, {}});
      } else if (inside) {
        blocks.back().lines.push_back(line);
      }
      if (!line.empty()) before = line;
    }
    return blocks;
  }

  /// Runs a line of a shell; what it printed is in `.out`.
  int shell(const std::string& line) const {
    std::string command = line.substr(0, line.find('#'));
    if (command.starts_with("dielast ")) command.replace(0, 7, DIELAST_PROGRAM);
    const int status =
        std::system(("cd " + directory.string() + " && " + command + " > .out 2> .err").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(Guide, EveryCommandDoesWhatItSays) {
  std::string printed;
  int commands = 0;
  for (const Block& block : blocks()) {
    std::string text;
    for (const std::string& line : block.lines) text += line + "\n";
    if (block.language == "toml" || block.language == "csv") {
      const auto end = block.before.rfind("`:");
      ASSERT_NE(end, std::string::npos) << "no name before the file:\n" << text;
      const auto begin = block.before.rfind('`', end - 1);
      write(block.before.substr(begin + 1, end - begin - 1), text);
    } else if (block.language == "sh") {
      printed.clear();
      for (const std::string& line : block.lines) {
        const auto told = line.find("# exit ");
        const int expected = told == std::string::npos ? 0 : std::stoi(line.substr(told + 7));
        EXPECT_EQ(shell(line), expected) << line << "\n" << content(".out") << content(".err");
        printed += content(".out");
        ++commands;
      }
    } else if (block.language.empty()) {
      for (const std::string& line : block.lines) // errors of the mesh may differ in their last digit
        EXPECT_NE(printed.find(line.substr(0, line.find("±"))), std::string::npos) << line << "\n" << printed;
    }
  }
  EXPECT_GE(commands, 12);
  for (const char* made :
       {"circle-results/report.html", "angles-study/study.csv", "model-linear/linear_model.m",
        "tests-fit/material.toml", "own-results/history.csv"})
    EXPECT_TRUE(exists(directory / made)) << made;
}

} // namespace
} // namespace dielast::test::guide_test
