// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/schema.hpp"

#include <cmath>

namespace dielast::cases {

Section study_section() {
  Section vary;
  vary.name = "vary";
  vary.meaning =
      "keys to vary, as \"section.key\" = [values], { from, to, step } or { from, to, count } with spacing = "
      "\"logarithmic\" where values are to have equal ratios; the study is their full grid. A name that is "
      "no "
      "key of the case is a parameter for `derive`";
  vary.presence = Section::Presence::separate;
  Section derive;
  derive.name = "derive";
  derive.meaning = "keys whose values are computed from those that vary, as \"film.prestretch\" = [\"l1\", "
                   "\"10 / l1\"]: numbers, units (2*mm), + - * / ^, sqrt, exp, ln, log10, abs, sin, "
                   "cos, tan (of angles with a unit: sin(pi/2*rad)), asin, acos, atan, pi";
  derive.presence = Section::Presence::separate;
  Section set;
  set.name = "set";
  set.meaning = "keys that have another value than in the case at all points, as \"output.fields\" = false";
  set.presence = Section::Presence::separate;
  Section plot = list_section(
      "plot",
      "a plot in the study's report; its points are joined where nothing but one key varies along a curve",
      each(&Study::plots));
  plot.keys = {
      text("x", to(&StudyPlot::x), "a varied key, or a quantity"),
      text("y", to(&StudyPlot::y), "quantities").values(1, 20),
      text("group", to(&StudyPlot::group), "a varied key: one curve for each of its values").optional(),
  };
  Section target = list_section(
      "target", "asks at which value of the one varied key a quantity has this value: found by further runs",
      each(&Study::targets));
  Binding tolerance = to(&StudyTarget::tolerance);
  tolerance.set = [](void* object, const Value& value) {
    StudyTarget& asked = *static_cast<StudyTarget*>(object);
    const Scalar& scalar = value.at(0);
    asked.tolerance = scalar.number * (scalar.text == "%" ? std::abs(asked.value) : 1.0);
  };
  Key allowance =
      text("tolerance", tolerance,
           "difference at which it counts as found: \"0.1 %\" of the value, or in the quantity's "
           "unit; without it 0.01 % of the value or of its change between the two points of the study beside "
           "it, whichever is smaller; of a value of 0 that of the change");
  allowance.type = Type::tolerance;
  target.keys = {
      text("quantity", to(&StudyTarget::quantity), "name of the quantity"),
      measure("value", "", to(&StudyTarget::value), "value that it is to have, in the quantity's unit"),
      std::move(allowance).above(0).optional(),
  };
  target.check = [](const void* object) -> std::optional<Conflict> {
    if (static_cast<const StudyTarget*>(object)->tolerance != 0.0) return std::nullopt;
    return Conflict{"tolerance", "a part of zero is zero; give it in the quantity's unit"};
  };
  Section bound =
      list_section("where", "what a point must hold to be among the best", each(&StudyBest::where));
  bound.keys = {
      text("quantity", to(&StudyBound::quantity), "name of the quantity"),
      measure("below", "", to(&StudyBound::below), "upper bound, in the quantity's unit").optional(),
      measure("above", "", to(&StudyBound::above), "lower bound, in the quantity's unit").optional(),
  };
  bound.check = [](const void* object) -> std::optional<Conflict> {
    const auto& one = *static_cast<const StudyBound*>(object);
    if (one.below || one.above) return std::nullopt;
    return Conflict{"below", "missing: this bounds nothing; give below, above or both"};
  };
  Section best = list_section(
      "best", "asks for the best point of the grid, among those that ran to their end", each(&Study::best));
  best.keys = {
      text("largest", to(&StudyBest::largest), "quantity that is to be large"),
      text("smallest", to(&StudyBest::smallest), "quantity that is to be small")
          .optional()
          .replacing("largest"),
  };
  best.sections = {bound};
  Section section;
  section.name = "study";
  section.meaning = "a sweep over keys of the case, run by `dielast study`";
  section.presence = Section::Presence::separate;
  section.access = same_object();
  section.keys = {
      text("collect", to(&Study::collect), "quantities in study.csv; without it all")
          .optional()
          .values(1, 1000),
      text("pair", to(&Study::pair),
           "varied keys, with equally many values, that go together: one axis of the grid")
          .optional()
          .values(2, 20),
  };
  section.sections = {vary, derive, set, plot, target, best};
  return section;
}

} // namespace dielast::cases
