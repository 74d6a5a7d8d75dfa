// SPDX-License-Identifier: GPL-3.0-or-later
// A rectangle of film held in a frame.
#include "cases/geometries/geometry_kinds.hpp"
#include "cases/tables/bar_keys.hpp"

namespace dielast::cases {

GeometryKind rectangle_geometry() {
  const auto size = [](std::string name, auto member, std::string meaning) {
    return measure(std::move(name), "m", to(member), std::move(meaning)).above(0).at_most(10);
  };
  Section section;
  section.name = "rectangle";
  section.meaning =
      "film held in a rectangular frame about the origin, with a rectangular electrode in the middle";
  section.presence = Section::Presence::geometry;
  section.access = geometry_of_type<Rectangle>();
  section.keys = {
      size("length", &Rectangle::length, "along x as clamped, after the prestretch"),
      size("width", &Rectangle::width, "along y as clamped, after the prestretch").otherwise_as("length"),
      size("electrode_length", &Rectangle::electrode_length,
           "of the electrode along x as clamped; without it all of the length")
          .optional(),
      size("electrode_width", &Rectangle::electrode_width,
           "of the electrode along y as clamped; without it all of the width")
          .optional(),
  };
  section.check = [](const void* object) -> std::optional<Conflict> {
    const auto& rectangle = *static_cast<const Rectangle*>(object);
    if (rectangle.electrode_length.value_or(0) > rectangle.length)
      return Conflict{"electrode_length", "the electrode is longer than the film"};
    if (rectangle.electrode_width.value_or(0) > rectangle.width)
      return Conflict{"electrode_width", "the electrode is wider than the film"};
    return std::nullopt;
  };
  return {std::move(section),
          {order_key(), across_key("elements from side to side of a rectangle, along y", 1000, "32"),
           quadrature_key("3")},
          {{"rectangle",
            "a film held in a rectangular frame, with a rectangular electrode in the middle",
            {{"film", "the film"},
             {"electrode", "the film under the electrode"},
             {"passive", "the film beside it, if there is any"},
             {"left", "the side at x < 0"},
             {"right", "the side at x > 0"},
             {"bottom", "the side at y < 0"},
             {"top", "the side at y > 0"},
             {"frame", "all four sides, held"},
             {"electrode_edge", "the electrode's edge within the film, or the frame"},
             {"centre", "the node in the middle, or those nearest to it"}},
            R"(
electrode = [{ name = "film", place = "electrode" }]
support = [{ place = "frame", fix = ["x", "y", "z"] }]
step = [{ kind = "voltage" }]
)",
            R"(
quantity = [
  { name = "areal_strain", kind = "areal strain", of = "electrode" },
  { name = "strain_x", kind = "growth", of = "electrode", along = "x" },
  { name = "strain_y", kind = "growth", of = "electrode", along = "y" }
]
)"}}};
}

} // namespace dielast::cases
