#include "cases/study_points.hpp"

#include "post/file_output.hpp"

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
  std::filesystem::create_directories(point.directory);
  post::replace_file(mark_path(point),
                     json{{"values", point.values}, {"exit_code", exit_code}, {"message", message}}.dump(2) +
                         "\n");
}

std::optional<PointResult> result_of(const Study& study, const StudyPoint& point) {
  std::ifstream mark_file(mark_path(point)), summary_file(point.directory / "summary.json");
  const json mark = json::parse(mark_file, nullptr, false);
  if (mark.is_discarded() || mark.value("values", std::vector<std::string>{}) != point.values)
    return std::nullopt;
  PointResult result{.exit_code = mark.value("exit_code", 0), .message = mark.value("message", "")};
  const json summary = json::parse(summary_file, nullptr, false);
  for (const std::string& name : study.collect) {
    result.quantities.emplace_back();
    result.units.emplace_back();
    if (summary.is_discarded() || !summary["quantities"].contains(name)) continue;
    const json& quantity = summary["quantities"][name];
    result.units.back() = quantity.value("unit", "");
    if (quantity["value"].is_number()) result.quantities.back() = quantity["value"].get<double>();
  }
  if (!summary.is_discarded()) {
    if (result.message.empty()) result.message = summary.value("message", "");
    for (const json& event : summary["events"])
      if (const std::string kind = event.value("kind", "");
          std::find(result.events.begin(), result.events.end(), kind) == result.events.end())
        result.events.push_back(kind);
  }
  return result;
}

std::optional<WrittenMeasure> axis_number(const std::string& toml) {
  std::string_view text = toml;
  if (text.size() > 1 && (text.front() == '"' || text.front() == '\''))
    text = text.substr(1, text.size() - 2);
  try {
    return split_measure(text);
  } catch (const UnitError&) {
    return std::nullopt;
  }
}

} // namespace dielast::cases
