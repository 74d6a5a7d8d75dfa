// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/geometries/geometry_kinds.hpp"
#include "cases/language/conditions.hpp"
#include "cases/tables/bar_keys.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace dielast::cases {

namespace {

/// Cells of neighbouring columns interlock.
std::string interlocking(const Value& columns) {
  for (std::size_t i = 1; i < columns.size(); ++i)
    if (std::abs(columns[i].number - columns[i - 1].number) != 1)
      return fmt::format(
          "columns {} and {} have {} and {} cells, allowed numbers that differ by one, such as "
          "[7, 6, 7, 6, 7]",
          i, i + 1, columns[i - 1].number, columns[i].number);
  return "";
}

} // namespace

Section honeycomb_section() {
  constexpr double degree = std::numbers::pi / 180;
  Section section;
  section.name = "honeycomb";
  section.meaning = "film with a printed lattice of hexagonal cells on both faces, cut free along its edge";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Honeycomb>();
  section.keys = {
      measure("angle", "rad", to(&Honeycomb::angle), "interior angle at the four equal vertices of a cell")
          .at_least(60.01 * degree)
          .at_most(179.99 * degree)
          .because("cells close up at 60 deg and are flat at 180 deg"),
      integer("columns", to(&Honeycomb::columns), "number of cells in each column, left to right")
          .values(1, 200)
          .at_least(1)
          .at_most(200)
          .otherwise("[7, 6, 7, 6, 7]")
          .checked(interlocking),
      measure("wall_length", "m", to(&Honeycomb::wall_length), "length of each of a cell's six walls")
          .above(0)
          .at_most(1),
      measure("wall_width", "m", to_part<Honeycomb>([](auto& h) -> auto& { return h.wall.width; }),
              "width of a wall in the film's plane")
          .above(0)
          .at_most(1),
      measure("wall_height", "m", to_part<Honeycomb>([](auto& h) -> auto& { return h.wall.height; }),
              "height of a wall normal to the film")
          .above(0)
          .at_most(1),
      word("wall_bond",
           {{"line", "the film moves with a wall's centreline", WallBond::line},
            {"width", "the film under a wall is clamped to it over its width, and is not charged",
             WallBond::width}},
           to(&Honeycomb::wall_bond), "how walls hold the film")
          .otherwise("line"),
      wall_print(),
      measure(
          "electrode_gap", "m", to(&Honeycomb::electrode_gap),
          "what the place \"electrode\" leaves free beside each wall: from its centreline, or from its face "
          "with wall_bond = \"width\"")
          .at_least(0)
          .otherwise("0 mm")
          .only_with(when::an_electrode_keeps_off_walls()),
  };
  section.sections.push_back(bar_material_section<Honeycomb>(
      "wall_material", [](auto& honeycomb) -> auto& { return honeycomb.wall; }));
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& honeycomb = *static_cast<const Honeycomb*>(object);
    if (honeycomb.wall.width < honeycomb.wall_length) return std::nullopt;
    return Conflict{"wall_width", "a wall is wider than it is long; wall_width must be below wall_length"};
  };
  return section;
}

Section disc_section() {
  Section section;
  section.name = "disc";
  section.meaning = "round film clamped at its rim, with a round electrode in the middle";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Disc>();
  section.keys = {
      measure("radius", "m", to(&Disc::radius), "radius as clamped, after the prestretch")
          .above(0)
          .at_most(1),
      measure("electrode_radius", "m", to(&Disc::electrode_radius),
              "radius of the electrode as clamped; without it the whole disc")
          .above(0)
          .at_most(1)
          .optional(),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& disc = *static_cast<const Disc*>(object);
    if (!disc.electrode_radius || *disc.electrode_radius < disc.radius) return std::nullopt;
    return Conflict{"electrode_radius", "must be below the disc's radius"};
  };
  return section;
}

Section balloon_section() {
  Section section;
  section.name = "balloon";
  section.meaning = "a sphere of film around a chamber";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Balloon>();
  section.keys = {measure("radius", "m", to(&Balloon::radius), "radius as drawn, after the prestretch")
                      .above(0)
                      .at_most(1)};
  return section;
}

Section annulus_section() {
  Section section;
  section.name = "annulus";
  section.meaning = "ring of film clamped at both edges, or at the outer edge with a [plate] in its hole";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Annulus>();
  section.keys = {
      measure("inner_radius", "m", to(&Annulus::inner_radius),
              "radius of the hole as clamped, after the prestretch")
          .above(0)
          .at_most(1),
      measure("outer_radius", "m", to(&Annulus::outer_radius),
              "outer radius as clamped, after the prestretch")
          .above(0)
          .at_most(1),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& annulus = *static_cast<const Annulus*>(object);
    if (annulus.inner_radius < annulus.outer_radius) return std::nullopt;
    return Conflict{"inner_radius", "must be below outer_radius"};
  };
  return section;
}

namespace {

/// What contradicts a patch's mode or another of its keys.
std::optional<Conflict> patch_conflict(const void* object) {
  const auto& patch = *static_cast<const Patch*>(object);
  const char* const y = patch.stretch_y ? "stretch_y" : "stress_y";
  const bool y_is_given = patch.stretch_y || patch.stress_y;
  if (patch.stretch_x && patch.stress_x)
    return Conflict{"stress_x", "given twice: write either stretch_x or stress_x"};
  if (patch.stretch_y && patch.stress_y)
    return Conflict{"stress_y", "given twice: write either stretch_y or stress_y"};
  if (y_is_given && patch.mode == PatchMode::pure_shear) return Conflict{y, "in pure shear y is held"};
  if (y_is_given && patch.mode == PatchMode::equal_biaxial)
    return Conflict{y, "in equal-biaxial tension y does as x does: write stretch_x or stress_x"};
  if (patch.mode == PatchMode::equal_biaxial &&
      std::abs(patch.width - patch.length) > 1e-9 * patch.length) // the same in other units
    return Conflict{"width", "in equal-biaxial tension the patch is a square: leave width out"};
  return std::nullopt;
}

} // namespace

Section patch_section() {
  const auto stretch = [](std::string name, std::optional<Waveform> Patch::*part, std::string meaning) {
    return wave(std::move(name), "1", to(part), std::move(meaning))
        .of_stretch()
        .above(0)
        .at_most(100)
        .optional();
  };
  const auto stress = [](std::string name, std::optional<Waveform> Patch::*part, std::string meaning) {
    return wave(std::move(name), "Pa", to(part), std::move(meaning)).optional();
  };
  Section section;
  section.name = "patch";
  section.meaning = "homogeneous block of film whose sides are pulled; a direction without stretch or stress "
                    "is free of stress";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Patch>();
  section.keys = {
      measure("length", "m", to(&Patch::length), "length along x, before the prestretch")
          .above(0)
          .at_most(1)
          .otherwise("10 mm"),
      measure("width", "m", to(&Patch::width), "width along y, before the prestretch")
          .above(0)
          .at_most(1)
          .otherwise_as("length"),
      word("mode",
           {{"biaxial", "x and y move independently", PatchMode::biaxial},
            {"equal-biaxial", "x and y are stretched alike: stretch_x and stress_x act along both",
             PatchMode::equal_biaxial},
            {"pure-shear", "y is held at the prestretch", PatchMode::pure_shear}},
           to(&Patch::mode), "how the sides move")
          .otherwise("biaxial"),
      stretch("stretch_x", &Patch::stretch_x, "stretch along x of the unstretched film"),
      stretch("stretch_y", &Patch::stretch_y, "stretch along y of the unstretched film"),
      stress("stress_x", &Patch::stress_x, "nominal stress along x: force over undeformed section"),
      stress("stress_y", &Patch::stress_y, "nominal stress along y: force over undeformed section"),
  };
  section.check = patch_conflict;
  return section;
}

Section slab_section() {
  Section section;
  section.name = "slab";
  section.meaning =
      "rectangle of solid, as high along y as its layers are stacked: in plane strain; or of "
      "revolution about z, as high along z: a disc, a ring, a tube; with a width in space: a block";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Slab>();
  section.keys = {
      measure("length", "m", to(&Slab::length), "along x, or along the radius").above(0).at_most(10),
      measure("height", "m", to(&Slab::height), "along y, or along z").above(0).at_most(10),
      measure("inner_radius", "m", to(&Slab::inner_radius), "of revolution: where it begins")
          .at_least(0)
          .at_most(10)
          .otherwise("0 m")
          .only_with(when::of_revolution()),
      measure("electrode", "m", to(&Slab::electrode),
              "where the electrode begins and ends, along x from the slab's beginning; without it it covers "
              "all")
          .values(2, 2)
          .at_least(0)
          .optional(),
      measure("cover_thickness", "m", to(&Slab::cover_thickness),
              "height without electrodes at the bottom, and at the top")
          .at_least(0)
          .otherwise("0 m"),
      measure("width", "m", to(&Slab::width),
              "in space: along z, about z = 0; with it the default is model = \"3d\"")
          .above(0)
          .at_most(10)
          .optional()
          .only_with(when::in_space()),
      measure("electrode_width", "m", to(&Slab::electrode_width),
              "in space: of the electrode, about z = 0; without it that of the slab")
          .above(0)
          .optional()
          .only_with(when::in_space()),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& slab = *static_cast<const Slab*>(object);
    if (slab.electrode &&
        !((*slab.electrode)[0] < (*slab.electrode)[1] && (*slab.electrode)[1] <= slab.length))
      return Conflict{"electrode", "must lead from the left to the right, within the slab's length"};
    if (2 * slab.cover_thickness >= slab.height)
      return Conflict{"cover_thickness", "must be below half of the height"};
    if (slab.width && slab.electrode_width > slab.width)
      return Conflict{"electrode_width", "must be at most the slab's width"};
    return std::nullopt;
  };
  return section;
}

Section hollow_sphere_section() {
  Section section;
  section.name = "hollow_sphere";
  section.meaning = "sphere of solid about a hollow, of revolution about z; in space (model = \"3d\") its "
                    "eighth at x, y, z >= 0, to which volumes, charges, capacitances, energies and masses "
                    "belong then";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<HollowSphere>();
  section.keys = {
      measure("inner_radius", "m", to(&HollowSphere::inner_radius), "radius of the hollow")
          .above(0)
          .at_most(10),
      measure("outer_radius", "m", to(&HollowSphere::outer_radius), "outer radius").above(0).at_most(10),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& sphere = *static_cast<const HollowSphere*>(object);
    if (sphere.inner_radius < sphere.outer_radius) return std::nullopt;
    return Conflict{"inner_radius", "must be below outer_radius"};
  };
  return section;
}

} // namespace dielast::cases
