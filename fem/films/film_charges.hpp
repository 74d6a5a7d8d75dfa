// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/film_block.hpp"

// Charges on films, and sheets that conduct them: members of FilmBlock.

namespace dielast::fem {

template<class Kinematics>
void FilmBlock<Kinematics>::add_charges(const State& state, const DofMap* dof_map, Charges& charges) const {
  if (!dof_map && !section_.tension_field) return add_taut_charges(state, charges);
  for_each_point(state, [&](const Visit& at) {
    const int electrode = electrodes_[static_cast<std::size_t>(at.element)];
    if (electrode == passive) return;
    const auto e = static_cast<std::size_t>(electrode);
    const auto density = film_.charge_density(film_.shape(state, at.point, at.C, at.k), at.C);
    const double phi = voltage(state, at.element, at.place);
    const double per_volt =
        permittivity() * at.geometry.volume[at.lane] / (section_.thickness * section_.thickness);
    charges.capacitance[e] += per_volt * density.value;
    charges.charge[e] += per_volt * phi * density.value;
    if (!dof_map) return;
    charges.capacitance[e] += per_volt * 2 * at.k * density.per_k; // k goes with the square of Phi
    const auto& q = density.slope;
    for (int a = 0; a < Nodes; ++a)
      for (int c = 0; c < Dim; ++c) {
        const int equation = dof_map->equation(node(at.element, a), component(c));
        if (equation < 0) continue;
        Lanes slope[3];
        Kinematics::slope(at.geometry, at.deformation, a, c, slope);
        charges.coupling[e][equation] +=
            per_volt * phi * (q[0] * slope[0][at.lane] + q[1] * slope[1][at.lane] + q[2] * slope[2][at.lane]);
      }
  });
}

template<class Kinematics>
void FilmBlock<Kinematics>::add_taut_charges(const State& state, Charges& charges) const {
  const double per_volume = permittivity() / (section_.thickness * section_.thickness);
  for (int pack = 0; pack * lanes < count_; ++pack) {
    Lanes x[Nodes][Dim], capacitance{}, charge{};
    gather(state, pack, x);
    for (int p = 0; p < points_; ++p) {
      const Point at = point(pack, p);
      const materials::InPlaneC<Lanes> C = Kinematics::deformation(x, at).C;
      const Lanes per_volt =
          per_volume * at.volume * materials::capacitance_ratio_value(film_.dielectric(), C.trace(), C.det());
      capacitance += per_volt;
      charge += per_volt * lanes_of([&](int l) { return voltage(state, pack * lanes + l, p); });
    }
    for (int l = 0; l < lanes && pack * lanes + l < count_; ++l) {
      const int electrode = electrodes_[static_cast<std::size_t>(pack * lanes + l)];
      if (electrode == passive) continue;
      charges.capacitance[static_cast<std::size_t>(electrode)] += capacitance[l];
      charges.charge[static_cast<std::size_t>(electrode)] += charge[l];
    }
  }
}

/// The current flows along the film itself, wrinkles included.
template<class Kinematics>
void FilmBlock<Kinematics>::add_sheets(const State& state, SheetMatrices& matrices) const {
  if (sheets_.empty()) return;
  std::vector<FilmPlace<Nodes, Corners>> places;
  for_each_point(state, [&](const Visit& at) {
    if (!sheets_.points(at.element)) return;
    if (at.place == 0) places = Kinematics::places(drawn(at.element), section_, points_);
    const auto& place = places[static_cast<std::size_t>(at.place)];
    const materials::TensionField field = film_.shape(state, at.point, at.C, at.k);
    const double per_volt = film_.dielectric().permittivity * place.area / section_.thickness *
                            film_.charge_density(field, at.C).value;
    sheets_.add(matrices, at.element, place.corner_shape * per_volt,
                std::sqrt(place.area) * place.corner_gradient, field.natural);
  });
}

} // namespace dielast::fem
