#pragma once

#include "cases/case.hpp"

#include <ostream>

namespace dielast::cases {

/// Writes the case as a case file with every default explicit, in SI, and the program's version in a comment.
/// Reading it gives the same case.
void write_resolved(const Case& one, std::ostream& out);

} // namespace dielast::cases
