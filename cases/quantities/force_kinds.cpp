// SPDX-License-Identifier: GPL-3.0-or-later
// Forces, moments and stresses.
#include "cases/quantities/film_values.hpp"
#include "cases/quantities/forces.hpp"
#include "cases/quantities/probing.hpp"
#include "fem/model/contact_block.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases {
namespace {

Probe force(const Probing& probing) {
  return [&device = probing.device, &quantity = probing.quantity](const Measured& measured) {
    return component(support_force(device, quantity.of, measured.reaction()), quantity.along);
  };
}

Probe pull_of_film(const Probing& probing) {
  if (const Part* part = part_with(probing.quantity.of, probing.one); part && !part->film)
    probing.refuse("of",
                   "bars end there; the film that is tied to them pulls on its own place, and a support "
                   "has the \"force\" of both");
  PullingFilm film = film_that_pulls(probing.quantity.of, probing.one, probing.device);
  if (film.elements.empty()) probing.refuse("of", "no film meets this place, so none pulls on it");
  return [&device = probing.device, &quantity = probing.quantity,
          film = std::move(film)](const Measured& measured) {
    return component(film_force(device, quantity.of, film, measured.equilibrium, measured.state),
                     quantity.along);
  };
}

Probe moment(const Probing& probing) {
  const fem::DofMap& dofs = probing.device.model.dofs;
  const int master = probing.device.mesh.node_sets.at(probing.quantity.of).front();
  return [&dofs, e = dofs.equation(master, 3 + *probing.quantity.along)](const Measured& measured) {
    return dofs.is_held(e) ? measured.reaction()[e] : 0.0;
  };
}

Probe contact_force(const Probing& probing) {
  return [&model = probing.device.model, &of = probing.quantity.of](const Measured& measured) {
    return fem::contact_force(model, measured.state, of);
  };
}

Probe contact_pressure(const Probing& probing) {
  return [&device = probing.device, &of = probing.quantity.of](const Measured& measured) {
    return largest_contact_pressure(device, of, measured.state);
  };
}

Key touching_key() {
  return of_key("the surface; without it all that may touch").optional().refers_to(Reference::place);
}

std::string on_words(const Quantity& quantity) { return quantity.of.empty() ? "" : " on " + quantity.of; }

/// What touches must be there, and of a named surface something must be able to touch it.
std::string touches_not(const Case& one, const Quantity& quantity) {
  if (!one.contact) return "nothing touches; add [contact]";
  if (quantity.of.empty() || one.may_touch(quantity.of)) return "";
  return fmt::format("found \"{}\": it is neither one of contact.between nor lies on the [table]",
                     quantity.of);
}

/// Rods that lie across the axis pull nowhere along it.
void refuse_across(const Probing& probing, const std::vector<char>& near, int along) {
  const meshing::Mesh& mesh = probing.device.mesh;
  const meshing::CellBlock& rods = *mesh.film();
  for (int cell = 0; cell < rods.size(); ++cell) {
    if (!near[static_cast<std::size_t>(cell)]) continue;
    const auto node = [&](int a) {
      return mesh.nodes[static_cast<std::size_t>(rods.cell(cell)[static_cast<std::size_t>(a)])];
    };
    const Eigen::Vector3d drawn = (node(1) - node(0)).normalized();
    if (std::abs(drawn[along]) < 1e-6)
      probing.refuse("along", fmt::format("found \"{}\": a rod pulls along itself, and one here lies across "
                                          "this axis",
                                          "xyz"[along]));
  }
}

/// Force over undeformed section along an axis, Pa: the axis turns with the film, by the smallest turn that
/// takes z to its normal. Film of revolution and rods have axes of their own, `own_axes`, whichever way those
/// were drawn.
double nominal_stress_of(const fem::MembraneSample& film, int axis, bool own_axes) {
  if (own_axes) return film.F.col(axis).norm() * film.S(axis, axis);
  const Eigen::Vector3d normal = film.F.col(0).cross(film.F.col(1));
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  return (turn * Eigen::Vector3d::Unit(axis)).dot(film.F * film.S.col(axis));
}

/// Of all film that lies there side by side and one on another, with a voltage or without.
Probe nominal_stress(const Probing& probing) {
  const Device& device = probing.device;
  const int along = *probing.quantity.along;
  const std::vector<char> near = film_at(probing.quantity.of, probing.one, device);
  for (std::size_t cell = 0; cell < near.size(); ++cell)
    if (const int part = device.film_parts[cell];
        near[cell] && !probing.one.parts[static_cast<std::size_t>(part)].film->further_layers.empty())
      probing.refuse("of", "the film there has layers of different undeformed sections");
  const bool of_rods = device.mesh.film()->type == meshing::CellType::rod2;
  if (of_rods) refuse_across(probing, near, along);
  const std::vector<FilmElements> counted = films_of(probing.quantity.of, probing.one, device);
  const bool own_axes = of_rods || probing.one.dimension == fem::Dimension::axisymmetric;
  const int axis = of_rods ? 0 : along;
  return [&device, near, counted, own_axes, axis](const Measured& measured) {
    double sum = 0, volume = 0;
    for (std::size_t b = 0; b < counted.size(); ++b) {
      if (counted[b].elements.empty()) continue;
      for (const fem::MembraneSample& s : points_of(*device.model.blocks[b], measured.state).film) {
        if (!near[static_cast<std::size_t>(s.cell)]) continue;
        sum += s.volume * nominal_stress_of(s, axis, own_axes);
        volume += s.volume;
      }
    }
    return volume > 0 ? sum / volume : no_value;
  };
}

} // namespace

std::vector<QuantityKind> force_kinds() {
  return {
      {.word = "force",
       .meaning =
           "reaction at a support while it holds, with what its masses and dampers take; in a model of "
           "revolution radial forces all around are summed as if they were along x (N)",
       .unit = "N",
       .keys =
           [] {
             return std::vector<Key>{of_key("the place of a support, or a body that is fixed")
                                         .refers_to(Reference::supported_place),
                                     component_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("force of the support {} on the device{}{}", q.of, along_words(q),
                                at_words(q));
           },
       .probe = force},
      {.word = "film force",
       .meaning =
           "with which the film pulls on a place, without the pressure of a chamber on the elements beside "
           "it; that of the place's own part, whatever it is tied to; "
           "in a model of revolution the radial pulls all around are summed as if they were along x (N)",
       .unit = "N",
       .keys =
           [] {
             return std::vector<Key>{place_key(), component_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("force of the film on {}{}{}", q.of, along_words(q), at_words(q));
           },
       .probe = pull_of_film},
      {.word = "moment",
       .meaning = "reaction about an axis where a body's rotation is fixed, with that of its inertia (N m)",
       .unit = "N m",
       .keys =
           [] {
             return std::vector<Key>{body_key(), about_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("moment of the support of {} on it{}{}", q.of, about_words(q), at_words(q));
           },
       .probe = moment,
       .refusal = turns_not},
      {.word = "contact force",
       .meaning =
           "sum of the normal forces where walls touch, surfaces of solids, a solid lies on a [table], "
           "or a [roll] on its core, beside its caps as the film next to these (N)",
       .unit = "N",
       .keys = [] { return std::vector<Key>{touching_key()}; },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("sum of the normal forces of contact{}{}", on_words(q), at_words(q));
           },
       .probe = contact_force,
       .refusal = touches_not},
      {.word = "contact pressure",
       .meaning =
           "largest normal force over area as drawn among the nodes of the surfaces that may touch (Pa)",
       .unit = "Pa",
       .keys = [] { return std::vector<Key>{touching_key()}; },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("largest pressure of contact{}{}", on_words(q), at_words(q));
           },
       .probe = contact_pressure,
       .refusal =
           [](const Case& one, const Quantity& q) {
             const std::string wrong = touches_not(one, q);
             const bool surfaces =
                 !one.contact || !one.contact->between.empty() || one.table || one.geometry<Roll>();
             return surfaces ? wrong : "the walls of a lattice touch along lines: ask for the contact force";
           }},
      {.word = "nominal stress",
       .meaning =
           "force over undeformed section, mean over the film at a place, with what of it no electrode "
           "covers; x and y turn with film in space, by the smallest turn that takes z to its normal; "
           "in a model of revolution x is along the meridian, y around the axis; of a rod along itself (Pa)",
       .unit = "Pa",
       .keys =
           [] {
             return std::vector<Key>{place_key(), plane_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("mean nominal stress of {}{}{}", q.of, along_words(q), at_words(q));
           },
       .probe = nominal_stress,
       .fields = true,
       .of_solids = false,
       .orders = next_to_a_place},
  };
}

} // namespace dielast::cases
