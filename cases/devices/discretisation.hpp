// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

#include <optional>
#include <vector>

namespace dielast::cases {

/// A case with other elements and time steps.
struct Discretisation {
  Case one;
  double size = 1; ///< of its elements and time steps, over those of the case that it was made from
};

/// Discretisations that tell, beside the case's own, how much its results depend on elements and time steps:
/// elements and time steps about twice and four times as large, from the finer to the coarser, as many as
/// there are. A user's own mesh that is not refined has one with elements half as large and time steps twice
/// as long. Static steps take a third of their increments: homogeneous patches and what is one element have
/// that only where no time passes. Empty when a mesh is the coarsest already.
std::vector<Discretisation> other_discretisations(const Case& one);

/// Whether the edge of a hole or of an electrode has as many sides with the other's elements: these do not
/// tell then what few sides change.
bool divides_edges_alike(const Case& one, const Case& other);

/// The case with elements that were halved so many times, and time steps twice as long; nothing where a mesh
/// has no number of elements that could be doubled, or that would change nothing.
std::optional<Discretisation> finer_discretisation(const Case& one, int halvings = 1);

} // namespace dielast::cases
