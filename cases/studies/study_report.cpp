// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study_report.hpp"

#include "cases/studies/study_best.hpp"
#include "cases/text/tree.hpp"
#include "cases/text/units.hpp"
#include "post/engineering.hpp"
#include "post/files/history.hpp"
#include "post/pictures/plot.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace dielast::cases {

namespace {

template<class Names>
std::optional<std::size_t> position(const Names& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - names.begin()));
}

/// A column of study.csv: numbers where the values are.
struct Column {
  std::string header;
  std::vector<std::string> cells;
};

/// A value of what varies that is a number with a unit; nothing for words, and names of files that begin with
/// a digit.
std::optional<WrittenMeasure> measure_in(const Study& study, std::size_t varied, const std::string& value) {
  if (varied < study.axes.size() && !study.axes[varied].is_measure) return std::nullopt;
  auto written = written_measure(value);
  try {
    if (written) si_unit(written->unit);
  } catch (const UnitError&) {
    return std::nullopt;
  }
  return written;
}

/// Columns of what varies: of numbers in the unit in which all are written, otherwise in SI; one for each
/// item of a list; texts where something is no number.
std::vector<Column> columns_of(const Study& study, std::size_t varied,
                               const std::vector<std::string>& values) {
  const std::string name = study.varied()[varied];
  std::vector<std::vector<WrittenMeasure>> rows;
  std::size_t items = 1;
  for (const std::string& value : values) {
    const Node node = parse_value(value, {});
    auto& row = rows.emplace_back();
    for (const Node& item : node.is(Node::Kind::list) ? node.items : std::vector<Node>{node})
      if (const auto number = measure_in(study, varied, text_of(item))) row.push_back(*number);
    items = std::max(items, row.size());
    if (row.empty() || (node.is(Node::Kind::list) && row.size() != node.items.size())) rows.back().clear();
  }
  const bool numeric = std::ranges::all_of(rows, [&](const auto& row) {
    return row.size() == items || row.size() == 1; // a number alone stands for all of the list
  });
  if (!numeric) {
    Column texts{name, {}};
    for (const std::string& value : values) texts.cells.push_back(unquoted(value));
    return {std::move(texts)};
  }
  bool alike = true;
  for (const auto& row : rows)
    for (const WrittenMeasure& one : row) alike = alike && one.unit == rows[0][0].unit;
  std::string written; // a number without a unit is in SI
  for (const auto& row : rows)
    for (const WrittenMeasure& one : row)
      if (written.empty()) written = one.unit;
  const std::string si = name_of_unit(si_unit(written).powers);
  const std::string unit = alike ? rows[0][0].unit : si;
  std::vector<Column> columns;
  for (std::size_t i = 0; i < items; ++i) {
    Column& column = columns.emplace_back();
    column.header =
        fmt::format("{}{}[{}]", name, items > 1 ? fmt::format(".{}", i + 1) : "", unit.empty() ? "1" : unit);
    for (const auto& row : rows) {
      const WrittenMeasure& one = row[std::min(i, row.size() - 1)];
      column.cells.push_back(alike ? fmt::format("{}", one.number)
                                   : fmt::format("{:.15g}", one.number * si_unit(one.unit).factor));
    }
  }
  return columns;
}

post::Ratio ratio_of(const Study& study, const std::string& quantity) {
  return study.relative.contains(quantity) ? post::Ratio::percent : post::Ratio::plain;
}

/// A plot for each unit among those of a plot's quantities: an axis has one unit.
std::vector<StudyPlot> by_unit(const Study& study, const StudyPlot& spec, const Collected& collected) {
  std::vector<StudyPlot> plots;
  std::vector<std::pair<std::string, post::Ratio>> units;
  for (const std::string& y : spec.y) {
    const auto q = position(study.collect, y);
    if (!q) continue;
    const std::pair unit{collected.units[*q], ratio_of(study, y)};
    const auto found = std::ranges::find(units, unit);
    if (found == units.end()) {
      units.push_back(unit);
      plots.push_back(spec);
      plots.back().y.clear();
      plots.back().y.push_back(y);
    } else {
      plots[static_cast<std::size_t>(found - units.begin())].y.push_back(y);
    }
  }
  return plots;
}

/// Whether one key varies along each curve, or keys that go together: lines would join points that have
/// nothing else in common.
bool varies_one_key(const Study& study, const StudyPlot& spec) {
  const auto together = [&](const std::string& key) {
    return study.goes_together(key) ? study.pair[0] : key;
  };
  std::set<std::string> varied;
  for (const StudyAxis& axis : study.axes)
    if (axis.values.size() > 1 && together(axis.key) != together(spec.group))
      varied.insert(together(axis.key));
  const bool of_axis = std::ranges::find(study.axes, spec.x, &StudyAxis::key) != study.axes.end();
  return varied.empty() || (varied.size() == 1 && (!of_axis || varied.contains(together(spec.x))));
}

post::Plot make_plot(const Study& study, const StudyPlot& spec, const std::vector<StudyPoint>& points,
                     const Collected& collected) {
  const auto axes = study.varied();
  const auto x_axis = position(axes, spec.x), group = position(axes, spec.group);
  const auto x_quantity = position(study.collect, spec.x);
  const bool joined = varies_one_key(study, spec);
  post::Plot plot{.x_label = spec.x};
  std::set<std::string> written; // units of x: where they differ, all are told in SI
  for (const StudyPoint& point : points)
    if (const auto number = x_axis ? measure_in(study, *x_axis, point.values[*x_axis]) : std::nullopt)
      written.insert(number->unit);
  const bool alike = written.size() <= 1;
  const std::string unit = written.empty() ? ""
                           : alike         ? *written.begin()
                                           : name_of_unit(si_unit(*written.rbegin()).powers);
  double size = 0;
  std::string names;
  for (const std::string& y : spec.y)
    if (const auto q = position(study.collect, y))
      for (std::size_t p = 0; p < points.size(); ++p)
        if (std::isfinite(collected.reached_value(p, *q)))
          size = std::max(size, std::abs(collected.reached_value(p, *q)));
  for (const std::string& y : spec.y) {
    const auto q = position(study.collect, y);
    if (!q) continue;
    const auto scale = post::scaled_unit(size, collected.units[*q], ratio_of(study, y));
    names += (names.empty() ? "" : ", ") + y;
    plot.y_label = fmt::format("{} [{}]", names, scale.unit.empty() ? "1" : scale.unit);
    std::map<std::string, post::Series> curves;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const std::string name = group ? unquoted(points[p].values[*group]) : "";
      post::Series& series = curves[name];
      series.label = !group               ? y
                     : spec.y.size() == 1 ? fmt::format("{} = {}", spec.group, name)
                                          : fmt::format("{}, {} = {}", y, spec.group, name);
      series.style = joined ? post::Series::Style::line_and_points : post::Series::Style::points;
      if (x_axis) {
        const auto number = measure_in(study, *x_axis, points[p].values[*x_axis]);
        series.x.push_back(!number ? static_cast<double>(p + 1)
                                   : number->number * (alike ? 1 : si_unit(number->unit).factor));
        if (!unit.empty()) plot.x_label = fmt::format("{} [{}]", spec.x, unit);
      } else {
        series.x.push_back(x_quantity ? collected.reached_value(p, *x_quantity) : static_cast<double>(p + 1));
      }
      series.y.push_back(collected.reached_value(p, *q) * scale.factor);
    }
    for (auto& [name, series] : curves) plot.series.push_back(std::move(series));
  }
  return plot;
}

} // namespace

std::string study_table(const Study& study, const std::vector<StudyPoint>& points,
                        const Collected& collected) {
  std::string table = "point";
  std::vector<Column> varied;
  const std::vector<std::string> names = study.varied();
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<std::string> values;
    for (const StudyPoint& point : points) values.push_back(point.values[i]);
    for (Column& column : columns_of(study, i, values)) varied.push_back(std::move(column));
  }
  for (const Column& column : varied) table += "," + post::csv_cell(column.header);
  for (std::size_t q = 0; q < study.collect.size(); ++q)
    table += fmt::format(",{}[{}]", study.collect[q], collected.units[q]);
  table += ",exit_code,events,message\n";
  for (std::size_t p = 0; p < points.size(); ++p) {
    table += fmt::format("{}", points[p].number);
    for (const Column& column : varied) table += "," + post::csv_cell(column.cells[p]);
    for (std::size_t q = 0; q < study.collect.size(); ++q) {
      const double value = collected.value(p, q);
      table += std::isfinite(value) ? fmt::format(",{}", value) : ",";
    }
    const auto& result = collected.results[p];
    table += result ? fmt::format(",{},{},{}\n", result->exit_code,
                                  post::csv_cell(fmt::format("{}", fmt::join(result->events, "; "))),
                                  post::csv_cell(result->message))
                    : ",,,\n";
  }
  return table;
}

std::string study_json(const Study& study, const std::vector<StudyPoint>& points, const Collected& collected,
                       const std::vector<TargetSolution>& solutions) {
  using Json = nlohmann::ordered_json;
  Json targets = Json::array(), best = Json::array();
  const auto tell = [&](const TargetSolution& solution) {
    const StudyTarget& target = study.targets[solution.target];
    const bool solved = solution.problem.empty();
    targets.push_back({{"quantity", target.quantity},
                       {"wanted", target.value},
                       {"unit", collected.units[study.column(target.quantity)]},
                       {"key", study.axes[0].key},
                       {"at", solved ? Json(solution.key) : Json(nullptr)},
                       {"at_unit", written_measure(points.front().values[0])->unit},
                       {"value", solved ? Json(solution.value) : Json(nullptr)},
                       {"problem", solution.problem}});
  };
  for (std::size_t t = 0; t < study.targets.size(); ++t) {
    if (std::ranges::count(solutions, t, &TargetSolution::target) == 0)
      tell({.target = t, .problem = not_within});
    for (const TargetSolution& solution : solutions)
      if (solution.target == t) tell(solution);
  }
  for (const StudyBest& asked : study.best) {
    const auto found = best_point(study, asked, collected);
    const std::size_t q = study.column(asked.quantity());
    Json varied = Json::object();
    const std::vector<std::string> names = study.varied();
    for (std::size_t i = 0; found && i < names.size(); ++i)
      varied[names[i]] = unquoted(points[*found].values[i]);
    best.push_back({{"quantity", asked.quantity()},
                    {"sense", asked.largest.empty() ? "smallest" : "largest"},
                    {"value", found ? Json(collected.value(*found, q)) : Json(nullptr)},
                    {"unit", collected.units[q]},
                    {"point", found ? Json(points[*found].number) : Json(nullptr)},
                    {"varied", std::move(varied)}});
  }
  const auto reached = std::ranges::count_if(
      collected.results, [](const auto& result) { return result && result->exit_code == 0; });
  return Json{{"program", "dielast " DIELAST_VERSION},
              {"title", study.title},
              {"points", points.size()},
              {"reached", reached},
              {"targets", std::move(targets)},
              {"best", std::move(best)}}
             .dump(2) +
         "\n";
}

post::Report study_report(const Study& study, const std::vector<StudyPoint>& points,
                          const Collected& collected, const std::vector<std::string>& answers) {
  post::Report report{
      .title = study.title,
      .subtitle = fmt::format("study of {}, {} points", study.base.filename().string(), points.size()),
      .footer = "dielast " DIELAST_VERSION};
  const auto failed = std::count_if(collected.results.begin(), collected.results.end(),
                                    [](const auto& result) { return !result || result->exit_code != 0; });
  report.status = failed ? post::Cell{fmt::format("{} points failed", failed), post::Tone::warning}
                         : post::Cell{"complete", post::Tone::good};
  if (!answers.empty()) {
    post::Section found{"Answers", {}};
    for (const std::string& line : answers) found.blocks.push_back(post::Paragraph{line});
    report.sections.push_back(std::move(found));
  }
  std::vector<post::Plot> plots;
  for (const StudyPlot& spec : study.plots)
    for (const StudyPlot& alike : by_unit(study, spec, collected))
      plots.push_back(make_plot(study, alike, points, collected));
  report.add("Plots", post::draw(plots));

  std::vector<std::pair<std::size_t, std::string>> best; // point and quantity
  for (const StudyBest& one : study.best)
    if (const auto found = best_point(study, one, collected)) best.emplace_back(*found, one.quantity());
  post::Table table{{"point"}, {}};
  for (std::string& name : study.varied()) table.header.push_back(std::move(name));
  for (const std::string& name : study.collect) table.header.push_back(name);
  for (const char* last : {"exit", "events", "message"}) table.header.emplace_back(last);
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<post::Cell> row{std::to_string(points[p].number)};
    if (std::filesystem::exists(points[p].directory / "report.html"))
      row[0].link = points[p].directory.filename().string() + "/report.html";
    for (const std::string& value : points[p].values) row.emplace_back(unquoted(value));
    for (std::size_t q = 0; q < study.collect.size(); ++q)
      row.emplace_back(
          post::engineering(collected.value(p, q), collected.units[q], ratio_of(study, study.collect[q])),
          std::ranges::count(best, std::pair(p, study.collect[q])) ? post::Tone::good : post::Tone::plain);
    if (const auto& result = collected.results[p]) {
      row.emplace_back(std::to_string(result->exit_code),
                       result->exit_code ? post::Tone::bad : post::Tone::plain);
      row.emplace_back(fmt::format("{}", fmt::join(result->events, "; ")), post::Tone::warning);
      row.emplace_back(result->message);
    }
    table.rows.push_back(std::move(row));
  }
  report.sections.push_back({"Points", {std::move(table)}});
  return report;
}

} // namespace dielast::cases
