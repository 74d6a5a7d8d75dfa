// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/text/tree.hpp"
#include "cases/text/waveform.hpp"

namespace dielast::cases {

/// Fills the samples of a wave from its CSV file and makes the file's path absolute. `folder` is the case
/// file's, `table` the wave as written at the key `path`; what is wrong is added to `wrong`.
void load_samples(Waveform& wave, std::string_view unit, const std::filesystem::path& folder,
                  const Node& table, const std::string& path, std::vector<Diagnostic>& wrong);

} // namespace dielast::cases
