// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/film_charges.hpp"
#include "materials/laws/elastic_law.hpp"

#include <concepts>

namespace dielast::fem {

/// Membrane elements whose loop over points is compiled for one law; for `ElasticLaw` it holds for all of
/// them and asks which one it is at every pack of points. A law costs a compiler seconds for every
/// kinematics.
template<class Kinematics, class Law>
class FilmOfLaw final : public FilmBlock<Kinematics> {
 public:
  using FilmBlock<Kinematics>::FilmBlock;

  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    const auto evaluated = [&](const auto& simple) {
      return scatter.tangent ? this->template evaluate_packs<true>(state, first, last, scatter, simple)
                             : this->template evaluate_packs<false>(state, first, last, scatter, simple);
    };
    if constexpr (std::same_as<Law, materials::ElasticLaw>)
      return evaluated(
          [&](const materials::InPlaneC<Lanes>& C, const Lanes& k) { return this->film().simple(C, k); });
    else
      return evaluated(Simple{this->film().template law<Law>(), this->film().dielectric()});
  }

 private:
  struct Simple {
    const Law& law;
    const materials::Dielectric& dielectric;

    [[gnu::always_inline]] inline materials::MembranePotential<Lanes>
    operator()(const materials::InPlaneC<Lanes>& C, const Lanes& k) const {
      return materials::membrane_potential(law, dielectric, C, k);
    }
  };
};

} // namespace dielast::fem
