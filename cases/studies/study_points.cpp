// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study_points.hpp"

#include "post/files/results_folder.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <limits>

namespace dielast::cases {

using nlohmann::json;

namespace {

std::filesystem::path mark_path(const StudyPoint& point) { return point.directory / "point.json"; }

} // namespace

std::string unquoted(const std::string& toml) {
  return toml.size() > 1 && toml.front() == '"' ? toml.substr(1, toml.size() - 2) : toml;
}

std::string label(const Study& study, const StudyPoint& point) {
  const std::vector<std::string> names = study.varied();
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{}{} = {}", i ? ", " : "", names[i], unquoted(point.values[i]));
  return text;
}

StudyPoint study_point(const Study& study, std::vector<std::string> axis_values) {
  StudyPoint point{.values = std::move(axis_values), .overrides = study.settings};
  std::vector<std::string> derived = derived_values(study, point.values);
  point.values.insert(point.values.end(), derived.begin(), derived.end());
  const std::vector<std::string> names = study.varied();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!study.is_parameter(names[i])) point.overrides.push_back(names[i] + "=" + point.values[i]);
  return point;
}

std::vector<StudyPoint> study_points(const Study& study, const std::filesystem::path& directory) {
  std::vector<StudyPoint> points;
  for (auto& values : grid_of(study)) {
    StudyPoint& point = points.emplace_back(study_point(study, std::move(values)));
    point.number = static_cast<int>(points.size());
    point.directory = directory / fmt::format("{}{:04d}", point_folder, point.number);
  }
  return points;
}

void mark_done(const StudyPoint& point, int exit_code, const std::string& message) {
  const json mark{{"values", point.values}, {"exit_code", exit_code}, {"message", message}};
  post::ResultsFolder(point.directory, "run").write("point.json", mark.dump(2) + "\n");
}

std::optional<PointResult> result_of(const Study& study, const StudyPoint& point) {
  try {
    std::ifstream mark_file(mark_path(point));
    const json mark = json::parse(mark_file);
    if (mark.at("values") != point.values) return std::nullopt;
    PointResult result{.exit_code = mark.at("exit_code"), .message = mark.at("message")};
    result.quantities.resize(study.collect.size());
    result.units.resize(study.collect.size());
    const auto summary_path = point.directory / "summary.json";
    if (result.exit_code != 0 && !std::filesystem::exists(summary_path)) return result; // it failed before
    std::ifstream summary_file(summary_path);
    const json summary = json::parse(summary_file);
    const json& quantities = summary.at("quantities");
    for (std::size_t i = 0; i < study.collect.size(); ++i) {
      const auto found = quantities.find(study.collect[i]);
      if (found == quantities.end()) continue;
      result.units[i] = found->at("unit");
      if (const json& value = found->at("value"); value.is_number())
        result.quantities[i] = value.get<double>();
    }
    if (result.message.empty()) result.message = summary.at("message");
    for (const json& event : summary.at("events"))
      if (const std::string kind = event.at("kind");
          std::find(result.events.begin(), result.events.end(), kind) == result.events.end())
        result.events.push_back(kind);
    return result;
  } catch (const json::exception&) { // damaged, or of an older version: as if it had not run
    return std::nullopt;
  }
}

Collected::Collected(const Study& study, const std::vector<StudyPoint>& points)
    : units(study.collect.size()) {
  for (const StudyPoint& point : points) {
    results.push_back(result_of(study, point));
    for (std::size_t q = 0; results.back() && q < units.size(); ++q)
      if (units[q].empty()) units[q] = results.back()->units[q];
  }
}

double Collected::value(std::size_t point, std::size_t quantity) const {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  return results[point] ? results[point]->quantities[quantity].value_or(missing) : missing;
}

double Collected::reached_value(std::size_t point, std::size_t quantity) const {
  return results[point] && results[point]->has_ended() ? value(point, quantity)
                                                       : std::numeric_limits<double>::quiet_NaN();
}

} // namespace dielast::cases
