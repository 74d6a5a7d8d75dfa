// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/conditions.hpp"

#include "cases/language/condition_on.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {

bool takes_time(const Case& one) {
  return std::ranges::any_of(one.steps, [](const Step& step) { return step.duration.has_value(); });
}

bool has_step(const Case& one, std::initializer_list<StepKind> kinds) {
  return std::ranges::any_of(
      one.steps, [&](const Step& step) { return std::ranges::find(kinds, step.kind) != kinds.end(); });
}

bool has_bars(const Part& part) {
  return part.beam || part.cable || part.hinge || part.ribbon ||
         std::holds_alternative<Honeycomb>(part.geometry);
}

bool has_heavy_bars(const Part& part) {
  const auto heavy = [](const Beam& beam) { return beam.material.density > 0; };
  const auto* lattice = std::get_if<Honeycomb>(&part.geometry);
  return (part.beam && heavy(*part.beam)) || (part.cable && part.cable->density > 0) ||
         (part.hinge && heavy(part.hinge->beam)) || (part.ribbon && heavy(part.ribbon->beam)) ||
         (lattice && heavy(lattice->wall));
}

namespace {

/// Whether film or bars have a density.
bool has_dense_parts(const Case& one) {
  return std::ranges::any_of(one.film_materials(),
                             [](const auto* material) { return material->density > 0; }) ||
         std::ranges::any_of(one.parts, [](const Part& part) { return has_heavy_bars(part); });
}

bool any_step(const Case& one, bool (*is)(const Step& step)) { return std::ranges::any_of(one.steps, is); }

bool any_quantity(const Case& one, bool (*is)(const Quantity& quantity)) {
  return std::ranges::any_of(one.quantities, is);
}

bool has_branches(const Case& one) {
  return std::ranges::any_of(one.film_materials(), [](const auto* material) {
    return !material->branches.empty() || material->viscosity > 0;
  });
}

bool has_inertia(const Case& one) {
  return any_step(one, [](const Step& step) { return step.inertia; });
}

} // namespace

bool has_mass(const Case& one) {
  const auto heavy = [](const auto& body) { return body.mass > 0; };
  return has_dense_parts(one) || (one.plate && heavy(*one.plate)) ||
         std::ranges::any_of(one.point_masses, heavy) || std::ranges::any_of(one.bodies, heavy) ||
         !one.fins.empty();
}

bool is_linearised(const Case& one) { return one.linearise || has_step(one, {StepKind::harmonic}); }

bool masses_accelerate(const Case& one) {
  return any_quantity(one, [](const Quantity& q) { return q.kind->vibrates; }) || has_inertia(one) ||
         is_linearised(one) || has_step(one, {StepKind::modes});
}

bool film_weighs(const Case& one) { return one.gravity.film && has_step(one, {StepKind::weight}); }

bool slides_with_friction(const Case& one) {
  return (one.table && one.table->friction > 0) ||
         (one.contact && !one.contact->between.empty() && one.contact->friction > 0);
}

bool may_jump(const Case& one) {
  return !slides_with_friction(one) && !one.any_film([](const Film& film) { return film.is_solid(); });
}

bool may_follow(const Case& one, const Step& step) { return !step.duration && !slides_with_friction(one); }

bool adapts(const Case& one, const Step& step) {
  return step.inertia || !one.circuits.empty() || has_branches(one) ||
         std::ranges::any_of(one.electrodes, [](const Electrode& electrode) {
           return electrode.sheet_resistance.has_value();
         });
}

namespace {

/// Whether dashpots of the film move, or keep others from moving.
constexpr const char* flow =
    "a step with a duration, of kind \"harmonic\", or with response = \"instantaneous\"";
bool flows(const Case& one) {
  return is_linearised(one) || std::ranges::any_of(one.steps, &Step::moves_dashpots);
}

/// Whether a step of a kind, `pressure` or `inflate`, reaches what [chamber] gives, or a transient follows
/// it: a chamber is open from the beginning, and from the former on, closed from the latter on.
bool follows_chamber(const Case& one, StepKind kind) {
  StepKind last = StepKind::pressure;
  for (const Step& step : one.steps) {
    if (step.kind == StepKind::pressure || step.kind == StepKind::inflate) last = step.kind;
    if (last == kind && ((step.kind == kind && !step.to) || step.kind == StepKind::transient)) return true;
  }
  return false;
}

/// Whether a ramp of that kind, or a transient, leads an electrode to what its drive says.
bool leads(const Case& one, const Drive& drive, StepKind kind, Control control) {
  const auto its = std::ranges::find_if(one.drives, [&](const auto& d) { return &d.second == &drive; });
  return std::ranges::any_of(one.steps, [&](const Step& step) {
    return (step.kind == kind && !step.to && (step.electrode.empty() || step.electrode == its->first)) ||
           (step.kind == StepKind::transient && step.control == control);
  });
}

} // namespace

namespace when {

Condition electrodes() {
  return on_case("an [[electrode]]", [](const Case& one) { return !one.electrodes.empty(); });
}

Condition charges_film() {
  return on<Film>("an [[electrode]] of the film itself", [](const Case& one, const Film& film) {
    const auto owner =
        std::ranges::find_if(one.parts, [&](const Part& part) { return part.film && &*part.film == &film; });
    const bool by_name = owner != one.parts.end() && owner->has_mesh() && !owner->name.empty();
    return std::ranges::any_of(one.electrodes, [&](const Electrode& e) {
      return e.layer.empty() &&
             (!by_name || e.place == owner->name || e.place.starts_with(owner->name + "."));
    });
  });
}

Condition charges_layer() {
  return on<Layer>("an [[electrode]] of the layer", [](const Case& one, const Layer& layer) {
    return std::ranges::any_of(one.electrodes,
                               [&](const Electrode& e) { return !e.layer.empty() && e.layer == layer.name; });
  });
}

Condition voltages() {
  return on_case("an [[electrode]], a step of kind \"voltage\", and none with a duration",
                 [](const Case& one) {
                   return !one.electrodes.empty() && !takes_time(one) &&
                          any_step(one, [](const Step& step) { return step.kind == StepKind::voltage; });
                 });
}

Condition branches() {
  return on_case("a [[film.material.branch]] or a viscosity",
                 [](const Case& one) { return has_branches(one); });
}

Condition sheets_matter() {
  return on_case("a step with a duration, or a leakage_resistance", [](const Case& one) {
    return takes_time(one) || std::ranges::any_of(one.circuits, [](const auto& circuit) {
             return circuit.second.leakage_resistance.has_value();
           });
  });
}

Condition without_duration() {
  return on<Step>("a step without a duration", [](const Case&, const Step& step) { return !step.duration; });
}

Condition weight() {
  return on_case("a step of kind \"weight\"",
                 [](const Case& one) { return has_step(one, {StepKind::weight}); });
}

Condition direction_of_weight() {
  return on_case("a step of kind \"weight\", or a quantity along gravity", [](const Case& one) {
    return has_step(one, {StepKind::weight}) ||
           any_quantity(one, [](const Quantity& q) { return q.along == along_gravity; });
  });
}

Condition film_has_weight() {
  return on_case("a step of kind \"weight\", and a density of film or bars",
                 [](const Case& one) { return has_step(one, {StepKind::weight}) && has_dense_parts(one); });
}

Condition masses_matter() {
  return on_case("inertia, a step of kind \"modes\" or \"harmonic\", or a weight",
                 [](const Case& one) { return masses_accelerate(one) || film_weighs(one); });
}

Condition point_masses_matter() {
  return on_case("inertia, or a step of kind \"weight\", \"modes\" or \"harmonic\"",
                 [](const Case& one) { return masses_accelerate(one) || has_step(one, {StepKind::weight}); });
}

Condition hung_weight_matters() {
  return on_case(
      "a step of kind \"weight\", \"modes\" or \"harmonic\", or inertia, and in natural frequencies",
      [](const Case& one) {
        return has_inertia(one) || is_linearised(one) || has_step(one, {StepKind::weight, StepKind::modes});
      });
}

Condition turns_matter() {
  const Condition mass = masses_matter();
  return {mass.needs + ", of what is not of revolution", [mass](const Case& one, const void* object) {
            return one.dimension != fem::Dimension::axisymmetric && mass.met(one, object);
          }};
}

Condition inertia() { return on_case("a step with inertia", has_inertia); }

Condition dampers_matter() {
  return on_case("a mass in a step with inertia, or a step of kind \"harmonic\"", [](const Case& one) {
    return (has_inertia(one) && cases::has_mass(one)) || is_linearised(one);
  });
}

Condition has_mass() {
  return on_case("a mass: of film or bars (their density), a [plate], a [[point_mass]] or a [[body]]",
                 [](const Case& one) { return cases::has_mass(one); });
}

Condition film_flows() {
  return on_case(flow, [](const Case& one) { return flows(one); });
}

Condition branches_flow() {
  const std::string text =
      std::string(flow) + ", or with dashpot = \"nominal\": its spring resists shear for ever";
  return on<materials::Branch>(text, [](const Case& one, const materials::Branch& branch) {
    return flows(one) || branch.dashpot == materials::Dashpot::nominal;
  });
}

Condition circuits_matter() {
  return on<Circuit>("a step with a duration or of kind \"harmonic\", or a leakage_resistance",
                     [](const Case& one, const Circuit& circuit) {
                       return takes_time(one) || is_linearised(one) || circuit.leakage_resistance;
                     });
}

Condition limits_matter() {
  return on<Circuit>(
      "a step with a duration, or a leakage_resistance",
      [](const Case& one, const Circuit& circuit) { return takes_time(one) || circuit.leakage_resistance; });
}

Condition time_steps_matter() {
  return on_case("a step with a duration in which branches, a circuit or a sheet_resistance flow, or inertia",
                 [](const Case& one) {
                   return std::ranges::any_of(
                       one.steps, [&](const Step& step) { return step.duration && adapts(one, step); });
                 });
}

Condition voltage_applies() {
  return on<Drive>(
      "a step of kind \"voltage\" about its electrode and without `to`, \"transient\" with control = "
      "\"voltage\", or \"harmonic\" without `driven`",
      [](const Case& one, const Drive& drive) {
        return (one.linearise && one.linearise->driven.empty()) ||
               leads(one, drive, StepKind::voltage, Control::voltage) || any_step(one, [](const Step& step) {
                 return step.kind == StepKind::harmonic && step.driven.empty();
               });
      });
}

Condition charge_applies() {
  return on<Drive>("a step of kind \"charge\" about its electrode and without `to`, or \"transient\" with "
                   "control = \"charge\"",
                   [](const Case& one, const Drive& drive) {
                     return leads(one, drive, StepKind::charge, Control::charge);
                   });
}

Condition chamber_is_open() {
  return on_case("a step of kind \"pressure\" without `to`, or \"transient\" while none of kind \"inflate\" "
                 "has closed it",
                 [](const Case& one) { return follows_chamber(one, StepKind::pressure); });
}

Condition chamber_is_closed() {
  return on_case("a step of kind \"inflate\", or a quantity of kind \"pumped volume\"", [](const Case& one) {
    return has_step(one, {StepKind::inflate}) ||
           any_quantity(one, [](const Quantity& q) { return q.kind->word == "pumped volume"; });
  });
}

Condition surfaces_touch() {
  return on_case("contact.between",
                 [](const Case& one) { return one.contact && !one.contact->between.empty(); });
}

Condition volume_applies() {
  return on_case("a step of kind \"inflate\" without `to`, or \"transient\" after that",
                 [](const Case& one) { return follows_chamber(one, StepKind::inflate); });
}

Condition an_electrode_keeps_off_walls() {
  return on_case("an [[electrode]] at the place \"electrode\"", [](const Case& one) {
    return std::ranges::any_of(one.electrodes, [](const Electrode& e) {
      return e.place == "electrode" || e.place.ends_with(".electrode");
    });
  });
}

Condition of_revolution() {
  return on_case("model = \"axisymmetric\"",
                 [](const Case& one) { return one.dimension == fem::Dimension::axisymmetric; });
}

Condition in_space() {
  return on_case("model = \"3d\"", [](const Case& one) { return one.dimension == fem::Dimension::spatial; });
}

Condition moves_along_it() {
  return on<Quantity>(
      "motion along that direction: a planar model has none along z, one of revolution none along y but at a "
      "point beside y = 0",
      [](const Case& one, const Quantity& quantity) {
        const auto moves = [&](int c) {
          const bool turned = one.dimension == fem::Dimension::axisymmetric && c == 1 && quantity.point &&
                              (*quantity.point)[1] != 0;
          return turned || fem::moves(one.dimension, c);
        };
        const auto pulls = [&](std::size_t c) {
          return one.gravity.direction[c] != 0 && moves(static_cast<int>(c));
        };
        if (quantity.along == along_gravity) return pulls(0) || pulls(1) || pulls(2);
        return !quantity.along || moves(*quantity.along);
      });
}

} // namespace when

} // namespace dielast::cases
