// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

namespace dielast::cases {

/// What is known of the discretisation error of a number.
struct ErrorEstimate {
  std::optional<double> error; ///< in the number's unit, >= 0; absent where none can be given
  bool singular = false;       ///< the number grows as the mesh is refined: it has no converged value
  std::string remark;          ///< why there is no error; may be empty
};

/// Orders of convergence between which an observed one is believed.
struct OrderRange {
  double least = 1, most = 2;
  std::optional<double> of_larger = {}; ///< for a coarser solution beside a finer one, instead of `least`
};

/// A number as one discretisation gives it.
struct Sampled {
  double size = 1;  ///< of elements and time steps, in any unit
  double value = 0; ///< may be NaN
  double rise = 0;  ///< of the extreme of a field: by how much the field changes over one element there, >= 0
};

/// The error of `own` from the same number on `others`, which stand from the finer to the coarser; the first
/// of them may be finer than `own`: Richardson's estimate times a safety factor. From three sizes the order
/// is observed; from two it is the least of `orders`. Where the differences change their sign no order can be
/// seen, and they are the estimate themselves. From a finer one and a coarser one it is the larger that
/// either tells at the least order, the coarser at the order of larger elements. (Roache's grid convergence
/// index as in Celik et al., J. Fluids Eng. 130, 078001, 2008.)
///
/// `direction`: 1 for a maximum of a field, -1 for a minimum, otherwise 0. An extreme is read at integration
/// points, so that its error is no less than its rise; one that grows from mesh to mesh while its rise does
/// not shrink is singular, unless it grows by less than `rounding`.
ErrorEstimate estimate_error(const Sampled& own, std::span<const Sampled> others, OrderRange orders,
                             int direction, double rounding = 0);

} // namespace dielast::cases
