// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fits/course.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace dielast::cases {

Course::Course(const DeviceTest& test, const std::vector<RecordedRow>& rows, std::size_t x, std::size_t y)
    : test_(test) {
  double largest = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RecordedRow& row = rows[i];
    const bool starts = !test.step.empty() && i + 1 < rows.size() && row.step != test.step &&
                        rows[i + 1].step == test.step; // the end of a step is the start of the next
    if (!test.step.empty() && row.step != test.step && !starts) continue;
    Point point{row.values[x], row.values[y], row.values[1], row.values[0],
                &row.step,     row.jumped,    row.at_once};
    if (starts && test.against == "load_factor") point.x = 0;
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    points_.push_back(point);
    largest = std::max(largest, std::abs(point.x));
  }
  constexpr double place = 2e-9, balance = 1e-7; // of states in time, and what forces are known to
  same_x_ = largest * (test.against == "time" ? place : balance);
  constexpr double negligible = 1e-5;
  double low = INFINITY, high = -INFINITY;
  for (const auto& value : test.measured) {
    low = std::min(low, value.real());
    high = std::max(high, value.real());
  }
  same_y_ = negligible * (high > low ? high - low : std::abs(high));
}

bool Course::alike(double y, double other) const { return std::abs(y - other) <= same_y_; }

/// Whether the loads or the device have jumped to this state from the one before.
bool Course::is_jump(std::size_t point) const {
  return points_[point].jumped && points_[point].time == points_[point - 1].time;
}

/// Of rows with the same value those that are meant.
Course::Visit Course::meant(Visit rows) const {
  const bool from_start = rows.first == 0, to_end = rows.last + 1 == points_.size();
  const bool timed = test_.against == "time";
  if (from_start && to_end && !test_.step.empty()) {
    rows.first = rows.last;
  } else if (test_.x.size() == 1 && test_.step.empty() && !timed) {
    return rows; // a row alone does not say that it was measured while the column moved
  } else if (from_start && !to_end) {
    const std::size_t first = rows.first;
    rows.first = rows.last;
    while (rows.first > first && (is_jump(rows.first) || (timed && points_[rows.first].at_once)))
      --rows.first;
    rows.at_jump = rows.first < rows.last;
  } else if (to_end && !from_start) {
    const std::size_t last = rows.last;
    rows.last = rows.first;
    while (rows.last < last && is_jump(rows.last + 1)) ++rows.last;
    rows.at_jump = rows.first < rows.last;
  } else {
    rows.at_jump = timed && rows.first < rows.last;
  }
  if (rows.at_jump && test_.at_jump == AtJump::before) rows.last = rows.first;
  if (rows.at_jump && test_.at_jump == AtJump::after) rows.first = rows.last;
  return rows;
}

std::vector<Course::Visit> Course::visits(double value) const {
  constexpr double digits = 2e-8; // of a time in another unit
  const double same_x = std::max(same_x_, test_.against == "time" ? digits * std::abs(value) : 0);
  std::vector<Visit> all;
  bool jumps_over = false, inside = false;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const bool was_inside = std::exchange(inside, std::abs(points_[i].x - value) <= same_x);
    if (inside && was_inside) {
      all.back().last = i;
    } else if (inside) {
      all.push_back({i, i});
    } else if (i > 0 && !was_inside && (points_[i].x > value) != (points_[i - 1].x > value)) {
      if (is_jump(i))
        jumps_over = true;
      else
        all.push_back({i, i, true});
    }
  }
  if (all.empty())
    throw std::runtime_error(fmt::format("{}: the run {} {} = {:.6g}{}", test_.name(),
                                         jumps_over ? "only jumps over" : "does not come to", test_.against,
                                         value, test_.step.empty() ? "" : " in step \"" + test_.step + "\""));
  for (Visit& visit : all)
    if (!visit.between_rows) visit = meant(visit);
  return all;
}

double Course::y_at(const Visit& visit, double value) const {
  const Point& after = points_[visit.first];
  if (!visit.between_rows) return after.y;
  const Point& before = points_[visit.first - 1];
  return std::lerp(before.y, after.y, (value - before.x) / (after.x - before.x));
}

double Course::at(double value) const {
  const std::vector<Visit> all = visits(value);
  const std::string where = fmt::format("{} = {:.6g}", test_.against, value);
  for (const Visit& visit : all)
    for (std::size_t i = visit.first + 1; i <= visit.last; ++i) {
      const Point &one = points_[visit.first], &other = points_[i];
      if (alike(one.y, other.y)) continue;
      if (visit.at_jump)
        throw std::runtime_error(fmt::format("{}: at {} {} jumps from {:.6g} to {:.6g}; say by at_jump which "
                                             "of them was measured, \"before\" or \"after\"",
                                             test_.name(), where, test_.quantity, one.y, other.y));
      throw std::runtime_error(fmt::format(
          "{}: the run stays at {} from step \"{}\" to step \"{}\", where {} goes from {:.6g} to {:.6g}; {}",
          test_.name(), where, *one.step, *other.step, test_.quantity, one.y, other.y,
          test_.step.empty() ? "say by step in which it was measured" : "leave this row out"));
    }
  const double y = y_at(all.front(), value);
  for (const Visit& visit : all)
    if (const double other = y_at(visit, value); !alike(y, other)) {
      const std::string &step = *points_[all.front().first].step, &next = *points_[visit.first].step;
      throw std::runtime_error(fmt::format(
          "{}: the run comes to {} more than once, with {} at {:.6g} in step \"{}\" and at {:.6g} in step "
          "\"{}\"; {}",
          test_.name(), where, test_.quantity, y, step, other, next,
          step != next ? "say by step in which it was measured"
                       : "take a first column in which the step goes on only, such as time"));
    }
  return y;
}

bool Course::has_jump_at(double value) const {
  return std::ranges::any_of(visits(value), [](const Visit& visit) { return visit.at_jump; });
}

std::vector<Place> Course::stops(double value, double tolerance) const {
  std::vector<Place> all;
  for (const Visit& visit : visits(value))
    if (visit.between_rows)
      all.push_back(between_rows(visit.first, value, tolerance));
    else
      all.push_back({*points_[visit.first].step, points_[visit.first].load_factor, true});
  return all;
}

Place Course::between_rows(std::size_t after, double value, double tolerance) const {
  const Point &before = points_[after - 1], &row = points_[after];
  if (std::abs(row.x - value) <= tolerance) return {*row.step, row.load_factor, true};
  if (std::abs(value - before.x) <= tolerance) return {*before.step, before.load_factor, true};
  const double s0 = *before.step == *row.step ? before.load_factor : 0, s1 = row.load_factor;
  // The load factor as a polynomial of the column, through up to four rows of the step.
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = after < 2 ? 0 : after - 2; i < std::min(points_.size(), after + 2); ++i)
    if (*points_[i].step == *row.step)
      points.emplace_back(points_[i].x, points_[i].load_factor);
    else if (i + 1 == after)
      points.emplace_back(points_[i].x, 0.0);
  double s = 0;
  for (const auto& [x, factor] : points) {
    double weight = 1;
    for (const auto& [other, unused] : points)
      if (other != x) weight *= (value - other) / (x - other);
    s += weight * factor;
  }
  if (!(s > s0 && s < s1)) s = std::lerp(s0, s1, (value - before.x) / (row.x - before.x));
  return {*row.step, s};
}

} // namespace dielast::cases
