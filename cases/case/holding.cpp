// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/holding.hpp"

#include <algorithm>
#include <utility>

namespace dielast::cases {

Holding holding_in(const Case& one, const std::vector<Step>& steps, int step) {
  step = std::min(step, static_cast<int>(steps.size()) - 1);
  while (step > 0 && steps[static_cast<std::size_t>(step)].is_analysis()) --step;
  const auto number = [&](const std::string& name) {
    return static_cast<int>(std::ranges::find(steps, name, &Step::name) - steps.begin());
  };
  Holding holding;
  for (const Support& support : one.supports)
    holding.supports.push_back((support.from.empty() || step >= number(support.from)) &&
                               (support.until.empty() || step <= number(support.until)));
  const bool moves = step >= 0 && steps[static_cast<std::size_t>(step)].inertia;
  holding.pins = !moves && is_free(one, holding.supports);
  return holding;
}

bool holds_in_any(const Case& one, std::size_t support, std::initializer_list<StepKind> kinds) {
  for (std::size_t s = 0; s < one.steps.size(); ++s)
    if (std::ranges::count(kinds, one.steps[s].kind) > 0 &&
        holding_in(one, one.steps, static_cast<int>(s)).supports[support] != 0)
      return true;
  return false;
}

Case held_by(Case one, const Holding& holding) {
  std::vector<Support> all = std::exchange(one.supports, {});
  for (std::size_t i = 0; i < all.size(); ++i)
    if (holding.supports[i])
      one.supports.push_back(std::move(all[i]));
    else if (all[i].holds_some_rotations())
      one.places_of_spins.push_back(all[i].place);
  one.pinned = holding.pins;
  return one;
}

bool is_free(const Case& one, const std::vector<char>& supports) {
  return std::ranges::count(supports, 1) == 0 && one.bodies.empty() && !one.table;
}

} // namespace dielast::cases
