// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "post/files/results_folder.hpp"
#include "post/pictures/report.hpp"

namespace dielast::post {

/// Writes report.html and the figures beside it. Throws WriteError.
void write_report(ResultsFolder& folder, const Report& report);

} // namespace dielast::post
