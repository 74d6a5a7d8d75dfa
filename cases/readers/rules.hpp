// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/section_reader.hpp"

namespace dielast::cases {

/// Rules between sections: every load, drive, motion and wave has a step that applies it, every step has
/// something to apply, time steps resolve the waves, a patch can do what it is asked.
void check_rules(SectionReader& reader, const Node& tree, const Case& one);

/// What a part must have, and what goes with what in it. Of the rules above, too.
void check_parts(SectionReader& reader, const Node& tree, const Case& one);

} // namespace dielast::cases
