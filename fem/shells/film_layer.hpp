// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/film_response.hpp"
#include "fem/films/lanes.hpp"
#include "fem/shells/shell_section.hpp"

#include <memory>

namespace dielast::fem {

/// What a layer of film stores and does at its integration points, whatever its law: FilmResponse without
/// wrinkles behind one virtual call for a pack of points.
class FilmLayer {
 public:
  using C = materials::InPlaneC<double>;
  using Potential = materials::MembranePotential<double>;

  virtual ~FilmLayer() = default;

  /// Psi and its derivatives at one point of each of the first `count` lanes, see FilmResponse; `points`:
  /// their numbers in the layer. k: Pa.
  virtual materials::MembranePotential<Lanes> potential(const State& state,
                                                        const std::array<int, lanes>& points, int count,
                                                        const materials::InPlaneC<Lanes>& at,
                                                        const Lanes& k) const = 0;
  virtual materials::TensionField resolve(const State& state, int point, const C& at, double k) const = 0;
  /// e det C and its derivatives in (C11, C22, C12): the charge is the integral of eps Phi/H^2 times it.
  virtual Potential charge_density(const C& at) const = 0;
  virtual EnergyParts energies(const State& state, int point, const C& at) const = 0;
  virtual Potential relaxation(const State& state, int point, const C& at, double k,
                               const RateWeight& weight) const = 0;
  virtual const materials::Dielectric& dielectric() const = 0;
  virtual int history_size(int points) const = 0;
  virtual void place_history(int first) = 0;
  virtual void start_history(int points, std::vector<double>& all) const = 0;
  virtual void advance_history(const State& state, int point, const C& at,
                               std::vector<double>& all) const = 0;
};

std::unique_ptr<FilmLayer> make_film_layer(const ShellLayer& layer);

} // namespace dielast::fem
