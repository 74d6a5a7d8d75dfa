// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study_best.hpp"

#include "post/engineering.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

std::size_t number_of(const Study& study, const std::string& quantity) {
  return static_cast<std::size_t>(std::ranges::find(study.collect, quantity) - study.collect.begin());
}

std::optional<double> value_of(const Study& study, const PointResult& result, const std::string& quantity) {
  return result.quantities.at(number_of(study, quantity));
}

/// Nothing for a point that did not run to its end, or in which something that is asked for has no value.
std::optional<PointResult> judged(const Study& study, const StudyBest& best, const StudyPoint& point) {
  auto result = result_of(study, point);
  if (!result || !result->has_ended() || !value_of(study, *result, best.quantity())) return std::nullopt;
  for (const StudyBound& bound : best.where)
    if (!value_of(study, *result, bound.quantity)) return std::nullopt;
  return result;
}

bool holds(const Study& study, const StudyBest& best, const PointResult& result) {
  return std::ranges::all_of(best.where, [&](const StudyBound& bound) {
    const double value = *value_of(study, result, bound.quantity);
    return value < bound.below.value_or(INFINITY) && value > bound.above.value_or(-INFINITY);
  });
}

std::string question(const Study& study, const StudyBest& best, const std::vector<std::string>& units) {
  std::string text = (best.largest.empty() ? "smallest " : "largest ") + best.quantity();
  for (std::size_t i = 0; i < best.where.size(); ++i) {
    const StudyBound& bound = best.where[i];
    const std::string& unit = units[number_of(study, bound.quantity)];
    text += (i ? " and " : " with ") + bound.quantity;
    if (bound.above) text += " above " + post::engineering(*bound.above, unit);
    if (bound.below)
      text += (bound.above ? " and below " : " below ") + post::engineering(*bound.below, unit);
  }
  return text;
}

} // namespace

std::optional<std::size_t> best_point(const Study& study, const StudyBest& best,
                                      const std::vector<StudyPoint>& points) {
  std::optional<std::size_t> found;
  double most = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto result = judged(study, best, points[p]);
    if (!result || !holds(study, best, *result)) continue;
    const double merit = *value_of(study, *result, best.quantity()) * (best.largest.empty() ? -1 : 1);
    if (found && !(merit > most)) continue;
    found = p;
    most = merit;
  }
  return found;
}

std::vector<std::string> best_lines(const Study& study, const std::vector<StudyPoint>& points) {
  std::vector<std::string> lines, units(study.collect.size());
  for (const StudyPoint& point : points)
    if (const auto result = result_of(study, point))
      for (std::size_t q = 0; q < units.size(); ++q)
        if (units[q].empty()) units[q] = result->units[q];
  for (const StudyBest& best : study.best) {
    std::string& line = lines.emplace_back(question(study, best, units) + ": ");
    if (const auto found = best_point(study, best, points)) {
      const auto result = result_of(study, points[*found]);
      line += post::engineering(*value_of(study, *result, best.quantity()),
                                units[number_of(study, best.quantity())]) +
              fmt::format(" at {} (point {})", label(study, points[*found]), points[*found].number);
      if (!result->events.empty())
        line += fmt::format(", where there is {}", fmt::join(result->events, ", "));
    } else {
      line += "no point of the grid holds this";
    }
    const auto judged_points = std::ranges::count_if(
        points, [&](const StudyPoint& point) { return judged(study, best, point).has_value(); });
    if (const auto others = static_cast<std::ptrdiff_t>(points.size()) - judged_points; others > 0)
      line += fmt::format("; {} of {} points have no result and are left out", others, points.size());
  }
  return lines;
}

} // namespace dielast::cases
