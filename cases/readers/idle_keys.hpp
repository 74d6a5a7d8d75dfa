// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/text/tree.hpp"

namespace dielast::cases {

/// A warning for every key and section that is written and does nothing in this case, by the conditions of
/// the schema. A key that says what holds anyway, its default, is no mistake. The tree is that of the case,
/// with what its template has brought.
std::vector<Diagnostic> idle_keys(const Node& tree, const Case& one);

} // namespace dielast::cases
