// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/analyses/course.hpp"

#include <cmath>
#include <limits>

namespace dielast::cases {

namespace {

double peak(References& references, const Quantity& quantity, double now) {
  double& peak = references.try_emplace(quantity.name, now).first->second;
  const bool beyond = quantity.extreme == post::Extreme::minimum ? now < peak : now > peak;
  if (beyond || std::isnan(peak)) peak = now;
  return peak;
}

double mean(References& references, const Quantity& quantity, double now, double time) {
  if (!references.contains(quantity.name)) {
    if (!quantity.since.empty()) return std::numeric_limits<double>::quiet_NaN();
    begin_mean(references, quantity, time);
  }
  double& integral = references.at(quantity.name);
  double& last = references.try_emplace(quantity.name + " last", now).first->second;
  double& last_time = references.at(quantity.name + " last time");
  double& known = references.at(quantity.name + " known"); // s
  if (!std::isnan(last) && !std::isnan(now)) {
    integral += (last + now) / 2 * (time - last_time);
    known += time - last_time;
  }
  last = now;
  last_time = time;
  return known > 0 ? integral / known : now;
}

} // namespace

double value_so_far(References& references, const Quantity& quantity, double now, double time) {
  return quantity.kind == QuantityKind::mean ? mean(references, quantity, now, time)
                                             : peak(references, quantity, now);
}

void begin_mean(References& references, const Quantity& quantity, double time) {
  references[quantity.name] = references[quantity.name + " known"] = 0;
  references[quantity.name + " last time"] = time;
  references.erase(quantity.name + " last");
}

} // namespace dielast::cases
