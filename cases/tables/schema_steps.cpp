// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/quantities.hpp"
#include "cases/language/conditions.hpp"
#include "cases/tables/sweep_keys.hpp"

namespace dielast::cases {
namespace {

const std::vector<std::string> ramps{"release", "voltage", "charge",   "force",
                                     "move",    "weight",  "pressure", "inflate"};
const std::vector<std::string> timed{"transient", "hold"};
const std::vector<std::string> moving{"release",  "voltage", "charge",    "force", "move", "weight",
                                      "pressure", "inflate", "transient", "hold",  "relax"};

std::optional<Conflict> conflict(const void* object) {
  const auto& step = *static_cast<const Step*>(object);
  if (step.kind == StepKind::harmonic)
    if (auto wrong = sweep_conflict(step.sweep)) return wrong;
  if (step.record && !step.duration) return Conflict{"record", "only for a step with a duration"};
  if (step.record && *step.record > *step.duration) return Conflict{"record", "is longer than the step"};
  if (step.duration && step.on_instability == OnInstability::follow)
    return Conflict{
        "on_instability",
        "time does not go back: a path is followed by steps without a duration; use \"jump\" or \"stop\""};
  return std::nullopt;
}

} // namespace

Section step_section() {
  const auto increments = [](std::string count, std::string meaning) {
    return integer("increments", to(&Step::increments), std::move(meaning))
        .at_least(1)
        .at_most(100000)
        .otherwise(std::move(count));
  };
  const auto duration = [](std::string meaning) {
    return measure("duration", "s", to(&Step::duration), std::move(meaning)).above(0);
  };
  Binding response = to(&Step::response);
  response.get = [](const void* object) -> std::optional<Value> {
    const auto& step = *static_cast<const Step*>(object);
    return step.duration ? std::nullopt : value_of(step.response); // with a duration there is none
  };
  const std::string equal = "number of equal increments to start with";

  Section section = list_section("step", "what happens, in this order", each(&Case::steps));
  section.selector = "kind";
  section.keys = {
      word(
          "kind",
          {{"release",
            "the prestretched film is cut free and finds its equilibrium; where edges in tension are free "
            "and no step of this kind is the first, one called \"settle\" comes before it; where it cannot "
            "be let go slowly, it jumps to a stable state, also with `on_instability` \"stop\"",
            StepKind::release},
           {"voltage", "ramps every drive to its voltage", StepKind::voltage},
           {"charge", "ramps every drive to its charge: the electrodes are isolated", StepKind::charge},
           {"force", "ramps every load to its force", StepKind::force},
           {"move", "ramps every moved support to its displacement", StepKind::move},
           {"weight", "lets gravity act", StepKind::weight},
           {"pressure", "ramps the chamber to its pressure", StepKind::pressure},
           {"inflate", "pumps the chamber to its volume", StepKind::inflate},
           {"transient", "time passes: drives, loads and supports follow their waves", StepKind::transient},
           {"hold", "time passes: drives, loads and supports stay as they are", StepKind::hold},
           {"relax",
            "dashpots and the charges behind circuits and on sheets flow to the end: drives, loads and "
            "supports stay as they are, and no time passes; how the heat divides among dashpots, sheets and "
            "resistances is known in time only, by a step \"hold\"",
            StepKind::relax},
           {"modes", "small free vibrations about the state, branches relaxed; of revolution round ones only",
            StepKind::modes},
           {"harmonic",
            "response to a small sine of the source, frequency by frequency, branches relaxed; peaks of what "
            "nothing damps are as high as their frequency is near",
            StepKind::harmonic}},
          to(&Step::kind), "what happens in this step"),
      text("name", to(&Step::name), "its name in results").otherwise_as("kind").distinct(),
      measure("to", "V", to(&Step::to), "voltage that it ramps to, instead of that of [drive]")
          .optional()
          .only_with(when::electrodes())
          .only({"voltage"}),
      measure("to", "C", to(&Step::to), "charge that it ramps to, instead of that of [drive]")
          .optional()
          .only_with(when::electrodes())
          .only({"charge"}),
      measure("to", "Pa", to(&Step::to), "pressure that it ramps to, instead of that of [chamber]")
          .optional()
          .only({"pressure"}),
      measure("to", "m^3", to(&Step::to), "volume that it pumps to, instead of that of [chamber]")
          .at_least(0)
          .optional()
          .only({"inflate"}),
      number("to", to(&Step::to),
             "part of its forces that every load ramps to, instead of all: 0 takes it off")
          .at_least(-1000)
          .at_most(1000)
          .optional()
          .only({"force"}),
      number("to", to(&Step::to),
             "part of its displacements that every moved support ramps to, instead of all: 0 leads it back")
          .at_least(-1000)
          .at_most(1000)
          .optional()
          .only({"move"}),
      text("electrode", to(&Step::electrode),
           "the only one that it is about: others that are isolated stay so, with their charges; without it "
           "all")
          .optional()
          .refers_to(Reference::electrode)
          .only({"voltage", "charge"}),
      increments("1", equal).only({"release", "relax"}),
      increments("10", equal).only({"voltage", "charge", "force", "move", "pressure", "inflate"}),
      increments("5", equal).only({"weight"}),
      increments("100", "the longest time step is the duration over this").only({"transient"}),
      increments("20", "the longest time step is the duration over this").only({"hold"}),
      duration("time that it takes; without it no time passes").optional().only(ramps),
      duration("time that it takes").only(timed),
      word("response",
           {{"relaxed", "the branches have all the time they need", Response::relaxed},
            {"instantaneous", "the branches have no time to flow", Response::instantaneous}},
           response, "what the branches of the film do in a ramp without a duration")
          .otherwise("relaxed")
          .only_with(when::branches())
          .replacing("duration")
          .only(ramps),
      measure("record", "s", to(&Step::record),
              "of a step with a duration: time between rows of the history; without it one for each "
              "increment. Events and peaks are those of all time steps")
          .above(0)
          .optional()
          .only(moving),
      word("control",
           {{"voltage", "the electrodes stay connected to their sources", Control::voltage},
            {"charge",
             "the electrodes are isolated, or follow their charges in a transient; a source that is "
             "connected again takes up at the voltage that it needs to keep the electrode's",
             Control::charge}},
           to(&Step::control), "what the electrodes keep")
          .otherwise("voltage")
          .only_with(when::electrodes())
          .only({"force", "move", "weight", "pressure", "inflate", "transient", "hold", "relax", "modes"}),
      integer("count", to(&Step::count), "number of modes")
          .at_least(1)
          .at_most(200)
          .otherwise("6")
          .only({"modes"}),
      text("response_of", to(&Step::response_of),
           "quantity of kind " + response_kinds() +
               "; without it the first displacement that has a direction, or the first of the next kind that "
               "there is")
          .optional()
          .refers_to(Reference::quantity)
          .only({"harmonic"}),
      text("driven", to(&Step::driven), driven_meaning)
          .values(1, 1000)
          .optional()
          .refers_to(Reference::electrode)
          .only({"harmonic"}),
      flag("inertia", to(&Step::inertia),
           "what has a mass resists acceleration; with a [plate], a [[point_mass]], a [[fin]], or a [weight] "
           "or "
           "[[body]] of some mass the default is true")
          .otherwise("false")
          .only_with(when::has_mass())
          .only(timed),
      word("on_instability",
           {{"stop", "the step ends at a limit point", OnInstability::stop},
            {"follow", "along the unstable path, by arclength", OnInstability::follow},
            {"jump", "to the next stable state, by damped motion", OnInstability::jump}},
           to(&Step::on_instability), "what happens where the equilibrium ends or loses its stability")
          .otherwise("stop")
          .only(moving),
      word("on_bifurcation",
           {{"follow", "along the path it is on", OnBifurcation::follow},
            {"switch",
             "onto the branch that is stable; where there is none, with on_instability \"jump\" to the "
             "next stable state",
             OnBifurcation::switch_branch}},
           to(&Step::on_bifurcation), "what happens where another path branches off")
          .otherwise("follow")
          .only_with(when::without_duration())
          .only(moving),
  };
  for (Key& key : sweep_keys(&Step::sweep, "", "0.1 Hz", "100 Hz"))
    section.keys.push_back(std::move(key).only({"harmonic"}));
  section.check = conflict;
  return section;
}

} // namespace dielast::cases
