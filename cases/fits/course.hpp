// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/identify_spec.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace dielast::cases {

/// A row of a run's history.
struct RecordedRow {
  std::vector<double> values; ///< of its columns, SI; begins with the load factor and the time
  std::string step;           ///< that led to it
  bool jumped = false;        ///< by loads that jumped, or to another stable state
  bool at_once = false;       ///< in a step without a duration in which branches had no time
};

/// A load factor of a step.
struct Place {
  std::string step;
  double load_factor = 0;
  bool is_row = false; ///< the history has a row there
};

/// The states of a run, or of the step that a test names, in which the column that the test was measured
/// against has the values of the test's rows.
///
/// A run may keep such a value: a column that stays before it begins to move has the value of a row in the
/// state in which it begins to, one that stays to the end of the run in the state in which it comes to
/// rest, of a step that is named at its end. At an instant at which loads jump, test.at_jump says which
/// state is meant.
class Course {
 public:
  /// `x`, `y`: columns of the test's values and of its quantity.
  Course(const DeviceTest& test, const std::vector<RecordedRow>& rows, std::size_t x, std::size_t y);

  /// The quantity where the run comes to `value`; between rows along a straight line. Throws
  /// std::runtime_error where it does not, or where it comes there more than once with other values of the
  /// quantity.
  double at(double value) const;
  /// Where steps have to stop for rows at `value`: existing ones where they are within `tolerance`. Throws
  /// as at().
  std::vector<Place> stops(double value, double tolerance) const;
  /// Whether a value lies where several states have it that only test.at_jump tells apart.
  bool has_jump_at(double value) const;

 private:
  struct Point {
    double x, y, time, load_factor;
    const std::string* step;
    bool jumped, at_once;
  };
  /// States with a value, one after another: those of rows, or a single one between the row before and this.
  struct Visit {
    std::size_t first, last;
    bool between_rows = false, at_jump = false;
  };
  std::vector<Visit> visits(double value) const;
  Visit meant(Visit rows) const;
  double y_at(const Visit& visit, double value) const;
  Place between_rows(std::size_t after, double value, double tolerance) const;
  bool alike(double y, double other) const;
  bool is_jump(std::size_t point) const;

  const DeviceTest& test_;
  std::vector<Point> points_;
  double same_x_ = 0, same_y_ = 0; ///< closer values are the same
};

} // namespace dielast::cases
