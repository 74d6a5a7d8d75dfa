// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/study_reader.hpp"
#include "cases/text/diagnostics.hpp"

#include <gtest/gtest.h>

namespace dielast::cases::study_test {
namespace {

const std::filesystem::path valid = std::filesystem::path(DIELAST_SOURCE_DIR) / "tests/cases/valid";

TEST(Study, OfACaseBesideIt) {
  const Study study = read_study(valid / "study.toml");
  EXPECT_EQ(study.title, "Angles and prestretches");
  EXPECT_EQ(study.base, valid / "honeycomb.toml");
  ASSERT_EQ(study.axes.size(), 3u);
  EXPECT_EQ(study.axes[0].key, "honeycomb.angle");
  EXPECT_EQ(study.axes[0].values, (std::vector<std::string>{"\"70 deg\"", "\"115 deg\"", "\"160 deg\""}));
  EXPECT_EQ(study.axes[1].values, (std::vector<std::string>{"[4, 2.5]", "3"}));
  EXPECT_EQ(study.axes[2].key, "step.voltage.increments");
  EXPECT_EQ(study.collect, (std::vector<std::string>{"eps_x", "eps_y"}));
  ASSERT_EQ(study.plots.size(), 1u);
  EXPECT_EQ(study.plots[0].x, "honeycomb.angle");
  EXPECT_EQ(study.plots[0].group, "film.prestretch");
}

TEST(Study, IsToldOfWhereItsCaseIsRunAlone) {
  EXPECT_FALSE(study_of_one_run(valid / "honeycomb.toml"));
  const auto told = study_of_one_run(valid / "study.toml");
  ASSERT_TRUE(told);
  EXPECT_NE(told->text().find("warning: study: has no effect here"), std::string::npos) << told->text();
}

TEST(Study, PairsParametersAndDerivedKeys) {
  const Study study = read_study(valid / "study_of_pairs.toml");
  ASSERT_EQ(study.axes.size(), 4u);
  EXPECT_EQ(study.axes[0].values, (std::vector<std::string>{"2", "2.82842712475", "4"}));
  EXPECT_EQ(study.axes[3].values, (std::vector<std::string>{"4", "5", "6"}));
  const auto grid = grid_of(study);
  ASSERT_EQ(grid.size(), 3u * 2u * 3u);
  EXPECT_EQ(grid[0], (std::vector<std::string>{"2", "\"120 deg\"", "\"2 kV\"", "4"}));
  EXPECT_EQ(grid[17], (std::vector<std::string>{"4", "\"150 deg\"", "\"4 kV\"", "6"}));
  EXPECT_EQ(derived_values(study, grid[17]), (std::vector<std::string>{"[4, 2.5]", "\"0.0005 m\""}));
  EXPECT_EQ(study.parameters, (std::vector<std::string>{"l1"}));
  EXPECT_EQ(study.settings, (std::vector<std::string>{"output.states=\"last\"", "output.error_estimate=false",
                                                      "mesh.wall_elements=3"}));
  // what the best must hold is collected although it is not asked for
  EXPECT_EQ(study.collect, (std::vector<std::string>{"eps_x", "eps_y", "breakdown_ratio"}));
  EXPECT_TRUE(study.relative.contains("eps_y")); // strains are shown in %, whatever they are called
  EXPECT_FALSE(study.relative.contains("breakdown_ratio"));
  EXPECT_EQ(study.best.at(0).largest, "eps_y");
  EXPECT_EQ(study.best.at(0).where.at(0).below, 0.9);
}

TEST(Study, MissingFile) { EXPECT_THROW(read_study(valid / "nowhere.toml"), FileError); }

} // namespace
} // namespace dielast::cases::study_test
