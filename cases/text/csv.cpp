// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/csv.hpp"

#include "cases/text/input_file.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace dielast::cases {
namespace {

struct Cell {
  std::string text;
  int column = 1; ///< of its first character in the line, from 1
};

std::vector<Cell> cells_of(std::string_view line) {
  constexpr std::string_view blanks = " \t\r";
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::string_view text = line.substr(begin, end - begin);
    const std::size_t first = std::min(text.find_first_not_of(blanks), text.size());
    const int column = static_cast<int>(begin + (first < text.size() ? first : 0)) + 1;
    text.remove_prefix(first);
    text = text.substr(0, text.find_last_not_of(blanks) + 1);
    if (text.size() > 1 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    cells.push_back({std::string(text), column});
    begin = end + 1;
  }
  return cells;
}

/// The number in a cell; NaN when it holds none.
double number_in(const std::string& text) {
  double number = std::nan("");
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(begin, end, number);
  return problem == std::errc{} && stop == end && std::isfinite(number) ? number : std::nan("");
}

} // namespace

int CsvTable::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

CsvTable read_csv(const std::filesystem::path& path, int least_rows, std::vector<Diagnostic>& wrong) {
  constexpr std::size_t largest = 64u << 20, enough = 20 * most_diagnostics;
  constexpr int most_rows = 100000;
  std::istringstream stream(read_input(path, "a CSV file", largest));
  CsvTable table;
  table.file = path.string();
  int number = 0;
  for (std::string line; std::getline(stream, line) && wrong.size() < enough;) {
    ++number;
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3); // byte order mark of spreadsheets
    if (line.starts_with('#') || line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto cells = cells_of(line);
    if (table.names.empty()) {
      for (const Cell& cell : cells) table.names.push_back(cell.text);
      table.columns.resize(cells.size());
      table.header_line = number;
      continue;
    }
    table.lines.push_back(number);
    if (cells.size() != table.names.size()) {
      wrong.push_back({{table.file, number, 1},
                       "",
                       fmt::format("found {} cells, allowed {}: one for each name in line {}", cells.size(),
                                   table.names.size(), table.header_line)});
      continue;
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const double value = number_in(cells[c].text);
      if (std::isnan(value))
        wrong.push_back({{table.file, number, cells[c].column},
                         table.names[c],
                         cells[c].text.empty()
                             ? "the cell is empty, allowed a number"
                             : fmt::format("found \"{}\", allowed a number", cells[c].text)});
      table.columns[c].push_back(value);
    }
  }
  if (table.rows() > most_rows)
    wrong.push_back({{table.file}, "", fmt::format("found {} rows, allowed {}", table.rows(), most_rows)});
  if (table.rows() < least_rows)
    wrong.push_back({{table.file},
                     "",
                     fmt::format("found {} row{} of numbers, allowed at least {}", table.rows(),
                                 table.rows() == 1 ? "" : "s", least_rows)});
  return table;
}

std::optional<double> factor_to_si(const CsvTable& table, int column, std::string_view si_unit) {
  if (si_unit == "1") return 1;
  const std::string& name = table.names.at(static_cast<std::size_t>(column));
  const auto unit = name.rfind('_');
  if (unit == std::string::npos) return std::nullopt;
  try {
    return parse_measure("1 " + name.substr(unit + 1), si_unit).value;
  } catch (const UnitError&) { // a word, not a unit
    return std::nullopt;
  }
}

std::vector<double> si_column(const CsvTable& table, int column, std::string_view si_unit) {
  const double factor = factor_to_si(table, column, si_unit).value_or(1);
  std::vector<double> values = table.columns.at(static_cast<std::size_t>(column));
  for (double& value : values) value *= factor;
  return values;
}

void require_growing(const CsvTable& table, int column, std::vector<Diagnostic>& wrong) {
  const auto& values = table.columns.at(static_cast<std::size_t>(column));
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1]))
      wrong.push_back({{table.file, table.lines[i], 1},
                       table.names[static_cast<std::size_t>(column)],
                       fmt::format("found {} after {}, allowed values that grow from row to row", values[i],
                                   values[i - 1])});
}

} // namespace dielast::cases
