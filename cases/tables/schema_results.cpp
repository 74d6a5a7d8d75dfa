// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/quantities.hpp"
#include "cases/language/conditions.hpp"
#include "cases/tables/sweep_keys.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

Section quantity_section() {
  Section section =
      list_section("quantity", "a number of the state, in every row of history.csv and in summary.json",
                   each(&Case::quantities));
  section.selector = "kind";
  std::vector<Choice> fields, of_film;
  for (const post::Scalar& field : post::scalars()) {
    fields.push_back({field.name, std::string(field.meaning)});
    if (field.part == post::Part::film) of_film.push_back(fields.back());
  }
  // in messages the scalars come before the components of tensors
  for (auto* all : {&fields, &of_film})
    std::stable_partition(all->begin(), all->end(),
                          [](const Choice& field) { return field.word.find('.') == std::string::npos; });
  const auto of = [](std::string meaning) { return text("of", to(&Quantity::of), std::move(meaning)); };
  section.keys = {
      text("name", to(&Quantity::name), "its name in results").distinct(),
      word(
          "kind",
          {{"distance", "between the centroids of two places (m)", QuantityKind::distance},
           {"elongation", "relative change of the distance between two places (-)", QuantityKind::elongation},
           {"stretch", "distance between two places over that of the unstretched film (-)",
            QuantityKind::stretch},
           {"size", "of the box around a place (m)", QuantityKind::size},
           {"growth", "relative change of the size of a place (-)", QuantityKind::growth},
           {"displacement", "of the centroid of a place (m)", QuantityKind::displacement},
           {"swelling", "largest displacement along an axis among the nodes of a place (m)",
            QuantityKind::swelling},
           {"angle", "rotation of a body about an axis (rad)", QuantityKind::angle},
           {"radius", "mean distance of a place's nodes from their centroid (m)", QuantityKind::radius},
           {"force", "reaction at a support while it holds (N)", QuantityKind::force},
           {"film force", "with which the film pulls on a place (N)", QuantityKind::film_force},
           {"moment", "reaction about an axis where a body's rotation is fixed (N m)", QuantityKind::moment},
           {"nominal stress", "force over undeformed section, mean over the film at a place (Pa)",
            QuantityKind::nominal_stress},
           {"capacitance", "of an electrode (F)", QuantityKind::capacitance},
           {"charge", "of an electrode (C)", QuantityKind::charge},
           {"current",
            "that the source of an electrode's [circuit] gives: without time what leaks; none where a "
            "charge is given (A)",
            QuantityKind::current},
           {"pressure", "in the chamber (Pa)", QuantityKind::pressure},
           {"volume", "of the chamber itself (m^3)", QuantityKind::volume},
           {"pumped volume", "that was pumped into the chamber, as it is without pressure (m^3)",
            QuantityKind::pumped_volume},
           {"stiffness",
            "force on a place per displacement along an axis, branches relaxed; none where the "
            "state is not at rest (N/m)",
            QuantityKind::stiffness},
           {"coupling",
            "force on a held place per squared voltage, over the electrode's capacitance per length as "
            "drawn, "
            "branches relaxed; none where the state is not at rest (-)",
            QuantityKind::coupling},
           {"natural frequency",
            "of small vibrations about the state, branches relaxed; none where it is "
            "not at rest (rad/s)",
            QuantityKind::natural_frequency},
           {"modal stiffness",
            "square of a natural frequency, of those nearest to zero: negative where the state is unstable "
            "(1/s^2)",
            QuantityKind::modal_stiffness},
           {"contact force",
            "sum of the normal forces where walls touch, surfaces of solids, a solid lies on a [table], or a "
            "[roll] on its core (N)",
            QuantityKind::contact_force},
           {"contact pressure",
            "largest normal force over area as drawn among the nodes of the surfaces that may touch (Pa)",
            QuantityKind::contact_pressure},
           {"radial stretch", "stretch of the film along the radius, mean at an edge (-)",
            QuantityKind::radial_stretch},
           {"energy", "part of the energy balance (J)", QuantityKind::energy},
           {"value", "of a field of the film: at a point, or its mean over a place", QuantityKind::value},
           {"extreme", "smallest or largest value of a field", QuantityKind::extreme},
           {"peak", "smallest or largest value of another quantity so far", QuantityKind::peak},
           {"mean", "mean of another quantity so far, over the time in which it has a value",
            QuantityKind::mean},
           {"fin force", "of the fluid on a fin, across it as drawn (N)", QuantityKind::fin_force},
           {"thrust", "of the fluid on a fin, along it from its trailing end to its front (N)",
            QuantityKind::thrust},
           {"fin power", "that a fin gives to the fluid (W)", QuantityKind::fin_power},
           {"margin",
            "factor on all voltages at the end of the run that leads to a limit, below 1 where it was "
            "passed; "
            "none where the run does not tell (-)",
            QuantityKind::margin}},
          to(&Quantity::kind), "what is measured"),
      text("between", to(&Quantity::between), "the two places")
          .values(2, 2)
          .only({"distance", "elongation", "stretch"})
          .refers_to(Reference::place),
      of("the place")
          .only({"size", "growth", "displacement", "swelling", "radius", "film force", "nominal stress",
                 "stiffness", "radial stretch"})
          .refers_to(Reference::place),
      of("the place of a support, or a body that is fixed")
          .only({"force"})
          .refers_to(Reference::supported_place),
      of("the surface; without it all that may touch")
          .only({"contact force", "contact pressure"})
          .optional()
          .refers_to(Reference::place),
      of("the body").only({"angle", "moment"}).refers_to(Reference::body),
      of("the fin").only({"fin force", "thrust", "fin power"}).refers_to(Reference::fin),
      of("the electrode")
          .only({"capacitance", "charge", "current", "coupling"})
          .refers_to(Reference::electrode),
      word("of", fields, to(&Quantity::of), "the field").only({"extreme"}),
      word("of", of_film, to(&Quantity::of), "the field").only({"value"}),
      text("place", to(&Quantity::place),
           "the place: a part of the film (mean by volume), or nodes (mean of what the elements continue to "
           "them)")
          .only({"value"})
          .refers_to(Reference::place),
      text("place", to(&Quantity::place), "the place that would be held")
          .only({"coupling"})
          .refers_to(Reference::place),
      measure("length", "m", to(&Quantity::length), "length of the electrode along the axis, as drawn")
          .above(0)
          .only({"coupling"}),
      measure("point", "m", to(&Quantity::point), "the point of the film, as drawn")
          .values(3, 3)
          .only({"value"})
          .replacing("place"),
      measure("point", "m", to(&Quantity::point), "instead of a place: the point of the film, as drawn")
          .values(3, 3)
          .only({"displacement"})
          .replacing("of"),
      word("of",
           {{"electrical_work", "done on the film's electrodes: sum of int Phi dQ"},
            {"mechanical_work", "done by loads, moved supports and the pressure in a chamber; where several "
                                "loads jump at once they do so along a straight line"},
            {"stored", "elastic, branches, electric and kinetic together"},
            {"elastic", "stored by the equilibrium law, walls and springs"},
            {"branches", "stored by the springs of the branches"},
            {"electric", "stored by the field"},
            {"kinetic", "of everything that has a mass"},
            {"dissipated", "turned into heat by dashpots, dampers and resistive electrodes"},
            {"source_work", "given by the sources: electrical_work, resistance_heat and leak_heat"},
            {"resistance_heat", "turned into heat by the resistances and limits of current of circuits"},
            {"leak_heat", "turned into heat by the current that leaks through the film"},
            {"released", "set free when the device is cut free or jumps to another state"},
            {"wrinkle_regularisation", "part of `elastic` that only keeps wrinkled film from being singular"},
            {"error",
             "estimate of the error of works and heat; beyond 1 % of them the run ends with exit code 5"}},
           to(&Quantity::of), "the part")
          .only({"energy"}),
      word("extreme",
           {{"minimum", "smallest value", post::Extreme::minimum},
            {"maximum", "largest value", post::Extreme::maximum}},
           to(&Quantity::extreme), "which extreme")
          .only({"extreme", "peak"}),
      word("of",
           {{"breakdown", "somewhere the field is the breakdown field"},
            {"loss of tension", "somewhere the film has lost its tension"},
            {"pull-in", "a limit point, beyond which no voltage is larger"},
            {"buckling", "a bifurcation, from which the device leaves its way"},
            {"wall yield", "somewhere a wall yields"}},
           to(&Quantity::of), "the limit")
          .only({"margin"}),
      of("the quantity").only({"peak", "mean"}).refers_to(Reference::quantity),
      word("along", {{"x", "", 0}, {"y", "", 1}, {"z", "", 2}}, to(&Quantity::along),
           "component; without it the magnitude")
          .optional()
          .only_with(when::moves_along_it())
          .only({"distance", "elongation", "size", "growth", "force", "film force"}),
      word("along", {{"x", "", 0}, {"y", "", 1}, {"z", "", 2}, {"gravity", "as it pulls", along_gravity}},
           to(&Quantity::along), "component; without it the magnitude")
          .optional()
          .only_with(when::moves_along_it())
          .only({"displacement"}),
      word("along", {{"x", "", 0}, {"y", "", 1}, {"z", "", 2}, {"gravity", "as it pulls", along_gravity}},
           to(&Quantity::along), "direction")
          .only_with(when::moves_along_it())
          .only({"coupling"}),
      word("along", {{"x", "", 0}, {"y", "", 1}, {"z", "", 2}}, to(&Quantity::along), "direction")
          .only_with(when::moves_along_it())
          .only({"stiffness", "swelling"}),
      word("along", {{"x", "", 0}, {"y", "", 1}, {"z", "", 2}}, to(&Quantity::along), "the axis")
          .only({"angle", "moment"}),
      integer("mode", to(&Quantity::mode), "its number, from the lowest frequency")
          .at_least(1)
          .at_most(100)
          .otherwise("1")
          .only({"natural frequency", "modal stiffness"}),
      word("along", {{"x", "", 0}, {"y", "", 1}}, to(&Quantity::along), "direction in the film's plane")
          .only({"stretch", "nominal stress"}),
      text("since", to(&Quantity::since), "step at whose end it is zero; without it the mesh as drawn")
          .optional()
          .only({"elongation", "growth", "displacement"})
          .refers_to(Reference::step),
      text("since", to(&Quantity::since), "step at whose end it begins; without it the whole run")
          .optional()
          .only({"mean"})
          .refers_to(Reference::step),
      text("at", to(&Quantity::at), "step at whose end summary.json reads it; without it the last")
          .optional()
          .refers_to(Reference::step),
  };
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
      word("along", {{"x", "", 0}, {"y", "", 1}, {"z", "", 2}}, to(&Profile::along),
           "component of the displacement")
          .only({"displacement"}),
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
          .at_most(1e-2)
          .otherwise("1e-9"),
      integer("max_iterations", to(&SolverOptions::max_iterations),
              "Newton iterations before an increment is cut")
          .at_least(1)
          .at_most(1000)
          .otherwise("25"),
      number("smallest_increment", to(&SolverOptions::smallest_increment),
             "part of a step below which it gives up")
          .at_least(1e-12)
          .at_most(1)
          .otherwise("1e-3"),
      number("time_tolerance", to(&SolverOptions::time_tolerance),
             "relative error of dashpots, charges and motion that one time step may add; run.log and "
             "summary.json tell the sum over the steps")
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
          .otherwise("1"),
      flag("fields", to(&Case::fields), "write the series of fields for ParaView").otherwise("true"),
      word("states",
           {{"all", "every row of the history", true},
            {"last", "the last of each step, on much less disk", false}},
           to(&Case::all_states),
           "what the series has, and whether the page has slides and its figures files of their own; points "
           "of a "
           "study have the last ones unless it is written")
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
  section.meaning = "the linear model that `dielast linearise` makes about the state at the end of the steps";
  section.access = member(&Case::linearise);
  section.keys = {
      integer("order", to(&Linearise::order), "number of its states").at_least(1).at_most(100).otherwise("3"),
      text("output", to(&Linearise::output),
           "quantity of kind \"displacement\", \"angle\", \"radius\" or \"distance\"; without it the first "
           "displacement that has a direction, or the first angle, radius or distance")
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
  return {quantity_section(), profile_section(),   check_section(), solver_section(),
          output_section(),   linearise_section(), study_section()};
}

} // namespace dielast::cases
