// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/contact/barrier.hpp"
#include "fem/contact/contact_sums.hpp"
#include "fem/contact/face.hpp"
#include "fem/contact/surface_ends.hpp"

namespace dielast::fem {

/// Adds area * S(t) * b(g) with its derivatives by the nodes of a face, then of another one: g is the gap
/// from a point of the first, whose shape functions are `own`, to the `place` of the `other` one (or of its
/// edge or corner) that is nearest, t what the `field` of the other one's nodes is there. The place follows
/// what moves, as the gap is the least.
void add_pressed(const Eigen::Vector<double, 6>& own, const FaceNodes& other, const FacePlace& place,
                 const Eigen::Vector<double, 6>& field, double area, const BarrierEnergy& barrier,
                 const Ramp& share, const Scatter& scatter, ContactSums<36>& sums);

} // namespace dielast::fem
