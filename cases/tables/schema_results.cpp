// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/quantities.hpp"
#include "cases/language/conditions.hpp"
#include "cases/tables/schema_controllers.hpp"
#include "cases/tables/sweep_keys.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

/// A kind is one of quantity_kinds(), and in a value its number there.
Binding kind_binding() {
  return {[](void* object, const Value& value) {
            static_cast<Quantity*>(object)->kind =
                &quantity_kinds()[static_cast<std::size_t>(value.at(0).number)];
          },
          [](const void* object) -> std::optional<Value> {
            const auto* kind = static_cast<const Quantity*>(object)->kind;
            if (!kind) return std::nullopt;
            return Value{{static_cast<double>(kind - quantity_kinds().data()), ""}};
          }};
}

Section quantity_section() {
  Section section =
      list_section("quantity", "a number of the state, in every row of history.csv and in summary.json",
                   each(&Case::quantities));
  section.selector = "kind";
  std::vector<Choice> kinds;
  for (const QuantityKind& kind : quantity_kinds()) {
    kinds.emplace_back(kind.word, kind.meaning, kinds.size());
    if (kind.keys) add_keys_of(kind.word, kind.keys(), section.keys);
  }
  section.keys.insert(section.keys.begin(),
                      {text("name", to(&Quantity::name), "its name in results").distinct(),
                       word("kind", kinds, kind_binding(), "what is measured")});
  section.keys.push_back(
      text("at", to(&Quantity::at), "step at whose end summary.json reads it; without it the last")
          .optional()
          .refers_to(Reference::step));
  return section;
}

Section profile_section() {
  Section section = list_section("profile",
                                 "how the nodes of a place have moved at the end, or what presses on them: "
                                 "the table profile_<name>.csv, "
                                 "and a curve on the page",
                                 each(&Case::profiles));
  section.selector = "kind";
  section.keys = {
      text("name", to(&Profile::name), "its name in results").distinct(),
      word("kind",
           {{"displacement", "along an axis (m)", ProfileKind::displacement},
            {"contact pressure", "normal force over area as drawn, of [contact] (Pa)",
             ProfileKind::contact_pressure}},
           to(&Profile::kind), "what is shown")
          .otherwise("displacement"),
      text("of", to(&Profile::of), "the place, such as a side or a surface").refers_to(Reference::place),
      word("along", axes(), to(&Profile::along), "component of the displacement").only({"displacement"}),
      text("since", to(&Profile::since), "step at whose end it is zero; without it the mesh as drawn")
          .optional()
          .only({"displacement"})
          .refers_to(Reference::step),
  };
  return section;
}

Section check_section() {
  Section section = list_section("check", "an expected result; a run that misses it ends with exit code 5",
                                 each(&Case::checks));
  Binding tolerance = to(&Check::tolerance);
  tolerance.set = [](void* object, const Value& value) {
    Check& check = *static_cast<Check*>(object);
    const Scalar& scalar = value.at(0);
    check.tolerance = scalar.number * (scalar.text == "%" ? std::abs(check.value) : 1.0);
  };
  Key allowance =
      text("tolerance", tolerance, "allowed difference: \"1 %\" of the value, or in the quantity's unit");
  allowance.type = Type::tolerance;
  allowance = std::move(allowance).above(0);
  section.keys = {
      text("quantity", to(&Check::quantity), "name of the quantity").refers_to(Reference::quantity),
      measure("value", "", to(&Check::value), "expected value, in the quantity's unit"),
      allowance,
      text("source", to(&Check::source), "where the expected value comes from"),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const double allowed = static_cast<const Check*>(object)->tolerance;
    if (!std::isfinite(allowed)) return Conflict{"tolerance", "is too large to store"};
    if (allowed > 0) return std::nullopt;
    return Conflict{"tolerance", "a part of zero is zero; give it in the quantity's unit"};
  };
  return section;
}

Section solver_section() {
  Section section;
  section.name = "solver";
  section.meaning = "when an equilibrium counts as found";
  section.access = member(&Case::solver);
  section.keys = {
      number("tolerance", to(&SolverOptions::tolerance), "out-of-balance force over the reaction scale")
          .above(1e-16)
          .at_most(1e-7)
          .otherwise("1e-9"),
      integer("max_iterations", to(&SolverOptions::max_iterations),
              "Newton iterations before an increment is cut")
          .at_least(1)
          .at_most(1000)
          .otherwise("25"),
      number("smallest_increment", to(&SolverOptions::smallest_increment),
             "part of a step below which it gives up, where longer parts have led to another branch a "
             "hundredth of it; without it 1e-3, with a shell or solids 1e-5")
          .at_least(1e-12)
          .at_most(1)
          .optional(),
      number(
          "time_tolerance", to(&SolverOptions::time_tolerance),
          "error that one time step may add: of the stretches of dashpots, which are about 1 (strains far "
          "below "
          "1 % need less), of charges, relative, and of motion over a hundredth of the device; run.log and "
          "summary.json tell the sum over the steps. With inertia every wave is followed that jumping loads "
          "send through film, where nothing but a viscosity damps it; beside a heavy plate 1e-4, or film "
          "without density, leaves its motion nearly as it is, with far fewer steps")
          .at_least(1e-12)
          .at_most(0.1)
          .otherwise("1e-6")
          .only_with(when::time_steps_matter()),
  };
  return section;
}

Section output_section() {
  Section section;
  section.name = "output";
  section.meaning = "what a run computes and writes besides the table of quantities";
  section.access = same_object();
  section.keys = {
      flag("error_estimate", to(&Case::error_estimate),
           "solve again with other elements and time steps to estimate the error")
          .otherwise("true"),
      number(
          "margins_up_to", to(&Case::margins_up_to),
          "factor on the voltages up to which limits are looked for beyond the end, by solving on; 1: what "
          "the run itself tells")
          .at_least(1)
          .at_most(100)
          .otherwise("1")
          .only_with(when::voltages()),
      flag("fields", to(&Case::fields), "write the series of fields for ParaView").otherwise("true"),
      word("states",
           {{"all", "every row of the history", true},
            {"last", "the last of each step, on much less disk", false}},
           to(&Case::all_states),
           "what the series has, and, with fields = false too, whether the page has slides and its figures "
           "files of their own; points of a study have the last ones unless it is written")
          .otherwise("all"),
  };
  return section;
}

Section linearise_section() {
  Section compare = list_section("compare", "a transfer function to compare with", each(&Linearise::compare));
  const auto powers = [](std::string name, std::vector<double> TransferFunction::*part, std::string meaning) {
    return number(std::move(name), to(part), std::move(meaning)).values(1, 20);
  };
  compare.keys = {
      text("name", to(&TransferFunction::name), "its name in the report"),
      powers("numerator", &TransferFunction::numerator,
             "coefficients of s, the highest power first; V give the output in its unit"),
      powers("denominator", &TransferFunction::denominator, "likewise"),
  };
  Section section;
  section.name = "linearise";
  section.presence = Section::Presence::optional;
  section.meaning = "the linear model that `dielast linearise` makes about the state at the end of the steps";
  section.access = present(&Case::linearise);
  section.keys = {
      integer("order", to(&Linearise::order), "number of its states").at_least(1).at_most(100).otherwise("3"),
      text("output", to(&Linearise::output),
           "quantity of kind " + response_kinds() +
               "; without it the first displacement that has a direction, or the first of the next kind that "
               "there is")
          .optional()
          .refers_to(Reference::quantity),
      text("driven", to(&Linearise::driven), driven_meaning)
          .values(1, 1000)
          .optional()
          .refers_to(Reference::electrode),
  };
  for (Key& key :
       sweep_keys(&Linearise::sweep, " at which it is compared with the full response", "0.01 Hz", "50 Hz"))
    section.keys.push_back(std::move(key));
  section.sections = {compare};
  section.check = [](const void* object) -> std::optional<Conflict> {
    return sweep_conflict(static_cast<const Linearise*>(object)->sweep);
  };
  return section;
}

} // namespace

std::vector<Section> result_sections() {
  return {quantity_section(), profile_section(), controller_section(), check_section(),
          solver_section(),   output_section(),  linearise_section(),  study_section()};
}

} // namespace dielast::cases
