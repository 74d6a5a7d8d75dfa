// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/lanes.hpp"
#include "fem/films/membrane_section.hpp"
#include "fem/model/element_block.hpp"
#include "materials/tension_field.hpp"

#include <tuple>
#include <variant>
#include <vector>

namespace dielast::fem {

/// What a film stores and does at its integration points: the material's law, its branches with their
/// internal variables, the field, and wrinkling, composed into one potential
///   Psi(C) = W(C) + sum_b Psi_b(C; history) - (k/2) e(C) det C,
/// relaxed where wrinkles carry no compression. Per undeformed volume, at one point numbered `point`.
class FilmResponse {
 public:
  using C = materials::InPlaneC<double>;
  using Potential = materials::MembranePotential<double>;

  explicit FilmResponse(const MembraneSection& section)
      : material_(materials::with_dashpot(section.material)), tension_field_(section.tension_field),
        wrinkled_(section.wrinkled) {}

  /// True when Psi depends on C and k alone, through the law and the field: several points may then be
  /// computed at once by simple().
  bool is_simple() const { return material_.branches.empty() && !tension_field_; }
  Potential simple(const C& at, double k) const;
  materials::MembranePotential<Lanes> simple(const materials::InPlaneC<Lanes>& at, const Lanes& k) const;

  /// The potential with its state of tension; `simple`: simple(at, k), known already.
  materials::TensionField resolve(const State& state, int point, const C& at, double k,
                                  const Potential& simple) const;
  materials::TensionField resolve(const State& state, int point, const C& at, double k) const {
    return resolve(state, point, at, k, simple(at, k));
  }

  /// The same without the potential, where only the film's own deformation is asked for.
  materials::TensionField shape(const State& state, int point, const C& at, double k) const {
    if (tension_field_) return resolve(state, point, at, k);
    return {materials::Tension::taut, {}, at};
  }

  /// e det C of the film itself, its derivatives in the given (C11, C22, C12) and, as the field widens what
  /// is wrinkled, in k: the charge on an electrode is the integral of eps Phi/H^2 times it.
  struct ChargeDensity {
    double value;
    Eigen::Vector3d slope;
    double per_k = 0;
  };
  ChargeDensity charge_density(const materials::TensionField& field, const C& at) const;

  /// Densities, per undeformed volume; `electric` stays 0: it follows from the charges.
  EnergyParts energies(const State& state, int point, const materials::TensionField& field,
                       const C& at) const;

  /// Second derivatives sum_j weight(rate_j) w_j w_j^T over the branches, see relaxation_spectrum().
  Potential relaxation(const State& state, int point, const C& at, double k, const RateWeight& weight) const;

  /// Whether a point in lane l is deformed like one in the lane before, and has the same past, to the last
  /// bit.
  bool alike(const State& state, int before, int point, const materials::InPlaneC<Lanes>& at, int l) const;

  template<class Law>
  const Law& law() const {
    return std::get<Law>(material_.law);
  }
  const materials::Dielectric& dielectric() const { return material_.dielectric; }

  // --- internal variables: branch by branch, point by point
  int history_size(int points) const { return points * branches() * per_branch; }
  /// `points`: of which what the branches do is kept until they are deformed otherwise; none with a tension
  /// field.
  void place_history(int first, int points = 0);
  void start_history(int points, std::vector<double>& all) const;
  void advance_history(const State& state, int point, const materials::TensionField& field,
                       std::vector<double>& all) const;
  /// Where the point `points` before it, in the lane before, is alike and has advanced, so does this one.
  bool repeats(const State& state, int point, int points, const materials::InPlaneC<Lanes>& at, int l,
               std::vector<double>& all) const;

 private:
  static constexpr int per_branch = static_cast<int>(std::tuple_size_v<materials::Internal>);

  int branches() const { return static_cast<int>(material_.branches.size()); }
  std::size_t place(int point, int branch) const {
    return static_cast<std::size_t>(first_ + (point * branches() + branch) * per_branch);
  }
  Potential with_branches(const State& state, int point, const C& at, const Potential& psi) const;
  Potential of_branches(const State& state, int point, const C& at) const;
  /// C, the scheme, two pasts, and the potential with its derivatives.
  int kept_size() const { return 7 + 2 * history_size(1) + 10; }
  bool wrinkles(const materials::TensionField& field) const {
    return tension_field_ && field.tension != materials::Tension::taut;
  }

  materials::Material material_;
  bool tension_field_;
  double wrinkled_; ///< see MembraneSection
  int first_ = 0;
  mutable std::vector<double> kept_; ///< kept_size() per point
};

} // namespace dielast::fem
