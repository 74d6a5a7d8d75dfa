#include "fem/membrane_block.hpp"

#include "fem/film_response.hpp"
#include "fem/triangle.hpp"

#include <cmath>
#include <stdexcept>

namespace dielast::fem {

namespace {

/// Elements are computed `lanes` at a time, one per lane of a vector register.
using Lanes = materials::Pack;
constexpr int lanes = static_cast<int>(sizeof(Lanes) / sizeof(double));
using Potential = materials::MembranePotential<Lanes>;
using LanePotential = materials::MembranePotential<double>;

materials::InPlaneC<double> lane_of(const materials::InPlaneC<Lanes>& C, int l) {
  return {C.C11[l], C.C22[l], C.C12[l]};
}

LanePotential lane_of(const Potential& p, int l) {
  LanePotential q{p.value[l], {}, {}};
  for (std::size_t i = 0; i < q.first.size(); ++i) q.first[i] = p.first[i][l];
  for (std::size_t i = 0; i < q.second.size(); ++i) q.second[i] = p.second[i][l];
  return q;
}

void set_lane(Potential& p, int l, const LanePotential& q) {
  p.value[l] = q.value;
  for (std::size_t i = 0; i < q.first.size(); ++i) p.first[i][l] = q.first[i];
  for (std::size_t i = 0; i < q.second.size(); ++i) p.second[i][l] = q.second[i];
}

template<int Nodes, int Dim, class Law>
class MembraneBlock final : public ElementBlock {
 public:
  MembraneBlock(const meshing::Mesh& mesh, const meshing::CellBlock& triangles,
                const MembraneSection& section, Law law, std::vector<int> electrodes, int integration_points);

  int element_count() const override { return count_; }
  int dofs_per_element() const override { return Nodes * Dim; }
  int granularity() const override { return lanes; }
  void claim_dofs(DofMap& dofs, bool planar) const override;
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override;
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override;
  void sample(const State& state, Samples& samples) const override;
  void add_charges(const State& state, const DofMap* dof_map, Charges& charges) const override;
  void add_energies(const State& state, EnergyParts& parts) const override;
  int history_size() const override { return film_.history_size(count_ * points_); }
  void place_history(int first) override { film_.place_history(first); }
  void start_history(std::vector<double>& all) const override { film_.start_history(count_ * points_, all); }
  void advance_history(const State& state, std::vector<double>& all) const override;

 private:
  static constexpr int dofs = Nodes * Dim;
  static constexpr int packed = dofs * (dofs + 1) / 2;

  /// One integration point of `lanes` elements.
  struct Point {
    Lanes gradient[Nodes][2]; ///< of the shape functions, w.r.t. the unstretched film, 1/m
    Lanes volume;             ///< undeformed volume, m^3; 0 in lanes past the last element
  };
  /// In-plane deformation gradient by columns, and C.
  struct Deformation {
    Lanes F[2][Dim];
    materials::InPlaneC<Lanes> C;
  };

  int node(int element, int a) const { return nodes_[static_cast<std::size_t>(element * Nodes + a)]; }
  void gather(const State& state, int pack, Lanes (&x)[Nodes][Dim]) const;
  Lanes electric_modulus(const State& state, int pack) const;
  static Deformation deformation(const Lanes (&x)[Nodes][Dim], const Point& point);
  /// Psi over the elements of a pack; `lost`: a wrinkled film that the field pulls wider without limit.
  Potential potential(const State& state, int pack, int point, const materials::InPlaneC<Lanes>& C,
                      const Lanes& k, bool& lost) const;
  /// One integration point of one element, as everything but the assembly sees it.
  struct Visit {
    int element;
    int point; ///< number in the film, see FilmResponse
    const Point& geometry;
    const Deformation& deformation;
    int lane;
    materials::InPlaneC<double> C;
    double k;
  };
  template<class Visitor>
  void for_each_point(const State& state, const Visitor& visit) const;
  template<bool with_tangent>
  static void accumulate(const Point& point, const Deformation& d,
                         const materials::MembranePotential<Lanes>& potential, Lanes (&residual)[dofs],
                         Lanes* tangent);
  template<bool with_tangent>
  Evaluation evaluate_packs(const State& state, int first, int last, const Scatter& scatter) const;

  FilmResponse<Law> film_;
  double thickness_; ///< undeformed, m
  int count_ = 0;
  int points_ = 0;
  std::vector<int> nodes_;      ///< padded to whole packs by repeating the last element
  std::vector<int> electrodes_; ///< likewise
  std::vector<Eigen::Vector3d> reference_;
  std::vector<Point> geometry_; ///< points_ per pack
};

template<int Nodes, int Dim, class Law>
MembraneBlock<Nodes, Dim, Law>::MembraneBlock(const meshing::Mesh& mesh, const meshing::CellBlock& triangles,
                                              const MembraneSection& section, Law law,
                                              std::vector<int> electrodes, int integration_points)
    : film_(std::move(law), section), thickness_(section.thickness), count_(triangles.size()),
      points_(integration_points), nodes_(triangles.nodes), electrodes_(std::move(electrodes)),
      reference_(mesh.nodes) {
  const int packs = (count_ + lanes - 1) / lanes;
  for (int e = count_; e < packs * lanes; ++e) {
    for (int a = 0; a < Nodes; ++a) nodes_.push_back(node(count_ - 1, a));
    electrodes_.push_back(electrodes_.back());
  }
  geometry_.assign(static_cast<std::size_t>(packs * points_), Point{});
  const auto rule = triangle_rule(points_);
  const Eigen::Vector2d prestretch(section.prestretch[0], section.prestretch[1]);
  for (int e = 0; e < packs * lanes; ++e) {
    Eigen::Matrix<double, 2, Nodes> X;
    for (int a = 0; a < Nodes; ++a)
      X.col(a) = reference_[static_cast<std::size_t>(node(e, a))].template head<2>();
    for (int p = 0; p < points_; ++p) {
      const auto& at = rule[static_cast<std::size_t>(p)];
      const Eigen::Matrix<double, Nodes, 2> dN = shape_gradients<Nodes>(at.xi, at.eta);
      const Eigen::Matrix2d jacobian = X * dN;
      const double det = jacobian.determinant();
      if (!(det > 0))
        throw std::invalid_argument("triangle " + std::to_string(e) + " is inverted or degenerate as drawn");
      const Eigen::Matrix<double, Nodes, 2> gradient = dN * jacobian.inverse() * prestretch.asDiagonal();
      Point& point = geometry_[static_cast<std::size_t>(e / lanes * points_ + p)];
      for (int a = 0; a < Nodes; ++a)
        for (int i = 0; i < 2; ++i) point.gradient[a][i][e % lanes] = gradient(a, i);
      point.volume[e % lanes] = e < count_ ? at.weight * det * section.thickness / prestretch.prod() : 0.0;
    }
  }
}

template<int Nodes, int Dim, class Law>
void MembraneBlock<Nodes, Dim, Law>::claim_dofs(DofMap& dof_map, bool /*planar: Dim says it*/) const {
  for (const int n : nodes_)
    for (int d = 0; d < Dim; ++d) dof_map.add(n, d);
}

template<int Nodes, int Dim, class Law>
void MembraneBlock<Nodes, Dim, Law>::element_equations(int element, const DofMap& dof_map,
                                                       std::span<int> equations) const {
  for (int a = 0; a < Nodes; ++a)
    for (int d = 0; d < Dim; ++d)
      equations[static_cast<std::size_t>(a * Dim + d)] = dof_map.equation(node(element, a), d);
}

template<int Nodes, int Dim, class Law>
void MembraneBlock<Nodes, Dim, Law>::gather(const State& state, int pack, Lanes (&x)[Nodes][Dim]) const {
  for (int a = 0; a < Nodes; ++a)
    for (int l = 0; l < lanes; ++l) {
      const auto n = static_cast<std::size_t>(node(pack * lanes + l, a));
      for (int d = 0; d < Dim; ++d) x[a][d][l] = reference_[n][d] + state.displacement[n][d];
    }
}

template<int Nodes, int Dim, class Law>
Lanes MembraneBlock<Nodes, Dim, Law>::electric_modulus(const State& state, int pack) const {
  Lanes k{};
  for (int l = 0; l < lanes; ++l) {
    const int electrode = electrodes_[static_cast<std::size_t>(pack * lanes + l)];
    if (electrode == passive) continue;
    const double nominal_field = state.voltage[static_cast<std::size_t>(electrode)] / thickness_;
    k[l] = film_.dielectric().permittivity * nominal_field * nominal_field;
  }
  return k;
}

template<int Nodes, int Dim, class Law>
typename MembraneBlock<Nodes, Dim, Law>::Deformation
MembraneBlock<Nodes, Dim, Law>::deformation(const Lanes (&x)[Nodes][Dim], const Point& point) {
  Deformation d{};
  for (int a = 0; a < Nodes; ++a)
    for (int i = 0; i < 2; ++i)
      for (int c = 0; c < Dim; ++c) d.F[i][c] += x[a][c] * point.gradient[a][i];
  for (int c = 0; c < Dim; ++c) {
    d.C.C11 += d.F[0][c] * d.F[0][c];
    d.C.C22 += d.F[1][c] * d.F[1][c];
    d.C.C12 += d.F[0][c] * d.F[1][c];
  }
  return d;
}

template<int Nodes, int Dim, class Law>
Potential MembraneBlock<Nodes, Dim, Law>::potential(const State& state, int pack, int point,
                                                    const materials::InPlaneC<Lanes>& C, const Lanes& k,
                                                    bool& lost) const {
  Potential psi = film_.simple(C, k);
  if (film_.is_simple()) return psi;
  for (int l = 0; l < lanes && pack * lanes + l < count_; ++l) {
    const materials::TensionField field =
        film_.resolve(state, (pack * lanes + l) * points_ + point, lane_of(C, l), k[l], lane_of(psi, l));
    lost |= field.tension == materials::Tension::lost;
    set_lane(psi, l, field.potential);
  }
  return psi;
}

template<int Nodes, int Dim, class Law>
template<class Visitor>
void MembraneBlock<Nodes, Dim, Law>::for_each_point(const State& state, const Visitor& visit) const {
  for (int pack = 0; pack * lanes < count_; ++pack) {
    Lanes x[Nodes][Dim];
    gather(state, pack, x);
    const Lanes k = electric_modulus(state, pack);
    for (int l = 0; l < lanes && pack * lanes + l < count_; ++l)
      for (int p = 0; p < points_; ++p) {
        const Point& geometry = geometry_[static_cast<std::size_t>(pack * points_ + p)];
        const Deformation d = deformation(x, geometry);
        const int element = pack * lanes + l, point = element * points_ + p;
        visit(Visit{element, point, geometry, d, l, lane_of(d.C, l), k[l]});
      }
  }
}

/// residual_a += V F S grad N_a;  tangent_ab += V [(grad N_a . S grad N_b) 1 + B_a^T (d2Psi/dC2) B_b] with B
/// = dC/du.
template<int Nodes, int Dim, class Law>
template<bool with_tangent>
void MembraneBlock<Nodes, Dim, Law>::accumulate(const Point& point, const Deformation& d,
                                                const materials::MembranePotential<Lanes>& potential,
                                                Lanes (&residual)[dofs], Lanes* tangent) {
  const Lanes S11 = 2.0 * point.volume * potential.first[0];
  const Lanes S22 = 2.0 * point.volume * potential.first[1];
  const Lanes S12 = point.volume * potential.first[2];
  Lanes SG[Nodes][2];
  for (int a = 0; a < Nodes; ++a) {
    const auto& G = point.gradient[a];
    SG[a][0] = S11 * G[0] + S12 * G[1];
    SG[a][1] = S12 * G[0] + S22 * G[1];
    for (int c = 0; c < Dim; ++c) residual[a * Dim + c] += d.F[0][c] * SG[a][0] + d.F[1][c] * SG[a][1];
  }
  if constexpr (with_tangent) {
    Lanes D[6];
    for (int p = 0; p < 6; ++p) D[p] = point.volume * potential.second[static_cast<std::size_t>(p)];
    Lanes B[dofs][3], DB[dofs][3];
    for (int a = 0; a < Nodes; ++a)
      for (int c = 0; c < Dim; ++c) {
        const auto& G = point.gradient[a];
        Lanes* b = B[a * Dim + c];
        Lanes* db = DB[a * Dim + c];
        b[0] = 2.0 * d.F[0][c] * G[0];
        b[1] = 2.0 * d.F[1][c] * G[1];
        b[2] = d.F[0][c] * G[1] + d.F[1][c] * G[0];
        db[0] = D[0] * b[0] + D[3] * b[1] + D[4] * b[2];
        db[1] = D[3] * b[0] + D[1] * b[1] + D[5] * b[2];
        db[2] = D[4] * b[0] + D[5] * b[1] + D[2] * b[2];
      }
    for (int a = 0; a < Nodes; ++a)
      for (int b = 0; b <= a; ++b) {
        const Lanes geometric = point.gradient[a][0] * SG[b][0] + point.gradient[a][1] * SG[b][1];
        for (int c = 0; c < Dim; ++c)
          for (int e = 0; e < Dim; ++e) {
            const int i = a * Dim + c, j = b * Dim + e;
            if (j > i) continue;
            Lanes sum = DB[i][0] * B[j][0] + DB[i][1] * B[j][1] + DB[i][2] * B[j][2];
            if (c == e) sum += geometric;
            tangent[i * (i + 1) / 2 + j] += sum;
          }
      }
  }
}

template<int Nodes, int Dim, class Law>
template<bool with_tangent>
Evaluation MembraneBlock<Nodes, Dim, Law>::evaluate_packs(const State& state, int first, int last,
                                                          const Scatter& scatter) const {
  Evaluation result;
  Lanes energy{};
  for (int pack = first / lanes; pack * lanes < last; ++pack) {
    Lanes x[Nodes][Dim];
    gather(state, pack, x);
    const Lanes k = electric_modulus(state, pack);
    Lanes residual[dofs] = {};
    Lanes tangent[with_tangent ? packed : 1] = {};
    for (int p = 0; p < points_; ++p) {
      const Point& point = geometry_[static_cast<std::size_t>(pack * points_ + p)];
      const Deformation d = deformation(x, point);
      // A planar film must not be turned over; in space its area must not vanish.
      Lanes area = d.C.det();
      if constexpr (Dim == 2) area = d.F[0][0] * d.F[1][1] - d.F[0][1] * d.F[1][0];
      for (int l = 0; l < lanes; ++l)
        if (!(area[l] > 0)) result.feasible = false;
      bool lost = false;
      const Potential stored = potential(state, pack, p, d.C, k, lost);
      if (lost) result.feasible = false;
      energy += point.volume * stored.value;
      accumulate<with_tangent>(point, d, stored, residual, tangent);
    }
    for (int l = 0; l < lanes && pack * lanes + l < count_; ++l) {
      const int element = pack * lanes + l;
      if (scatter.residual) {
        double values[dofs];
        for (int i = 0; i < dofs; ++i) values[i] = residual[i][l];
        scatter.add_residual(element, values);
      }
      if constexpr (with_tangent) {
        double values[packed];
        for (int i = 0; i < packed; ++i) values[i] = tangent[i][l];
        scatter.add_tangent(element, values);
      }
    }
  }
  for (int l = 0; l < lanes; ++l) result.energy += energy[l];
  if (!std::isfinite(result.energy)) result.feasible = false; // beyond a stretch limit
  return result;
}

template<int Nodes, int Dim, class Law>
Evaluation MembraneBlock<Nodes, Dim, Law>::evaluate(const State& state, int first, int last,
                                                    const Scatter& scatter) const {
  return scatter.tangent ? evaluate_packs<true>(state, first, last, scatter)
                         : evaluate_packs<false>(state, first, last, scatter);
}

template<int Nodes, int Dim, class Law>
void MembraneBlock<Nodes, Dim, Law>::sample(const State& state, Samples& samples) const {
  samples.film.reserve(samples.film.size() + static_cast<std::size_t>(count_ * points_));
  for_each_point(state, [&](const Visit& at) {
    const int electrode = electrodes_[static_cast<std::size_t>(at.element)];
    const materials::TensionField field = film_.resolve(state, at.point, at.C, at.k);
    const materials::InPlaneC<double>& natural = field.natural;
    MembraneSample s;
    s.cell = at.element;
    s.volume = at.geometry.volume[at.lane];
    s.F.setZero();
    for (int i = 0; i < 2; ++i)
      for (int c = 0; c < Dim; ++c) s.F(c, i) = at.deformation.F[i][c][at.lane];
    s.S = materials::tension_field::stress(field.potential);
    s.widening = std::sqrt(natural.det() / at.C.det());
    s.tension = field.tension;
    s.thickness = thickness_;
    s.voltage = electrode == passive ? 0.0 : state.voltage[static_cast<std::size_t>(electrode)];
    s.electrode = electrode;
    s.breakdown_field = film_.dielectric().breakdown_field_at(natural.det());
    samples.film.push_back(s);
  });
}

template<int Nodes, int Dim, class Law>
void MembraneBlock<Nodes, Dim, Law>::add_charges(const State& state, const DofMap* dof_map,
                                                 Charges& charges) const {
  for_each_point(state, [&](const Visit& at) {
    const int electrode = electrodes_[static_cast<std::size_t>(at.element)];
    if (electrode == passive) return;
    const auto e = static_cast<std::size_t>(electrode);
    const auto density = film_.charge_density(film_.shape(state, at.point, at.C, at.k), at.C);
    const double voltage = state.voltage[e];
    const double per_volt =
        film_.dielectric().permittivity * at.geometry.volume[at.lane] / (thickness_ * thickness_);
    charges.capacitance[e] += per_volt * density.value;
    charges.charge[e] += per_volt * voltage * density.value;
    if (!dof_map) return;
    const auto& q = density.slope;
    for (int a = 0; a < Nodes; ++a) {
      const double G1 = at.geometry.gradient[a][0][at.lane], G2 = at.geometry.gradient[a][1][at.lane];
      for (int c = 0; c < Dim; ++c) {
        const int equation = dof_map->equation(node(at.element, a), c);
        if (equation < 0) continue;
        const double F1 = at.deformation.F[0][c][at.lane], F2 = at.deformation.F[1][c][at.lane];
        charges.coupling[e][equation] +=
            per_volt * voltage * (2 * q[0] * F1 * G1 + 2 * q[1] * F2 * G2 + q[2] * (F1 * G2 + F2 * G1));
      }
    }
  });
}

template<int Nodes, int Dim, class Law>
void MembraneBlock<Nodes, Dim, Law>::add_energies(const State& state, EnergyParts& parts) const {
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

template<int Nodes, int Dim, class Law>
void MembraneBlock<Nodes, Dim, Law>::advance_history(const State& state, std::vector<double>& all) const {
  if (film_.history_size(1) == 0) return;
  for_each_point(state, [&](const Visit& at) {
    film_.advance_history(state, at.point, film_.shape(state, at.point, at.C, at.k), all);
  });
}

template<int Nodes, class Law>
std::unique_ptr<ElementBlock> make_block(const meshing::Mesh& mesh, const meshing::CellBlock& triangles,
                                         const MembraneSection& section, const Law& law,
                                         std::vector<int> electrodes, bool planar, int integration_points) {
  if (planar)
    return std::make_unique<MembraneBlock<Nodes, 2, Law>>(mesh, triangles, section, law,
                                                          std::move(electrodes), integration_points);
  return std::make_unique<MembraneBlock<Nodes, 3, Law>>(mesh, triangles, section, law, std::move(electrodes),
                                                        integration_points);
}

} // namespace

std::unique_ptr<ElementBlock> make_membrane_block(const meshing::Mesh& mesh,
                                                  const meshing::CellBlock& triangles,
                                                  const MembraneSection& section, std::vector<int> electrodes,
                                                  bool planar, int integration_points) {
  if (triangles.size() == 0 || static_cast<int>(electrodes.size()) != triangles.size())
    throw std::invalid_argument("a membrane needs triangles, and one electrode number for each");
  return std::visit(
      [&](const auto& law) {
        return triangles.type == meshing::CellType::triangle6
                   ? make_block<6>(mesh, triangles, section, law, std::move(electrodes), planar,
                                   integration_points)
                   : make_block<3>(mesh, triangles, section, law, std::move(electrodes), planar,
                                   integration_points);
      },
      section.material.law);
}

} // namespace dielast::fem
