// SPDX-License-Identifier: GPL-3.0-or-later
// What happened on one discretisation, and whether it does on others.
#include "cases/results/error_estimate.hpp"
#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dielast::cases {

namespace {

/// Rises over one element within which a singular extreme reaches a limit on a finer mesh.
constexpr double reach = 4;

/// What the extreme's estimate tells of the event; empty when the event is certain or out of reach.
std::string threshold_remark(const Quantity& quantity, double value, double rise,
                             const ErrorEstimate& estimate, double limit, const std::string& unit) {
  if (estimate.singular && std::abs(value - limit) < reach * rise)
    return fmt::format("depends on the mesh: {} ({}) grows as the mesh is refined", quantity.name,
                       post::engineering(value, unit));
  if (estimate.error && std::abs(value - limit) <= *estimate.error)
    return fmt::format("depends on the mesh: {} is {} ± {}", quantity.name, post::engineering(value, unit),
                       post::engineering(*estimate.error, unit, post::Ratio::plain, 2));
  return "";
}

constexpr double same_voltage = 1e-9; ///< of loads that are no voltages

} // namespace

bool is_singular_there(const Case& one, const std::string& limit,
                       const std::vector<ErrorEstimate>& estimates) {
  for (const Threshold& threshold : thresholds)
    for (std::size_t q = 0; threshold.kind == limit && q < estimates.size(); ++q) {
      const Quantity& quantity = one.quantities[q];
      if (quantity.kind->extreme && quantity.of == threshold.field && quantity.extreme == threshold.extreme &&
          estimates[q].singular)
        return true;
    }
  return false;
}

std::vector<EventRemark> event_remarks(const Case& one, const Device& device, const Solution& own,
                                       const std::vector<Solution>& others,
                                       const std::vector<ErrorEstimate>& estimates) {
  const double smallest = smallest_stress(one);
  std::vector<EventRemark> remarks;
  for (const Threshold& threshold : thresholds)
    for (std::size_t q = 0; q < one.quantities.size(); ++q) {
      const Quantity& quantity = one.quantities[q];
      if (!quantity.kind->extreme || quantity.of != threshold.field ||
          quantity.extreme != threshold.extreme || !quantity.at.empty() ||
          !std::isfinite(own.farthest[q].value) ||
          ((device.tension_field || device.bears_compression) && threshold.kind == "loss of tension"))
        continue;
      const auto [value, rise] = own.farthest[q];
      const bool rounding = std::abs(value) < smallest && estimates[q].error.value_or(0) < smallest;
      if (rounding && threshold.kind == "loss of tension") continue; // as across a rod
      std::string remark = threshold_remark(quantity, value, rise, estimates[q], threshold.limit,
                                            unit_of(quantity, one.quantities));
      if (remark.empty()) continue;
      if (!own.events.contains(std::string(threshold.kind))) remark = "not on this mesh, but it " + remark;
      remarks.push_back({std::string(threshold.kind), std::move(remark)});
      break;
    }
  for (const char* kind : {"loss of tension", "breakdown", "wall yield", "wall contact"}) {
    if (std::ranges::find(remarks, kind, &EventRemark::kind) != remarks.end()) continue;
    const bool here = own.events.contains(kind);
    const auto different =
        std::ranges::find_if(others, [&](const Solution& s) { return s.events.contains(kind) != here; });
    if (different != others.end())
      remarks.push_back({kind, fmt::format("depends on the mesh: {}, {} with {}", here ? "here" : "not here",
                                           here ? "not" : "but", size_text(different->size))});
  }
  return remarks;
}

EventRemark remark_on_end(const Case& one, const Solution& own, const std::vector<Solution>& others,
                          OrderRange orders) {
  const double volts = own.last.largest_voltage();
  const auto step = std::ranges::find(one.steps, own.last.step, &Step::name);
  const bool charged =
      std::ranges::any_of(one.drives, [](const auto& d) { return d.second.charge.has_value(); });
  const bool led = step == one.steps.end() || step->kind == StepKind::voltage || // else the voltage follows
                   (step->kind == StepKind::transient && !charged);
  const bool by_voltage =
      led && std::ranges::any_of(others, [&](const Solution& other) {
        return std::abs(other.last.largest_voltage() - volts) > same_voltage * std::abs(volts);
      });
  const auto load = [by_voltage](const Solution& solution) {
    return Sampled{solution.size, by_voltage ? solution.last.largest_voltage() : solution.last.load_factor};
  };
  std::vector<Sampled> sampled;
  for (const Solution& other : others) sampled.push_back(load(other));
  const double value = load(own).value;
  const double error =
      std::max(*estimate_error(load(own), sampled, orders, 0).error, margin_accuracy * std::abs(value));
  const std::string unit = by_voltage ? "V" : "1";
  return {"limit point", fmt::format("depends on the mesh: {}{} ± {}{}", by_voltage ? "" : "load factor ",
                                     post::engineering(value, unit, post::Ratio::plain, 5),
                                     post::engineering(error, unit, post::Ratio::plain, 2),
                                     by_voltage ? "" : fmt::format(" of step \"{}\"", own.last.step))};
}

} // namespace dielast::cases
