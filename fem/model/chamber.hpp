// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace dielast::fem {

/// What fills a chamber gives way to its pressure: of the volume V at the pressure p (Pa, over the outside)
/// there went in, measured without pressure,
///   Q = V (1 + p/K)    (the pumped volume, m^3),
/// for a liquid of bulk modulus K >> p, and for a gas at constant temperature, K being the pressure outside.
/// `fem` treats the own volume V as a port's charge (see Charges); where Q is given, V must be filled(p).
struct Chamber {
  double bulk_modulus = 2.2e9; ///< K, Pa

  double pumped(double volume, double pressure) const { return volume * (1 + pressure / bulk_modulus); }
  /// Own volume of the pumped volume Q at p; not finite where p <= -K.
  double filled(double pumped, double pressure) const {
    return pressure > -bulk_modulus ? pumped / (1 + pressure / bulk_modulus) : NAN;
  }
  /// Minus the slope of filled() in p, m^3/Pa, of the own volume V.
  double compliance(double volume, double pressure) const { return volume / (bulk_modulus + pressure); }
  /// Integral of filled() over p, J.
  double energy(double pumped, double pressure) const {
    return bulk_modulus * pumped * std::log1p(pressure / bulk_modulus);
  }
};

} // namespace dielast::fem
