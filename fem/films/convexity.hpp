// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/lanes.hpp"

namespace dielast::fem {

/// Whether a symmetric form, given in full, is positive definite in every lane that has a volume, by its
/// pivots. With the form dP/dF of a film's integration point this says that every gradient of a displacement
/// costs energy there; where it holds at all points the tangent of a film that is held somewhere is positive
/// definite: a sufficient condition for its stability, not a necessary one.
template<int size>
[[gnu::always_inline]] inline bool is_positive_definite(const Lanes (&full)[size][size],
                                                        const Lanes& volume) {
  constexpr double negligible = 1e-6; // pivot over the trace of the form
  Lanes form[size][size], trace{};    // lower triangle
  for (int i = 0; i < size; ++i) {
    trace += full[i][i];
    for (int j = 0; j <= i; ++j) form[i][j] = full[i][j];
  }
  const Lanes least = negligible * trace;
  auto holds = least > 0; // not where something is not a number
  for (int k = 0; k < size; ++k) {
    holds &= form[k][k] > least;
    const Lanes inverse = 1.0 / form[k][k];
    for (int i = k + 1; i < size; ++i) {
      const Lanes factor = form[i][k] * inverse;
      for (int j = k + 1; j <= i; ++j) form[i][j] -= factor * form[j][k];
    }
  }
  return all_lanes(holds | (volume == 0));
}

} // namespace dielast::fem
