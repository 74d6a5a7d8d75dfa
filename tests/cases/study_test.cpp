// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/study_reader.hpp"
#include "cases/text/diagnostics.hpp"

#include <gtest/gtest.h>

namespace dielast::cases {
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

TEST(Study, MissingFile) { EXPECT_THROW(read_study(valid / "nowhere.toml"), FileError); }

} // namespace
} // namespace dielast::cases
