// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/language/section_reader.hpp"

namespace dielast::cases {

/// How messages name a step, and where it stands.
struct StepPlace {
  std::string key;
  Source source;
};
StepPlace place_of_step(const Node& tree, std::size_t number);

/// Rules between sections: every load, drive, motion and wave has a step that applies it, every step has
/// something to apply, a patch can do what it is asked.
void check_rules(SectionReader& reader, const Node& tree, const Case& one);

/// Every wave has a step that follows it, in time steps that resolve it; no step leads a voltage to where it
/// is. Of the rules above, too.
void check_waves(SectionReader& reader, const Node& tree, const Case& one);

/// What supports hold, and when. Of the rules above, too.
void check_supports(SectionReader& reader, const Node& tree, const Case& one);

/// What a part must have, and what goes with what in it. Of the rules above, too.
void check_parts(SectionReader& reader, const Node& tree, const Case& one);

/// Regions must be parts of the film that have an area and do not overlap.
void check_regions(SectionReader& reader, const Node& tree, const Case& one);

/// Walls and the gap beside them must leave something of a honeycomb's cells.
void check_surroundings_of_walls(SectionReader& reader, const Node& tree, const Case& one);

/// What touches must be there, and slide as it can.
void check_contact(SectionReader& reader, const Node& tree, const Case& one);

/// What is measured must be there, for controllers at every state, and no two results may have one name.
void check_results(SectionReader& reader, const Node& tree, const Case& one);

void check_pivot(SectionReader& reader, const Node& tree, const Case& one);

} // namespace dielast::cases
