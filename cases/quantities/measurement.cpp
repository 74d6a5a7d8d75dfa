// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/quantities/measurement.hpp"

#include "cases/devices/pins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::cases {

Measured::Measured(const Device& device, fem::Equilibrium& solver, const fem::State& at,
                   const fem::EnergyBalance& balance, const post::WantedScalars& scalars,
                   const fem::Holding* held)
    : equilibrium(solver), upright_(upright(device, at)), state(upright_ ? *upright_ : at),
      samples(device.model.sample(state)), extremes(samples, scalars),
      charges(device.model.charges(state, false)), energy(balance), held_(held) {}

const Eigen::VectorXd& Measured::reaction() const {
  if (reaction_.size() == 0)
    reaction_ = fem::reactions(equilibrium.model(), state, held_ ? *held_ : fem::holding(equilibrium, state));
  return reaction_;
}

namespace {

/// Whether it is the magnitude of a change of a vector, which the magnitudes before and after do not tell.
bool is_magnitude_since(const Quantity& quantity) {
  return quantity.kind->directed && !quantity.along && !quantity.since.empty();
}

std::string name_of_component(std::size_t axis) { return std::string("along ") + "xyz"[axis]; }

} // namespace

Measurement::Measurement(const Case& one, const Device& device) : case_(one), device_(device) {
  prepare();
  begin_peaks();
}

void Measurement::begin_peaks() { peaks.assign(case_.quantities.size(), {no_value, 0}); }

void Measurement::begin(const Quantity& course, double time) {
  KeptNumbers& own = kept[course.name];
  course.kind->begin(own, time);
  for (const char* sum : {"rises", "rises known"}) own.erase(sum);
}

void Measurement::prepare() {
  const fem::State initial = device_.model.initial_state();
  const fem::Samples drawn = device_.model.sample(initial);
  shapes_.clear(), probes_.clear(), drawn_.clear(), magnitudes_.clear();
  int written = 0; // by the user, who counts no others
  for (const Quantity& quantity : case_.quantities) {
    written += !quantity.standard;
    const Probing probing{quantity, case_, device_, drawn, fmt::format("quantity[{}]", written)};
    const QuantityKind& kind = *quantity.kind;
    shapes_.push_back(kind.shape ? kind.shape(probing) : nullptr);
    probes_.push_back(kind.probe ? kind.probe(probing) : nullptr);
    drawn_.push_back(kind.since ? shapes_.back()(initial) : no_value);
    if (!is_magnitude_since(quantity)) continue;
    Components& components = magnitudes_[shapes_.size() - 1];
    for (std::size_t c = 0; c < 3; ++c) {
      Quantity& one = components.quantities[c] = quantity;
      one.along = static_cast<int>(c);
      components.shapes[c] = kind.shape({one, case_, device_, drawn, probing.path});
    }
  }
}

double Measurement::value(std::size_t number, const Measured& measured) const {
  const Quantity& quantity = case_.quantities[number];
  if (probes_[number]) return probes_[number](measured);
  if (!shapes_[number]) return no_value;
  const double now = shapes_[number](measured.state);
  if (!quantity.kind->since) return now;
  if (quantity.since.empty()) return quantity.kind->since(now, drawn_[number]);
  if (const auto components = magnitudes_.find(number); components != magnitudes_.end()) {
    Eigen::Vector3d moved;
    for (std::size_t c = 0; c < 3; ++c)
      moved[static_cast<Eigen::Index>(c)] = components->second.shapes[c](measured.state) -
                                            kept_of(quantity, name_of_component(c)).value_or(no_value);
    return moved.norm();
  }
  const auto then = kept_of(quantity, "value");
  return then ? quantity.kind->since(now, *then) : no_value;
}

std::vector<double> Measurement::all(const Measured& measured) {
  std::vector<double> values;
  for (std::size_t q = 0; q < case_.quantities.size(); ++q) values.push_back(value(q, measured));
  for (std::size_t q = 0; q < values.size(); ++q) {
    const Quantity& quantity = case_.quantities[q];
    if (quantity.kind->so_far) {
      const double now = values[subject(quantity)], time = measured.state.time;
      values[q] = quantity.kind->so_far(kept[quantity.name], quantity, now, time);
      note_rise_of_course(quantity, now, values[q], measured);
    } else if (quantity.kind->extreme && quantity.at.empty() && !std::isnan(values[q])) {
      note_farthest(quantity, values[q], measured);
    }
  }
  constexpr double same = 1 + 1e-9; // of two that rounding makes different the first
  for (std::size_t q = 0; q < values.size(); ++q)
    if (!std::isnan(values[q]) && !(std::abs(values[q]) <= same * std::abs(peaks[q].value)))
      peaks[q] = {values[q], measured.state.time};
  return values;
}

std::vector<std::string> Measurement::scalars() const {
  std::vector<std::string> names;
  for (const Quantity& quantity : case_.quantities)
    if (quantity.kind->extreme && std::ranges::count(names, quantity.of) == 0) names.push_back(quantity.of);
  return names;
}

std::optional<double> Measurement::kept_of(const Quantity& quantity, const std::string& name) const {
  const auto all = kept.find(quantity.name);
  if (all == kept.end()) return {};
  const auto found = all->second.find(name);
  return found == all->second.end() ? std::nullopt : std::optional(found->second);
}

std::size_t Measurement::subject(const Quantity& quantity) const {
  const auto found = std::ranges::find(case_.quantities, quantity.of, &Quantity::name);
  return static_cast<std::size_t>(found - case_.quantities.begin());
}

/// An extreme of a field where it was farthest, and how steep it was there.
void Measurement::note_farthest(const Quantity& quantity, double now, const Measured& measured) {
  KeptNumbers& own = kept[quantity.name];
  const auto [farthest, is_first] = own.try_emplace("farthest", now);
  const double before = farthest->second;
  if (!is_first && !(quantity.extreme == post::Extreme::maximum ? now > before : now < before)) return;
  farthest->second = now;
  own["rise"] = rise_of(quantity, measured);
}

/// How steep the subject of a course was: of a peak where it had it, of a mean over time the mean.
void Measurement::note_rise_of_course(const Quantity& quantity, double now, double value,
                                      const Measured& measured) {
  const Quantity& extreme = case_.quantities[subject(quantity)];
  if (!extreme.kind->extreme || std::isnan(now) || std::isnan(value)) return;
  KeptNumbers& own = kept[quantity.name];
  if (const auto known = own.find("known"); known != own.end()) {
    const double rise = rise_of(extreme, measured);
    double &sum = own["rises"], &before = own["rises known"];
    sum += (known->second - std::exchange(before, known->second)) * rise;
    own["rise"] = known->second > 0 ? sum / known->second : rise;
  } else if (now == value) {
    own["rise"] = rise_of(extreme, measured);
  }
}

double Measurement::rise_of(const Quantity& quantity, const Measured& measured) const {
  const auto extremum = measured.extremes.find(quantity.of, quantity.extreme);
  return extremum ? post::rise_at(*extremum, measured.samples, device_.mesh, device_.film_parts, quantity.of)
                  : 0;
}

double Measurement::rise(std::size_t number, const Measured& measured) const {
  const Quantity& each = case_.quantities[number];
  if (!each.kind->so_far) return each.kind->extreme ? rise_of(each, measured) : 0;
  return kept_of(each, "rise").value_or(0);
}

std::vector<Farthest> Measurement::farthest() const {
  std::vector<Farthest> all;
  for (const Quantity& quantity : case_.quantities) {
    const auto value = kept_of(quantity, "farthest");
    all.push_back(value ? Farthest{*value, kept_of(quantity, "rise").value_or(0)} : Farthest{});
  }
  return all;
}

void Measurement::step_ended(const std::string& step, const Measured& measured) {
  // Courses are those of the steps that a case has: what a film does to settle before the first is none of
  // it.
  const bool is_own = std::ranges::count(case_.steps, step, &Step::name) > 0;
  if (!is_own) begin_peaks();
  for (const Quantity& quantity : case_.quantities)
    if (!is_own && quantity.since.empty() && quantity.kind->begin) begin(quantity, measured.state.time);
  for (std::size_t q = 0; q < case_.quantities.size(); ++q) {
    const Quantity& quantity = case_.quantities[q];
    if (quantity.since != step || step.empty()) continue;
    if (quantity.kind->begin)
      begin(quantity, measured.state.time);
    else
      kept[quantity.name]["value"] = shapes_[q](measured.state);
    if (const auto components = magnitudes_.find(q); components != magnitudes_.end())
      for (std::size_t c = 0; c < 3; ++c)
        kept[quantity.name][name_of_component(c)] = components->second.shapes[c](measured.state);
  }
}

Eigen::VectorXd response_row(const Case& one, const Device& device, const fem::State& state,
                             const Quantity& quantity) {
  const fem::Samples none;
  return device.model.dofs.jacobian(state).transpose() *
         quantity.kind->gradient({quantity, one, device, none, ""}, state);
}

} // namespace dielast::cases
