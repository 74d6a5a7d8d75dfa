// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/fit_spec.hpp"
#include "cases/language/schema.hpp"
#include "cases/text/tree.hpp"

#include <filesystem>

namespace dielast::cases {

/// The parts of the table of keys that a fit file has; what a device needs of its film is not required.
Section fit_schema();

/// Reads and validates a fit file with the tables that it names. Every error is found before any is reported.
/// Throws FileError or CaseError.
Fit read_fit(const std::filesystem::path& path);

/// The task for the solver; the names of `fit.parameters` are known.
FitTask fit_task(const Fit& fit);

/// Throws CaseError when the tree is that of a fit, for commands that want a device.
void refuse_fit(const Node& tree);

} // namespace dielast::cases
