#pragma once

#include "cases/study_points.hpp"
#include "post/report.hpp"

namespace dielast::cases {

/// study.csv: one row per point in the grid's order: the axes as the user wrote them, the collected
/// quantities in SI, exit code, kinds of events, message.
std::string study_table(const Study& study, const std::vector<StudyPoint>& points);

/// The study's report: its plots and one row per point.
/// Where the quantities of the targets have their values, one line each: "stiffness = 160 N/m at
/// film.material.shear_modulus = 43.54 kPa". Between the points by polynomials through up to four of them.
std::vector<std::string> target_lines(const Study& study, const std::vector<StudyPoint>& points);

post::Report study_report(const Study& study, const std::vector<StudyPoint>& points);

} // namespace dielast::cases
