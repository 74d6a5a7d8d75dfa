// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/studies/study_points.hpp"
#include "post/pictures/report.hpp"

namespace dielast::cases {

/// study.csv: one row per point in the grid's order: the axes as the user wrote them, the collected
/// quantities in SI, exit code, kinds of events, message.
std::string study_table(const Study& study, const std::vector<StudyPoint>& points);

/// The study's report: what its targets have found, its plots and one row per point.
post::Report study_report(const Study& study, const std::vector<StudyPoint>& points,
                          const std::vector<std::string>& targets);

} // namespace dielast::cases
