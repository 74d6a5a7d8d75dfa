#pragma once

#include "cases/case.hpp"

#include <ostream>
#include <string>

namespace dielast::cases {

/// Writes the case as a case file with every default explicit, in SI, and the program's version in a comment.
/// Reading it gives the same case.
void write_resolved(const Case& one, std::ostream& out);
std::string resolved_text(const Case& one);

} // namespace dielast::cases
