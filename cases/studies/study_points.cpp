// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study_points.hpp"

#include "post/files/results_folder.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace dielast::cases {

using nlohmann::json;

namespace {

std::filesystem::path mark_path(const StudyPoint& point) { return point.directory / "point.json"; }

} // namespace

std::vector<StudyPoint> study_points(const Study& study, const std::filesystem::path& directory) {
  std::vector<StudyPoint> points{{}};
  for (const StudyAxis& axis : study.axes) {
    std::vector<StudyPoint> finer;
    for (const StudyPoint& point : points)
      for (const std::string& value : axis.values) {
        finer.push_back(point);
        finer.back().values.push_back(value);
        finer.back().overrides.push_back(axis.key + "=" + value);
      }
    points = std::move(finer);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].number = static_cast<int>(i) + 1;
    points[i].directory = directory / fmt::format("point-{:04d}", points[i].number);
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

} // namespace dielast::cases
