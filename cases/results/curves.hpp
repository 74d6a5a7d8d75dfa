// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/runs/recorder.hpp"
#include "post/pictures/plot.hpp"
#include "post/pictures/report_tables.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dielast::cases {

post::Ratio ratio_of(const Quantity& quantity);

/// The largest magnitude that a unit's numbers have in the run.
std::map<std::string, double> sizes_of_units(const Case& one, const Journal& journal);
inline constexpr double round_off = 1e-9; ///< of the largest number of the same unit in the run

/// Numbers of the quantities: the user's own before the standard ones.
std::vector<std::size_t> users_first(const Case& one);

/// The peak of the quantity of number `q` in a run in time; nothing where that is within 1 % of what it is at
/// the end.
std::optional<post::Peak> peak_of(const Case& one, std::size_t q, const std::vector<post::Peak>& peaks,
                                  const Journal& journal);

/// Every quantity against time, where it passes; otherwise against the largest voltage from where it rises,
/// or against the load factor of the last step in a run without voltage; strains in one plot. Quantities that
/// have hardly any values there, or that do not change beyond round-off, are `left_out` by their names.
std::vector<post::Plot> curves(const Case& one, const Journal& journal, std::vector<std::string>& left_out);

} // namespace dielast::cases
