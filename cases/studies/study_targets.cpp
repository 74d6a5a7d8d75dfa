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

constexpr int most_runs_of_target = 40;
constexpr int most_runs_to_failure = 12;
constexpr double usual_tolerance = 1e-4; ///< of the value or its change between the two points, the smaller
constexpr double rounding = 1e-8;        ///< of the value: what runs are good to

/// Value of the key, and of the quantity less the target.
using Point = std::pair<double, double>;

std::optional<double> difference(const Study& study, const StudyTarget& target,
                                 const std::optional<PointResult>& result) {
  if (!result || !result->has_ended()) return std::nullopt;
  const auto value = result->quantities[study.column(target.quantity)];
  return value ? std::optional(*value - target.value) : std::nullopt;
}

/// Along the key; points without a value are left out, their keys in `failed`.
std::vector<Point> curve_of(const Study& study, const StudyTarget& target,
                            const std::vector<StudyPoint>& points, std::vector<double>& failed) {
  std::vector<Point> curve;
  for (const StudyPoint& point : points) {
    const double key = written_measure(point.values[0])->number;
    if (const auto y = difference(study, target, result_of(study, point)))
      curve.emplace_back(key, *y);
    else
      failed.push_back(key);
  }
  std::ranges::sort(curve);
  const auto same_key = [](const Point& a, const Point& b) { return a.first == b.first; };
  curve.erase(std::unique(curve.begin(), curve.end(), same_key), curve.end()); // a value may stand twice
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
    const double change = std::abs(curve_[i_ + 1].second - curve_[i_].second), size = std::abs(target_.value);
    tolerance_ = target_.tolerance.value_or(
        size > 0 ? std::max(usual_tolerance * std::min(size, change), rounding * size)
                 : usual_tolerance * change);
  }

  TargetSolution run(const std::filesystem::path& directory, const std::string& name,
                     const PointRunner& run_point) {
    for (const Point& end : {curve_[i_], curve_[i_ + 1]})
      if (std::abs(end.second) <= tolerance_) return found(end);
    while (solution_.runs < most_runs_of_target) {
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

/// Where a curve that comes nearer to the target ends beside points that failed: further runs between its end
/// and the next of these, halfway each time, until one passes the target or the gap is closed. `ended` says
/// where it was left then.
class Approach {
 public:
  Approach(const Study& study, const StudyTarget& target, std::vector<Point>& curve)
      : study_(study), target_(target), curve_(curve) {}

  /// From the curve's last point, or its first, towards the key at which a run failed. False when
  /// interrupted.
  bool run(bool forward, double failed, const std::filesystem::path& directory, const std::string& name,
           const PointRunner& run_point) {
    if (curve_.size() > 1 && !comes_nearer(forward)) return true;
    for (int n = 1; n <= most_runs_to_failure; ++n) {
      const Point last = end(forward, 0);
      const double key = (last.first + failed) / 2;
      const auto result = run_point(point_at(study_, key, directory / fmt::format("{}-end-{:02d}", name, n)));
      if (!result) return false;
      const auto y = difference(study_, target_, result);
      if (!y) {
        failed = key;
        continue;
      }
      curve_.insert(forward ? curve_.end() : curve_.begin(), Point{key, *y});
      if (last.second * *y <= 0) return true;
      if (!comes_nearer(forward)) break;
    }
    ended = fmt::format("; runs fail from between {:.6g} and {:.6g} on, where it is {:.6g}",
                        end(forward, 0).first, failed, end(forward, 0).second + target_.value);
    return true;
  }

  std::string ended;

 private:
  const Point& end(bool forward, std::size_t back) const {
    return forward ? curve_[curve_.size() - 1 - back] : curve_[back];
  }
  bool comes_nearer(bool forward) const {
    return std::abs(end(forward, 0).second) < std::abs(end(forward, 1).second);
  }

  const Study& study_;
  const StudyTarget& target_;
  std::vector<Point>& curve_;
};

} // namespace

std::vector<TargetSolution> solve_targets(const Study& study, const std::vector<StudyPoint>& points,
                                          const std::filesystem::path& directory, const PointRunner& run) {
  std::vector<TargetSolution> solutions;
  for (std::size_t t = 0; t < study.targets.size(); ++t) {
    std::vector<double> failed;
    std::vector<Point> curve = curve_of(study, study.targets[t], points, failed);
    std::ranges::sort(failed);
    std::string ends;
    for (const bool forward : {false, true}) {
      if (curve.empty()) break;
      const double end = forward ? curve.back().first : curve.front().first;
      const auto next =
          forward ? std::ranges::upper_bound(failed, end) : std::ranges::lower_bound(failed, end);
      if (forward ? next == failed.end() : next == failed.begin()) continue;
      Approach approach(study, study.targets[t], curve);
      if (!approach.run(forward, forward ? *next : *std::prev(next), directory,
                        fmt::format("{}{:02d}-{}", target_folder, t + 1, forward ? "above" : "below"), run))
        return solutions;
      ends += approach.ended;
    }
    const std::size_t before = solutions.size();
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      const bool passes = curve[i].second * curve[i + 1].second <= 0;
      const bool is_last = i + 2 == curve.size();
      if (!passes || (curve[i + 1].second == 0 && !is_last)) continue; // that point begins the next pair
      solutions.push_back(
          Search(study, t, curve, i)
              .run(directory, fmt::format("{}{:02d}", target_folder, solutions.size() + 1), run));
    }
    if (solutions.size() == before && !ends.empty())
      solutions.push_back({.target = t, .problem = "it is not reached by the values that run" + ends});
  }
  return solutions;
}

std::vector<std::string> target_lines(const Study& study, const std::vector<StudyPoint>& points,
                                      const Collected& collected,
                                      const std::vector<TargetSolution>& solutions) {
  std::vector<std::string> lines;
  for (std::size_t t = 0; t < study.targets.size(); ++t) {
    const StudyTarget& target = study.targets[t];
    const std::string& quantity_unit = collected.units[study.column(target.quantity)];
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
    if (!any)
      lines.push_back(fmt::format(
          "{}: {}: between no two points beside each other does the quantity pass it (where it turns back "
          "between two, more points find it)",
          wanted, not_within));
  }
  return lines;
}

} // namespace dielast::cases
