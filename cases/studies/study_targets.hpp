// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/studies/study_points.hpp"

#include <functional>

namespace dielast::cases {

/// Where the quantity of a target has its value.
struct TargetSolution {
  std::size_t target = 0; ///< its number in the study
  double key = 0;         ///< value of the varied key, in the unit in which it is written
  double value = 0;       ///< of the quantity there, SI, as run
  int runs = 0;           ///< beside those of the grid
  std::string problem;    ///< why there is none; empty: it is solved
};

/// Why a target has no solution.
inline constexpr const char* not_within = "not within the values varied";
/// How the names of the runs' directories begin.
inline constexpr const char* target_folder = "target-";

/// Runs a point, or finds it run already; nothing when it was interrupted.
using PointRunner = std::function<std::optional<PointResult>(const StudyPoint&)>;

/// Runs the case between neighbouring points of the grid whose values of a target's quantity lie on either
/// side of it, at the zero of the polynomial through up to four points near, until the quantity is within the
/// target's tolerance: a solution for every such pair. Where the quantity comes nearer to the target up to a
/// point beside which the grid's fail, it looks between the two for the end of what runs. Directories
/// `target-<number>-<run>` below `directory`.
std::vector<TargetSolution> solve_targets(const Study& study, const std::vector<StudyPoint>& points,
                                          const std::filesystem::path& directory, const PointRunner& run);

/// One line for each solution: "stiffness = 160 N/m at film.material.shear_modulus = 43.54 kPa (run there:
/// 160 N/m)", and for each target without any.
std::vector<std::string> target_lines(const Study& study, const std::vector<StudyPoint>& points,
                                      const Collected& collected,
                                      const std::vector<TargetSolution>& solutions);

} // namespace dielast::cases
