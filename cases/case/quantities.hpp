// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "post/files/history.hpp"

#include <string>

namespace dielast::cases {

/// SI unit of a quantity's values; "1" for a pure number.
/// `all`: the quantities of the case, of which a peak needs another.
std::string unit_of(const Quantity& quantity, const std::vector<Quantity>& all);

/// A quantity in words, for a person who did not write the case.
std::string meaning_of(const Quantity& quantity);

/// Quantity by which a linear model responds: the named one, or the first of the first kind of those with a
/// gradient; null when there is none.
const Quantity* response_quantity(const Case& one, const std::string& name);

/// The kinds with a gradient in quotes, with `directed` behind those that need a direction:
/// "displacement", "angle" ... or "distance".
std::string response_kinds(const std::string& directed = "");

/// Column of an electrode's voltage; of its number.
std::string voltage_name(const Case& one, std::size_t electrode);

/// Columns of a run's history: load factor, time, voltages, the quantities, what the solver says.
std::vector<post::Column> history_columns(const Case& one);

} // namespace dielast::cases
