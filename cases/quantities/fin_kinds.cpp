// SPDX-License-Identifier: GPL-3.0-or-later
// What the fluid around a fin does with it.
#include "cases/quantities/probing.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

std::vector<Key> fin_keys() { return {of_key("the fin").refers_to(Reference::fin)}; }

template<double FinLoad::*part>
Probe of_fin(const Probing& probing) {
  const auto fin = std::ranges::find(probing.one.fins, probing.quantity.of, &Fin::name);
  const auto number = static_cast<std::size_t>(fin - probing.one.fins.begin());
  return [&points = probing.device.fins[number], &model = probing.device.model](const Measured& measured) {
    return load_on(points, model, measured.state).*part;
  };
}

} // namespace

std::vector<QuantityKind> fin_kinds() {
  return {
      {.word = "fin force",
       .meaning = "of the fluid on a fin, across it as drawn (N)",
       .unit = "N",
       .keys = fin_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format("force of the fluid on {}, across it{}", q.of, at_words(q));
           },
       .probe = of_fin<&FinLoad::force>},
      {.word = "thrust",
       .meaning = "of the fluid on a fin, along it from its trailing end to its front (N)",
       .unit = "N",
       .keys = fin_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format("force of the fluid on {}, forward along it{}", q.of, at_words(q));
           },
       .probe = of_fin<&FinLoad::thrust>},
      {.word = "fin power",
       .meaning = "that a fin gives to the fluid (W)",
       .unit = "W",
       .keys = fin_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format("power that {} gives to the fluid{}", q.of, at_words(q));
           },
       .probe = of_fin<&FinLoad::power>},
  };
}

} // namespace dielast::cases
