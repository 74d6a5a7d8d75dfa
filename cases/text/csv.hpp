// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/text/diagnostics.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::cases {

/// Columns of numbers from a CSV file: one line of names, lines that begin with # are comments. Cells are
/// separated by semicolons or tabs where the line of names has some, and then numbers may have a decimal
/// comma, but none between thousands; otherwise by commas. The unit of a column is at the end of its name:
/// time_s, "time (s)", voltage[kV]. Columns of remarks or clock times, in which no cell looks like a number,
/// are left out.
struct CsvTable {
  std::string file; ///< as messages name it
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns; ///< one for each name, as written
  std::vector<int> lines;                   ///< of the file, one for each row
  int header_line = 0;
  std::vector<std::string> texts; ///< names of the columns that are left out, each with a cell of it

  int rows() const { return static_cast<int>(lines.size()); }
  /// Number of the column; -1 when there is none of that name.
  int find(std::string_view name) const;
  /// The column of the time: time_s, or the only one called time with a unit of it; -1 where there is none.
  int find_time() const;
  /// The names in words, and those of the columns that are left out.
  std::string listed_names() const;
};

/// A column's name without its unit, and the unit: "time" and "s" of "time (s)"; no unit: "" and the name.
struct NameWithUnit {
  std::string name, unit;
};
NameWithUnit split_unit(const std::string& name);

/// Whether a column's name says percent, anywhere: "strain (%)", "percent strain", "strain_pct".
bool names_percent(std::string name);

/// Everything that is wrong with the file is added to `wrong`, with line and column: text or nothing in a
/// cell of a column of numbers, a row with more or fewer cells than names, fewer than `least_rows` rows; a
/// thousand errors end it. Throws FileError when the file cannot be read.
CsvTable read_csv(const std::filesystem::path& path, int least_rows, std::vector<Diagnostic>& wrong);

/// What the numbers of the column are multiplied by to be SI: its name ends in a unit of the dimension of
/// `si_unit`. Nothing where the name has no such unit. Of a pure number: 0.01 where the name says percent,
/// the factor of a unit in brackets ("mm/mm"), and otherwise 1.
std::optional<double> factor_to_si(const CsvTable& table, int column, std::string_view si_unit);

/// The column in SI: its name ends in a unit of the dimension of `si_unit`, or its numbers are SI already.
std::vector<double> si_column(const CsvTable& table, int column, std::string_view si_unit);

/// Says where a column does not grow from row to row; `advice`: where two are equal.
void require_growing(const CsvTable& table, int column, std::vector<Diagnostic>& wrong,
                     std::string_view advice = "");

} // namespace dielast::cases
