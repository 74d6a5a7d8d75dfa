// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/film_response.hpp"
#include "fem/shells/shell_section.hpp"

namespace dielast::fem {

/// What a layer of film stores and does at its integration points: FilmResponse without wrinkles.
class FilmLayer {
 public:
  using C = materials::InPlaneC<double>;
  using Potential = materials::MembranePotential<double>;

  explicit FilmLayer(const ShellLayer& layer);

  /// Psi and its derivatives at one point of each of the first `count` lanes, see FilmResponse; `points`:
  /// their numbers in the layer. k: Pa.
  materials::MembranePotential<Lanes> potential(const State& state, const std::array<int, lanes>& points,
                                                int count, const materials::InPlaneC<Lanes>& at,
                                                const Lanes& k) const;
  materials::TensionField resolve(const State& state, int point, const C& at, double k) const {
    return film_.resolve(state, point, at, k);
  }
  /// e det C with its derivatives in (C11, C22, C12), and alone: what a voltage across a slice of the layer
  /// charges it with, over eps/H times it.
  materials::MembranePotential<Lanes> capacitance_ratio(const materials::InPlaneC<Lanes>& at) const;
  Lanes capacitance_ratio_value(const materials::InPlaneC<Lanes>& at) const;
  EnergyParts energies(const State& state, int point, const C& at) const;
  Potential relaxation(const State& state, int point, const C& at, double k, const RateWeight& weight) const {
    return film_.relaxation(state, point, at, k, weight);
  }
  const materials::Dielectric& dielectric() const { return film_.dielectric(); }
  int history_size(int points) const { return film_.history_size(points); }
  void place_history(int first) { film_.place_history(first); }
  void start_history(int points, std::vector<double>& all) const { film_.start_history(points, all); }
  void advance_history(const State& state, int point, const C& at, std::vector<double>& all) const;

 private:
  FilmResponse film_;
};

} // namespace dielast::fem
