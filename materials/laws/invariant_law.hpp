// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/laws/pack.hpp"
#include "materials/laws/parameter.hpp"

#include <array>
#include <concepts>

namespace dielast::materials {

/// An energy density and its derivatives in the first invariant I1.
template<class T>
struct InvariantDerivatives {
  T W, W1, W11;
};

/// An incompressible law whose energy density is a function of I1 alone.
template<class Law>
concept FirstInvariantLaw = requires(const Law law, double I1) {
  { law.derivatives(I1) } -> std::same_as<InvariantDerivatives<double>>;
};

/// W is linear in I1: products with W11 = 0 need not be computed.
template<class Law>
constexpr bool linear_in_first_invariant = false;

} // namespace dielast::materials
