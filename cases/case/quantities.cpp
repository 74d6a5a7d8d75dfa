// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/quantities.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace dielast::cases {

std::string unit_of(const Quantity& quantity, const std::vector<Quantity>& all) {
  switch (quantity.kind) {
  case QuantityKind::distance:
  case QuantityKind::size:
  case QuantityKind::displacement:
  case QuantityKind::swelling:
  case QuantityKind::radius:
    return "m";
  case QuantityKind::elongation:
  case QuantityKind::growth:
  case QuantityKind::stretch:
  case QuantityKind::radial_stretch:
  case QuantityKind::coupling:
  case QuantityKind::margin:
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
  case QuantityKind::modal_stiffness:
    return "1/s^2";
  case QuantityKind::angle:
    return "rad";
  case QuantityKind::moment:
    return "N m";
  case QuantityKind::force:
  case QuantityKind::film_force:
  case QuantityKind::contact_force:
    return "N";
  case QuantityKind::nominal_stress:
  case QuantityKind::contact_pressure:
    return "Pa";
  case QuantityKind::capacitance:
    return "F";
  case QuantityKind::charge:
    return "C";
  case QuantityKind::energy:
    return "J";
  case QuantityKind::fin_force:
  case QuantityKind::thrust:
    return "N";
  case QuantityKind::fin_power:
    return "W";
  case QuantityKind::peak:
  case QuantityKind::mean:
    for (const Quantity& other : all)
      if (other.name == quantity.of && !is_of_course(other.kind)) return unit_of(other, all);
    return "1";
  case QuantityKind::value:
  case QuantityKind::extreme:
    break;
  }
  for (const post::Scalar& field : post::scalars())
    if (field.name == quantity.of) return std::string(field.unit);
  return "1";
}

std::string meaning_of(const Quantity& q) {
  const auto field = [&q] { // "electric_field" in words
    std::string words = q.of;
    std::ranges::replace(words, '_', ' ');
    return words;
  };
  static constexpr const char* axes[] = {"x", "y", "z", "gravity"};
  const std::string along = q.along ? fmt::format(" along {}", axes[*q.along]) : "";
  const std::string at = q.at.empty() ? "" : fmt::format(", at the end of \"{}\"", q.at);
  switch (q.kind) {
  case QuantityKind::distance:
    return fmt::format("distance of {} and {}{}{}", q.between[0], q.between[1], along, at);
  case QuantityKind::elongation:
    return fmt::format("elongation from {} to {}{}, since {}{}", q.between[0], q.between[1], along,
                       q.since.empty() ? "the mesh as drawn" : "\"" + q.since + "\"", at);
  case QuantityKind::size:
    return fmt::format("size of {}{}{}", q.of, along, at);
  case QuantityKind::growth:
    return fmt::format("growth of {}{}, since {}{}", q.of, along,
                       q.since.empty() ? "the mesh as drawn" : "\"" + q.since + "\"", at);
  case QuantityKind::displacement:
    return fmt::format("displacement of {}{}{}{}",
                       q.point ? fmt::format("the point ({} m)", fmt::join(*q.point, ", ")) : q.of, along,
                       q.since.empty() ? "" : ", since \"" + q.since + "\"", at);
  case QuantityKind::swelling:
    return fmt::format("largest displacement of {}{}{}", q.of, along, at);
  case QuantityKind::radius:
    return fmt::format("mean radius of {}{}", q.of, at);
  case QuantityKind::angle:
    return fmt::format("rotation of {}{}{}", q.of, along, at);
  case QuantityKind::moment:
    return fmt::format("moment of the support of {} on it{}{}", q.of, along, at);
  case QuantityKind::force:
    return fmt::format("force of the support {} on the device{}{}", q.of, along, at);
  case QuantityKind::film_force:
    return fmt::format("force of the film on {}{}{}", q.of, along, at);
  case QuantityKind::contact_force:
    return fmt::format("sum of the normal forces of contact{}{}", q.of.empty() ? "" : " on " + q.of, at);
  case QuantityKind::contact_pressure:
    return fmt::format("largest pressure of contact{}{}", q.of.empty() ? "" : " on " + q.of, at);
  case QuantityKind::capacitance:
    return fmt::format("capacitance of electrode {}{}", q.of, at);
  case QuantityKind::charge:
    return fmt::format("charge on electrode {}{}", q.of, at);
  case QuantityKind::current:
    return fmt::format("current from the source of electrode {}{}", q.of, at);
  case QuantityKind::pressure:
    return fmt::format("pressure in the chamber{}", at);
  case QuantityKind::volume:
    return fmt::format("volume of the chamber{}", at);
  case QuantityKind::pumped_volume:
    return fmt::format("volume pumped into the chamber, as it is without pressure{}", at);
  case QuantityKind::stiffness:
    return fmt::format("force on {} per displacement{}{}", q.of, along, at);
  case QuantityKind::coupling:
    return fmt::format(
        "force on {} held{} per squared voltage of {}, over its drawn capacitance per length{}", q.place,
        along, q.of, at);
  case QuantityKind::natural_frequency:
    return fmt::format("natural frequency number {}{}", q.mode, at);
  case QuantityKind::modal_stiffness:
    return fmt::format("square of natural frequency number {}, negative where it is unstable{}", q.mode, at);
  case QuantityKind::radial_stretch:
    return fmt::format("stretch along the radius at {}{}", q.of, at);
  case QuantityKind::peak:
    return fmt::format("{} {} so far{}", q.extreme == post::Extreme::minimum ? "smallest" : "largest", q.of,
                       at);
  case QuantityKind::mean:
    return fmt::format("mean of {} over time{}{}", q.of, q.since.empty() ? "" : ", since \"" + q.since + "\"",
                       at);
  case QuantityKind::fin_force:
    return fmt::format("force of the fluid on {}, across it{}", q.of, at);
  case QuantityKind::thrust:
    return fmt::format("force of the fluid on {}, forward along it{}", q.of, at);
  case QuantityKind::fin_power:
    return fmt::format("power that {} gives to the fluid{}", q.of, at);
  case QuantityKind::margin:
    return fmt::format("factor on the voltages at the end that leads to {}", q.of);
  case QuantityKind::stretch:
    return fmt::format("stretch between {} and {}{}{}", q.between[0], q.between[1], along, at);
  case QuantityKind::nominal_stress:
    return fmt::format("mean nominal stress of {}{}{}", q.of, along, at);
  case QuantityKind::energy:
    return fmt::format("energy balance: {}{}", field(), at);
  case QuantityKind::value:
    if (q.point)
      return fmt::format("{} at ({:.6g}, {:.6g}, {:.6g}) m as drawn{}", field(), (*q.point)[0], (*q.point)[1],
                         (*q.point)[2], at);
    return fmt::format("mean {} at {}{}", field(), q.place, at);
  case QuantityKind::extreme:
    return fmt::format("{} {} anywhere{}", q.extreme == post::Extreme::minimum ? "smallest" : "largest",
                       field(), at);
  }
  return "";
}

bool reads_film(QuantityKind kind) {
  return kind == QuantityKind::nominal_stress || kind == QuantityKind::radial_stretch ||
         kind == QuantityKind::value;
}

const Quantity* response_quantity(const Case& one, const std::string& name) {
  for (const QuantityKind kind :
       {QuantityKind::displacement, QuantityKind::angle, QuantityKind::radius, QuantityKind::distance}) {
    const bool directed = kind == QuantityKind::displacement || kind == QuantityKind::angle;
    for (const Quantity& quantity : one.quantities)
      if (quantity.kind == kind && (quantity.along || !directed) && !quantity.point &&
          (name.empty() || quantity.name == name))
        return &quantity;
  }
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
