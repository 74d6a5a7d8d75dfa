// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/inertia.hpp"
#include "fem/model/model.hpp"

namespace dielast::fem {

/// Largest local error of the internal variables over the time step from `past` to `next`, over the larger
/// of 1 and the variable: the distance to the polynomial through the last three accepted values (Milne's
/// device). 0 where the past is too short to tell.
double history_error(const History& past, const History& next);

/// Largest local error of the displacements of what has a mass, over a hundredth of the model's extent, of
/// the time step by `scheme` from `past` to `next`.
double motion_error(const Model& model, const GeneralisedAlpha& scheme, const Motion& past,
                    const Motion& next);

} // namespace dielast::fem
