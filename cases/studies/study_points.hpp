// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/study_spec.hpp"
#include "cases/console/exit_code.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace dielast::cases {

/// Folders of points are called this and their number.
inline constexpr const char* point_folder = "point-";

/// One case of a study's grid.
struct StudyPoint {
  int number = 0;                     ///< from 1, the last axis running fastest
  std::vector<std::string> values;    ///< of Study::varied(), TOML texts
  std::vector<std::string> overrides; ///< "key=value", of those that are keys of the case
  std::filesystem::path directory;
};

/// What became of a point.
struct PointResult {
  int exit_code = 0;                             ///< of its run; -signal when it crashed
  std::string message;                           ///< why it failed, "" when it did not
  std::vector<std::optional<double>> quantities; ///< the collected ones, SI
  std::vector<std::string> units;
  std::vector<std::string> events; ///< kinds, in order of their first appearance

  /// Whether the quantities are those of the state that the case asks for.
  bool has_ended() const {
    return exit_code == static_cast<int>(ExitCode::ok) ||
           exit_code == static_cast<int>(ExitCode::check_failed);
  }
};

/// A TOML text without its quotes, as a person reads it.
std::string unquoted(const std::string& toml);

/// "honeycomb.angle = 150 deg, drive.voltage = 4 kV"
std::string label(const Study& study, const StudyPoint& point);

/// The point at these values of the axes, without number and directory. Throws ExpressionError.
StudyPoint study_point(const Study& study, std::vector<std::string> axis_values);

/// The full grid of a study, where the axes of a pair are one; point directories below `directory`.
std::vector<StudyPoint> study_points(const Study& study, const std::filesystem::path& directory);

/// Remembers in the point's directory how its run ended; reads it back, nothing when the point was not
/// finished, has other values or damaged results.
void mark_done(const StudyPoint& point, int exit_code, const std::string& message);
std::optional<PointResult> result_of(const Study& study, const StudyPoint& point);

/// The results of all points of a study, as they are now.
struct Collected {
  std::vector<std::optional<PointResult>> results; ///< nothing: not finished
  std::vector<std::string> units;                  ///< of Study::collect; "" where no point has a value

  Collected(const Study& study, const std::vector<StudyPoint>& points);
  /// SI, NaN where there is none.
  double value(std::size_t point, std::size_t quantity) const;
  /// What a plot over the values that vary may show: NaN where a run ended on its way to them, too.
  double reached_value(std::size_t point, std::size_t quantity) const;
};

} // namespace dielast::cases
