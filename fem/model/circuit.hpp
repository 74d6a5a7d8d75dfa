// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "materials/branches/time_scheme.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dielast::fem {

/// A source behind a resistance drives one electrode; charge leaks through the film:
///   dQ/dt = i - G Phi,  i = (U - Phi)/R, at most the source's limit either way.
/// Over a time step (see TimeScheme) this is Q(u, Phi) + drawn(Phi) = (h1 Q_n + h2 Q_{n-1}) / a0 with
/// drawn = (dt/a0) (G Phi - i(Phi)), which grows with Phi: an electrode of given charge whose capacitance is
/// larger. Q_n is an internal variable of the model. Isolated (Supply::leak), i = 0.
struct Circuit {
  double resistance = 0;                                          ///< R > 0, Ohm
  double leakage = 0;                                             ///< G, S, of the whole electrode
  double current_limit = std::numeric_limits<double>::infinity(); ///< A
  double charge_scale = 1; ///< C: internal variables are charges over this, to be of order one
  double sheet_share = 1;  ///< of `leakage`, felt at the terminal once nothing changes: a sheet drops voltage

  /// i, A, from the source's voltage U and the electrode's Phi (V).
  double current(double source, double voltage) const {
    return std::clamp((source - voltage) / resistance, -current_limit, current_limit);
  }
  /// Part of U that reaches the electrode once nothing changes any more, where the source is below its limit.
  double steady_share() const { return 1 / (1 + resistance * steady_leakage()); }
  double steady_leakage() const { return leakage * sheet_share; } ///< S
  /// Phi once nothing changes any more, V: what leaks is what the source gives, at most its limit.
  double steady_voltage(double source) const {
    const double most = current_limit / steady_leakage(); // infinite where nothing leaks
    return std::clamp(source * steady_share(), -most, most);
  }
  /// U that keeps Phi for ever, below the limit.
  double holding_source(double voltage) const { return voltage / steady_share(); }

  struct Drawn {
    double charge = 0;      ///< C
    double capacitance = 0; ///< its slope, F
    double energy = 0;      ///< its integral over Phi, J
  };
  /// What leaks of it alone.
  Drawn leaked(double voltage, const materials::TimeScheme& scheme) const {
    const double per_volt = scheme.dt / scheme.a0 * leakage;
    return {per_volt * voltage, per_volt, per_volt * voltage * voltage / 2};
  }
  Drawn drawn(double source, double voltage, const materials::TimeScheme& scheme) const {
    const double step = scheme.dt / scheme.a0, drop = source - voltage;
    const double limit = current_limit * resistance;
    const bool limited = drop > limit || drop < -limit;
    const double fed = limited ? current_limit * (std::max(drop, -drop) - limit / 2)
                               : drop * drop / (2 * resistance); // integral of -i over Phi
    return {step * (leakage * voltage - current(source, voltage)),
            step * (leakage + (limited ? 0 : 1 / resistance)),
            step * (leakage * voltage * voltage / 2 + fed)};
  }
};

} // namespace dielast::fem
