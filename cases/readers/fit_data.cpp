// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/fit_data.hpp"

#include "cases/text/csv.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace dielast::cases {
namespace {

/// A factor to Pa, when the text is a unit of stress.
std::optional<double> stress_unit(const std::string& text) {
  try {
    return parse_measure("1 " + text, "Pa").value;
  } catch (const UnitError&) {
    return std::nullopt;
  }
}

/// "P_kPa_raw" -> 1000, "stress (MPa)" -> 1e6: the last part of the name that is a unit of stress.
std::optional<double> unit_in(const std::string& name) {
  for (NameWithUnit part = split_unit(name); !part.unit.empty(); part = split_unit(part.name))
    if (const auto factor = stress_unit(part.unit)) return factor;
  return std::nullopt;
}

bool ends_in_stress(const std::string& name) {
  const std::string unit = split_unit(name).unit;
  return !unit.empty() && stress_unit(unit);
}

bool has_any(std::string name, std::initializer_list<const char*> words) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::ranges::any_of(words, [&](const char* word) { return name.find(word) != std::string::npos; });
}
bool names_true_stress(const std::string& name) { return has_any(name, {"true", "cauchy"}); }
bool names_other_strain(const std::string& name) {
  return has_any(name, {"true", "hencky", "logarithmic", "log strain", "log_strain"});
}

/// Finds the columns of a test, and says what is wrong with them.
class Columns {
 public:
  Columns(const CsvTable& csv, const Node& table, const std::string& path, std::vector<Diagnostic>& wrong)
      : csv_(csv), table_(table), path_(path), wrong_(wrong) {}

  /// Keys one of which tells what `key` does.
  static std::string keys_of(const std::string& key) {
    return key == "stretch" ? "stretch, strain or displacement" : key;
  }

  /// Number of the column that `key` names, or of `usual`; -1 when there is none, after a report.
  int find(const std::string& key, const std::string& named, const std::string& usual) const {
    const std::string& name = named.empty() ? usual : named;
    const int column = csv_.find(name);
    if (column < 0)
      report(named.empty() ? "file" : key,
             named.empty() ? fmt::format("{} has no column {}: give {}, one of {}", csv_.file, usual,
                                         keys_of(key), csv_.listed_names())
                           : missing(named));
    return column;
  }

  /// The column that `key` names in SI; empty after a report. A column without a unit of this kind is
  /// refused, unless it is a pure number.
  std::vector<double> values(const std::string& key, const std::string& named,
                             std::string_view si_unit) const {
    const int column = find(key, named, "");
    if (column < 0) return {};
    if (const auto factor = factor_to_si(csv_, column, si_unit)) return scaled(column, *factor);
    report(key,
           si_unit == "1"
               ? fmt::format("found {}, whose unit is none of a pure number: allowed %, mm/mm or none",
                             toml_string(named))
               : fmt::format("found {}: its name has no unit; allowed one of {}, as in \"{} ({})\"",
                             toml_string(named), dimension(si_unit).usual, named, dimension(si_unit).shown));
    return {};
  }

  /// The stretch of a column of nominal strains; where a number without a unit may be meant in percent,
  /// `doubt` says so.
  std::vector<double> stretch_of_strain(const std::string& named, std::string& doubt) const {
    constexpr double largest = 15, unusual = 4;
    if (names_other_strain(named)) {
      report("strain",
             fmt::format("found {}, which is not the nominal strain by its name; wanted is stretch - 1, "
                         "of a logarithmic strain e exp(e) - 1",
                         toml_string(named)));
      return {};
    }
    std::vector<double> stretch = values("strain", named, "1");
    const bool has_unit = names_percent(named) || named.ends_with(')') || named.ends_with(']');
    if (const auto top = std::ranges::max_element(stretch); top != stretch.end() && !has_unit) {
      if (*top > largest)
        report("strain", fmt::format("found {}, which rises to {:.6g}: a strain of {:.6g} %; where it is "
                                     "in percent, its name says so, as in \"strain (%)\"; where it is not, "
                                     "as in \"strain (1)\"",
                                     toml_string(named), *top, 100 * *top));
      else if (*top > unusual)
        doubt = fmt::format("{} rises to {:.6g}, a strain of {:.6g} %: if it is in percent, its name must "
                            "say so, as in \"strain (%)\"; if it is not, as in \"strain (1)\"",
                            toml_string(named), *top, 100 * *top);
    }
    for (double& one : stretch) one += 1;
    return stretch;
  }

  /// A column of stretches: pure numbers, 1 where the film is undeformed.
  std::vector<double> stretch(const std::string& named) const {
    constexpr double largest = 50; // no elastomer stretches so far
    const int column = find("stretch", named, "stretch");
    if (column < 0) return {};
    const std::string& name = csv_.names[static_cast<std::size_t>(column)];
    const auto factor = factor_to_si(csv_, column, "1");
    const std::vector<double>& found = csv_.columns[static_cast<std::size_t>(column)];
    const double top = found.empty() ? 0 : *std::ranges::max_element(found);
    const char* key = named.empty() ? "file" : "stretch";
    if (names_percent(name) || factor != 1.0)
      report(key, fmt::format("found {}: wanted is the stretch as a number, 1 where the film is undeformed; "
                              "where it is a strain in percent, give strain = {}",
                              toml_string(name), toml_string(name)));
    else if (top > largest)
      report(key,
             fmt::format("found {}, which rises to {:.6g}; allowed a stretch up to {}: a number, 1 where "
                         "the film is undeformed",
                         toml_string(name), top, largest));
    return found;
  }

  /// The column of the stress, Pa; empty after a report.
  std::vector<double> stress(const std::string& named) const {
    std::string name = named;
    if (named.empty()) {
      std::vector<std::string> candidates;
      std::copy_if(csv_.names.begin(), csv_.names.end(), std::back_inserter(candidates), ends_in_stress);
      if (candidates.size() != 1) {
        report("file",
               candidates.empty()
                   ? fmt::format("{} has no column that ends in a unit of stress, only {}: rename the "
                                 "column of the nominal stress, as in stress_kPa",
                                 csv_.file, csv_.listed_names())
                   : fmt::format("{} has several columns of stress: give stress, one of {}", csv_.file,
                                 listed(candidates)));
        return {};
      }
      name = candidates[0];
      if (names_true_stress(name)) {
        report("file",
               fmt::format("the only column of stress, {}, is of true stress by its name; wanted is the "
                           "nominal one, force over undeformed area: true stress over stretch, where "
                           "the volume is kept. If it is nominal, say so by stress = {}",
                           toml_string(name), toml_string(name)));
        return {};
      }
    }
    const int column = find("stress", name, "");
    if (column < 0) return {};
    const auto unit = unit_in(name);
    if (!unit) {
      report("stress", fmt::format("found {}: its name has no unit of stress; rename the column, as in {}",
                                   toml_string(name), toml_string(name + "_kPa")));
      return {};
    }
    return scaled(column, *unit);
  }

  void report(const std::string& key, std::string message) const {
    const Node* node = table_.find(key);
    wrong_.push_back({node ? node->source : table_.source, path_ + "." + key, std::move(message)});
  }

 private:
  std::vector<double> scaled(int column, double factor) const {
    std::vector<double> numbers = csv_.columns[static_cast<std::size_t>(column)];
    for (double& number : numbers) number *= factor;
    return numbers;
  }
  std::string missing(const std::string& name) const {
    return fmt::format("found {}: {} has no such column, allowed {}{}", toml_string(name), csv_.file,
                       csv_.listed_names(), did_you_mean(name, csv_.names));
  }

  const CsvTable& csv_;
  const Node& table_;
  const std::string& path_;
  std::vector<Diagnostic>& wrong_;
};

void move_to_origin(MeasuredTest& measured) {
  const double stretch = measured.history.stretch[0], stress = measured.stress[0];
  for (double& one : measured.history.stretch) one += 1 - stretch;
  for (double& one : measured.stress) one -= stress;
}

void require_positive(const CsvTable& csv, const std::string& column, const std::vector<double>& stretch,
                      std::vector<Diagnostic>& wrong) {
  for (std::size_t row = 0; row < stretch.size(); ++row)
    if (!(stretch[row] > 0))
      wrong.push_back({{csv.file, csv.lines[row], 1},
                       column,
                       fmt::format("found {:.6g}, allowed a stretch above 0", stretch[row])});
}

/// Times of rows that a film reaches from its undeformed state at a constant rate.
std::vector<double> times_at(double rate, const std::vector<double>& stretch) {
  std::vector<double> times;
  double last = 1, time = 0;
  for (const double one : stretch) {
    time += std::abs(one - last) / rate;
    times.push_back(time);
    last = one;
  }
  return times;
}

void read_rows(FitTest& test, const CsvTable& csv, bool needs_time, const Columns& columns,
               std::vector<Diagnostic>& wrong) {
  const std::size_t errors_before = wrong.size();
  constexpr const char* usual_time = "time_s";
  std::string stretch_name = test.stretch_column.empty() ? "stretch" : test.stretch_column;
  std::vector<double>& stretch = test.measured.history.stretch;
  if (!test.strain_column.empty()) {
    stretch_name = test.strain_column;
    stretch = columns.stretch_of_strain(test.strain_column, test.doubt);
  } else if (!test.displacement_column.empty()) {
    stretch_name = test.displacement_column;
    stretch = columns.values("displacement", test.displacement_column, "m");
    for (double& one : stretch) one = 1 + one / *test.length;
  } else {
    stretch = columns.stretch(test.stretch_column);
  }
  if (test.force_column.empty()) {
    test.measured.stress = columns.stress(test.stress_column);
  } else {
    test.measured.stress = columns.values("force", test.force_column, "N");
    for (double& one : test.measured.stress) one /= *test.area;
  }
  int time = -1;
  if (!test.time_column.empty() && !columns.values("time", test.time_column, "s").empty())
    time = csv.find(test.time_column);
  else if (test.time_column.empty() && !test.rate && !test.equilibrium)
    time = csv.find_time();
  if (const int said = csv.find_time(); test.rate && said >= 0)
    columns.report("rate",
                   fmt::format("found a rate, but {} has the times in its column {}: leave the rate out, "
                               "or the column",
                               csv.file, toml_string(csv.names[static_cast<std::size_t>(said)])));
  if (wrong.size() > errors_before) return;
  if (needs_time && !test.equilibrium && !test.rate && time < 0) {
    columns.report("file",
                   fmt::format("{} has no column {}, and the branches need the time: give time, one of "
                               "{}, or rate, or equilibrium = true",
                               csv.file, usual_time, csv.listed_names()));
    return;
  }
  test.measured.history.mode = test.kind;
  test.measured.weight = test.weight;
  test.measured.predict = test.predict;
  test.lines = csv.lines;
  if (test.zero) move_to_origin(test.measured);
  require_positive(csv, stretch_name, stretch, wrong);
  if (time >= 0) {
    require_growing(csv, time, wrong);
    test.measured.history.time = si_column(csv, time, "s");
  } else if (test.rate) {
    test.measured.history.time = times_at(*test.rate, test.measured.history.stretch);
  }
  if (test.measured.largest_stress() == 0)
    columns.report("file", fmt::format("{} has no stress other than 0", csv.file));
}

} // namespace

void load_test(FitTest& test, const std::filesystem::path& folder, bool needs_time, const Node& table,
               const std::string& path, std::vector<Diagnostic>& wrong) {
  const std::size_t errors_before = wrong.size();
  try {
    const CsvTable csv = read_csv(folder / test.file, 2, wrong);
    if (wrong.size() > errors_before) return;
    read_rows(test, csv, needs_time, Columns(csv, table, path, wrong), wrong);
  } catch (const FileError& error) {
    wrong.push_back({table.find("file")->source, path + ".file",
                     fmt::format("found {}: {}", toml_string(test.file.string()),
                                 std::filesystem::exists(folder / test.file)
                                     ? error.what()
                                     : "no such file; the path starts at this file's folder")});
  }
}

} // namespace dielast::cases
