// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/shells/film_layer.hpp"

namespace dielast::fem {

namespace {

template<class Law>
class LayerOf final : public FilmLayer {
 public:
  LayerOf(Law law, const ShellLayer& layer)
      : film_(std::move(law), MembraneSection{.material = layer.material, .thickness = layer.thickness}) {}

  materials::MembranePotential<Lanes> potential(const State& state, const std::array<int, lanes>& points,
                                                int count, const materials::InPlaneC<Lanes>& at,
                                                const Lanes& k) const override {
    materials::MembranePotential<Lanes> psi = film_.simple(at, k);
    for (int l = 0; !film_.is_simple() && l < count; ++l)
      set_lane(
          psi, l,
          film_.resolve(state, points[static_cast<std::size_t>(l)], lane_of(at, l), k[l], lane_of(psi, l))
              .potential);
    return psi;
  }
  materials::TensionField resolve(const State& state, int point, const C& at, double k) const override {
    return film_.resolve(state, point, at, k);
  }
  Potential charge_density(const C& at) const override {
    return materials::in_components<false>(
        materials::capacitance_ratio(film_.dielectric(), at.trace(), at.det()), at, C{1, 1, 0}, 1.0);
  }
  EnergyParts energies(const State& state, int point, const C& at) const override {
    return film_.energies(state, point, taut(at), at);
  }
  Potential relaxation(const State& state, int point, const C& at, double k,
                       const RateWeight& weight) const override {
    return film_.relaxation(state, point, at, k, weight);
  }
  const materials::Dielectric& dielectric() const override { return film_.dielectric(); }
  int history_size(int points) const override { return film_.history_size(points); }
  void place_history(int first) override { film_.place_history(first); }
  void start_history(int points, std::vector<double>& all) const override {
    film_.start_history(points, all);
  }
  void advance_history(const State& state, int point, const C& at, std::vector<double>& all) const override {
    film_.advance_history(state, point, taut(at), all);
  }

 private:
  static materials::TensionField taut(const C& at) { return {materials::Tension::taut, {}, at}; }

  FilmResponse<Law> film_;
};

} // namespace

std::unique_ptr<FilmLayer> make_film_layer(const ShellLayer& layer) {
  return std::visit(
      [&](const auto& law) -> std::unique_ptr<FilmLayer> {
        return std::make_unique<LayerOf<std::decay_t<decltype(law)>>>(law, layer);
      },
      layer.material.law);
}

} // namespace dielast::fem
