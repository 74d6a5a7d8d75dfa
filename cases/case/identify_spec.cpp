// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/identify_spec.hpp"

#include <fmt/format.h>

namespace dielast::cases {

std::string Unknown::assignment(double value) const {
  return fmt::format("{}={}{}{}", key, value, unit.empty() ? "" : " ", unit);
}

const char* unit_of(MeasuredResponse response) {
  switch (response) {
  case MeasuredResponse::displacement:
    return "m/V^2";
  case MeasuredResponse::impedance:
    return "Ohm";
  case MeasuredResponse::admittance:
    return "S";
  case MeasuredResponse::none:
    break;
  }
  return "1";
}

std::size_t Identification::fitted_numbers() const {
  std::size_t numbers = 0;
  for (const DeviceTest& test : tests)
    if (!test.predict) numbers += test.x.size() * (test.is_response() ? 2 : 1);
  return numbers;
}

} // namespace dielast::cases
