// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/studies/study_targets.hpp"

#include "cases/text/units.hpp"
#include "post/engineering.hpp"

#include <boost/math/tools/roots.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace dielast::cases {

namespace {

constexpr int most_runs = 40;
constexpr double usual_tolerance = 1e-4; ///< of the value, or of its change between the two points

/// Value of the key, and of the quantity less the target.
using Point = std::pair<double, double>;

std::size_t collected(const Study& study, const StudyTarget& target) {
  const auto found = std::ranges::find(study.collect, target.quantity);
  return static_cast<std::size_t>(found - study.collect.begin());
}

std::optional<double> difference(const Study& study, const StudyTarget& target,
                                 const std::optional<PointResult>& result) {
  if (!result || !result->has_ended()) return std::nullopt;
  const auto value = result->quantities[collected(study, target)];
  return value ? std::optional(*value - target.value) : std::nullopt;
}

/// Along the key; points without a value are left out.
std::vector<Point> curve_of(const Study& study, const StudyTarget& target,
                            const std::vector<StudyPoint>& points) {
  std::vector<Point> curve;
  for (const StudyPoint& point : points)
    if (const auto y = difference(study, target, result_of(study, point)))
      curve.emplace_back(written_measure(point.values[0])->number, *y);
  std::ranges::sort(curve);
  return curve;
}

/// Zero of the polynomial through up to four points, between numbers `i` and i + 1 of the curve.
double root_near(const std::vector<Point>& curve, std::size_t i) {
  const std::size_t first = i > 0 ? i - 1 : 0, last = std::min(i + 3, curve.size());
  const auto near = std::span(curve).subspan(first, last - first);
  const auto polynomial = [&](double x) { // Neville's scheme
    std::vector<double> value;
    for (const Point& point : near) value.push_back(point.second);
    for (std::size_t order = 1; order < near.size(); ++order)
      for (std::size_t k = 0; k + order < near.size(); ++k)
        value[k] = ((x - near[k].first) * value[k + 1] - (x - near[k + order].first) * value[k]) /
                   (near[k + order].first - near[k].first);
    return value[0];
  };
  const auto bracket = boost::math::tools::bisect(polynomial, curve[i].first, curve[i + 1].first,
                                                  boost::math::tools::eps_tolerance<double>(45));
  return (bracket.first + bracket.second) / 2;
}

/// The study's point at another value of its key.
StudyPoint point_at(const Study& study, double key, const std::filesystem::path& directory) {
  const std::string unit = written_measure(study.axes[0].values[0])->unit;
  const std::string number = fmt::format("{:.15g}", key);
  StudyPoint point = study_point(study, {unit.empty() ? number : fmt::format("\"{} {}\"", number, unit)});
  point.directory = directory;
  return point;
}

/// The solution between two neighbouring points of the curve; they are on either side of the target.
class Search {
 public:
  Search(const Study& study, std::size_t target, std::vector<Point> curve, std::size_t first)
      : study_(study), target_(study.targets[target]), curve_(std::move(curve)), i_(first) {
    solution_.target = target;
    const double change = std::abs(curve_[i_ + 1].second - curve_[i_].second);
    tolerance_ = target_.tolerance.value_or(usual_tolerance * std::max(std::abs(target_.value), change));
  }

  TargetSolution run(const std::filesystem::path& directory, const std::string& name,
                     const PointRunner& run_point) {
    for (const Point& end : {curve_[i_], curve_[i_ + 1]})
      if (std::abs(end.second) <= tolerance_) return found(end);
    while (solution_.runs < most_runs) {
      const double low = curve_[i_].first, high = curve_[i_ + 1].first;
      // A curve that the polynomial does not follow is halved now and then.
      const double key = solution_.runs % 4 == 3 ? (low + high) / 2 : root_near(curve_, i_);
      if (!(key > low && key < high)) break;
      const auto folder = directory / fmt::format("{}-{:02d}", name, ++solution_.runs);
      const auto result = run_point(point_at(study_, key, folder));
      const auto y = difference(study_, target_, result);
      if (!y)
        return failed(fmt::format("the run at {:.6g} {}", key,
                                  result ? "has no value: " + result->message : "was interrupted"));
      if (std::abs(*y) <= tolerance_) return found({key, *y});
      curve_.insert(curve_.begin() + static_cast<std::ptrdiff_t>(i_) + 1, {key, *y});
      if (curve_[i_].second * *y > 0) ++i_;
    }
    return failed(fmt::format("the quantity jumps over the value near {:.6g}", curve_[i_].first));
  }

 private:
  TargetSolution found(const Point& at) {
    solution_.key = at.first;
    solution_.value = at.second + target_.value;
    return solution_;
  }
  TargetSolution failed(std::string problem) {
    solution_.key = curve_[i_].first;
    solution_.problem = std::move(problem);
    return solution_;
  }

  const Study& study_;
  const StudyTarget& target_;
  std::vector<Point> curve_;
  std::size_t i_; ///< the target is between this point of the curve and the next
  double tolerance_ = 0;
  TargetSolution solution_;
};

} // namespace

std::vector<TargetSolution> solve_targets(const Study& study, const std::vector<StudyPoint>& points,
                                          const std::filesystem::path& directory, const PointRunner& run) {
  std::vector<TargetSolution> solutions;
  for (std::size_t t = 0; t < study.targets.size(); ++t) {
    const std::vector<Point> curve = curve_of(study, study.targets[t], points);
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      const bool passes = curve[i].second * curve[i + 1].second <= 0;
      const bool is_last = i + 2 == curve.size();
      if (!passes || (curve[i + 1].second == 0 && !is_last)) continue; // that point begins the next pair
      solutions.push_back(
          Search(study, t, curve, i)
              .run(directory, fmt::format("{}{:02d}", target_folder, solutions.size() + 1), run));
    }
  }
  return solutions;
}

std::vector<std::string> target_lines(const Study& study, const std::vector<StudyPoint>& points,
                                      const std::vector<TargetSolution>& solutions) {
  std::vector<std::string> lines;
  for (std::size_t t = 0; t < study.targets.size(); ++t) {
    const StudyTarget& target = study.targets[t];
    std::string quantity_unit;
    for (const StudyPoint& point : points)
      if (const auto result = result_of(study, point); result && quantity_unit.empty())
        quantity_unit = result->units[collected(study, target)];
    const std::string wanted =
        fmt::format("{} = {}", target.quantity, post::engineering(target.value, quantity_unit));
    const std::string unit = written_measure(points.front().values[0])->unit;
    bool any = false;
    for (const TargetSolution& solution : solutions) {
      if (solution.target != t) continue;
      any = true;
      lines.push_back(
          solution.problem.empty()
              ? fmt::format("{} at {} = {:.6g} {} (run there: {})", wanted, study.axes[0].key, solution.key,
                            unit, post::engineering(solution.value, quantity_unit, post::Ratio::plain, 6))
              : fmt::format("{}: not solved: {}", wanted, solution.problem));
    }
    if (!any) lines.push_back(wanted + ": not within the values varied");
  }
  return lines;
}

} // namespace dielast::cases
