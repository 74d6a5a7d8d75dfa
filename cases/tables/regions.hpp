// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "meshing/regions/region.hpp"

#include <optional>

namespace dielast::cases {

/// The disc or annulus whose regions can be drawn; nothing for other geometries.
std::optional<meshing::RoundFilm> round_film(const Part& part);

/// A drawn region. Throws std::invalid_argument for one that is empty.
meshing::Region region_of(const DrawnRegion& drawn, const meshing::RoundFilm& film);

/// Those of [sectors]. Throws std::invalid_argument where their gaps leave nothing of them.
std::vector<meshing::Region> sectors_of(const Sectors& sectors, const meshing::RoundFilm& film);

/// All regions of a part: its sectors, then those that are drawn.
std::vector<meshing::Region> regions_of(const Part& part);

/// What [pivot] does, as an ordinary support.
void add_pivot_support(Case& one);

} // namespace dielast::cases
