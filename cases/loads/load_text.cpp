// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/loads/load_text.hpp"

#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases {

namespace {

constexpr double alike = 1e-9; ///< changes that differ by rounding
constexpr double drop = 1e-5;  ///< between a source and its electrode, that five digits show

} // namespace

std::string load_text(const fem::Model& model, const fem::LoadPath& path, const fem::State& at, double s,
                      bool timed) {
  fem::State begin = at;
  if (timed)
    path.before(begin, 0); // a load may jump there
  else
    path.apply(begin, 0);
  std::string text;
  double largest = alike;
  for (std::size_t e = 0; e < at.voltage.size(); ++e) {
    const bool isolated = fem::is_isolated(at.supply[e]);
    const double from = isolated ? begin.charge[e] : begin.voltage[e];
    const double to = isolated ? at.charge[e] : at.voltage[e];
    const double change = std::abs(to - from) / std::max(std::abs(from), std::abs(to)); // 0/0: none
    if (!(change > (1 + alike) * largest)) continue;
    largest = change;
    const bool chamber = model.ports[e].chamber.has_value();
    const char* unit = chamber ? (isolated ? "m^3" : "Pa") : (isolated ? "C" : "V");
    text = post::engineering(to, unit, post::Ratio::plain, 5);
    if (model.ports[e].circuit && !isolated && std::abs(at.source[e] - to) > drop * std::abs(to))
      text +=
          fmt::format(" (its source at {})", post::engineering(at.source[e], unit, post::Ratio::plain, 5));
  }
  if (!text.empty()) return text;
  return s > 0 ? fmt::format("load factor {:.5g}", s) : "the beginning of the step";
}

std::string endless_text(const std::string& step, double s, const fem::RampOptions& options) {
  return fmt::format(
      "step \"{}\" stopped at load factor {:.4g}: with more than {} increments for a tenth of it it "
      "would hardly end. A larger solver.time_tolerance or solver.smallest_increment makes them "
      "longer, or says where it fails{}",
      step, s, options.most_tries,
      options.inertia ? ". They follow every wave of what has a mass, film too, through which loads that "
                        "jump send waves that nothing but a viscosity damps; beside a heavy plate or "
                        "body film may be without density"
                      : "");
}

} // namespace dielast::cases
