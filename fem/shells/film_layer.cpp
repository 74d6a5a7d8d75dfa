// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/shells/film_layer.hpp"

namespace dielast::fem {

namespace {

materials::TensionField taut(const FilmLayer::C& at) { return {materials::Tension::taut, {}, at}; }

} // namespace

FilmLayer::FilmLayer(const ShellLayer& layer)
    : film_(MembraneSection{.material = layer.material, .thickness = layer.thickness}) {}

materials::MembranePotential<Lanes> FilmLayer::potential(const State& state,
                                                         const std::array<int, lanes>& points, int count,
                                                         const materials::InPlaneC<Lanes>& at,
                                                         const Lanes& k) const {
  materials::MembranePotential<Lanes> psi = film_.simple(at, k);
  for (int l = 0; !film_.is_simple() && l < count; ++l)
    set_lane(psi, l,
             film_.resolve(state, points[static_cast<std::size_t>(l)], lane_of(at, l), k[l], lane_of(psi, l))
                 .potential);
  return psi;
}

materials::MembranePotential<Lanes> FilmLayer::capacitance_ratio(const materials::InPlaneC<Lanes>& at) const {
  return materials::in_components<false>(
      materials::capacitance_ratio(film_.dielectric(), at.trace(), at.det()), at, C{1, 1, 0}, 1.0);
}

Lanes FilmLayer::capacitance_ratio_value(const materials::InPlaneC<Lanes>& at) const {
  return materials::capacitance_ratio_value(film_.dielectric(), at.trace(), at.det());
}

EnergyParts FilmLayer::energies(const State& state, int point, const C& at) const {
  return film_.energies(state, point, taut(at), at);
}

void FilmLayer::advance_history(const State& state, int point, const C& at, std::vector<double>& all) const {
  film_.advance_history(state, point, taut(at), all);
}

} // namespace dielast::fem
