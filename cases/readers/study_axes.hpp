// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/study_spec.hpp"
#include "cases/language/section_reader.hpp"

namespace dielast::cases {

/// Reads what varies and what is derived of it from the section [study] into `study`, whose pair is known,
/// and tries every value on `base`, the case as all points have it. Errors go to `reader`.
void read_axes(SectionReader& reader, const Node& section, const Node& base, Study& study);

} // namespace dielast::cases
