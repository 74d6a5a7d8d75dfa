#include "cases/quantities.hpp"

#include <array>

namespace dielast::cases {

std::span<const FieldName> field_names() {
  static constexpr std::array names{
      FieldName{"electric_field", "V/m", "true electric field |E|"},
      FieldName{"breakdown_ratio", "1", "|E| over the film's breakdown field"},
      FieldName{"min_principal_stress", "Pa", "smaller principal Cauchy stress in the film's plane"},
      FieldName{"max_principal_stress", "Pa", "larger principal Cauchy stress in the film's plane"},
      FieldName{"thickness", "m", "thickness of the deformed film"},
      FieldName{"max_stretch", "1", "larger principal stretch in the film's plane"},
      FieldName{"min_stretch", "1", "smaller principal stretch in the film's plane"},
      FieldName{"wall_strain", "1", "largest |strain| of a wall's fibres"},
  };
  return names;
}

std::string_view unit_of(const Quantity& quantity) {
  switch (quantity.kind) {
  case QuantityKind::distance:
  case QuantityKind::displacement:
  case QuantityKind::radius:
    return "m";
  case QuantityKind::elongation:
    return "1";
  case QuantityKind::force:
    return "N";
  case QuantityKind::capacitance:
    return "F";
  case QuantityKind::charge:
    return "C";
  case QuantityKind::extreme:
    break;
  }
  for (const FieldName& field : field_names())
    if (field.name == quantity.of) return field.unit;
  return "1";
}

} // namespace dielast::cases
