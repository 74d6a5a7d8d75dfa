#include "fem/membrane_block.hpp"

#include "fem/triangle.hpp"
#include "materials/plane_stress.hpp"

#include <stdexcept>

namespace dielast::fem {

namespace {

/// Elements are computed `lanes` at a time, one per lane of a vector register.
constexpr int lanes = 4;
using Lanes = double __attribute__((vector_size(lanes * sizeof(double))));

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
  template<bool with_tangent>
  static void accumulate(const Point& point, const Deformation& d,
                         const materials::MembranePotential<Lanes>& potential, Lanes (&residual)[dofs],
                         Lanes* tangent);
  template<bool with_tangent>
  Evaluation evaluate_packs(const State& state, int first, int last, const Scatter& scatter) const;

  Law law_;
  MembraneSection section_;
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
    : law_(law), section_(section), count_(triangles.size()), points_(integration_points),
      nodes_(triangles.nodes), electrodes_(std::move(electrodes)), reference_(mesh.nodes) {
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
    const double nominal_field = state.voltage[static_cast<std::size_t>(electrode)] / section_.thickness;
    k[l] = section_.material.dielectric.permittivity * nominal_field * nominal_field;
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
      const auto potential = materials::membrane_potential(law_, d.C, k);
      energy += point.volume * potential.value;
      accumulate<with_tangent>(point, d, potential, residual, tangent);
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
  for (int e = 0; e < count_; ++e) {
    const int pack = e / lanes, l = e % lanes;
    Lanes x[Nodes][Dim];
    gather(state, pack, x);
    const Lanes k = electric_modulus(state, pack);
    const int electrode = electrodes_[static_cast<std::size_t>(e)];
    for (int p = 0; p < points_; ++p) {
      const Point& point = geometry_[static_cast<std::size_t>(pack * points_ + p)];
      const Deformation d = deformation(x, point);
      const auto potential = materials::membrane_potential(law_, d.C, k);
      MembraneSample s;
      s.cell = e;
      s.volume = point.volume[l];
      s.F.setZero();
      for (int i = 0; i < 2; ++i)
        for (int c = 0; c < Dim; ++c) s.F(c, i) = d.F[i][c][l];
      s.S << 2 * potential.first[0][l], potential.first[2][l], potential.first[2][l],
          2 * potential.first[1][l];
      s.thickness = section_.thickness;
      s.voltage = electrode == passive ? 0.0 : state.voltage[static_cast<std::size_t>(electrode)];
      s.electrode = electrode;
      s.permittivity = section_.material.dielectric.permittivity;
      s.breakdown_field = section_.material.dielectric.breakdown_field;
      samples.film.push_back(s);
    }
  }
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
