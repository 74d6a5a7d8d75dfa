// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/schema.hpp"

#include <fmt/format.h>

namespace dielast::cases {

inline constexpr const char* driven_meaning = "electrodes whose sources swing together, by 1 V each; without "
                                              "it all that [drive] gives a voltage, or all "
                                              "when it gives none. Others that are isolated keep their "
                                              "charges";

/// Keys of a sweep over frequencies; `purpose` ends their meanings, `from` and `to` are defaults.
template<class T>
std::vector<Key> sweep_keys(Sweep T::*sweep, const std::string& purpose, std::string from, std::string to) {
  const auto part = [sweep](auto Sweep::*member) {
    return to_part<T>([ sweep, member ](auto& object) -> auto& { return (object.*sweep).*member; });
  };
  return {
      measure("from", "Hz", part(&Sweep::from), "lowest frequency" + purpose)
          .at_least(1e-9)
          .otherwise(std::move(from)),
      measure("to", "Hz", part(&Sweep::to), "highest frequency" + purpose).above(0).otherwise(std::move(to)),
      integer("points", part(&Sweep::points), "number of frequencies, at equal ratios")
          .at_least(2)
          .at_most(10000)
          .otherwise("121"),
  };
}

inline std::optional<Conflict> sweep_conflict(const Sweep& sweep) {
  if (sweep.from < sweep.to) return std::nullopt;
  return Conflict{
      "from",
      fmt::format("must be below the highest frequency: to is {:.6g} Hz, as it is written or by default",
                  sweep.to)};
}

} // namespace dielast::cases
