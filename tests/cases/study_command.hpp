// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/cases/command.hpp"

namespace dielast::test {

inline const std::string study_grid =
    R"({ "honeycomb.angle" = ["120 deg", "150 deg"], "drive.voltage" = ["2 kV", "4 kV", "6 kV"] })";

class StudyCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_study(study_grid);
  }
  void write_study(const std::string& vary, const std::string& more_plots = "") const {
    write("study.toml", "title = \"Small study\"\ncase = \"small.toml\"\n[study]\nvary = " + vary +
                            "\ncollect = [\"eps_x\", \"eps_y\"]\n"
                            "plot = [{ x = \"eps_x\", y = [\"eps_y\"] }" +
                            more_plots + "]\n");
  }
  std::string mark(int point) const { return "out/point-000" + std::to_string(point) + "/point.json"; }
  std::vector<std::string> into(const std::string& folder, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"study", "study.toml", "-o", folder};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

} // namespace dielast::test
