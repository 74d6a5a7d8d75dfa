// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/studies/study_points.hpp"
#include "cases/studies/study_targets.hpp"
#include "post/pictures/report.hpp"

namespace dielast::cases {

/// study.csv: one row per point in the grid's order: what varies as numbers, with its unit in the header, the
/// collected quantities in SI, exit code, kinds of events, message.
std::string study_table(const Study& study, const std::vector<StudyPoint>& points,
                        const Collected& collected);

/// study.json: how many points reached their ends, where its targets lie (the varied key as it is written,
/// the quantity in SI), and its best points.
std::string study_json(const Study& study, const std::vector<StudyPoint>& points, const Collected& collected,
                       const std::vector<TargetSolution>& solutions);

/// The study's report: the answers to its questions, its plots and one row per point, which leads to the
/// point's own report.
post::Report study_report(const Study& study, const std::vector<StudyPoint>& points,
                          const Collected& collected, const std::vector<std::string>& answers);

} // namespace dielast::cases
