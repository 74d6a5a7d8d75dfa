// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/wave_file.hpp"

#include "cases/text/csv.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>

namespace dielast::cases {
namespace {

/// Number of the column with the values; -1 after a report.
int value_column(const CsvTable& table, const std::string& time, const Waveform& wave, const Node& written,
                 const std::string& path, std::vector<Diagnostic>& wrong) {
  std::vector<std::string> values;
  for (const std::string& name : table.names)
    if (name != time) values.push_back(name);
  if (!wave.column.empty()) {
    if (const int column = table.find(wave.column); column >= 0) return column;
    wrong.push_back({written.find("column")->source, path + ".column",
                     fmt::format("found {}: {} has no such column, allowed {}{}", toml_string(wave.column),
                                 table.file, listed(values), did_you_mean(wave.column, values))});
    return -1;
  }
  if (values.size() == 1) return table.find(values[0]);
  wrong.push_back({written.find("file")->source, path + ".file",
                   values.empty() ? fmt::format("{} has no column besides {}", table.file, time)
                                  : fmt::format("{} has several columns: give column, one of {}", table.file,
                                                listed(values))});
  return -1;
}

} // namespace

void load_samples(Waveform& wave, std::string_view unit, const std::filesystem::path& folder,
                  const Node& table, const std::string& path, std::vector<Diagnostic>& wrong) {
  const auto file = folder / wave.file;
  const std::size_t errors_before = wrong.size();
  try {
    const CsvTable csv = read_csv(file, 2, wrong);
    const int time = csv.find_time();
    if (time < 0 && !csv.names.empty())
      wrong.push_back({{csv.file, csv.header_line, 1},
                       "",
                       fmt::format("there is no column time_s, nor \"time\" with another unit, found {}",
                                   csv.listed_names())});
    if (wrong.size() > errors_before) return;
    require_growing(csv, time, wrong, "; a jump takes a time, be it short");
    const int column = value_column(csv, csv.names[static_cast<std::size_t>(time)], wave, table, path, wrong);
    if (wrong.size() > errors_before) return;
    const std::string& name = csv.names[static_cast<std::size_t>(column)];
    if (unit == "1" &&
        (name.find("strain") != std::string::npos || name.find("elongation") != std::string::npos ||
         (names_percent(name) && name.find("stretch") == std::string::npos))) {
      wrong.push_back({{csv.file, csv.header_line, 1},
                       name,
                       "is wanted as a stretch, a length over the unstretched one: 1 plus the strain"});
      return;
    }
    if (!factor_to_si(csv, column, unit)) {
      wrong.push_back({{csv.file, csv.header_line, 1},
                       name,
                       fmt::format("there is no unit; allowed a name that ends in one of {}, such as {}_{}",
                                   dimension(unit).usual, name, dimension(unit).shown)});
      return;
    }
    const auto times = si_column(csv, time, "s");
    const auto values = si_column(csv, column, unit);
    wave.samples.clear();
    for (std::size_t i = 0; i < times.size(); ++i) wave.samples.push_back({times[i], values[i]});
    wave.file = std::filesystem::absolute(file).lexically_normal();
  } catch (const FileError& error) {
    wrong.push_back({table.find("file")->source, path + ".file",
                     fmt::format("found {}: {}", toml_string(wave.file.string()),
                                 std::filesystem::exists(file)
                                     ? error.what()
                                     : "no such file; the path starts at the case file's folder")});
  }
}

} // namespace dielast::cases
