// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/csv.hpp"

#include "cases/text/input_file.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>

namespace dielast::cases {
namespace {

struct Cell {
  std::string text;
  int column = 1; ///< of its first character in the line, from 1
};

std::vector<Cell> cells_of(std::string_view line, char separator) {
  const std::string_view blanks = separator == '\t' ? " \r" : " \t\r";
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
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

/// What separates the cells of a table with this line of names.
char separator_of(std::string_view names) {
  for (const char separator : {';', '\t'})
    if (names.find(separator) != std::string_view::npos) return separator;
  return ',';
}

/// The number in a cell; NaN when it holds none. A decimal comma is one where commas separate nothing.
double number_in(std::string text, char separator) {
  double number = std::nan("");
  if (separator != ',' && text.find('.') == std::string::npos)
    if (const auto comma = text.find(','); comma != std::string::npos) text[comma] = '.';
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(begin, end, number);
  return problem == std::errc{} && stop == end && std::isfinite(number) ? number : std::nan("");
}

/// Whether a cell holds words, or what may be meant as a number.
bool is_text(std::string cell) {
  std::ranges::transform(cell, cell.begin(), [](unsigned char c) { return std::tolower(c); });
  return cell != "nan" && cell != "inf" && cell.find_first_not_of("0123456789.,+-e ") != std::string::npos;
}

/// A column as it is read: its numbers, what is wrong with its cells, and whether these hold words alone.
struct Column {
  std::vector<double> numbers;
  std::vector<Diagnostic> wrong;
  std::string first_text;
  bool text = true;
};

/// Whether the number may have a separator of thousands where another has a decimal one: "13.678".
bool may_have_thousands(std::string_view text, char separator) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  const std::size_t at = text.find(separator);
  return at >= 1 && at <= 3 && text.size() == at + 4 && text[0] != '0' &&
         text.find_first_not_of(std::string("0123456789") + separator) == std::string_view::npos;
}

/// Decimal commas and dots of a file.
class Decimals {
 public:
  void add(const std::string& text, const Source& source) {
    for (std::size_t i : {0u, 1u}) {
      if (text.find(signs[i]) == std::string::npos) continue;
      if (first_[i].empty()) first_[i] = text;
      if (doubtful_[i].first.empty() && may_have_thousands(text, signs[i])) doubtful_[i] = {text, source};
    }
  }
  /// Where one of them may stand between thousands.
  void check(std::vector<Diagnostic>& wrong) const {
    for (std::size_t i : {0u, 1u})
      if (const auto& [text, source] = doubtful_[i]; !text.empty() && !first_[1 - i].empty())
        wrong.push_back(
            {source, "",
             fmt::format("found \"{}\" in a file with \"{}\", allowed one sign for decimals and none "
                         "between thousands",
                         text, first_[1 - i])});
  }

 private:
  static constexpr std::array signs{',', '.'};
  std::array<std::string, 2> first_;
  std::array<std::pair<std::string, Source>, 2> doubtful_;
};

} // namespace

int CsvTable::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

NameWithUnit split_unit(const std::string& name) {
  for (const char* brackets : {"()", "[]"})
    if (const auto open = name.find(brackets[0]); open != std::string::npos && name.back() == brackets[1]) {
      std::string stem = name.substr(0, open);
      while (stem.ends_with(' ')) stem.pop_back();
      return {stem, name.substr(open + 1, name.size() - open - 2)};
    }
  const auto last = name.rfind('_');
  return last == std::string::npos ? NameWithUnit{name, ""}
                                   : NameWithUnit{name.substr(0, last), name.substr(last + 1)};
}

bool names_percent(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (name.find('%') != std::string::npos || name.find("percent") != std::string::npos ||
      name.find("per cent") != std::string::npos)
    return true;
  const auto is_letter = [&](std::size_t i) {
    return i < name.size() && std::isalpha(static_cast<unsigned char>(name[i])) != 0;
  };
  for (std::size_t at = name.find("pct"); at != std::string::npos; at = name.find("pct", at + 1))
    if (!is_letter(at - 1) && !is_letter(at + 3)) return true;
  return false;
}

int CsvTable::find_time() const {
  if (const int column = find("time_s"); column >= 0) return column;
  int found = -1;
  for (int i = 0; i < static_cast<int>(names.size()); ++i)
    if (split_unit(names[static_cast<std::size_t>(i)]).name == "time" && factor_to_si(*this, i, "s")) {
      if (found >= 0) return -1;
      found = i;
    }
  return found;
}

std::string CsvTable::listed_names() const {
  return listed(names) +
         (texts.empty() ? "" : fmt::format("; no numbers stand in {}", fmt::join(texts, ", ")));
}

CsvTable read_csv(const std::filesystem::path& path, int least_rows, std::vector<Diagnostic>& wrong) {
  constexpr std::size_t largest = 64u << 20, enough = 20 * most_diagnostics;
  constexpr int most_rows = 100000;
  std::istringstream stream(read_input(path, "a CSV file", largest));
  CsvTable table;
  table.file = path.string();
  std::vector<std::string> names;
  std::vector<Column> columns;
  int number = 0;
  char separator = ',';
  Decimals decimals;
  for (std::string line; std::getline(stream, line) && wrong.size() < enough;) {
    ++number;
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3); // byte order mark of spreadsheets
    if (line.starts_with('#') || line.find_first_not_of(" \t\r") == std::string::npos) continue;
    if (names.empty()) separator = separator_of(line);
    const auto cells = cells_of(line, separator);
    if (names.empty()) {
      for (const Cell& cell : cells) names.push_back(cell.text);
      columns.resize(cells.size());
      table.header_line = number;
      continue;
    }
    table.lines.push_back(number);
    if (cells.size() != names.size()) {
      wrong.push_back({{table.file, number, 1},
                       "",
                       fmt::format("found {} cells, allowed {}: one for each name in line {}{}", cells.size(),
                                   names.size(), table.header_line,
                                   separator == ',' && cells.size() == 2 * names.size()
                                       ? "; with decimal commas cells are separated by semicolons"
                                       : "")});
      continue;
    }
    for (std::size_t c = 0; c < cells.size(); ++c) {
      Column& column = columns[c];
      const std::string& cell = cells[c].text;
      column.numbers.push_back(number_in(cell, separator));
      column.text = column.text && (cell.empty() || is_text(cell));
      if (column.first_text.empty()) column.first_text = cell;
      if (!std::isnan(column.numbers.back())) {
        if (separator != ',') decimals.add(cell, {table.file, number, cells[c].column});
      } else if (column.wrong.size() < enough) {
        column.wrong.push_back({{table.file, number, cells[c].column},
                                names[c],
                                cell.empty() ? "the cell is empty, allowed a number"
                                             : fmt::format("found \"{}\", allowed a number", cell)});
      }
    }
  }
  const bool any_numbers = !std::ranges::all_of(columns, &Column::text);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string& word = columns[c].first_text;
    if (any_numbers && columns[c].text && (!word.empty() || names[c].empty())) {
      if (!word.empty()) table.texts.push_back(fmt::format("\"{}\" (\"{}\")", names[c], word));
      continue; // nothing at all: each line ends with a separator
    }
    std::ranges::move(columns[c].wrong, std::back_inserter(wrong));
    const bool is_alone = std::ranges::count(names, names[c]) == 1; // otherwise which of them is asked for?
    table.names.push_back(is_alone ? names[c] : fmt::format("column {}: {}", c + 1, names[c]));
    table.columns.push_back(std::move(columns[c].numbers));
  }
  std::ranges::stable_sort(wrong, {}, [](const Diagnostic& one) { return one.source.line; });
  decimals.check(wrong);
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
  const std::string& name = table.names.at(static_cast<std::size_t>(column));
  if (si_unit == "1" && names_percent(name)) return 0.01;
  const auto [stem, unit] = split_unit(name);
  const bool brackets = name.ends_with(')') || name.ends_with(']'); // otherwise any word may stand there
  if (si_unit == "1" && (!brackets || unit.empty() || unit == "-")) return 1;
  try {
    return parse_measure("1 " + unit, si_unit).value;
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

void require_growing(const CsvTable& table, int column, std::vector<Diagnostic>& wrong,
                     std::string_view advice) {
  const auto& values = table.columns.at(static_cast<std::size_t>(column));
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1]))
      wrong.push_back({{table.file, table.lines[i], 1},
                       table.names[static_cast<std::size_t>(column)],
                       fmt::format("found {} after {}, allowed values that grow from row to row{}", values[i],
                                   values[i - 1], values[i] == values[i - 1] ? advice : "")});
}

} // namespace dielast::cases
