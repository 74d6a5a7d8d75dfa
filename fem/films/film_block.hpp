// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/film_kinematics.hpp"
#include "fem/films/film_response.hpp"
#include "fem/films/film_sheets.hpp"
#include "fem/model/element_block.hpp"
#include "meshing/mesh.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

namespace dielast::fem {

/// Membrane elements of one kinematics, `lanes` at a time; FilmOfLaw says how the law is evaluated.
/// Energy: int_A0 H Psi(C, k) dA0, k = eps (Phi/H)^2 under the element's electrode (see FilmResponse), where
/// that is a sheet by the voltages of its corners: k = eps sum_a N_a (V_a/H)^2 with N_a linear (see
/// SheetPoint). A point's volume is that of the film, of a full turn where it is a film of revolution.
template<class Kinematics>
class FilmBlock : public ElementBlock {
 public:
  FilmBlock(const meshing::Mesh& mesh, const meshing::CellBlock& cells, const MembraneSection& section,
            std::vector<int> electrodes, int integration_points, std::vector<int> numbers);

  int element_count() const override { return count_; }
  int dofs_per_element() const override { return dofs; }
  int granularity() const override { return lanes; }
  bool may_be_slack() const override { return true; }
  double left_where_wrinkled() const override { return section_.wrinkled; }
  void claim_dofs(DofMap& dof_map, Dimension dimension) override;
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override;
  void sample(const State& state, Samples& samples) const override;
  void add_mass(int element, std::span<double> packed) const override;
  void add_charges(const State& state, const DofMap* dof_map, Charges& charges) const override;
  void place_sheets(SheetMap& sheets) override {
    sheets_.claim(sheets, electrodes_, [this](int element, int a) { return node(element, a); });
  }
  void add_sheets(const State& state, SheetMatrices& matrices) const override;
  void add_energies(const State& state, EnergyParts& parts) const override;
  void add_relaxation(const State& state, const RateWeight& weight, const Scatter& scatter) const override;
  int history_size() const override { return film_.history_size(count_ * points_); }
  void place_history(int first) override { film_.place_history(first, count_ * points_); }
  void start_history(std::vector<double>& all) const override { film_.start_history(count_ * points_, all); }
  void advance_history(const State& state, std::vector<double>& all) const override;

 protected:
  /// `simple(C, k)`: FilmResponse::simple() of a pack.
  template<bool with_tangent, class Simple>
  Evaluation evaluate_packs(const State& state, int first, int last, const Scatter& scatter,
                            const Simple& simple) const;
  const FilmResponse& film() const { return film_; }

 private:
  static constexpr int Nodes = Kinematics::nodes, Dim = Kinematics::dim, Corners = Kinematics::corners;
  static constexpr int dofs = Nodes * Dim, packed_size = dofs * (dofs + 1) / 2;
  using Point = typename Kinematics::Point;
  using Deformation = typename Kinematics::Deformation;
  using Potential = materials::MembranePotential<Lanes>;

  static constexpr int component(int d) { return Kinematics::components[static_cast<std::size_t>(d)]; }
  int node(int element, int a) const { return nodes_[static_cast<std::size_t>(element * Nodes + a)]; }
  Eigen::Matrix<double, 3, Nodes> drawn(int element) const {
    Eigen::Matrix<double, 3, Nodes> X;
    for (int a = 0; a < Nodes; ++a) X.col(a) = reference_[static_cast<std::size_t>(node(element, a))];
    return X;
  }
  decltype(auto) point(int pack, int p) const {
    return Kinematics::point(geometry_[static_cast<std::size_t>(pack * points_ + p)],
                             rule_[static_cast<std::size_t>(p)]);
  }
  void gather(const State& state, int pack, Lanes (&x)[Nodes][Dim]) const;
  Lanes electric_modulus(const State& state, int pack) const;
  /// The same at a point where some of the elements lie under sheets; `k` holds for the others.
  Lanes under_sheets(const State& state, int pack, int point, Lanes k) const;
  double voltage(const State& state, int element, int point) const;
  /// The charges without what couples them, of film that never wrinkles: see film_charges.hpp.
  void add_taut_charges(const State& state, Charges& charges) const;
  double permittivity() const { return film_.dielectric().permittivity / section_.bulk(); }
  /// Psi over the elements of a pack, `psi` what it is without branches and wrinkles; `lost`: a wrinkled film
  /// that the field pulls wider without limit.
  void resolve(const State& state, int pack, int point, const materials::InPlaneC<Lanes>& C, const Lanes& k,
               Potential& psi, bool& lost) const;
  /// One integration point of one element, as everything but the assembly sees it.
  struct Visit {
    int element;
    int place; ///< number in the element
    int point; ///< number in the film, see FilmResponse
    const Point& geometry;
    const Deformation& deformation;
    int lane;
    materials::InPlaneC<double> C;
    double k;
  };
  template<class Visitor>
  void for_each_point(const State& state, const Visitor& visit) const;
  FilmResponse film_;
  MembraneSection section_;
  int count_ = 0, points_ = 0;
  std::vector<int> nodes_;      ///< padded to whole packs by repeating the last element
  std::vector<int> electrodes_; ///< padded like nodes_
  std::vector<int> numbers_;    ///< of the elements, in the mesh's block
  FilmSheets<Corners> sheets_;
  std::vector<Eigen::Vector3d> reference_;
  std::vector<typename Kinematics::Kept> geometry_; ///< points_ per pack
  std::vector<typename Kinematics::Rule> rule_;
};

template<class Kinematics>
FilmBlock<Kinematics>::FilmBlock(const meshing::Mesh& mesh, const meshing::CellBlock& cells,
                                 const MembraneSection& section, std::vector<int> electrodes,
                                 int integration_points, std::vector<int> numbers)
    : film_(section), section_(section), count_(cells.size()), points_(integration_points),
      nodes_(cells.nodes), electrodes_(std::move(electrodes)), numbers_(std::move(numbers)),
      reference_(mesh.nodes), rule_(Kinematics::rule(integration_points)) {
  const int packs = (count_ + lanes - 1) / lanes;
  for (int e = count_; e < packs * lanes; ++e) {
    for (int a = 0; a < Nodes; ++a) nodes_.push_back(node(count_ - 1, a));
    electrodes_.push_back(electrodes_.back());
  }
  geometry_.resize(static_cast<std::size_t>(packs * points_));
  for (int e = 0; e < packs * lanes; ++e) {
    const auto places = Kinematics::places(drawn(e), section_, points_);
    for (int p = 0; p < points_; ++p) {
      const auto& place = places[static_cast<std::size_t>(p)];
      if (e == 0) sheets_.add_place(place.corner_shape);
      if (!(place.area > 0))
        throw std::invalid_argument(std::string(Kinematics::element) + " " + std::to_string(numbers_[e]) +
                                    " is inverted or degenerate as drawn");
      auto& kept = geometry_[static_cast<std::size_t>(e / lanes * points_ + p)];
      Kinematics::keep(place, e % lanes, kept);
      kept.volume[e % lanes] = e < count_ ? place.area * section_.thickness * section_.bulk() : 0.0;
    }
  }
}

/// Consistent: rho H int N_a N_b dA.
template<class Kinematics>
void FilmBlock<Kinematics>::add_mass(int element, std::span<double> packed) const {
  for (const auto& place : Kinematics::places(drawn(element), section_, Kinematics::mass_points))
    for (int a = 0; a < Nodes; ++a)
      for (int b = 0; b <= a; ++b) {
        const double mass = section_.material.density * section_.thickness * section_.bulk() * place.area *
                            place.shape[a] * place.shape[b];
        for (int c = 0; c < Dim; ++c) {
          const int i = a * Dim + c;
          packed[static_cast<std::size_t>(i * (i + 1) / 2 + b * Dim + c)] += mass;
        }
      }
}

template<class Kinematics>
void FilmBlock<Kinematics>::claim_dofs(DofMap& dof_map, Dimension /*the kinematics say it*/) {
  for (const int n : nodes_)
    for (int d = 0; d < Dim; ++d) dof_map.add(n, component(d));
}

template<class Kinematics>
void FilmBlock<Kinematics>::element_equations(int element, const DofMap& dof_map,
                                              std::span<int> equations) const {
  for (int a = 0; a < Nodes; ++a)
    for (int d = 0; d < Dim; ++d)
      equations[static_cast<std::size_t>(a * Dim + d)] = dof_map.equation(node(element, a), component(d));
}

template<class Kinematics>
void FilmBlock<Kinematics>::gather(const State& state, int pack, Lanes (&x)[Nodes][Dim]) const {
  for (int a = 0; a < Nodes; ++a)
    for (int d = 0; d < Dim; ++d)
      x[a][d] = lanes_of([&](int l) {
        const auto n = static_cast<std::size_t>(node(pack * lanes + l, a));
        return reference_[n][component(d)] + state.displacement[n][component(d)];
      });
}

template<class Kinematics>
Lanes FilmBlock<Kinematics>::electric_modulus(const State& state, int pack) const {
  Lanes k{};
  for (int l = 0; l < lanes; ++l) {
    const int electrode = electrodes_[static_cast<std::size_t>(pack * lanes + l)];
    if (electrode == passive) continue;
    const double nominal_field = state.voltage[static_cast<std::size_t>(electrode)] / section_.thickness;
    k[l] = permittivity() * nominal_field * nominal_field;
  }
  return k;
}

template<class Kinematics>
Lanes FilmBlock<Kinematics>::under_sheets(const State& state, int pack, int point, Lanes k) const {
  for (int l = 0; l < lanes; ++l) {
    const int element = pack * lanes + l;
    if (!sheets_.points(element)) continue;
    const auto electrode = static_cast<std::size_t>(electrodes_[static_cast<std::size_t>(element)]);
    k[l] = permittivity() / (section_.thickness * section_.thickness) *
           sheets_.mean_square(state, element, point, state.voltage[electrode]);
  }
  return k;
}

/// Phi at a point of an element, 0 under no electrode, V.
template<class Kinematics>
double FilmBlock<Kinematics>::voltage(const State& state, int element, int point) const {
  const int electrode = electrodes_[static_cast<std::size_t>(element)];
  if (electrode == passive) return 0;
  return sheets_.voltage(state, element, point, state.voltage[static_cast<std::size_t>(electrode)]);
}

template<class Kinematics>
void FilmBlock<Kinematics>::resolve(const State& state, int pack, int point,
                                    const materials::InPlaneC<Lanes>& C, const Lanes& k, Potential& psi,
                                    bool& lost) const {
  materials::TensionField field{}; // that of the lane before holds for triangles of a patch
  for (int l = 0; l < lanes && pack * lanes + l < count_; ++l) {
    const int here = (pack * lanes + l) * points_ + point;
    if (l == 0 || k[l] != k[l - 1] || !film_.alike(state, here - points_, here, C, l))
      field = film_.resolve(state, here, lane_of(C, l), k[l], lane_of(psi, l));
    lost |= field.tension == materials::Tension::lost;
    set_lane(psi, l, field.potential);
  }
}

template<class Kinematics>
template<class Visitor>
void FilmBlock<Kinematics>::for_each_point(const State& state, const Visitor& visit) const {
  std::vector<Point> points(static_cast<std::size_t>(points_));
  std::vector<Deformation> of_pack(points.size());
  for (int pack = 0; pack * lanes < count_; ++pack) {
    Lanes x[Nodes][Dim];
    gather(state, pack, x);
    const Lanes k = electric_modulus(state, pack);
    for (std::size_t p = 0; p < points.size(); ++p) {
      points[p] = point(pack, static_cast<int>(p));
      of_pack[p] = Kinematics::deformation(x, points[p]);
    }
    for (int l = 0; l < lanes && pack * lanes + l < count_; ++l)
      for (int p = 0; p < points_; ++p) {
        const auto at = static_cast<std::size_t>(p);
        const int element = pack * lanes + l;
        const Lanes here = sheets_.vary(state) ? under_sheets(state, pack, p, k) : k;
        visit(Visit{element, p, element * points_ + p, points[at], of_pack[at], l, lane_of(of_pack[at].C, l),
                    here[l]});
      }
  }
}

template<class Kinematics>
template<bool with_tangent, class Simple>
Evaluation FilmBlock<Kinematics>::evaluate_packs(const State& state, int first, int last,
                                                 const Scatter& scatter, const Simple& simple) const {
  Evaluation result{.convex = with_tangent};
  Lanes energy{};
  LaneMask upright = Lanes{} == 0.0;
  const bool varies = sheets_.vary(state);
  for (int pack = first / lanes; pack * lanes < last; ++pack) {
    Lanes x[Nodes][Dim];
    gather(state, pack, x);
    const Lanes k = electric_modulus(state, pack);
    Lanes residual[dofs] = {}, tangent[with_tangent ? packed_size : 1] = {};
    for (int p = 0; p < points_; ++p) {
      decltype(auto) point = this->point(pack, p);
      const Deformation d = Kinematics::deformation(x, point);
      upright &= Kinematics::orientation(d) > 0;
      bool lost = false;
      const Lanes here = varies ? under_sheets(state, pack, p, k) : k;
      Potential stored = simple(d.C, here);
      if (!film_.is_simple()) resolve(state, pack, p, d.C, here, stored, lost);
      if (lost) result.feasible = false;
      energy += point.volume * stored.value;
      const WeightedStress stress(point.volume, stored);
      result.convex &= Kinematics::template accumulate<with_tangent>(
          point, d, stress, scatter.residual ? residual : nullptr, tangent);
    }
    for (int l = 0; l < lanes && pack * lanes + l < count_; ++l) {
      const int element = pack * lanes + l;
      if (scatter.residual) scatter.add_residual(element, lane_of(residual, l));
      if constexpr (with_tangent) scatter.add_tangent(element, lane_of(tangent, l));
    }
  }
  result.feasible &= all_lanes(upright);
  for (int l = 0; l < lanes; ++l) result.energy += energy[l];
  if (!std::isfinite(result.energy)) result.feasible = false; // beyond a stretch limit
  return result;
}

template<class Kinematics>
void FilmBlock<Kinematics>::add_relaxation(const State& state, const RateWeight& weight,
                                           const Scatter& scatter) const {
  if (history_size() == 0) return;
  for (int pack = 0; pack * lanes < count_; ++pack) {
    Lanes x[Nodes][Dim];
    gather(state, pack, x);
    const Lanes k = electric_modulus(state, pack);
    Lanes tangent[packed_size] = {};
    for (int p = 0; p < points_; ++p) {
      decltype(auto) point = this->point(pack, p);
      const Deformation d = Kinematics::deformation(x, point);
      const Lanes here = sheets_.vary(state) ? under_sheets(state, pack, p, k) : k;
      Potential psi{};
      for (int l = 0; l < lanes && pack * lanes + l < count_; ++l)
        set_lane(psi, l,
                 film_.relaxation(state, (pack * lanes + l) * points_ + p, lane_of(d.C, l), here[l], weight));
      Kinematics::template accumulate<true>(point, d, WeightedStress(point.volume, psi), nullptr, tangent);
    }
    for (int l = 0; l < lanes && pack * lanes + l < count_; ++l)
      scatter.add_tangent(pack * lanes + l, lane_of(tangent, l));
  }
}

template<class Kinematics>
void FilmBlock<Kinematics>::sample(const State& state, Samples& samples) const {
  samples.film.reserve(samples.film.size() + static_cast<std::size_t>(count_ * points_));
  for_each_point(state, [&](const Visit& at) {
    const materials::TensionField field = film_.resolve(state, at.point, at.C, at.k);
    MembraneSample s;
    s.cell = numbers_[static_cast<std::size_t>(at.element)];
    s.volume = at.geometry.volume[at.lane];
    s.F = Kinematics::gradient_of(at.deformation, at.lane);
    s.S = materials::tension_field::stress(field.potential);
    s.widening = std::sqrt(field.natural.det() / at.C.det());
    s.tension = field.tension;
    if constexpr (Kinematics::free_across) Kinematics::relieve(s, at.deformation, at.lane);
    s.thickness = section_.thickness;
    s.voltage = voltage(state, at.element, at.place);
    s.electrode = electrodes_[static_cast<std::size_t>(at.element)];
    s.breakdown_field = film_.dielectric().breakdown_field_at(field.natural.det());
    samples.film.push_back(s);
  });
}

template<class Kinematics>
void FilmBlock<Kinematics>::add_energies(const State& state, EnergyParts& parts) const {
  for_each_point(state, [&](const Visit& at) {
    const EnergyParts density =
        film_.energies(state, at.point, film_.shape(state, at.point, at.C, at.k), at.C);
    const double volume = at.geometry.volume[at.lane];
    parts.elastic += volume * density.elastic;
    parts.branches += volume * density.branches;
    parts.regularised += volume * density.regularised;
    parts.dissipation += volume * density.dissipation;
  });
}

template<class Kinematics>
void FilmBlock<Kinematics>::advance_history(const State& state, std::vector<double>& all) const {
  if (film_.history_size(1) == 0) return;
  for_each_point(state, [&](const Visit& at) {
    if (film_.repeats(state, at.point, points_, at.deformation.C, at.lane, all)) return;
    film_.advance_history(state, at.point, film_.shape(state, at.point, at.C, at.k), all);
  });
}

} // namespace dielast::fem
