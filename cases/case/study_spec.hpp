// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace dielast::cases {

/// One key that a study varies.
struct StudyAxis {
  std::string key;                 ///< path, as after --set
  std::vector<std::string> values; ///< TOML texts, as after --set key=
};

/// One plot of a study's report.
struct StudyPlot {
  std::string x;              ///< key of an axis, or a quantity
  std::vector<std::string> y; ///< quantities
  std::string group;          ///< key of an axis that makes one curve each; empty: none
};

/// [[study.target]]: asks at which value of the one varied key a quantity has a value
struct StudyTarget {
  std::string quantity;
  double value = 0;                  ///< SI
  std::optional<double> tolerance{}; ///< SI; absent: see solve_targets
};

/// [study]: a full grid over its axes
struct Study {
  std::string title;
  std::filesystem::path source; ///< the file with the [study] section
  std::filesystem::path base;   ///< the case that is varied; the same file unless it says case = "..."
  std::vector<StudyAxis> axes;
  std::vector<std::string> collect; ///< quantities
  std::vector<StudyPlot> plots;
  std::vector<StudyTarget> targets;
};

} // namespace dielast::cases
