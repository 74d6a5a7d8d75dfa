// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study_best.hpp"

#include "post/engineering.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

/// Whether the point ran to its end, and all that is asked for has a value.
bool is_judged(const Study& study, const StudyBest& best, const std::optional<PointResult>& result) {
  if (!result || !result->has_ended()) return false;
  const auto has_value = [&](const std::string& quantity) {
    return result->quantities[study.column(quantity)].has_value();
  };
  return has_value(best.quantity()) && std::ranges::all_of(best.where, has_value, &StudyBound::quantity);
}

bool holds(const Study& study, const StudyBest& best, const PointResult& result) {
  return std::ranges::all_of(best.where, [&](const StudyBound& bound) {
    const double value = *result.quantities[study.column(bound.quantity)];
    return value < bound.below.value_or(INFINITY) && value > bound.above.value_or(-INFINITY);
  });
}

std::string question(const Study& study, const StudyBest& best, const std::vector<std::string>& units) {
  std::string text = (best.largest.empty() ? "smallest " : "largest ") + best.quantity();
  for (std::size_t i = 0; i < best.where.size(); ++i) {
    const StudyBound& bound = best.where[i];
    const std::string& unit = units[study.column(bound.quantity)];
    text += (i ? " and " : " with ") + bound.quantity;
    if (bound.above) text += " above " + post::engineering(*bound.above, unit);
    if (bound.below)
      text += (bound.above ? " and below " : " below ") + post::engineering(*bound.below, unit);
  }
  return text;
}

} // namespace

std::optional<std::size_t> best_point(const Study& study, const StudyBest& best, const Collected& collected) {
  std::optional<std::size_t> found;
  double most = 0;
  for (std::size_t p = 0; p < collected.results.size(); ++p) {
    const auto& result = collected.results[p];
    if (!is_judged(study, best, result) || !holds(study, best, *result)) continue;
    const double merit = collected.value(p, study.column(best.quantity())) * (best.largest.empty() ? -1 : 1);
    if (found && !(merit > most)) continue;
    found = p;
    most = merit;
  }
  return found;
}

std::vector<std::string> best_lines(const Study& study, const std::vector<StudyPoint>& points,
                                    const Collected& collected) {
  std::vector<std::string> lines;
  for (const StudyBest& best : study.best) {
    std::string& line = lines.emplace_back(question(study, best, collected.units) + ": ");
    if (const auto found = best_point(study, best, collected)) {
      const std::size_t q = study.column(best.quantity());
      line += post::engineering(collected.value(*found, q), collected.units[q]) +
              fmt::format(" at {} (point {})", label(study, points[*found]), points[*found].number);
      if (const auto& events = collected.results[*found]->events; !events.empty())
        line += fmt::format(", where there is {}", fmt::join(events, ", "));
    } else {
      line += "no point of the grid holds this";
    }
    const auto others = std::ranges::count_if(
        collected.results, [&](const auto& result) { return !is_judged(study, best, result); });
    if (others > 0)
      line += fmt::format("; {} of {} points have no result and are left out", others, points.size());
  }
  return lines;
}

} // namespace dielast::cases
