// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/loads/load_text.hpp"

#include "post/engineering.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::cases {

std::string load_text(const fem::Model& model, const fem::LoadPath& path, const fem::State& at, double s,
                      bool timed) {
  fem::State begin = at;
  if (timed)
    path.before(begin, 0); // a load may jump there
  else
    path.apply(begin, 0);
  std::string text;
  double largest = 0;
  for (std::size_t e = 0; e < at.voltage.size(); ++e) {
    const bool isolated = fem::is_isolated(at.supply[e]);
    const double from = isolated ? begin.charge[e] : begin.voltage[e];
    const double to = isolated ? at.charge[e] : at.voltage[e];
    if (std::abs(to - from) <= largest) continue;
    largest = std::abs(to - from);
    const bool chamber = e >= model.electrodes.size();
    const char* unit = chamber ? (isolated ? "m^3" : "Pa") : (isolated ? "C" : "V");
    text = post::engineering(to, unit, post::Ratio::plain, 5);
  }
  if (!text.empty()) return text;
  return s > 0 ? fmt::format("load factor {:.5g}", s) : "the beginning of the step";
}

} // namespace dielast::cases
