// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/holding.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {

std::vector<char> holding_in(const Case& one, const std::vector<Step>& steps, int step) {
  step = std::min(step, static_cast<int>(steps.size()) - 1);
  while (step > 0 && steps[static_cast<std::size_t>(step)].is_analysis()) --step;
  const auto number = [&](const std::string& name) {
    return static_cast<int>(std::ranges::find(steps, name, &Step::name) - steps.begin());
  };
  std::vector<char> holding;
  for (const Support& support : one.supports)
    holding.push_back((support.from.empty() || step >= number(support.from)) &&
                      (support.until.empty() || step <= number(support.until)));
  return holding;
}

bool is_free(const Case& one, const std::vector<char>& holding) {
  return std::ranges::count(holding, 1) == 0 && one.bodies.empty() && !one.table;
}

std::string borne_by_pins(std::string_view what) {
  return fmt::format(
      "nothing holds the device: the nodes that keep it from drifting bear here its {}; hold it with "
      "[[support]]",
      what);
}

} // namespace dielast::cases
