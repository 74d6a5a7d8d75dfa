// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/geometries/geometry_kinds.hpp"

namespace dielast::cases {
namespace {

constexpr std::string_view honeycomb_quantities = R"(
quantity = [
  { name = "eps_x", kind = "elongation", between = ["left_apex", "right_apex"], along = "x", since = "release" },
  { name = "eps_y", kind = "elongation", between = ["corner_bottom", "corner_top"], along = "y", since = "release" },
  { name = "released_length_x", kind = "distance", between = ["left_apex", "right_apex"], along = "x", at = "release" },
  { name = "released_length_y", kind = "distance", between = ["corner_bottom", "corner_top"], along = "y", at = "release" }
]
)";

constexpr std::string_view disc_quantities = R"(
quantity = [
  { name = "electrode_radius", kind = "radius", of = "electrode_edge" }
]
)";

constexpr std::string_view pivoted_quantities = R"(
quantity = [
  { name = "tilt_x", kind = "angle", of = "plate", along = "x" },
  { name = "tilt_y", kind = "angle", of = "plate", along = "y" },
  { name = "pivot_force", kind = "force", of = "plate", along = "z" }
]
)";

constexpr std::string_view diaphragm_quantities = R"(
quantity = [
  { name = "drop", kind = "displacement", of = "plate", along = "gravity" },
  { name = "stroke", kind = "displacement", of = "plate", along = "gravity", since = "weight" },
  { name = "stiffness", kind = "stiffness", of = "plate", along = "z" },
  { name = "natural_frequency", kind = "natural frequency" },
  { name = "stretch_inner", kind = "radial stretch", of = "inner" },
  { name = "stretch_outer", kind = "radial stretch", of = "outer" }
]
)";

constexpr std::string_view patch_quantities = R"(
quantity = [
  { name = "stretch_x", kind = "stretch", between = ["left", "right"], along = "x" },
  { name = "stretch_y", kind = "stretch", between = ["bottom", "top"], along = "y" },
  { name = "stress_x", kind = "nominal stress", of = "film", along = "x" },
  { name = "stress_y", kind = "nominal stress", of = "film", along = "y" },
  { name = "thickness_stretch", kind = "extreme", of = "principal_stretches.lambda3", extreme = "maximum" }
]
)";

constexpr std::string_view honeycomb_defaults = R"(
electrode = [{ name = "film", place = "electrode" }]
step = [{ kind = "release" }, { kind = "voltage" }]
)";

constexpr std::string_view disc_defaults = R"(
electrode = [{ name = "film", place = "electrode" }]
support = [{ place = "rim", fix = ["x", "y", "z"] }]
step = [{ kind = "voltage" }]
)";

constexpr std::string_view annulus_defaults = R"(
electrode = [{ name = "film", place = "film" }]
support = [{ place = "inner", fix = ["x", "y", "z"] }, { place = "outer", fix = ["x", "y", "z"] }]
step = [{ kind = "voltage" }]
)";

constexpr std::string_view pivoted_defaults = R"(
electrode = [{ name = "film", place = "film" }]
support = [{ place = "outer", fix = ["x", "y", "z"] }]
body = [{ name = "plate", places = ["inner"] }]
step = [{ kind = "move" }, { kind = "voltage" }]
)";

constexpr std::string_view diaphragm_defaults = R"(
electrode = [{ name = "film", place = "film" }]
support = [{ place = "outer", fix = ["x", "y", "z"] }]
step = [{ kind = "weight" }, { kind = "voltage" }]
)";

constexpr std::string_view balloon_defaults = R"(
support = [{ place = "equator", fix = ["z"] }]
step = [{ kind = "inflate" }]
)";

constexpr std::string_view patch_defaults = R"(
electrode = [{ name = "film", place = "film" }]
)"; // and patch_steps()

constexpr std::string_view rolls_defaults = R"(
electrode = [{ name = "upper", place = "upper" }, { name = "lower", place = "lower" }]
body = [{ name = "tip", places = ["tip_ends"] }]
support = [{ place = "base", fix = ["x", "y", "z", "turn_x", "turn_y", "turn_z"] },
           { place = "roots", fix = ["x", "y", "z"] }, { place = "joints", fix = ["y", "z"] }]
step = [{ kind = "release" }, { kind = "voltage" }]
)";

constexpr std::string_view rolls_quantities = R"(
quantity = [
  { name = "tip_angle", kind = "angle", of = "tip", along = "z" },
  { name = "upper_strain", kind = "elongation", between = ["upper.start", "upper.end"], along = "x", since = "release" },
  { name = "lower_strain", kind = "elongation", between = ["lower.start", "lower.end"], along = "x", since = "release" },
  { name = "upper_force", kind = "film force", of = "upper.end", along = "x" },
  { name = "lower_force", kind = "film force", of = "lower.end", along = "x" }
]
)";

constexpr std::string_view strip_defaults = R"(
electrode = [{ name = "film", place = "electrode" }]
support = [{ place = "upper_end", fix = ["x", "y", "z"] }]
body = [{ name = "bar", places = ["lower_end"], fix = ["x", "z", "turn_x", "turn_y", "turn_z"] }]
step = [{ kind = "weight" }, { kind = "voltage" }]
)";

constexpr std::string_view strip_quantities = R"(
quantity = [
  { name = "extension", kind = "displacement", of = "lower_end", along = "gravity" },
  { name = "stroke", kind = "displacement", of = "lower_end", along = "gravity", since = "weight" },
  { name = "strain", kind = "elongation", between = ["lower_end", "upper_end"], along = "y", since = "weight" },
  { name = "stiffness", kind = "stiffness", of = "lower_end", along = "y" },
  { name = "coupling", kind = "coupling", place = "lower_end", along = "gravity" },
  { name = "natural_frequency", kind = "natural frequency" }
]
)";

constexpr std::string_view roll_defaults = R"(
electrode = [{ name = "film", place = "electrode" }]
body = [{ name = "lower_cap", places = ["lower_end"], fix = ["z"] }, { name = "upper_cap", places = ["upper_end"] }]
step = [{ kind = "release" }, { kind = "voltage" }]
)";

constexpr std::string_view roll_quantities = R"(
quantity = [
  { name = "length", kind = "distance", between = ["lower_end", "upper_end"], along = "z" },
  { name = "strain", kind = "elongation", between = ["lower_end", "upper_end"], along = "z", since = "release" },
  { name = "roll_force", kind = "film force", of = "lower_end", along = "z" },
  { name = "stroke", kind = "displacement", of = "upper_end", along = "z", since = "release" },
  { name = "stiffness", kind = "stiffness", of = "upper_end", along = "z" }
]
)";

constexpr std::string_view slab_defaults = R"(
electrode = [{ name = "film", place = "electrode" }]
step = [{ kind = "voltage" }]
)";

constexpr std::string_view hollow_sphere_defaults = R"(
electrode = [{ name = "film", place = "outer", ground = "inner" }]
support = [{ place = "equator", fix = ["z"] }]
step = [{ kind = "voltage" }]
)";

constexpr std::string_view hollow_sphere_quantities = R"(
quantity = [
  { name = "inner_radius", kind = "size", of = "inner", along = "x" },
  { name = "outer_radius", kind = "size", of = "outer", along = "x" }
]
)";

constexpr std::string_view file_defaults = R"(
electrode = [{ name = "film", place = "film" }]
step = [{ kind = "voltage" }]
)";

} // namespace

std::vector<Template> honeycomb_templates() {
  return {
      {"honeycomb",
       "unidirectional actuator: a film with a printed honeycomb, cut free",
       {{"film", "the film"},
        {"walls", "all walls"},
        {"electrode", "the film that an electrode covers: all of it, or what electrode_gap and walls leave"},
        {"cell[i,j]", "the film in cell j of column i, from 0"},
        {"left_apex", "leftmost vertex at mid height"},
        {"right_apex", "rightmost vertex at mid height"},
        {"corner_top_wall", "top wall of the first column's top cell"},
        {"corner_bottom_wall", "bottom wall of the first column's bottom cell"},
        {"corner_top", "the node in the middle of corner_top_wall, or the two nearest to it"},
        {"corner_bottom", "the node in the middle of corner_bottom_wall, or the two nearest to it"},
        {"top_wall", "top wall of the middle column"},
        {"bottom_wall", "bottom wall of the middle column"},
        {"top", "the node in the middle of top_wall, or the two nearest to it"},
        {"bottom", "the node in the middle of bottom_wall, or the two nearest to it"},
        {"centre", "the node nearest to the middle"}},
       honeycomb_defaults,
       honeycomb_quantities}};
}

std::vector<Template> disc_templates() {
  return {{"disc",
           "a film clamped at its rim, with a round electrode in the middle; where it stays round, model = "
           "\"axisymmetric\" takes a small part of the time",
           {{"film", "the film"},
            {"electrode", "the film under the electrode"},
            {"passive", "the film beside it, if there is any"},
            {"electrode_edge", "the electrode's edge"},
            {"rim", "the clamped edge"},
            {"centre", "the node in the middle"}},
           disc_defaults,
           disc_quantities}};
}

std::vector<Template> annulus_templates() {
  return {{"annulus",
           "a diaphragm: a ring of film that carries a plate in its hole",
           {{"film", "the film"},
            {"inner", "the plate's edge"},
            {"plate", "the plate, by its edge"},
            {"outer", "the clamped edge"}},
           diaphragm_defaults,
           diaphragm_quantities,
           "plate"},
          {"annulus",
           "a manipulator: a ring of film whose plate tilts on a pivot that pushes it up",
           {{"film", "the film"},
            {"inner", "the plate's edge"},
            {"outer", "the clamped edge"},
            {"a, b, c, ...", "its sectors, sector[0], sector[1], ... too"}},
           pivoted_defaults,
           pivoted_quantities,
           "pivot"},
          {"annulus",
           "a ring of film clamped at both edges",
           {{"film", "the film"}, {"inner", "the inner edge"}, {"outer", "the outer edge"}},
           annulus_defaults,
           ""}};
}

std::vector<Template> balloon_templates() {
  return {{"balloon",
           "a sphere of film around a chamber",
           {{"film", "the film"},
            {"equator", "the widest circle, held along z"},
            {"south", "the lower pole"},
            {"north", "the upper pole"}},
           balloon_defaults,
           ""}};
}

std::vector<Template> patch_templates() {
  return {{"patch",
           "one homogeneous block of film under stretches, nominal stresses, voltage or charge: a material "
           "test; without [[step]] it takes one for each that is given, or one of kind \"transient\" for "
           "waves",
           {{"film", "the film"},
            {"left", "the side x = 0, held along x"},
            {"right", "the side that moves along x"},
            {"bottom", "the side y = 0, held along y"},
            {"top", "the side that moves along y"},
            {"centre", "the middle"}},
           patch_defaults,
           patch_quantities}};
}

std::vector<Template> strip_templates() {
  return {{"strip",
           "a strip of film, or a stack of layers, that hangs from a clamp, with a [weight] at its lower end",
           {{"film", "the film"},
            {"electrode", "the film under the electrode"},
            {"passive", "the film beside it, if there is any"},
            {"upper_end", "the clamped end, y = 0"},
            {"lower_end", "the end in the clamp that hangs, the body \"bar\""},
            {"left", "the side x < 0"},
            {"right", "the side x > 0"},
            {"bar", "the body at the lower end"}},
           strip_defaults,
           strip_quantities,
           "",
           true}};
}

std::vector<Template> roll_templates() {
  return {{"roll",
           "film wound around a core, along which it slides, between two end caps; with a [[spring]] between "
           "these a spring-rolled muscle",
           {{"film", "the film"},
            {"electrode", "the film under the electrode"},
            {"passive", "the film beside it, if there is any"},
            {"lower_end", "the end z = 0, on the body \"lower_cap\""},
            {"upper_end", "the other end, on the body \"upper_cap\""},
            {"lower_cap", "the end cap that is held"},
            {"upper_cap", "the end cap that moves"}},
           roll_defaults,
           roll_quantities,
           "",
           true}};
}

std::vector<Template> antagonistic_rolls_templates() {
  return {{"antagonistic_rolls",
           "two rolls of film beside a hinge that turn a tip by ribbons: the one that is charged lengthens",
           {{"film", "both rolls"},
            {"upper", "the roll at y > 0"},
            {"lower", "the roll at y < 0"},
            {"hinge", "the hinge, from the backbone along -x to the tip"},
            {"upper_ribbon", "from the tip to the upper roll"},
            {"lower_ribbon", "from the tip to the lower roll"},
            {"base", "where the hinge begins, held"},
            {"tip_ends", "what the body \"tip\" carries"},
            {"joints", "of ribbons and rolls, held along y: a roll's end stays on its axis"},
            {"roots", "where the rolls begin, held"}},
           rolls_defaults,
           rolls_quantities,
           "",
           true}};
}

std::vector<Template> slab_templates() {
  return {{"slab",
           "a thick part, from the side or in space: a stack of layers; of revolution a disc, a ring or "
           "a tube",
           {{"film", "all of it"},
            {"electrode", "what is charged"},
            {"passive", "what is not"},
            {"left", "the side at its beginning"},
            {"right", "the side at its end"},
            {"bottom", "the lower side"},
            {"top", "the upper side"},
            {"lower_electrode", "the lower side of what is charged"},
            {"upper_electrode", "its upper side"},
            {"back", "with a width: its side at z < 0"},
            {"front", "with a width: its side at z > 0"}},
           slab_defaults,
           ""}};
}

std::vector<Template> hollow_sphere_templates() {
  return {{"hollow_sphere",
           "a thick sphere about a hollow, charged between its surfaces",
           {{"film", "all of it"},
            {"inner", "the surface of the hollow"},
            {"outer", "the outer surface"},
            {"equator", "where z = 0, held along z"},
            {"south", "of revolution: the wall on the axis below"},
            {"north", "of revolution: the wall on the axis above"},
            {"side_x", "in space: where x = 0, held along x"},
            {"side_y", "in space: where y = 0, held along y"}},
           hollow_sphere_defaults,
           hollow_sphere_quantities}};
}

std::vector<Template> line_templates() {
  return {{"line",
           "a rod of film between two points",
           {{"film", "the rod"}, {"start", "where it starts"}, {"end", "where it ends"}},
           file_defaults,
           "",
           "rod"},
          {"line",
           "a straight row of bars between two points",
           {{"line", "the bars"}, {"start", "where it starts"}, {"end", "where it ends"}},
           "",
           ""}};
}

std::vector<Template> file_templates() {
  return {{"file", "your own gmsh mesh, or a closed surface: [mesh] file = \"...\"", {}, file_defaults, ""}};
}

} // namespace dielast::cases
