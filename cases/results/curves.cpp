// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/results/curves.hpp"

#include "cases/case/quantities.hpp"
#include "cases/runs/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

namespace dielast::cases {
namespace {

/// The state in which the first step that takes time begins.
std::vector<post::StepRecord>::const_iterator
before_time_passes(const std::vector<post::StepRecord>& records) {
  const auto later =
      std::ranges::find_if(records, [](const post::StepRecord& record) { return record.time > 0; });
  const auto first = std::ranges::find(records, later->step, &post::StepRecord::step);
  return first == records.begin() ? first : first - 1;
}

} // namespace

post::Ratio ratio_of(const Quantity& quantity) {
  return quantity.kind->relative ? post::Ratio::percent : post::Ratio::plain;
}

std::map<std::string, double> sizes_of_units(const Case& one, const Journal& journal) {
  std::map<std::string, double> sizes;
  for (const auto& row : journal.values)
    for (std::size_t q = 0; q < one.quantities.size(); ++q)
      if (std::isfinite(row[q])) {
        double& size = sizes[unit_of(one.quantities[q], one.quantities)];
        size = std::max(size, std::abs(row[q]));
      }
  if (const auto stress = sizes.find("Pa"); stress != sizes.end()) // of a free film rounding alone
    stress->second = std::max(stress->second, smallest_stress(one) / round_off);
  return sizes;
}

std::vector<std::size_t> users_first(const Case& one) {
  std::vector<std::size_t> order(one.quantities.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t q) { return !one.quantities[q].standard; });
  return order;
}

std::optional<post::Peak> peak_of(const Case& one, std::size_t q, const std::vector<post::Peak>& peaks,
                                  const Journal& journal) {
  constexpr double notable = 1.01; // of the last value
  const auto& records = journal.records;
  if (records.empty() || records.back().time == 0 || !one.quantities[q].at.empty()) return std::nullopt;
  const double last = journal.values.back()[q];
  const double least = std::isfinite(last) ? notable * std::abs(last) : 0;
  if (!(std::abs(peaks[q].value) > least)) return std::nullopt;
  return peaks[q];
}

std::vector<post::Plot> curves(const Case& one, const Journal& journal, std::vector<std::string>& left_out) {
  std::vector<post::Plot> plots;
  const auto sizes = sizes_of_units(one, journal);
  std::map<std::string, std::size_t> by_label;
  const auto& records = journal.records;
  const auto charged = std::find_if(records.begin(), records.end(), [](const post::StepRecord& record) {
    return record.largest_voltage() != 0;
  });
  const bool electric = charged != records.end();
  const bool timed = records.back().time > 0;
  const auto begin = timed ? before_time_passes(records)
                     : electric
                         ? charged - (charged != records.begin())
                         : std::find_if(records.begin(), records.end(), [&](const post::StepRecord& record) {
                             return record.step == records.back().step;
                           });
  const std::string x_label = timed ? "time [s]"
                              : electric
                                  ? (one.electrodes.size() > 1 ? "largest voltage [kV]" : "voltage [kV]")
                                  : fmt::format("load factor of \"{}\"", begin->step);
  for (const std::size_t q : users_first(one)) {
    const Quantity& quantity = one.quantities[q];
    if (!quantity.at.empty()) continue;
    double size = 0;
    for (const auto& row : journal.values)
      if (std::isfinite(row[q])) size = std::max(size, std::abs(row[q]));
    const auto scaled = post::scaled_unit(size, unit_of(quantity, one.quantities), ratio_of(quantity));
    const bool strain = quantity.kind->relative;
    post::Series series{.label = quantity.name,
                        .style = records.size() > 100 ? post::Series::Style::line
                                                      : post::Series::Style::line_and_points};
    for (auto r = static_cast<std::size_t>(begin - records.begin()); r < records.size(); ++r) {
      series.x.push_back(timed      ? records[r].time
                         : electric ? records[r].largest_voltage() / 1000
                                    : records[r].load_factor);
      series.y.push_back(journal.values[r][q] * scaled.factor);
    }
    std::vector<double> values;
    for (const double value : series.y)
      if (std::isfinite(value)) values.push_back(value / scaled.factor);
    const auto ends = std::ranges::minmax_element(values);
    if (values.size() < std::max<std::size_t>(2, series.y.size() / 10) ||
        !(*ends.max - *ends.min > round_off * sizes.at(unit_of(quantity, one.quantities)))) {
      left_out.push_back(quantity.name);
      continue;
    }
    const std::string label = strain                ? "strain [%]"
                              : scaled.unit.empty() ? quantity.name
                                                    : fmt::format("{} [{}]", quantity.name, scaled.unit);
    const auto [place, fresh] = by_label.try_emplace(label, plots.size());
    if (fresh) {
      std::string heading = strain ? "strains" : meaning_of(quantity);
      heading[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(heading[0])));
      plots.push_back({.title = strain ? "strains" : quantity.name,
                       .x_label = x_label,
                       .y_label = label,
                       .heading = std::move(heading)});
    }
    plots[place->second].series.push_back(std::move(series));
  }
  return plots;
}

} // namespace dielast::cases
