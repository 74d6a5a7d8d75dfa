// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/fit_spec.hpp"
#include "cases/text/diagnostics.hpp"
#include "cases/text/tree.hpp"

namespace dielast::cases {

/// Reads the file of a test into test.measured. `table` is the test as written and `path` its name in
/// messages, both for `wrong`: no such file or column, no unit of stress, fewer than two rows, text or gaps,
/// a stretch that is not positive, a time that does not grow, no stress at all, and, with `needs_time`
/// (the material has branches), neither time nor rate.
void load_test(FitTest& test, const std::filesystem::path& folder, bool needs_time, const Node& table,
               const std::string& path, std::vector<Diagnostic>& wrong);

} // namespace dielast::cases
