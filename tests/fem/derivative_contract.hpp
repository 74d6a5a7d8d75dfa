// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/model.hpp"

namespace dielast::fem::test {

/// What every element block must pass at any feasible state of a model whose unknowns are all free: the
/// residual is the derivative of the energy, the tangent the second derivative along DofMap::advance() and
/// the symmetric part of the residual's derivative, to `tolerance`, relative. Differences of fourth order, in
/// units of `length` (m).
void expect_consistent_derivatives(const Model& model, const State& state, double length,
                                   double tolerance = 2e-9);

} // namespace dielast::fem::test
