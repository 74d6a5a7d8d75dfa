// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/studies/study_points.hpp"
#include "post/files/results_folder.hpp"

#include <functional>
#include <sys/types.h>

namespace dielast::cases {

/// A point that has to run, or to go on where it was stopped.
struct WaitingPoint {
  const StudyPoint* point;
  bool resume;
};

/// Hears of a point that has run, with its exit code.
using PointEnded = std::function<void(const StudyPoint&, int exit_code)>;

/// What is there of a point before it runs.
struct Kept {
  std::optional<PointResult> result; ///< it need not run
  bool resume = false;               ///< otherwise: it goes on where it was stopped
};

/// The point's directory, as far as it goes, is of the case as it is now.
bool is_current(const Study& study, const StudyPoint& point);

/// Goes on with a study's folder. Points that have other numbers now than when they ran get the folders of
/// these numbers: a study whose axes have grown keeps what is done. Points that are in the study no more are
/// removed, and told.
void begin_again(post::ResultsFolder& folder, const Study& study, const std::vector<StudyPoint>& points);

/// A point that has crashed or could not write its files is run again.
Kept kept_of(const Study& study, const StudyPoint& point, bool resume);

/// Starts a process that runs the point and dies with this one; why it failed is left in the point's mark. A
/// point that another process runs is left alone. Throws FileError.
pid_t start(const Study& study, const StudyPoint& point, bool resume);

/// Takes up how the process of a point ended; returns its exit code, -signal when it crashed.
int exit_code_of(const StudyPoint& point, int status);

/// Both, one after the other.
int run_and_wait(const Study& study, const StudyPoint& point, bool resume);

} // namespace dielast::cases
