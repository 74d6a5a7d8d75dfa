// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace dielast::fem {

/// Memory that this process can have without taking it from others, bytes; infinity where the system does not
/// say it.
double available_memory();

/// Throws std::runtime_error, which says how much `what` takes and how much there is, where that is less:
/// Linux gives any memory away, and ends a process that uses what there is not.
void require_memory(double bytes, const std::string& what, double available = available_memory());

} // namespace dielast::fem
