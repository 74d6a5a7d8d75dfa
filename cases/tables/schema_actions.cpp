// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/conditions.hpp"
#include "cases/tables/motion_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

constexpr double smallest_resistance = 1e-3; ///< Ohm: below, charging is quicker than any step of time

const std::vector<Choice> described_axes{
    {"x", "along x", 0}, {"y", "along y", 1}, {"z", "along z, normal to flat film", 2}};

Section electrode_section() {
  Section section = list_section("electrode", "a charged part of the film", each(&Case::electrodes));
  section.keys = {
      text("name", to(&Electrode::name), "its name, for [drive.<name>]").distinct(),
      text("place", to(&Electrode::place), "the part of the film that it covers").refers_to(Reference::place),
      text("layer", to(&Electrode::layer), "the [[film.layer]] that it charges; without it the film itself")
          .optional(),
      text("ground", to(&Electrode::ground),
           "of a solid with field = \"potential\": the surface without voltage; `place` is the one that is "
           "charged")
          .optional()
          .refers_to(Reference::place),
      measure("sheet_resistance", "Ohm", to(&Electrode::sheet_resistance),
              "per square of the deformed film, both faces together; without it the voltage is the same "
              "everywhere")
          .at_least(smallest_resistance)
          .optional()
          .only_with(when::sheets_matter()),
      text("terminal", to(&Electrode::terminal),
           "place where an electrode with a sheet_resistance is connected")
          .optional()
          .refers_to(Reference::place),
      measure("stray_capacitance", "F", to(&Electrode::stray_capacitance),
              "beside the film's, of leads and of what measures it")
          .at_least(0)
          .at_most(1)
          .otherwise("0 F"),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& electrode = *static_cast<const Electrode*>(object);
    for (const Section& one : case_schema().sections)
      if (one.shape == Section::Shape::by_electrode && one.find_key(electrode.name, ""))
        return Conflict{"name", fmt::format("a key of [{0}], from which [{0}.{1}] could not be told",
                                            one.name, electrode.name)};
    if (electrode.sheet_resistance && electrode.stray_capacitance > 0)
      return Conflict{"stray_capacitance", "none beside a sheet_resistance"};
    if (electrode.sheet_resistance.has_value() == !electrode.terminal.empty()) return std::nullopt;
    return electrode.terminal.empty()
               ? Conflict{"terminal", "missing; say where the resistive electrode is connected"}
               : Conflict{"sheet_resistance", "missing; only a resistive electrode has a terminal"};
  };
  return section;
}

/// [support.displacement]
Section displacement_section() {
  Section section;
  section.name = "displacement";
  section.meaning = "where the steps of kind \"move\" and \"transient\" take a support";
  section.access = same_object();
  section.access.entries = [](const void* parent) {
    return static_cast<const Support*>(parent)->moves() ? std::vector<Access::Entry>{{"", parent}}
                                                        : std::vector<Access::Entry>{};
  };
  for (std::size_t i = 0; i < described_axes.size(); ++i) {
    Binding motion = to_part<Support>([i](auto& support) -> auto& { return support.motion[i]; });
    motion.set = [i](void* object, const Value& value) {
      auto& support = *static_cast<Support*>(object);
      assign(support.motion[i], value);
      support.fixed[i] = true; // what is moved is held
    };
    section.keys.push_back(wave(described_axes[i].word, "m", motion,
                                "displacement " + described_axes[i].meaning + ", from the film as drawn")
                               .optional());
  }
  return section;
}

Section support_section() {
  Section section =
      list_section("support",
                   "a place that is held or moved. Nodes that one support merely holds (fix) another may "
                   "move; two that move the same nodes must say the same, a displacement of 0 too",
                   each(&Case::supports));
  section.keys = {
      text("place", to(&Support::place), "the place that is held").refers_to(Reference::place),
      word("fix", motions, flags(&Support::fixed),
           "what its nodes cannot do; walls and shells have rotations, membranes have none")
          .values(1, 6)
          .checked(each_once)
          .optional(),
      text("from", to(&Support::from), "the first step in which it holds, its place being where it is then")
          .optional()
          .refers_to(Reference::step),
      text("until", to(&Support::until),
           "the last step in which it holds; in the next its forces are ramped to zero")
          .optional()
          .refers_to(Reference::step),
  };
  section.sections.push_back(displacement_section());
  section.check = [](const void* object) -> std::optional<Conflict> {
    if (std::ranges::count(static_cast<const Support*>(object)->fixed, true) > 0) return std::nullopt;
    return Conflict{"fix", "missing; give the directions in which it is held, such as [\"x\", \"y\"], or a "
                           "displacement"};
  };
  return section;
}

Section load_section() {
  Section section =
      list_section("load", "a dead force or moment, applied by the steps of kind \"force\" and \"transient\"",
                   each(&Case::loads));
  Binding force = to(&Load::force);
  force.get = [](const void* object) -> std::optional<Value> {
    const auto& load = *static_cast<const Load*>(object);
    return load.moment ? std::nullopt : value_of(load.force);
  };
  section.keys = {
      text("place", to(&Load::place),
           "the place over whose volume, area or length as drawn it is spread evenly")
          .refers_to(Reference::place),
      wave("force", "N", force, "components along x, y and z; a load is a force or a moment").values(3, 3),
      wave("moment", "N m", to(&Load::moment),
           "instead of a force: components about axes along x, y and z that stay; on a body, or on those "
           "nodes of walls that can "
           "turn")
          .values(3, 3)
          .replacing("force"),
  };
  return section;
}

/// Keys of what pulls at the distance of two places.
template<class T>
std::vector<Key> distance_keys() {
  return {text("between", to(&T::between), "the two places (their centroids)")
              .values(2, 2)
              .refers_to(Reference::place),
          word("along", described_axes, to(&T::along), "axis along which the distance is taken")};
}

Section spring_section() {
  Section section = list_section("spring", "a linear spring between two places", each(&Case::springs));
  section.keys = distance_keys<Spring>();
  section.keys.push_back(
      measure("stiffness", "N/m", to(&Spring::stiffness), "force per change of the distance").above(0));
  section.keys.push_back(
      measure("free_length", "m", to(&Spring::free_length), "distance at which it is free").at_least(0));
  return section;
}

Section linkage_section() {
  Section section = list_section(
      "linkage",
      "a weight P on a linkage; with l = distance + offset it pulls two places "
      "apart by P (arm^2 + l^2 - strut^2) / (2 arm l); its potential, but for a constant, is part of "
      "the elastic energy",
      each(&Case::linkages));
  section.keys = distance_keys<Linkage>();
  section.keys.push_back(measure("force", "N", to(&Linkage::force), "the weight P"));
  section.keys.push_back(
      measure("arm", "m", to(&Linkage::arm), "side of the triangle that carries the weight").above(0));
  section.keys.push_back(
      measure("strut", "m", to(&Linkage::strut), "side of the triangle that holds it").above(0));
  section.keys.push_back(
      measure("offset", "m", to(&Linkage::offset), "length of the third side beyond the distance")
          .otherwise("0 m"));
  return section;
}

/// Access to what there is for each electrode.
template<class T>
Access of_electrodes(std::map<std::string, T> Case::*part) {
  return {[part](void* parent, const std::string& electrode) -> void* {
            return &(static_cast<Case*>(parent)->*part)[electrode];
          },
          [part](const void* parent) {
            std::vector<Access::Entry> entries;
            for (const auto& [electrode, object] : static_cast<const Case*>(parent)->*part)
              entries.push_back({electrode, &object});
            return entries;
          }};
}

Section circuit_section() {
  Section section;
  section.name = "circuit";
  section.meaning = "what is between an electrode and its source while time passes; with several electrodes "
                    "[circuit.<electrode>]";
  section.presence = Section::Presence::optional;
  section.shape = Section::Shape::by_electrode;
  section.access = of_electrodes(&Case::circuits);
  section.acts = when::circuits_matter();
  section.keys = {
      measure("resistance", "Ohm", to(&Circuit::resistance), "between the source and the electrode")
          .at_least(smallest_resistance),
      measure(
          "leakage_resistance", "Ohm", to(&Circuit::leakage_resistance),
          "through the film under the whole electrode; without it none leaks. In steps without a duration "
          "it divides the voltage as it does in the long run. An isolated electrode loses its charge "
          "through it while time passes; a charge that is given stays: its source gives what leaks, too")
          .at_least(smallest_resistance)
          .optional(),
      measure("current_limit", "A", to(&Circuit::current_limit),
              "current that the source gives or takes at most. In steps without a duration the voltage is at "
              "most that at which as much leaks")
          .above(0)
          .optional()
          .only_with(when::limits_matter()),
  };
  return section;
}

template<class T>
std::vector<Key> mass_keys() {
  return {measure("mass", "kg", to(&T::mass), "its mass").at_least(0).only_with(when::point_masses_matter()),
          measure("damping", "N s/m", to(&T::damping), "of a damper between it and the ground")
              .at_least(0)
              .otherwise("0 N.s/m")
              .only_with(when::dampers_matter())};
}

Section plate_section() {
  Section section;
  section.name = "plate";
  section.meaning = "a rigid plate that moves along z and carries the film's edge with it";
  section.presence = Section::Presence::optional;
  section.access = present(&Case::plate);
  section.keys = mass_keys<Plate>();
  section.keys.push_back(text("at", to(&Plate::place), "the place of the film that it carries")
                             .refers_to(Reference::place)
                             .otherwise("inner"));
  return section;
}

Section point_mass_section() {
  Section section = list_section("point_mass", "a mass on the film", each(&Case::point_masses));
  section.acts = when::point_masses_matter();
  section.keys = mass_keys<PointMass>();
  section.keys.push_back(text("place", to(&PointMass::place),
                              "the place over whose volume, area or length as drawn it is spread evenly")
                             .refers_to(Reference::place));
  return section;
}

Section gravity_section() {
  Section section;
  section.name = "gravity";
  section.meaning = "what the steps of kind \"weight\" apply";
  section.access = member(&Case::gravity);
  section.keys = {
      measure("acceleration", "m/s^2", to(&Gravity::acceleration), "of free fall")
          .at_least(0)
          .otherwise("9.81 m/s^2")
          .only_with(when::weight()),
      number("direction", to(&Gravity::direction),
             "where it pulls; any length; by default a [strip] hangs along [0, -1, 0]")
          .values(3, 3)
          .otherwise("[0, 0, -1]")
          .checked([](const Value& value) {
            const bool zero = std::ranges::all_of(value, [](const Scalar& c) { return c.number == 0; });
            return std::string(zero ? "found no direction" : "");
          })
          .only_with(when::direction_of_weight()),
      flag("film", to(&Gravity::film), "whether film and bars have a weight, too; by default a [strip] has")
          .otherwise("false")
          .only_with(when::film_has_weight())};
  return section;
}

Section chamber_section() {
  Section section;
  section.name = "chamber";
  section.meaning =
      "a chamber between the film, with its plate, and the plane z = 0; inside a balloon. Where the film or "
      "surface has an edge, this is held, or moves in such a way that the pressure has a potential: of "
      "revolution along x or along z alone";
  section.presence = Section::Presence::optional;
  section.access = present(&Case::chamber);
  section.keys = {
      wave("pressure", "Pa", to(&Chamber::pressure),
           "pressure that the steps of kind \"pressure\" reach, and \"transient\" follows")
          .optional()
          .only_with(when::chamber_is_open()),
      wave(
          "volume", "m^3", to(&Chamber::volume),
          "pumped volume Q that the steps of kind \"inflate\" reach, measured without pressure: the pressure "
          "follows, and the chamber's own volume is Q / (1 + pressure / bulk_modulus)")
          .at_least(0)
          .optional()
          .only_with(when::volume_applies()),
      measure("bulk_modulus", "Pa", to(&Chamber::bulk_modulus),
              "of the liquid that fills the chamber; of a gas the pressure outside")
          .at_least(1)
          .otherwise("2.2 GPa")
          .only_with(when::chamber_is_closed()),
      text("at", to(&Chamber::place),
           "of a solid: the surface on which it presses; with both ends held along z the volume is that "
           "around "
           "the axis")
          .optional()
          .refers_to(Reference::place),
  };
  return section;
}

Section contact_section() {
  Section section;
  section.name = "contact";
  section.meaning =
      "what touches is kept apart by a barrier (Li et al. 2020): walls of a planar [honeycomb], without "
      "friction, surfaces of solids, a solid on a [table], and a [roll] on its one-sided core";
  section.presence = Section::Presence::optional;
  section.access = present(&Case::contact);
  section.keys = {
      measure(
          "thickness", "m", to(&Contact::thickness),
          "gap between faces at which the barrier sets in; it is never closed. The errors of results have "
          "in them what it changes, as half of it tells")
          .above(0)
          .at_most(0.1),
      text("between", to(&Contact::between),
           "surfaces of solids, of one part or of several, each kept apart from each other; drawn at "
           "least the thickness apart")
          .values(2, 20)
          .optional()
          .refers_to(Reference::place),
      number("friction", to(&Contact::friction),
             "Coulomb's coefficient between these surfaces, in ramps that take no time")
          .at_least(0)
          .at_most(100)
          .otherwise("0")
          .only_with(when::surfaces_touch())};
  return section;
}

Section table_section() {
  Section section;
  section.name = "table";
  section.meaning = "a rigid plane across the height (y, of revolution z) on which a solid lies: its surface "
                    "touches as drawn, "
                    "sinks in by less than contact.thickness, and may lift";
  section.presence = Section::Presence::optional;
  section.access = present(&Case::table);
  section.keys = {
      text("at", to(&Table::place), "the surface that lies on it").refers_to(Reference::place),
      number("friction", to(&Table::friction), "Coulomb's coefficient, in ramps that take no time")
          .at_least(0)
          .at_most(100)
          .otherwise("0")};
  return section;
}

Section drive_section() {
  Section section;
  section.name = "drive";
  section.meaning = "how an electrode is driven; with several electrodes [drive.<electrode>]";
  section.shape = Section::Shape::by_electrode;
  section.access = of_electrodes(&Case::drives);
  section.keys = {
      wave("voltage", "V", to(&Drive::voltage),
           "voltage that the steps of kind \"voltage\" reach, and \"transient\" follow")
          .optional()
          .only_with(when::voltage_applies()),
      wave("charge", "C", to(&Drive::charge),
           "charge that the steps of kind \"charge\" reach, and \"transient\" with control = \"charge\" "
           "follow")
          .optional()
          .only_with(when::charge_applies()),
  };
  return section;
}

} // namespace

std::vector<Section> action_sections() {
  return {electrode_section(), support_section(), load_section(),  spring_section(),     linkage_section(),
          drive_section(),     circuit_section(), plate_section(), point_mass_section(), body_section(),
          fin_section(),       weight_section(),  pivot_section(), gravity_section(),    chamber_section(),
          table_section(),     contact_section()};
}

} // namespace dielast::cases
