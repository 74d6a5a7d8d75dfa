// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/quantities/probing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace dielast::cases {

std::span<const QuantityKind> quantity_kinds() {
  static const std::vector<QuantityKind> all = [] {
    std::vector<QuantityKind> kinds;
    for (const auto& some : {shape_kinds, area_kinds, force_kinds, port_kinds, stiffness_kinds, field_kinds,
                             run_kinds, fin_kinds})
      std::ranges::move(some(), std::back_inserter(kinds));
    return kinds;
  }();
  return all;
}

void Probing::refuse(const std::string& key, const std::string& message) const {
  throw one.error_at(path + "." + key, message);
}

std::size_t Probing::electrode() const { return device.model.ports.electrode(quantity.of); }

Eigen::Vector3d Probing::axis() const {
  return quantity.along == along_gravity ? one.gravity.down() : Eigen::Vector3d::Unit(*quantity.along);
}

std::vector<Choice> axes_and_gravity() {
  std::vector<Choice> all = axes();
  all.emplace_back("gravity", "as it pulls", along_gravity);
  return all;
}

Key of_key(std::string meaning) { return text("of", to(&Quantity::of), std::move(meaning)); }

Key place_key() { return of_key("the place").refers_to(Reference::place); }

Key between_key() {
  return text("between", to(&Quantity::between), "the two places").values(2, 2).refers_to(Reference::place);
}

Key electrode_key() { return of_key("the electrode").refers_to(Reference::electrode); }

Key body_key() { return of_key("the body").refers_to(Reference::body); }

Key about_key() { return word("along", axes(), to(&Quantity::along), "the axis"); }

std::string turns_not(const Case& one, const Quantity&) {
  return one.dimension == fem::Dimension::axisymmetric
             ? "in a model of revolution bodies move along z alone, and do not turn"
             : "";
}

Key component_key() {
  return word("along", axes(), to(&Quantity::along), "component; without it the magnitude")
      .optional()
      .only_with(when::moves_along_it());
}

Key axis_key() {
  return word("along", axes(), to(&Quantity::along), "direction").only_with(when::moves_along_it());
}

Key plane_key() {
  return word("along", {{"x", "", 0}, {"y", "", 1}}, to(&Quantity::along), "direction in the film's plane");
}

Key since_key(std::string meaning) {
  return text("since", to(&Quantity::since), std::move(meaning)).optional().refers_to(Reference::step);
}

Key extreme_key() {
  return word("extreme",
              {{"minimum", "smallest value", post::Extreme::minimum},
               {"maximum", "largest value", post::Extreme::maximum}},
              to(&Quantity::extreme), "which extreme");
}

const char* extreme_word(const Quantity& quantity) {
  return quantity.extreme == post::Extreme::minimum ? "smallest" : "largest";
}

namespace {

std::string axis_words(const char* preposition, const Quantity& quantity) {
  static constexpr const char* axes[] = {"x", "y", "z", "gravity"};
  return quantity.along ? fmt::format(" {} {}", preposition, axes[*quantity.along]) : "";
}

} // namespace

std::string along_words(const Quantity& quantity) { return axis_words("along", quantity); }
std::string about_words(const Quantity& quantity) { return axis_words("about", quantity); }

std::string at_words(const Quantity& quantity) {
  return quantity.at.empty() ? "" : fmt::format(", at the end of \"{}\"", quantity.at);
}

std::string since_words(const Quantity& quantity) {
  return quantity.since.empty() ? "the mesh as drawn" : "\"" + quantity.since + "\"";
}

std::string field_words(const Quantity& quantity) {
  std::string words = quantity.of;
  std::ranges::replace(words, '_', ' ');
  return words;
}

} // namespace dielast::cases
