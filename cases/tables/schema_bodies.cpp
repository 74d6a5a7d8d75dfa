// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/conditions.hpp"
#include "cases/tables/motion_keys.hpp"

namespace dielast::cases {

Section body_section() {
  Section section = list_section(
      "body",
      "a rigid body that carries places of the film; its name is a place, too: its pivot or its centre. In a "
      "model of revolution it moves along z alone",
      each(&Case::bodies));
  section.keys = {
      text("name", to(&Body::name), "its name").distinct(),
      text("places", to(&Body::places), "the places whose nodes move with it")
          .values(1, 100)
          .refers_to(Reference::place),
      measure("mass", "kg", to(&Body::mass), "its mass")
          .at_least(0)
          .otherwise("0 kg")
          .only_with(when::point_masses_matter()),
      measure("inertia", "kg m^2", to(&Body::inertia),
              "moments of inertia about axes along x, y and z through its centre; in the plane only the last "
              "acts")
          .values(3, 3)
          .at_least(0)
          .otherwise("0 kg.m^2")
          .or_one_for_all()
          .only_with(when::turns_matter()),
      measure("centre", "m", to(&Body::centre),
              "of its mass, as drawn; without it the centroid of its places, by their lengths or areas")
          .values(3, 3)
          .optional(),
      measure("pivot", "m", to(&Body::pivot), "a point of the body, as drawn, that stays where it is")
          .values(3, 3)
          .optional(),
      word("fix", motions, flags(&Body::fixed), "what its own place cannot do")
          .values(1, 6)
          .checked(each_once)
          .optional(),
      measure("damping_rate", "1/s", to(&Body::damping_rate),
              "of dampers between all of its mass and the ground: what they resist its motion with, over its "
              "mass and velocity, or moment of inertia and angular velocity")
          .at_least(0)
          .otherwise("0 1/s")
          .only_with(when::dampers_matter()),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& body = *static_cast<const Body*>(object);
    const auto& [x, y, z] = body.inertia;
    if (body.mass == 0 && x + y + z > 0) return Conflict{"inertia", "a body without a mass has none"};
    if (body.mass == 0 && body.damping_rate > 0)
      return Conflict{"damping_rate", "a body without a mass has none"};
    const bool about_z_alone = x == 0 && y == 0; // all that a planar model asks for
    if (x > y + z || y > z + x || (z > x + y && !about_z_alone))
      return Conflict{"inertia", "no body has it: each moment is at most the sum of the two others"};
    return std::nullopt;
  };
  return section;
}

Section fin_section() {
  Section section = list_section(
      "fin", "a flat fin on a body, in a fluid that resists its motion across itself", each(&Case::fins));
  const auto end = [](const char* name, std::array<double, 3> Fin::*member, const char* meaning) {
    return measure(name, "m", to(member), meaning).values(3, 3).at_least(-10).at_most(10);
  };
  section.keys = {
      text("name", to(&Fin::name), "its name").distinct(),
      text("body", to(&Fin::body), "the body").refers_to(Reference::body),
      end("from", &Fin::from, "its front end, as drawn"),
      end("to", &Fin::to, "its trailing end, as drawn"),
      measure("height", "m", to(&Fin::height), "across its length and the axis `along`")
          .above(0)
          .at_most(10)
          .only_with(when::masses_matter()),
      word("along", axes(), to(&Fin::along), "the axis across it, as drawn, along which the fluid resists"),
      measure("fluid_density", "kg/m^3", to(&Fin::fluid_density), "of the fluid")
          .above(0)
          .at_most(1e5)
          .otherwise("1000 kg/m^3")
          .only_with(when::masses_matter()),
      number("drag_coefficient", to(&Fin::drag_coefficient),
             "drag over density x height x length x velocity squared / 2")
          .at_least(0)
          .at_most(100)
          .otherwise("2")
          .only_with(when::inertia()),
      number("added_mass_coefficient", to(&Fin::added_mass_coefficient),
             "added mass over that of the cylinder of fluid around the fin, whose diameter is its height")
          .at_least(0)
          .at_most(100)
          .otherwise("1")
          .only_with(when::masses_matter()),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& fin = *static_cast<const Fin*>(object);
    const auto along = static_cast<std::size_t>(fin.along);
    if (fin.from == fin.to) return Conflict{"to", "the fin has no length"};
    if (fin.from[along] != fin.to[along]) return Conflict{"along", "the fin is not across this axis"};
    return std::nullopt;
  };
  return section;
}

Section pivot_section() {
  Section section;
  section.name = "pivot";
  section.meaning =
      "a pin that pushes a body's own place along z in the steps of kind \"move\", and lets it turn";
  section.presence = Section::Presence::optional;
  section.access = present(&Case::pivot);
  section.keys = {
      text("body", to(&Pivot::body), "the body; an annulus without one gets a \"plate\" in its hole")
          .otherwise("plate")
          .refers_to(Reference::body),
      measure("height", "m", to(&Pivot::height), "by which it is pushed up from where it is drawn")
          .at_least(-1)
          .at_most(1),
  };
  return section;
}

} // namespace dielast::cases
