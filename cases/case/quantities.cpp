// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/quantities.hpp"

namespace dielast::cases {

std::string unit_of(const Quantity& quantity, const std::vector<Quantity>& all) {
  switch (quantity.kind) {
  case QuantityKind::distance:
  case QuantityKind::size:
  case QuantityKind::displacement:
  case QuantityKind::radius:
    return "m";
  case QuantityKind::elongation:
  case QuantityKind::growth:
  case QuantityKind::stretch:
  case QuantityKind::radial_stretch:
    return "1";
  case QuantityKind::current:
    return "A";
  case QuantityKind::pressure:
    return "Pa";
  case QuantityKind::volume:
  case QuantityKind::pumped_volume:
    return "m^3";
  case QuantityKind::stiffness:
    return "N/m";
  case QuantityKind::natural_frequency:
    return "rad/s";
  case QuantityKind::angle:
    return "rad";
  case QuantityKind::moment:
    return "N m";
  case QuantityKind::force:
    return "N";
  case QuantityKind::nominal_stress:
    return "Pa";
  case QuantityKind::capacitance:
    return "F";
  case QuantityKind::charge:
    return "C";
  case QuantityKind::energy:
    return "J";
  case QuantityKind::peak:
    for (const Quantity& other : all)
      if (other.name == quantity.of && other.kind != QuantityKind::peak) return unit_of(other, all);
    return "1";
  case QuantityKind::extreme:
    break;
  }
  for (const post::Scalar& field : post::scalars())
    if (field.name == quantity.of) return std::string(field.unit);
  return "1";
}

const Quantity* response_quantity(const Case& one, const std::string& name) {
  for (const Quantity& quantity : one.quantities)
    if (quantity.kind == QuantityKind::displacement && quantity.along &&
        (name.empty() || quantity.name == name))
      return &quantity;
  return nullptr;
}

std::string voltage_name(const Case& one, std::size_t electrode) {
  return one.electrodes.size() == 1 ? "voltage" : "voltage_" + one.electrodes[electrode].name;
}

std::vector<post::Column> history_columns(const Case& one) {
  std::vector<post::Column> columns{{"load_factor", "1"}, {"time", "s"}};
  for (std::size_t e = 0; e < one.electrodes.size(); ++e) columns.push_back({voltage_name(one, e), "V"});
  for (const Quantity& quantity : one.quantities)
    columns.push_back({quantity.name, unit_of(quantity, one.quantities)});
  for (const char* solver : {"iterations", "residual", "unstable_modes", "jumped"})
    columns.push_back({solver, "1"});
  return columns;
}

} // namespace dielast::cases
