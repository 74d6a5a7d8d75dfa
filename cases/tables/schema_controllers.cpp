// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/tables/schema_controllers.hpp"
#include "cases/language/conditions.hpp"

#include <algorithm>

namespace dielast::cases {
namespace {

constexpr double most_gain = 1e18; ///< 1 kV for each fF

bool has_transient(const Case& one, Control control) {
  return std::ranges::any_of(one.steps, [&](const Step& step) {
    return step.kind == StepKind::transient && step.control == control;
  });
}

/// A pressure acts until the chamber is pumped up, a volume from then on.
bool chamber_follows(const Case& one, bool pumped) {
  bool closed = false;
  for (const Step& step : one.steps) {
    if (step.kind == StepKind::inflate) closed = true;
    if (step.kind == StepKind::pressure) closed = false;
    if (step.kind == StepKind::transient && closed == pumped) return true;
  }
  return false;
}

bool acts(const Case& one, Driven what) {
  switch (what) {
  case Driven::voltage:
    return has_transient(one, Control::voltage);
  case Driven::pressure:
    return chamber_follows(one, false);
  case Driven::volume:
    return chamber_follows(one, true);
  case Driven::force:
  case Driven::displacement:
    return has_step(one, {StepKind::transient});
  }
  return false;
}

template<class M>
Binding of_load(M DrivenLoad::*part) {
  return to_part<Controller>([part](auto& controller) -> auto& { return controller.drives.*part; });
}

} // namespace

Section controller_section() {
  Section section = list_section(
      "controller",
      "while time passes in a step of kind \"transient\" a voltage, a pressure ... follows a quantity: it is "
      "what the case says of it, more by what the quantity lacks of its target, and is held until the next "
      "measurement",
      each(&Case::controllers));
  section.selector = "drives";
  section.keys = {
      word(
          "drives",
          {{"voltage", "of the source of an electrode", Driven::voltage},
           {"pressure", "of the chamber, as long as it is open to its pressure", Driven::pressure},
           {"volume", "pumped into the chamber, once a step of kind \"inflate\" has closed it",
            Driven::volume},
           {"force", "of the [[load]] on a place", Driven::force},
           {"displacement", "of the [[support]] of a place, from the film as drawn, in steps without inertia",
            Driven::displacement}},
          of_load(&DrivenLoad::what), "what it drives")
          .otherwise("voltage"),
      text("electrode", of_load(&DrivenLoad::of), "the electrode")
          .refers_to(Reference::electrode)
          .only({"voltage"}),
      text("place", of_load(&DrivenLoad::of), "the place of the load")
          .refers_to(Reference::place)
          .only({"force"}),
      text("place", of_load(&DrivenLoad::of), "the place that is held")
          .refers_to(Reference::supported_place)
          .only({"displacement"}),
      word("along", axes(), of_load(&DrivenLoad::along), "component of the force or displacement")
          .only({"force", "displacement"}),
      text("quantity", to(&Controller::quantity), "name of the quantity that is measured")
          .refers_to(Reference::quantity),
      measure("target", "", to(&Controller::target), "what the quantity should be"),
      number("gain", to(&Controller::gain),
             "V, Pa, m^3, N or m for each unit that the quantity lacks, in SI: V/m of a displacement")
          .at_least(-most_gain)
          .at_most(most_gain),
      number("integral_gain", to(&Controller::integral_gain),
             "the same for each unit that it lacks for a second")
          .at_least(-most_gain)
          .at_most(most_gain)
          .otherwise("0"),
      measure("every", "s", to(&Controller::every), "time between two measurements; the first is at t = 0")
          .above(0),
  };
  for (const auto& [what, unit] : {std::pair{"voltage", "V"},
                                   {"pressure", "Pa"},
                                   {"volume", "m^3"},
                                   {"force", "N"},
                                   {"displacement", "m"}}) {
    const std::string zero = std::string("0 ") + unit;
    section.keys.push_back(measure("lowest", unit, to(&Controller::lowest), "least that it can be")
                               .otherwise(zero)
                               .only({what}));
    section.keys.push_back(
        measure("highest", unit, to(&Controller::highest), "most that it can be").only({what}));
  }
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& controller = *static_cast<const Controller*>(object);
    if (controller.lowest < controller.highest) return std::nullopt;
    return Conflict{"highest", "must be above lowest, 0 where nothing else is written"};
  };
  section.acts = {"a step of kind \"transient\" in which what it drives is given: electrodes connected, the "
                  "chamber open to a pressure or pumped up",
                  [](const Case& one, const void* object) {
                    return acts(one, static_cast<const Controller*>(object)->drives.what);
                  }};
  return section;
}

} // namespace dielast::cases
