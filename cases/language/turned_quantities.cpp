// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/turned_quantities.hpp"

#include "cases/text/units.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::cases {
namespace {

/// rad; 0 for what is no angle, which the reader reports.
double angle_of(const Node& part) try {
  if (const Node* turned = part.find("turned");
      turned && (turned->is(Node::Kind::number) || turned->is(Node::Kind::integer)))
    return turned->number;
  return parse_measure(text_at(part, "turned"), "rad").value;
} catch (const UnitError&) {
  return 0;
}

bool is_one_of(const std::string& word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

} // namespace

void turn_standard_quantities(std::vector<Node>& quantities, const Node& part) {
  const double quarters = angle_of(part) * 2 / std::numbers::pi;
  const double whole = std::round(quarters);
  const bool along_axes = std::abs(quarters - whole) < 1e-12;
  if (along_axes && std::fmod(whole, 2) == 0) return;
  std::erase_if(quantities, [&](Node& quantity) {
    const std::string kind = text_at(quantity, "kind");
    Node* const along = quantity.find("along");
    const bool straight = is_one_of(kind, {"distance", "elongation"});
    if (!along || !is_one_of(along->text, {"x", "y"}) ||
        !(straight || is_one_of(kind, {"growth", "size", "stretch", "stiffness"})))
      return false;
    if (along_axes)
      along->text = along->text == "x" ? "y" : "x";
    else if (straight)
      quantity.remove("along");
    return !along_axes && !straight;
  });
}

} // namespace dielast::cases
