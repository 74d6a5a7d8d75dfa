// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/language/schema.hpp"

#include <fmt/format.h>

namespace dielast::cases {
namespace {

Section region_section() {
  const auto radius = [](std::string name, std::optional<double> DrawnRegion::*part, std::string meaning) {
    return measure(std::move(name), "m", to(part), std::move(meaning))
        .at_least(0)
        .at_most(1)
        .optional()
        .only({"sector", "ring"});
  };
  const auto direction = [](std::string name, double DrawnRegion::*part, std::string meaning) {
    return measure(std::move(name), "rad", to(part), std::move(meaning)).only({"sector"});
  };
  const auto side = [](std::string name, double DrawnRegion::*part, std::string meaning) {
    return measure(std::move(name), "m", to(part), std::move(meaning))
        .above(0)
        .at_most(1)
        .only({"rectangle"});
  };
  const auto corners = [](std::string name, std::vector<double> DrawnRegion::*part, std::string meaning) {
    return measure(std::move(name), "m", to(part), std::move(meaning)).values(3, 1000).only({"polygon"});
  };
  Section section = list_section("region",
                                 "a part of a disc or an annulus, drawn in its plane as clamped; its name is "
                                 "a place, and where the case "
                                 "has no [[electrode]] each region is one; film beside them is passive",
                                 each(&Part::regions));
  section.selector = "kind";
  section.keys = {
      text("name", to(&DrawnRegion::name), "its name").distinct(),
      word("kind",
           {{"sector", "between two radii and two directions", RegionKind::sector},
            {"ring", "between two radii", RegionKind::ring},
            {"rectangle", "of a length and a width about a centre", RegionKind::rectangle},
            {"polygon", "of straight sides between corners", RegionKind::polygon}},
           to(&DrawnRegion::kind), "its shape"),
      radius("inner_radius", &DrawnRegion::inner_radius, "where it begins; without it where the film does"),
      radius("outer_radius", &DrawnRegion::outer_radius, "where it ends; without it where the film does"),
      direction("from", &DrawnRegion::from, "direction in which it begins, counter-clockwise from x"),
      direction("to", &DrawnRegion::to, "direction in which it ends, less than a full turn further"),
      measure("centre", "m", to(&DrawnRegion::centre), "its middle")
          .values(2, 2)
          .otherwise("[\"0 mm\", \"0 mm\"]")
          .only({"rectangle"}),
      side("length", &DrawnRegion::length, "along x, before it is turned"),
      side("width", &DrawnRegion::width, "along y, before it is turned"),
      measure("turned", "rad", to(&DrawnRegion::turned), "angle by which it is turned about its centre")
          .otherwise("0 deg")
          .only({"rectangle"}),
      corners("x", &DrawnRegion::x, "of its corners, one after another"),
      corners("y", &DrawnRegion::y, "of its corners, as many as x"),
      measure("gap", "m", to(&DrawnRegion::gap), "by which all of its edges are moved inwards")
          .at_least(0)
          .at_most(1)
          .otherwise("0 mm"),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& region = *static_cast<const DrawnRegion*>(object);
    if (region.x.size() == region.y.size()) return std::nullopt;
    return Conflict{"y", fmt::format("has {} values and x has {}: a corner has one of each", region.y.size(),
                                     region.x.size())};
  };
  return section;
}

Section sectors_section() {
  Section section;
  section.name = "sectors";
  section.meaning =
      "a disc or an annulus cut into regions of one size around its middle, called a, b, c, ... "
      "counter-clockwise; where the case has no [[electrode]] each is one";
  section.presence = Section::Presence::optional;
  section.access = present(&Part::sectors);
  section.keys = {
      integer("count", to(&Sectors::count), "how many").at_least(2).at_most(26).otherwise("4"),
      measure("gap", "m", to(&Sectors::gap), "width of the strip of bare film between two of them")
          .at_least(0)
          .at_most(1)
          .otherwise("0 mm"),
      measure("edge_gap", "m", to(&Sectors::edge_gap), "of bare film between them and the edges of the film")
          .at_least(0)
          .at_most(1)
          .otherwise("0 mm"),
      measure("first", "rad", to(&Sectors::first), "direction of the middle of the first, from x")
          .otherwise("0 deg"),
  };
  return section;
}

} // namespace

std::vector<Section> region_sections() { return {region_section(), sectors_section()}; }

} // namespace dielast::cases
