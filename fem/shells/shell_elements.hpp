// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/membrane_block.hpp"
#include "fem/model/node_places.hpp"
#include "fem/shells/film_layer.hpp"
#include "fem/shells/shell_block.hpp"
#include "fem/shells/shell_shear.hpp"
#include "fem/shells/shell_sum.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace dielast::fem {

/// Gauss points across a layer, in -1..1.
struct Depth {
  double place, weight; ///< the weights add up to 1
};
constexpr int depths = 3;
inline const std::array<Depth, depths> depth_rule{
    {{-std::sqrt(0.6), 5.0 / 18}, {0, 8.0 / 18}, {std::sqrt(0.6), 5.0 / 18}}};

using Matrix36 = Eigen::Matrix<double, 3, 6>;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

inline Eigen::Matrix<double, 6, 2> matrix(const ShellTables::Gradient& gradient) {
  Eigen::Matrix<double, 6, 2> all;
  for (std::size_t a = 0; a < 6; ++a) all.row(static_cast<Eigen::Index>(a)) << gradient[a][0], gradient[a][1];
  return all;
}

/// Orthonormal axes in the plane of two tangents: along x, or along y where the plane is next to normal to x,
/// and to the left of it about the normal.
Matrix32 axes(const Matrix32& tangents);

/// Normals at the nodes of an element whose nodes are these columns.
Matrix36 directors(const Matrix36& X);

/// See make_shell_block().
class ShellBlock final : public ElementBlock {
 public:
  ShellBlock(const meshing::Mesh& mesh, const meshing::CellBlock& cells, const ShellSection& section,
             std::vector<std::vector<int>> electrodes, std::vector<int> numbers);

  int element_count() const override { return count_; }
  int dofs_per_element() const override { return dofs; }
  NodeOrder node_order() const override { return {Nodes, 5}; } // see ShellSum
  int granularity() const override { return lanes; }
  void claim_dofs(DofMap& dof_map, Dimension dimension) override;
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override;
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override;
  void sample(const State& state, Samples& samples) const override;
  void add_charges(const State& state, const DofMap* dof_map, Charges& charges) const override;
  void add_energies(const State& state, EnergyParts& parts) const override;
  void add_relaxation(const State& state, const RateWeight& weight, const Scatter& scatter) const override;
  int history_size() const override;
  void place_history(int first) override;
  void start_history(std::vector<double>& all) const override;
  void advance_history(const State& state, std::vector<double>& all) const override;

 private:
  static constexpr int Nodes = ShellTables::nodes, points = ShellTables::points;
  static constexpr int dofs = ShellSum<true, 3>::dofs;
  static constexpr double slenderest = 30;

  struct Layer {
    FilmLayer film;
    double thickness;                    ///< H, m
    double depth, middle;                ///< see ShellSection::depth_of(); above that of all, m
    std::array<double, 2> extra_stretch; ///< see ShellSection
    int number;
    std::vector<int> electrodes; ///< padded like nodes_
    bool charged;                ///< there is one

    bool stretched() const { return extra_stretch != std::array{1.0, 1.0}; }
    /// By which C of the section, components 11, 22, 12, becomes the layer's.
    std::array<double, 3> factors() const {
      const auto [x, y] = extra_stretch;
      return {x * x, y * y, x * y};
    }
    materials::InPlaneC<Lanes> own(const materials::InPlaneC<Lanes>& C) const {
      if (!stretched()) return C;
      const auto f = factors();
      return {f[0] * C.C11, f[1] * C.C22, f[2] * C.C12};
    }
    /// Of a potential in the layer's C, that in the section's.
    materials::MembranePotential<Lanes> in_section(materials::MembranePotential<Lanes> psi) const {
      if (!stretched()) return psi;
      const auto f = factors();
      const auto of = [&](int component) { return f[static_cast<std::size_t>(component)]; };
      for (std::size_t i = 0; i < 3; ++i) psi.first[i] *= f[i];
      for (std::size_t p = 0; p < 6; ++p)
        psi.second[p] *= of(materials::component_pairs[p][0]) * of(materials::component_pairs[p][1]);
      return psi;
    }
  };
  /// One point across the thickness at an integration point of a pack.
  struct Place {
    const Layer& layer;
    double Z, weight;             ///< above the middle, before the prestretch, m
    Lanes height;                 ///< above the surface of the strains, along the director, m
    std::array<int, lanes> point; ///< numbers in the layer
    materials::InPlaneC<Lanes> C; ///< of the layer
    Lanes field;                  ///< nominal, over Phi/H
    Lanes k;                      ///< of that field, Pa
  };

  int node(int element, int a) const { return nodes_[static_cast<std::size_t>(element * Nodes + a)]; }
  int lanes_of(int pack) const { return std::min(lanes, count_ - pack * lanes); }
  Matrix36 drawn(int element) const {
    Matrix36 X;
    for (int a = 0; a < Nodes; ++a) X.col(a) = reference_[static_cast<std::size_t>(node(element, a))];
    return X;
  }
  const ShellPoint& point(int pack, int p) const {
    return geometry_[static_cast<std::size_t>(pack * points + p)];
  }
  bool is_prestretched() const {
    return prestretch_ != std::array{1.0, 1.0} || std::ranges::any_of(layers_, &Layer::stretched);
  }
  void place_element(int element);
  ShellNodes gather(const State& state, int pack) const;
  void turn(int pack, int a, const Lanes (&R)[3][3], std::span<const Matrix36> middle,
            ShellNodes& nodes) const;
  Lanes electric_modulus(const State& state, const Layer& layer, int pack) const;
  template<class Visitor>
  void across(const State& state, const Layer& layer, int pack, int p, const ShellStrain& strain,
              const Visitor& visit) const;
  /// A point across the thickness of one element.
  struct Visit {
    const Place& place;
    int lane, element, p;
    double volume; ///< m^3
    const ShellDeformation& f;

    int number() const { return place.point[static_cast<std::size_t>(lane)]; }
  };
  template<class Visitor>
  void for_each_point(const State& state, const Visitor& visit) const;
  /// Adds the energy of a pack to `energy`; whether it can be in this state.
  template<bool with_tangent, int axes>
  bool evaluate_pack(const State& state, int pack, const ShellNodes& nodes, const Scatter& scatter,
                     Lanes& energy) const;
  template<bool with_tangent>
  Evaluation evaluate_packs(const State& state, int first, int last, const Scatter& scatter) const;
  template<bool with_tangent, int axes>
  void scatter_pack(int pack, const ShellSum<with_tangent, axes>& sum, const Scatter& scatter) const;
  /// Numbers of a pack's p-th points in the surface.
  std::array<int, lanes> surface_points(int pack, int p) const {
    std::array<int, lanes> numbers;
    for (int l = 0; l < lanes; ++l) numbers[static_cast<std::size_t>(l)] = (pack * lanes + l) * points + p;
    return numbers;
  }
  Lanes drilling_stiffness(int pack) const { // N m
    return drilling_ * shear_.stiffness() / Nodes * areas_[static_cast<std::size_t>(pack)];
  }

  std::vector<Layer> layers_;
  std::array<double, 2> prestretch_;
  double lever_ = 0;  ///< of the layers' middle above the drawn surface, as drawn, m: strains are its own
  double height_ = 0; ///< of the layers before the prestretch, m
  ShellShear shear_;
  double drilling_; ///< see ShellSection
  int count_ = 0;
  std::vector<int> nodes_;   ///< padded to whole packs by repeating the last element
  std::vector<int> numbers_; ///< of the elements, in the mesh's block
  std::vector<Eigen::Vector3d> reference_;
  std::vector<ShellPoint> geometry_;                       ///< `points` per pack
  std::vector<Lanes> areas_;                               ///< undeformed, of the elements, per pack
  std::shared_ptr<const std::vector<TiltAxes>> tilt_axes_; ///< see DofMap
};

/// The faces of a charged layer have one potential each, wherever it is bent: the nominal displacement eps r
/// Phi'(Z), r = e det C(Z), is even across it, and the field is Phi/H over r(Z) times the mean of 1/r.
template<class Visitor>
void ShellBlock::across(const State& state, const Layer& layer, int pack, int p, const ShellStrain& strain,
                        const Visitor& visit) const {
  const Lanes k = electric_modulus(state, layer, pack), thinning = strain.thinning(),
              gaussian = strain.gaussian_curvature(), mean = strain.mean_curvature();
  std::array<double, depths> Z;
  std::array<materials::InPlaneC<Lanes>, depths> C;
  std::array<Lanes, depths> field, height;
  Lanes mean_field{};
  for (std::size_t q = 0; q < depths; ++q) {
    Z[q] = layer.middle + depth_rule[q].place * layer.depth / 2;
    height[q] = Z[q] * thinning;
    C[q] = layer.own(strain.at(height[q], gaussian));
    field[q] = Lanes{} + 1.0;
    if (layer.charged) field[q] /= layer.film.capacitance_ratio_value(C[q]);
    mean_field += depth_rule[q].weight * field[q];
  }
  for (std::size_t q = 0; q < depths; ++q) {
    std::array<int, lanes> numbers;
    for (int l = 0; l < lanes; ++l)
      numbers[static_cast<std::size_t>(l)] = ((pack * lanes + l) * points + p) * depths + static_cast<int>(q);
    if (layer.charged) field[q] /= mean_field;
    visit(Place{layer, Z[q], depth_rule[q].weight * layer.depth, height[q] * (1.0 - mean * height[q]),
                numbers, C[q], field[q], k * field[q] * field[q]});
  }
}

template<class Visitor>
void ShellBlock::for_each_point(const State& state, const Visitor& visit) const {
  for (int pack = 0; pack * lanes < count_; ++pack) {
    const ShellNodes nodes = gather(state, pack);
    for (int p = 0; p < points; ++p) {
      const ShellDeformation f = deformation(shell_tables().point[static_cast<std::size_t>(p)], nodes);
      const ShellStrain strain = fem::strain(point(pack, p), f);
      for (const Layer& layer : layers_)
        across(state, layer, pack, p, strain, [&](const Place& place) {
          for (int l = 0; l < lanes_of(pack); ++l)
            visit(Visit{place, l, pack * lanes + l, p, point(pack, p).area[l] * place.weight, f});
        });
    }
  }
}

template<bool with_tangent, int axes>
void ShellBlock::scatter_pack(int pack, const ShellSum<with_tangent, axes>& sum,
                              const Scatter& scatter) const {
  using Sum = ShellSum<with_tangent, axes>;
  for (int l = 0; l < lanes_of(pack); ++l) {
    const int element = pack * lanes + l;
    if (scatter.residual) {
      double values[Sum::dofs];
      for (int i = 0; i < Sum::dofs; ++i) values[i] = sum.residual(i)[l];
      scatter.add_residual(element, values, dofs);
    }
    if constexpr (with_tangent) {
      double values[Sum::packed_size];
      for (int i = 0; i < Sum::packed_size; ++i) values[i] = sum.tangent(i)[l];
      add_by_nodes<Nodes, 5, dofs>(scatter, element, values);
    }
  }
}

} // namespace dielast::fem
