// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/studies/study_points.hpp"

namespace dielast::cases {

/// The index of the point that `best` asks for: of those that ran to their end and hold its bounds the one
/// with the largest or smallest value, the first of equal ones; nothing when no point holds them.
std::optional<std::size_t> best_point(const Study& study, const StudyBest& best, const Collected& collected);

/// One line for each of the study's questions: "largest eps_y with breakdown_ratio below 0.9: 31.2 % at
/// honeycomb.angle = 150 deg (point 7)", with the number of points that have no result.
std::vector<std::string> best_lines(const Study& study, const std::vector<StudyPoint>& points,
                                    const Collected& collected);

} // namespace dielast::cases
