// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/text/diagnostics.hpp"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace dielast::cases {

/// One key that a study varies.
struct StudyAxis {
  std::string key;                 ///< path, as after --set
  std::vector<std::string> values; ///< TOML texts, as after --set key=
  bool is_measure = true;          ///< whether its texts are numbers with units
};

/// A key whose values are computed of those of the axes.
struct DerivedKey {
  std::string key;                      ///< path, as after --set
  std::vector<std::string> expressions; ///< see evaluate()
  bool is_list = false;                 ///< the value is a list of the expressions' values
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

/// What a point must hold to be among the best.
struct StudyBound {
  std::string quantity;
  std::optional<double> below{}, above{}; ///< SI
};

/// [[study.best]]: asks for the point with the largest or smallest value of a quantity
struct StudyBest {
  std::string largest, smallest; ///< quantity; one of the two is empty
  std::vector<StudyBound> where;

  const std::string& quantity() const { return largest.empty() ? smallest : largest; }
};

/// [study]: a full grid over its axes
struct Study {
  std::string title;
  std::filesystem::path source; ///< the file with the [study] section
  std::filesystem::path base;   ///< the case that is varied; the same file unless it says case = "..."
  std::vector<StudyAxis> axes;
  std::vector<std::string> pair; ///< axes of equal length that go together; empty: none
  std::vector<DerivedKey> derived;
  std::vector<std::string> parameters; ///< axes that are no keys of the case: variables of expressions
  std::vector<std::string> settings;   ///< "key=value" of all points
  std::vector<std::string> collect;    ///< quantities
  std::set<std::string> relative{};    ///< those that are changes, which are shown in %
  std::vector<StudyPlot> plots;
  std::vector<StudyTarget> targets;
  std::vector<StudyBest> best;
  std::vector<Diagnostic> warnings; ///< of the section; those of its cases are their own

  /// Names of a point's values: of the axes, then of the derived keys.
  std::vector<std::string> varied() const;
  bool goes_together(const std::string& axis) const;
  /// The number of a quantity among `collect`; that of none is their count.
  std::size_t column(const std::string& quantity) const;
  bool is_parameter(const std::string& axis) const;
};

/// Values of the axes at every point, the last axis running fastest; the axes of a pair run as one.
std::vector<std::vector<std::string>> grid_of(const Study& study);

/// TOML texts of the derived keys' values where the axes have these. Throws ExpressionError.
std::vector<std::string> derived_values(const Study& study, const std::vector<std::string>& axis_values);

} // namespace dielast::cases
