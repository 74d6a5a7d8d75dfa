#pragma once

#include "cases/case.hpp"

#include <string>

namespace dielast::cases {

/// SI unit of a quantity's values; "1" for a pure number.
std::string unit_of(const Quantity& quantity);

} // namespace dielast::cases
