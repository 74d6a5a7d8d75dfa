// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/tables/schema_controllers.hpp"
#include "cases/language/schema.hpp"

#include <algorithm>

namespace dielast::cases {

Section controller_section() {
  Section section = list_section(
      "controller",
      "while time passes in a step of kind \"transient\" the source of an electrode follows a quantity: it "
      "gives the voltage of its [drive], more by what the quantity lacks of its target, and holds it until "
      "the next measurement",
      each(&Case::controllers));
  section.keys = {
      text("electrode", to(&Controller::electrode), "the electrode")
          .refers_to(Reference::electrode)
          .distinct(),
      text("quantity", to(&Controller::quantity), "name of the quantity that is measured")
          .refers_to(Reference::quantity),
      measure("target", "", to(&Controller::target), "what the quantity should be"),
      number("gain", to(&Controller::gain),
             "V for each unit that the quantity lacks, in SI: V/m of a displacement"),
      number("integral_gain", to(&Controller::integral_gain),
             "V for each unit that it lacks for a second, likewise")
          .otherwise("0"),
      measure("every", "s", to(&Controller::every), "time between two measurements; the first is at t = 0")
          .above(0),
      measure("lowest", "V", to(&Controller::lowest), "least voltage that the source can give")
          .otherwise("0 V"),
      measure("highest", "V", to(&Controller::highest), "largest voltage that the source can give"),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& controller = *static_cast<const Controller*>(object);
    if (controller.lowest < controller.highest) return std::nullopt;
    return Conflict{"highest", "must be above lowest"};
  };
  section.acts = {"a step of kind \"transient\" in which electrodes are connected",
                  [](const Case& one, const void*) {
                    return std::ranges::any_of(one.steps, [](const Step& step) {
                      return step.kind == StepKind::transient && step.control == Control::voltage;
                    });
                  }};
  return section;
}

} // namespace dielast::cases
