// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/branches/branch.hpp"

#include "materials/branches/viscous_flow.hpp"

#include <cmath>

namespace dielast::materials {

namespace {

InPlaneC<double> inverse(const InPlaneC<double>& C) {
  const double det = C.det();
  return {C.C22 / det, C.C11 / det, -C.C12 / det};
}

InPlaneC<double> viscous(const Internal& y) { return {y[0], y[1], y[2]}; }

/// G = Cv^-1
InPlaneC<double> metric(Dashpot dashpot, const Internal& y) {
  if (dashpot == Dashpot::log) return inverse(viscous(y));
  return {1 / (y[0] * y[0]), 1 / (y[1] * y[1]), 0};
}

LogFlow log_flow(const Branch& branch, const TimeScheme& scheme, const Internal& now,
                 const Internal& before) {
  const double weight = branch.viscosity / (2 * scheme.dt);
  const InPlaneC<double> n = viscous(now);
  const ViscousHistory<double> last{n, 1 / n.det()};
  if (scheme.h2 == 0) return {weight, last};
  const InPlaneC<double> b = viscous(before);
  const ViscousHistory<double> H{{scheme.h1 * n.C11 + scheme.h2 * b.C11,
                                  scheme.h1 * n.C22 + scheme.h2 * b.C22,
                                  scheme.h1 * n.C12 + scheme.h2 * b.C12},
                                 scheme.h1 / n.det() + scheme.h2 / b.det()};
  const bool positive = H.plane.C11 > 0 && H.plane.det() > 0 && H.normal > 0;
  return {weight, positive ? H : last};
}

NominalFlow nominal_flow(const Branch& branch, const TimeScheme& scheme, const Internal& now,
                         const Internal& before) {
  const double rate = branch.viscosity / (2 * scheme.dt); // 0: relaxed
  const NominalFlow euler{rate, 1, {now[0], now[1]}, branch.directions, {now[0], now[1]}};
  if (scheme.h2 == 0) return euler;
  const double longer = scheme.h1 - 1; // than the step before
  const NominalFlow flow{
      rate / scheme.a0,
      scheme.a0,
      {scheme.h1 * now[0] + scheme.h2 * before[0], scheme.h1 * now[1] + scheme.h2 * before[1]},
      branch.directions,
      {now[0] + longer * (now[0] - before[0]), now[1] + longer * (now[1] - before[1])}};
  return flow.h[0] > 0 && flow.h[1] > 0 ? flow : euler;
}

/// Viscous deformation that a neo-Hookean branch of shear modulus mu reaches.
InPlaneC<double> neo_hookean_flow(double mu, const LogFlow& flow, const InPlaneC<double>& C) {
  const double q = mu / (2 * flow.weight);
  const ViscousHistory<double>& H = flow.H;
  const ViscousHistory<double> A{{H.plane.C11 + q * C.C11, H.plane.C22 + q * C.C22, H.plane.C12 + q * C.C12},
                                 H.normal + q / C.det()};
  const double root = std::cbrt(A.det());
  return {A.plane.C11 / root, A.plane.C22 / root, A.plane.C12 / root};
}

/// Starts where a neo-Hookean branch would end, or, where the law cannot be there, fully relaxed.
template<class Law>
Settled<LogFlow> settle(const Law& law, const LogFlow& flow, const InPlaneC<double>& C) {
  const auto y = [](const InPlaneC<double>& G) { return Eigen::Vector3d(G.C11, G.C22, G.C12); };
  const Eigen::Vector3d start = y(inverse(neo_hookean_flow(law.initial_shear_modulus(), flow, C)));
  const auto settled = settle(law, flow, C, start);
  return settled.found ? settled : settle(law, flow, C, y(inverse(C)));
}

/// Starts where the branch was going, or, where the law cannot be there, where it would be without its
/// spring, or relaxed.
template<class Law>
Settled<NominalFlow> settle(const Law& law, const NominalFlow& flow, const InPlaneC<double>& C) {
  Settled<NominalFlow> settled{false, {}};
  for (const std::array<double, 2>& start :
       {flow.expected, {flow.h[0] / flow.a0, flow.h[1] / flow.a0}, {std::sqrt(C.C11), std::sqrt(C.C22)}}) {
    const Eigen::Vector2d y(flow.directions[0] ? start[0] : 1, flow.directions[1] ? start[1] : 1);
    if (flow.admits(y)) settled = settle(law, flow, C, y);
    if (settled.found) break;
  }
  return settled;
}

} // namespace

MembranePotential<double> branch_potential(const Branch& branch, const InPlaneC<double>& C,
                                           const TimeScheme& scheme, const Internal& now,
                                           const Internal& before) {
  return std::visit(
      [&](const auto& law) -> MembranePotential<double> {
        if (scheme.is_frozen()) {
          MembranePotential<double> psi = membrane_potential(law, C, metric(branch.dashpot, now));
          // At rest a stiff spring, as before a viscosity, would have the rounding of its stiffness as
          // stress.
          if (branch.dashpot == Dashpot::log && now == Internal{C.C11, C.C22, C.C12})
            psi.value = 0, psi.first = {};
          return psi;
        }
        if (branch.dashpot == Dashpot::nominal) {
          const NominalFlow flow = nominal_flow(branch, scheme, now, before);
          return condensed(law, flow, C, settle(law, flow, C));
        }
        if (scheme.is_relaxed()) return {};
        const LogFlow flow = log_flow(branch, scheme, now, before);
        if constexpr (std::same_as<decltype(law), const NeoHookean&>)
          return neo_hookean_branch(law.shear_modulus, branch.viscosity, scheme.dt, C, flow.H);
        else
          return condensed(law, flow, C, settle(law, flow, C));
      },
      branch.law);
}

Internal advance(const Branch& branch, const InPlaneC<double>& C, const TimeScheme& scheme,
                 const Internal& now, const Internal& before) {
  if (scheme.is_frozen()) return now;
  if (branch.dashpot == Dashpot::log && scheme.is_relaxed()) return {C.C11, C.C22, C.C12};
  return std::visit(
      [&](const auto& law) -> Internal {
        if (branch.dashpot == Dashpot::nominal) {
          const Eigen::Vector2d xi = settle(law, nominal_flow(branch, scheme, now, before), C).y;
          return {xi[0], xi[1], 0};
        }
        const LogFlow flow = log_flow(branch, scheme, now, before);
        InPlaneC<double> Cv;
        if constexpr (std::same_as<decltype(law), const NeoHookean&>) {
          Cv = neo_hookean_flow(law.shear_modulus, flow, C);
        } else {
          const Eigen::Vector3d G = settle(law, flow, C).y;
          Cv = inverse({G[0], G[1], G[2]});
        }
        return {Cv.C11, Cv.C22, Cv.C12};
      },
      branch.law);
}

BranchPower branch_power(const Branch& branch, const InPlaneC<double>& C, const Internal& internal) {
  const InPlaneC<double> G = metric(branch.dashpot, internal);
  const double T = C.C11 * G.C11 + C.C22 * G.C22 + 2 * C.C12 * G.C12, D = C.det() * G.det();
  const PlanarDerivatives<double> w =
      std::visit([&](const auto& law) { return planar(law, T, D); }, branch.law);
  if (branch.dashpot == Dashpot::log) {
    // M = 2 dW/dG G in the plane, G33 = 1/det G taken along; its deviator in three dimensions drives the
    // flow. By half the sum and half the difference of its eigenvalues, from P = C G entry by entry: a spring
    // much stiffer than its dashpot leaves eigenvalues of P that hardly differ.
    const double P11 = C.C11 * G.C11 + C.C12 * G.C12, P12 = C.C11 * G.C12 + C.C12 * G.C22;
    const double P21 = C.C12 * G.C11 + C.C22 * G.C12, P22 = C.C12 * G.C12 + C.C22 * G.C22;
    const double half_sum = w.dT * T + 2 * w.dD * D;
    const double squared_half_difference = w.dT * w.dT * ((P11 - P22) * (P11 - P22) + 4 * P12 * P21);
    return {w.value, (half_sum * half_sum + 3 * squared_half_difference) / (3 * branch.viscosity)};
  }
  const std::array<double, 2> stretch_squared{C.C11 * G.C11, C.C22 * G.C22};
  double power = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!branch.directions[i]) continue;
    const double slope = -2 / internal[i] * (w.dT * stretch_squared[i] + w.dD * D); // dW/dxi_i
    power += slope * slope / branch.viscosity;
  }
  return {w.value, power};
}

} // namespace dielast::materials
