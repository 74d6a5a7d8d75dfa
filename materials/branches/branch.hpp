// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/time_scheme.hpp"
#include "materials/laws/plane_stress.hpp"

#include <array>

namespace dielast::materials {

/// How a branch's dashpot measures flow: `log` dissipates eta |Dv|^2 of the rate of the logarithmic viscous
/// strain (Reese & Govindjee 1998; Foo et al. 2012); `nominal` dissipates eta xi'^2 of the viscous stretches
/// xi themselves, along the axes of the film (rolled muscles).
enum class Dashpot { log, nominal };

/// Maxwell branch: a spring (any law) in series with a dashpot. It stores W_b, the law's energy at the
/// elastic deformation C Cv^-1; Cv is its viscous deformation.
///   log:     eta Cv' = 2 dW_b/dG - alpha Cv,  G = Cv^-1 in three dimensions, alpha keeps det Cv = 1;
///   nominal: eta xi_i' = -dW_b/dxi_i for the `directions` that flow, G = diag(xi_1^-2, xi_2^-2); others keep
///            xi = 1.
/// The relaxation time is tau = eta over the law's initial shear modulus (neo-Hookean, log: Cv' = (C - tr(C
/// G)/3 Cv)/tau).
struct Branch {
  ElasticLaw law;
  Dashpot dashpot = Dashpot::log;
  double viscosity = 0; ///< eta, Pa s
  std::array<bool, 2> directions{true, true};
};

/// What a branch remembers at a point: Cv11, Cv22, Cv12 (log), or xi_1, xi_2, 0 (nominal).
using Internal = std::array<double, 3>;

constexpr Internal undeformed() { return {1, 1, 0}; }

/// Potential of a branch over a step of time: W_b plus what the dashpot dissipates, at the viscous
/// deformation that makes the sum stationary; that deformation solves the flow rule in `scheme`. Symmetric
/// consistent tangent. `now`, `before`: internal variables at the last two accepted times (`before` is not
/// read where its weight is 0). Frozen: W_b at the viscous deformation `now`. Relaxed: zero (log), the
/// smallest W_b (nominal). A history that BDF2 cannot extrapolate is continued by backward Euler. The value
/// is not finite where the law cannot be or no viscous deformation was found.
MembranePotential<double> branch_potential(const Branch& branch, const InPlaneC<double>& C,
                                           const TimeScheme& scheme, const Internal& now,
                                           const Internal& before);

/// Internal variables at the end of the step that ends at C.
Internal advance(const Branch& branch, const InPlaneC<double>& C, const TimeScheme& scheme,
                 const Internal& now, const Internal& before);

/// Per undeformed volume: stored energy W_b, J/m^3, and dissipated power, W/m^3, from the flow rule:
/// dW_b/dt = dW_b/dC : C' - dissipation.
struct BranchPower {
  double stored, dissipation;
};
BranchPower branch_power(const Branch& branch, const InPlaneC<double>& C, const Internal& internal);

} // namespace dielast::materials
