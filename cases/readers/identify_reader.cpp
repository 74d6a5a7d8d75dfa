// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/identify_reader.hpp"

#include "cases/case/quantities.hpp"
#include "cases/language/conditions.hpp"
#include "cases/language/section_reader.hpp"
#include "cases/readers/case_tree.hpp"
#include "cases/text/csv.hpp"
#include "cases/text/overrides.hpp"
#include "cases/text/units.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

/// A test as it is written: where its keys stand, and how messages call it.
struct Written {
  const Node& table;
  std::string path;
};

/// The columns of a test's file, in SI. What is missing is added to `wrong`.
class Columns {
 public:
  Columns(const CsvTable& csv, const Written& test, std::vector<Diagnostic>& wrong)
      : csv_(csv), test_(test), wrong_(wrong) {}

  /// Number of the column of that name, with any unit; -1 where there is none.
  int find(const std::string& name) const {
    auto found =
        std::ranges::find(csv_.names, name); // "gap_in" is a gap in inches only where there is no "gap"
    if (found == csv_.names.end())
      found = std::ranges::find_if(csv_.names, [&](const auto& own) { return split_unit(own).name == name; });
    return found == csv_.names.end() ? -1 : static_cast<int>(found - csv_.names.begin());
  }
  std::vector<double> values(const std::string& name, std::string_view si_unit) const {
    const int column = find(name);
    if (column >= 0) return values(column, name, si_unit);
    wrong_.push_back({test_.table.find("file")->source, test_.path + ".file",
                      fmt::format("{} has no column {}, only {}", csv_.file, name, csv_.listed_names())});
    return {};
  }

  /// Those of the column that find() has found by that name: what stands behind it is a unit.
  std::vector<double> values(int column, const std::string& name, std::string_view si_unit) const {
    const std::string& written = csv_.names[static_cast<std::size_t>(column)];
    const std::string unit = written == name ? "" : split_unit(written).unit;
    const bool ratio = unit == "%" || unit == "1" || unit == "-"; // an angle is none
    const bool known = si_unit == "1" ? unit.empty() || ratio
                       : unit.empty() ? name != "phase" && name != "time"
                                      : !ratio && factor_to_si(csv_, column, si_unit).has_value();
    if (known && unit.empty() && si_unit != "1") bare_.push_back(fmt::format("{} ({})", name, si_unit));
    if (known) return si_column(csv_, column, si_unit);
    const Source header{csv_.file, csv_.header_line, 1};
    const auto [usual, other] = name == "time" ? std::pair{"s", "min"} : std::pair{"deg", "rad"};
    if (unit.empty())
      wrong_.push_back({header, "",
                        fmt::format("found {0} without a unit; write \"{1}[{2}]\" or \"{1}[{3}]\"",
                                    toml_string(written), name, usual, other)});
    else
      wrong_.push_back(
          {header, "",
           fmt::format("found {}, whose unit \"{}\" is none of {}{}", toml_string(written), unit, name,
                       name == "phase"  ? ""
                       : si_unit == "1" ? "; without a unit the numbers are those of the run, no percent"
                                        : "; without a unit the numbers are in " + std::string(si_unit))});
    return {};
  }
  /// Names of those that have been read without a unit, with that in which they are taken.
  const std::vector<std::string>& bare() const { return bare_; }

 private:
  const CsvTable& csv_;
  const Written& test_;
  std::vector<Diagnostic>& wrong_;
  mutable std::vector<std::string> bare_;
};

FrequencyTable read_response(MeasuredResponse response, const CsvTable& csv, const Columns& columns,
                             std::vector<Diagnostic>& wrong) {
  const std::size_t before = wrong.size();
  if (columns.find("magnitude") >= 0 && columns.find("real") >= 0)
    wrong.push_back({{csv.file, csv.header_line, 1},
                     "",
                     "the response is given twice, by magnitude and by real part; leave one out"});
  std::string_view unit = unit_of(response);
  if (const int column = std::max(columns.find("magnitude"), columns.find("real"));
      response == MeasuredResponse::displacement && column >= 0 && !factor_to_si(csv, column, unit) &&
      factor_to_si(csv, column, "rad/V^2"))
    unit = "rad/V^2"; // of an angle
  FrequencyTable table{columns.values("frequency", "Hz"), {}};
  const bool polar = columns.find("real") < 0;
  const std::vector<double> first = columns.values(polar ? "magnitude" : "real", unit);
  const std::vector<double> second = columns.values(polar ? "phase" : "imaginary", polar ? "rad" : unit);
  if (wrong.size() > before) return table;
  for (std::size_t i = 0; i < table.hertz.size(); ++i) {
    table.value.push_back(polar ? std::polar(first[i], second[i]) : std::complex(first[i], second[i]));
    if (!(table.hertz[i] > 0) || table.value.back() == 0.0)
      wrong.push_back({{csv.file, csv.lines[i], 1}, "", "a response is above 0, at a frequency above 0"});
  }
  return table;
}

void read_quantity(DeviceTest& test, const CsvTable& csv, const Columns& columns, const Case& one,
                   std::vector<Diagnostic>& wrong) {
  std::vector<post::Column> history = history_columns(one);
  history.erase(std::ranges::find(history, "iterations", &post::Column::name), history.end()); // the solver's
  test.against = csv.names.at(0);
  auto column = std::ranges::find(history, test.against, &post::Column::name);
  if (column == history.end()) {
    test.against = split_unit(csv.names[0]).name;
    column = std::ranges::find(history, test.against, &post::Column::name);
  }
  if (column == history.end()) {
    std::vector<std::string> known;
    for (const post::Column& each : history) known.push_back(each.name);
    wrong.push_back({{csv.file, csv.header_line, 1},
                     "",
                     fmt::format("found {}: its first column is none of the run's history, allowed {}",
                                 toml_string(csv.names[0]), listed(known))});
    return;
  }
  if (std::vector<std::string> steps; test.against == "load_factor" && test.step.empty()) {
    for (const Step& step : one.steps)
      if (!step.is_analysis()) steps.push_back(step.name);
    if (steps.size() > 1)
      wrong.push_back({{csv.file, csv.header_line, 1},
                       "",
                       fmt::format("found \"load_factor\", which begins again in each step; say by step in "
                                   "which it was measured, one of {}",
                                   listed(steps))});
  }
  const auto quantity = std::ranges::find(history, test.quantity, &post::Column::name);
  const std::size_t before = wrong.size();
  test.x = columns.values(0, test.against, column->unit);
  for (const double value : columns.values(test.quantity, quantity->unit)) test.measured.emplace_back(value);
  if (wrong.size() > before) return;
  require_growing(csv, 0, wrong);
  if (std::ranges::all_of(test.measured, [](const auto& value) { return value == 0.0; }))
    wrong.push_back({{csv.file, csv.header_line, 1}, "", "nothing other than 0 was measured"});
}

/// Hands the table in a test's file to `take`, with its columns.
template<class Take>
void load(const std::filesystem::path& file, const std::filesystem::path& folder, const Written& written,
          std::vector<Diagnostic>& wrong, Take take) {
  const std::size_t before = wrong.size();
  try {
    const CsvTable csv = read_csv(folder / file, 1, wrong);
    if (wrong.size() == before) take(csv, Columns(csv, written, wrong));
  } catch (const FileError& error) {
    wrong.push_back({written.table.find("file")->source, written.path + ".file",
                     fmt::format("found {}: {}", toml_string(file.string()),
                                 std::filesystem::exists(folder / file)
                                     ? error.what()
                                     : "no such file; the path starts at this file's folder")});
  }
}

/// A test's own settings are keys of the case, which no schema of this file knows.
void read_settings(SectionReader& reader, const Node& table, const std::string& path, const Node& base,
                   const std::vector<std::string>& unknowns, DeviceTest& test) {
  const Node* set = table.find("set");
  if (!set) return;
  for (std::size_t i = 0; set->is(Node::Kind::table) && i < set->items.size(); ++i) {
    test.settings.push_back(set->keys[i] + "=" + text_of(set->items[i]));
    const std::string key = numbered_key(base, set->keys[i]);
    if (std::ranges::any_of(unknowns, [&](const std::string& unknown) {
          return is_within(numbered_key(base, unknown), key);
        }))
      reader.report(set->items[i].key_source, path + ".set",
                    fmt::format("found {}: it is one of the unknowns, which are found for all tests",
                                toml_string(set->keys[i])));
  }
}

/// "; did you mean ...?", where the case has one key that ends in the last name of `key`; otherwise "".
std::string key_of_that_name(const std::string& key, const Case& one) {
  const std::string ending = "." + key.substr(key.rfind('.') + 1);
  std::vector<std::string> found;
  for (const auto& [known, source] : one.keys)
    if (known.ends_with(ending)) found.push_back(known);
  return found.size() == 1 ? did_you_mean(found.front(), found) : "";
}

/// The unknowns with their start values: the case's, or those of identify.start.
void find_unknowns(SectionReader& reader, const Node& section, Node base, const Case& one,
                   Identification& asked) {

  const Node* start = section.find("start");
  for (std::size_t i = 0; start && start->is(Node::Kind::table) && i < start->items.size(); ++i) {
    if (std::ranges::count(asked.keys, start->keys[i]) == 0)
      reader.report(start->items[i].key_source, "identify.start",
                    fmt::format("found {}: none of the unknowns", toml_string(start->keys[i])));
    else
      override_case(base, start->keys[i], text_of(start->items[i]), start->items[i].source);
  }
  const Node& written = *section.find("unknowns");
  for (std::size_t i = 0; i < asked.keys.size(); ++i) {
    const Source& source = written.items.empty() ? written.source : written.items[i].source;
    const auto report = [&](const std::string& message) {
      reader.report(source, "identify.unknowns",
                    fmt::format("found {}: {}", toml_string(asked.keys[i]), message));
    };
    const std::string own = numbered_key(base, asked.keys[i]);
    if (std::ranges::count_if(asked.keys, [&](const auto& key) { return numbered_key(base, key) == own; }) >
        1)
      return report("given twice");
    try {
      const auto value = written_measure(text_of(value_at(base, asked.keys[i])));
      if (!value)
        report("the case has no such key with a number; write its start value there, or in identify.start" +
               key_of_that_name(asked.keys[i], one));
      else if (value->number == 0)
        report("the case starts it at 0; write a start value other than 0");
      else
        asked.unknowns.push_back({asked.keys[i], value->number, value->unit});
    } catch (const CaseError& error) {
      report(error.diagnostics().front().message);
    }
  }
}

/// The step of the case in which a test was measured: one whose states it can be compared with.
void check_step(SectionReader& reader, const Node& table, const std::string& path, const Case& one,
                const DeviceTest& test) {
  std::vector<std::string> steps;
  for (const Step& step : one.steps)
    if (test.is_response() ? step.kind == StepKind::harmonic : !step.is_analysis())
      steps.push_back(step.name);
  const char* kind = test.is_response() ? "of kind \"harmonic\"" : "with a history";
  if (const Node* at_jump = table.find("at_jump"); at_jump && test.is_response())
    reader.report(at_jump->source, path + ".at_jump", "has no effect: a response is that of a state at rest");
  if (test.is_response() && steps.empty())
    reader.report(table.source, path + ".response",
                  "the case has no step of kind \"harmonic\", whose response it would be");
  else if (const Node* step = table.find("step"); step && std::ranges::count(steps, test.step) == 0)
    reader.report(step->source, path + ".step",
                  fmt::format("found {}: the case has no such step {}, allowed {}{}", toml_string(test.step),
                              kind, listed(steps), did_you_mean(test.step, steps)));
  else if (test.is_response() && !step && steps.size() > 1)
    reader.report(table.source, path + ".step",
                  fmt::format("missing: the case has several steps {}; say which was measured, one of {}",
                              kind, listed(steps)));
}

/// What the tests ask of the case.
void check_tests(SectionReader& reader, const Node& section, const Case& one, const Identification& asked) {
  for (std::size_t t = 0; t < asked.tests.size(); ++t) {
    const DeviceTest& test = asked.tests[t];
    const Node& table = section.find("test")->items[t];
    const std::string path = fmt::format("identify.test[{}]", t + 1);
    check_step(reader, table, path, one, test);
    if (!test.is_response() && std::ranges::count(one.quantities, test.quantity, &Quantity::name) == 0) {
      std::vector<std::string> known;
      for (const Quantity& quantity : one.quantities) known.push_back(quantity.name);
      reader.report(table.find("quantity")->source, path + ".quantity",
                    fmt::format("found {}: the case has no such quantity, allowed {}{}",
                                toml_string(test.quantity), listed(known),
                                did_you_mean(test.quantity, known)));
    }
  }
}

} // namespace

bool is_identification(const std::filesystem::path& path) { return read_tree(path).find("identify"); }

Identification read_identification(const std::filesystem::path& path) {
  const Node tree = read_tree(path);
  Identification asked;
  asked.source = path;
  asked.title = path.stem().string();
  if (const Node* title = tree.find("title"); title && title->is(Node::Kind::text)) asked.title = title->text;
  SectionReader reader({.folder = path.parent_path()});
  for (std::size_t i = 0; i < tree.items.size(); ++i)
    if (const std::string& key = tree.keys[i]; key != "title" && key != "case" && key != "identify")
      reader.report(
          tree.items[i].key_source, key,
          "an identification has only \"title\", \"case\" and [identify]; this belongs in that case");
  const Node* base_name = tree.find("case");
  if (!base_name || !base_name->is(Node::Kind::text))
    throw CaseError({{base_name ? base_name->source : tree.source, "case",
                      "missing; write the name of the case file whose keys are to be found"}});
  asked.base = path.parent_path() / base_name->text;
  if (std::error_code failure; !std::filesystem::is_regular_file(asked.base, failure))
    throw CaseError({{base_name->source, "case",
                      fmt::format("found {}: no such file; the path starts at this file's folder",
                                  text_of(*base_name))}});
  const Node base = read_case_file(asked.base);
  const Case one = interpret(base, asked.base); // its own errors come first

  const Node& section = *tree.find("identify");
  if (!section.is(Node::Kind::table))
    throw CaseError({{section.source, "identify", "is a section, [identify]"}});
  reader.read_table(identify_section(), section, &asked, "identify");
  const Node tests = section.find("test") ? *section.find("test") : Node{};
  if (!tests.is(Node::Kind::list) || tests.items.empty())
    reader.report(section.source, "identify.test",
                  "missing; add an [[identify.test]] with the file of a table");
  if (!reader.diagnostics().empty()) throw CaseError(reader.diagnostics());
  find_unknowns(reader, section, base, one, asked);
  check_tests(reader, section, one, asked);
  std::vector<Diagnostic> wrong;
  for (std::size_t t = 0; t < asked.tests.size() && reader.diagnostics().empty(); ++t) {
    const std::string test_path = fmt::format("identify.test[{}]", t + 1);
    read_settings(reader, tests.items[t], test_path, base, asked.keys, asked.tests[t]);
    Node with = base;
    for (const std::string& setting : asked.tests[t].settings) override_case(with, setting);
    DeviceTest& test = asked.tests[t];
    const Case changed = interpret(with, asked.base);
    load(test.file, path.parent_path(), {tests.items[t], test_path}, wrong,
         [&](const CsvTable& csv, const Columns& columns) {
           if (!test.is_response()) {
             read_quantity(test, csv, columns, changed, wrong);
           } else {
             FrequencyTable table = read_response(test.response, csv, columns, wrong);
             test.against = "frequency";
             test.x = std::move(table.hertz);
             test.measured = std::move(table.value);
           }
           test.bare = columns.bare();
         });
  }
  if (wrong.empty() && reader.diagnostics().empty() && asked.fitted_numbers() <= asked.unknowns.size())
    reader.report(section.find("unknowns")->source, "identify.unknowns",
                  fmt::format("there are {} unknowns, and the fitted tests have {} numbers; more are needed",
                              asked.unknowns.size(), asked.fitted_numbers()));
  wrong.insert(wrong.end(), reader.diagnostics().begin(), reader.diagnostics().end());
  if (!wrong.empty()) throw CaseError(wrong);
  return asked;
}

bool is_rational_fit(const std::filesystem::path& path) { return read_tree(path).find("rational"); }

RationalFits read_rational_fits(const std::filesystem::path& path) {
  const Node tree = read_tree(path);
  RationalFits asked{.title = path.stem().string(), .source = path, .fits = {}};
  Section root;
  root.access = same_object();
  root.keys = {text("title", to(&RationalFits::title), "title of the report").optional()};
  root.sections = {rational_section()};
  root.sections.front().presence = Section::Presence::list;
  SectionReader reader({.folder = path.parent_path()});
  reader.read_table(root, tree, &asked, "");
  if (!reader.diagnostics().empty()) throw CaseError(reader.diagnostics());
  std::vector<Diagnostic> wrong;
  for (std::size_t i = 0; i < asked.fits.size(); ++i) {
    RationalFit& fit = asked.fits[i];
    const Written written{tree.find("rational")->items[i], fmt::format("rational[{}]", i + 1)};
    const std::size_t before = wrong.size();
    load(fit.file, path.parent_path(), written, wrong, [&](const CsvTable& csv, const Columns& columns) {
      fit.measured = read_response(fit.response, csv, columns, wrong);
    });
    if (const std::size_t numbers = 2 * fit.measured.hertz.size();
        wrong.size() == before && static_cast<int>(numbers) <= fit.unknowns())
      wrong.push_back({written.table.source, written.path,
                       fmt::format("there are {} unknowns, and {} has {} numbers; more are needed",
                                   fit.unknowns(), fit.file.string(), numbers)});
  }
  if (!wrong.empty()) throw CaseError(wrong);
  return asked;
}

} // namespace dielast::cases
