// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::post {

/// One number per accepted step.
struct Column {
  std::string name;
  std::string unit; ///< SI; "1" when it has none
};

/// A text as a cell of a CSV table: in quotes where it must be, always on one line.
std::string csv_cell(std::string_view text);

/// The table of a run as CSV: header `step,name[unit],...`, one row per accepted step, each written at once,
/// so that a killed run leaves whole rows. Numbers are the shortest that read back to the same double; NaN is
/// an empty cell.
class History {
 public:
  /// Starts the table. Throws WriteError.
  History(std::filesystem::path path, const std::vector<Column>& columns);
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  /// Appends a row: the step's name and one value per column. Throws WriteError.
  void append(std::string_view step, std::span<const double> values);

 private:
  std::filesystem::path path_;
  std::size_t column_count_;
  int descriptor_ = -1;
};

} // namespace dielast::post
