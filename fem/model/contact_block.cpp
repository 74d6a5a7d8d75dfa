// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/contact_block.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace dielast::fem {

namespace {

template<class Use>
void for_each_contact(const Model& model, const Use& use) {
  for (const auto& block : model.blocks)
    if (const auto* contact = dynamic_cast<const ContactBlock*>(block.get())) use(*contact);
}

} // namespace

double free_way(const Model& model, const State& from, const State& to) {
  double part = 1;
  for_each_contact(model, [&](const ContactBlock& one) { part = std::min(part, one.free_way(from, to)); });
  return part;
}

bool edges_meet(const Model& model, const State& state) {
  bool any = false;
  for_each_contact(model, [&](const ContactBlock& one) { any = any || one.edges_meet(state); });
  return any;
}

bool apply_freely(const Model& model, State& state, const std::function<void(State&)>& apply) {
  bool touches = false;
  for_each_contact(model, [&](const ContactBlock&) { touches = true; });
  if (!touches) {
    apply(state);
    return true;
  }
  const State before = state;
  apply(state);
  return free_way(model, before, state) == 1;
}

double contact_force(const Model& model, const State& state, std::string_view place) {
  double sum = 0;
  for_each_contact(model, [&](const ContactBlock& one) {
    if (place.empty() || one.is_between(place)) sum += one.contact_force(state);
  });
  return sum;
}

std::vector<double> contact_pressure(const Model& model, const State& state) {
  const std::size_t nodes = state.displacement.size();
  std::vector<double> pressure(nodes, 0);
  bool may_touch = false;
  for_each_contact(model, [&](const ContactBlock& one) { // each has the whole area of its surfaces
    NodalPressure own{std::vector<double>(nodes, 0), std::vector<double>(nodes, 0)};
    one.add_pressure(state, own);
    for (std::size_t n = 0; n < nodes; ++n) {
      if (!(own.area[n] > 0)) continue;
      pressure[n] += own.force[n] / own.area[n];
      may_touch = true;
    }
  });
  return may_touch ? pressure : std::vector<double>();
}

double friction_heat(const Model& model, const State& state) {
  double sum = 0;
  for_each_contact(model, [&](const ContactBlock& one) { sum += one.friction_heat(state); });
  return sum;
}

bool has_friction(const Model& model) {
  bool any = false;
  for_each_contact(model, [&](const ContactBlock& one) { any = any || one.has_friction(); });
  return any;
}

double friction_in_use(const Model& model, const State& state) {
  double part = 0;
  for_each_contact(model,
                   [&](const ContactBlock& one) { part = std::max(part, one.friction_in_use(state)); });
  return part;
}

bool is_pressed_first(const Model& model, const State& state) {
  bool any = false;
  for_each_contact(model, [&](const ContactBlock& one) { any = any || one.is_pressed_first(state); });
  return any;
}

double bound_friction(const Model& model, State& state, bool solved, double eased) {
  const std::vector<double>& before = state.history->now;
  History bound = *state.history;
  for_each_contact(model,
                   [&](const ContactBlock& one) { one.bound_friction(state, solved, eased, bound.now); });
  double change = 0, largest = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (bound.now[i] == before[i]) continue;
    change = std::max(change, std::abs(bound.now[i] - before[i]));
    largest = std::max({largest, bound.now[i], before[i]});
  }
  state.history = std::make_shared<const History>(std::move(bound));
  return change > 0 ? change / largest : 0;
}

} // namespace dielast::fem
