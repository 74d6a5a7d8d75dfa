#include "cases/quantities.hpp"

namespace dielast::cases {

std::string unit_of(const Quantity& quantity) {
  switch (quantity.kind) {
  case QuantityKind::distance:
  case QuantityKind::size:
  case QuantityKind::displacement:
  case QuantityKind::radius:
    return "m";
  case QuantityKind::elongation:
  case QuantityKind::growth:
  case QuantityKind::stretch:
    return "1";
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
  case QuantityKind::extreme:
    break;
  }
  for (const post::Scalar& field : post::scalars())
    if (field.name == quantity.of) return std::string(field.unit);
  return "1";
}

} // namespace dielast::cases
