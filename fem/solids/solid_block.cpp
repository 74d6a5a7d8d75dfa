// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solids/solid_block.hpp"

#include "fem/films/membrane_block.hpp"
#include "fem/solids/solid_elements.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

namespace dielast::fem {

using materials::Pack;

template<class Element>
Eigen::Matrix3d SolidElementState<Element>::deformation(const SolidPoint<Element>& at) const {
  constexpr int dim = Element::dim;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.topLeftCorner<dim, dim>() += displacement * at.gradient.template leftCols<dim>();
  if constexpr (dim == 2) F(2, 2) += displacement.row(0) * at.gradient.col(2);
  return F;
}

template<class Element>
Eigen::Vector3d SolidElementState<Element>::field(const SolidPoint<Element>& at) const {
  if (given_field) return *given_field;
  Eigen::Vector3d field = Eigen::Vector3d::Zero();
  field.head<Element::dim>() = -at.gradient.template leftCols<Element::dim>().transpose() * potential;
  return field;
}

template<class Element>
SolidBlock<Element>::SolidBlock(const meshing::Mesh& mesh, const SolidCells& cells,
                                const std::vector<SolidSection>& sections, std::vector<int> potentials,
                                Dimension dimension)
    : axes_(dimension == Dimension::axisymmetric ? revolution : as_drawn), count_(cells.elements.size()),
      nodes_(cells.elements.nodes), numbers_(cells.numbers), electrodes_(cells.electrodes),
      sections_(cells.sections), potentials_(std::move(potentials)) {
  for (const SolidSection& section : sections) {
    Part& part = parts_.emplace_back(Part{SolidResponse(section), section.thickness, section.width, {}, 0});
    for (int i = 0; i < 3; ++i) part.normal[i] = section.normal[axes_.axis[static_cast<std::size_t>(i)]];
  }
  for (const int section : sections_) place_.push_back(parts_[static_cast<std::size_t>(section)].elements++);
  const materials::Material& first = sections.front().material;
  pressure_unit_ = materials::initial_shear_modulus(first.law);
  potential_unit_ = sections.front().thickness * std::sqrt(pressure_unit_ / first.dielectric.permittivity);
  geometry_.resize(static_cast<std::size_t>(count_ * points));
  for (int e = 0; e < count_; ++e) place_element(mesh, e);
}

template<class Element>
void SolidBlock<Element>::place_element(const meshing::Mesh& mesh, int element) {
  const auto fail = [&](const char* what) {
    throw std::invalid_argument(std::string(Element::name) + " " +
                                std::to_string(numbers_[static_cast<std::size_t>(element)]) + what);
  };
  Eigen::Matrix<double, dim, nodes> X;
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < dim; ++i)
      X(i, a) =
          mesh.nodes[static_cast<std::size_t>(node(element, a))][axes_.axis[static_cast<std::size_t>(i)]];
  for (int p = 0; p < points; ++p) {
    const Eigen::Matrix<double, nodes, dim> slope = Element::slope(p);
    const Eigen::Matrix<double, dim, dim> jacobian = X * slope;
    const double det = jacobian.determinant();
    if (!(det > 0)) fail(" is inverted or degenerate as drawn");
    Point& place = geometry_[static_cast<std::size_t>(element * points + p)];
    place.gradient.setZero();
    place.gradient.template leftCols<dim>() = slope * jacobian.inverse();
    place.pressure = Element::template shape<corners>(p);
    place.volume = Element::weight(p) * det;
    if constexpr (dim == 2) {
      const Eigen::Vector<double, nodes> shape = Element::template shape<nodes>(p);
      const double radius = X.row(0) * shape;
      if (axes_.of_revolution && !(radius > 0)) fail(" of a solid of revolution is not at x > 0");
      place.volume *= axes_.of_revolution ? 2 * std::numbers::pi * radius : part(element).width;
      if (axes_.of_revolution) place.gradient.col(2) = shape / radius;
    }
  }
}

/// A corner has one pressure for each section and electrode of an element there.
template<class Element>
void SolidBlock<Element>::place_scalars(DofMap& dof_map) {
  pressure_scalar_.assign(static_cast<std::size_t>(count_ * corners), none);
  std::map<std::array<int, 3>, int> pressures; // by node, section and electrode
  for (int e = 0; e < count_; ++e)
    for (int a = 0; part(e).response.has_pressure() && a < corners; ++a) {
      const auto [known, fresh] =
          pressures.try_emplace({node(e, a), sections_[static_cast<std::size_t>(e)], electrode(e)}, 0);
      if (fresh) known->second = dof_map.add_scalar(pressure_unit_);
      pressure_scalar_[static_cast<std::size_t>(e * corners + a)] = known->second;
    }
  potential_scalar_.assign(potentials_.size(), none);
  if (!has_potential()) return;
  for (const int n : nodes_)
    if (int& scalar = potential_scalar_[static_cast<std::size_t>(n)];
        scalar == none && potentials_[static_cast<std::size_t>(n)] == NodePotential::follows)
      scalar = dof_map.add_scalar(potential_unit_);
}

template<class Element>
void SolidBlock<Element>::claim_dofs(DofMap& dof_map, Dimension /*that of the block*/) {
  for (const int n : nodes_)
    for (std::size_t i = 0; i < dim; ++i) dof_map.add(n, axes_.axis[i]);
}

template<class Element>
void SolidBlock<Element>::element_equations(int element, const DofMap& dof_map,
                                            std::span<int> equations) const {
  std::size_t at = 0;
  const auto scalar = [&](int number) {
    return number == none ? DofMap::absent : dof_map.scalar_equation(number);
  };
  for (std::size_t i = 0; i < dim; ++i)
    for (int a = 0; a < nodes; ++a) equations[at++] = dof_map.equation(node(element, a), axes_.axis[i]);
  for (int a = 0; a < corners; ++a)
    equations[at++] = scalar(pressure_scalar_[static_cast<std::size_t>(element * corners + a)]);
  for (int a = 0; has_potential() && a < nodes; ++a)
    equations[at++] = scalar(potential_scalar_[static_cast<std::size_t>(node(element, a))]);
}

template<class Element>
double SolidBlock<Element>::potential_at(const State& state, int node) const {
  const auto n = static_cast<std::size_t>(node);
  switch (const int known = potentials_[n]) {
  case NodePotential::follows:
    return state.scalar[static_cast<std::size_t>(potential_scalar_[n])];
  case NodePotential::ground:
    return 0;
  default:
    return state.voltage[static_cast<std::size_t>(known)];
  }
}

template<class Element>
SolidElementState<Element> SolidBlock<Element>::at(const State& state, int element) const {
  ElementState now;
  for (int a = 0; a < nodes; ++a) {
    const Eigen::Vector3d& u = state.displacement[static_cast<std::size_t>(node(element, a))];
    for (std::size_t i = 0; i < dim; ++i) now.displacement(static_cast<int>(i), a) = u[axes_.axis[i]];
    now.potential[a] = has_potential() ? potential_at(state, node(element, a)) : 0;
  }
  for (int a = 0; a < corners; ++a) {
    const int scalar = pressure_scalar_[static_cast<std::size_t>(element * corners + a)];
    now.pressure[a] = scalar == none ? 0 : state.scalar[static_cast<std::size_t>(scalar)];
  }
  if (has_potential()) return now;
  const int e = electrode(element);
  now.given_field = e == passive ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                 : Eigen::Vector3d(state.voltage[static_cast<std::size_t>(e)] /
                                                   part(element).thickness * part(element).normal);
  return now;
}

/// Of the components of C those that change: C11, C22, C33, C12, and in space C23, C13. F's are numbered 3 i
/// + K; of a triangle F13 stands for F33, and F23 for nothing.
template<class Element>
void SolidBlock<Element>::add_point(const Point& at, const Eigen::Matrix3d& F, const SolidDensity& density,
                                    Sums& sums, materials::Derivatives wanted) const {
  constexpr int strains = dim == 2 ? 4 : 6, slopes = 3 * dim;
  Eigen::Matrix<double, strains, slopes> B = Eigen::Matrix<double, strains, slopes>::Zero(); // dC/dF
  for (int c = 0; c < strains; ++c) {
    const auto [j, k] = materials::solid_components[static_cast<std::size_t>(c)];
    for (int i = 0; j < dim && i < dim; ++i) {
      B(c, 3 * i + k) += F(i, j);
      B(c, 3 * i + j) += F(i, k);
    }
  }
  if constexpr (dim == 2) B(2, 2) = 2 * F(2, 2);
  const Eigen::Vector<double, corners> P = pressure_unit_ * at.pressure; // dp/d(unknowns)
  const Eigen::Matrix<double, nodes, dim> E = -potential_unit_ * at.gradient.template leftCols<dim>();
  const Eigen::Vector<double, slopes> stress = at.volume * (B.transpose() * density.in_C.head<strains>());
  for (int i = 0; i < dim; ++i)
    sums.first.template segment<nodes>(nodes * i) += at.gradient * stress.template segment<3>(3 * i);
  sums.first.template segment<corners>(motions) += at.volume * density.in_p * P;
  if (has_potential()) sums.first.template tail<nodes>() += at.volume * (E * density.in_E.head<dim>());
  if (wanted == materials::Derivatives::first) return;
  const double volume = at.volume;
  const auto row = static_cast<std::size_t>(3 * sums.points++);
  using Row = typename Sums::Row;
  std::array<Row, 3> G; // volume * gradients
  for (int k = 0; k < 3; ++k) {
    Row& slope = sums.slope[row + static_cast<std::size_t>(k)];
    slope = {};
    std::memcpy(slope.data(), at.gradient.col(k).data(), nodes * sizeof(double));
    for (std::size_t c = 0; c < slope.size(); ++c) G[static_cast<std::size_t>(k)][c] = volume * slope[c];
  }
  const auto with_nodes = [&G](const Pack& in_F) { // what goes with F's row i goes with displacements along i
    Row of_nodes;
    for (std::size_t c = 0; c < of_nodes.size(); ++c)
      of_nodes[c] = in_F[0] * G[0][c] + in_F[1] * G[1][c] + in_F[2] * G[2][c];
    return of_nodes;
  };
  std::array<std::array<Pack, strains>, dim> in_axis; // rows of B, by F's row
  for (int i = 0; i < dim; ++i)
    for (int c = 0; c < strains; ++c)
      in_axis[static_cast<std::size_t>(i)][static_cast<std::size_t>(c)] =
          Pack{B(c, 3 * i), B(c, 3 * i + 1), B(c, 3 * i + 2), 0};
  const auto with_axis = [&](const auto& in_C, std::size_t j) { // of a row vector
    Pack sum{};
    for (std::size_t c = 0; c < strains; ++c) sum += in_C[static_cast<int>(c)] * in_axis[j][c];
    return sum;
  };
  Eigen::Matrix3d S; // second Piola-Kirchhoff, of axes that F keeps apart
  S.setZero();
  for (int c = 0; c < strains; ++c) {
    const auto [j, k] = materials::solid_components[static_cast<std::size_t>(c)];
    if (j < dim) S(j, k) = S(k, j) = (j == k ? 2 : 1) * density.in_C[c];
  }
  for (std::size_t j = 0; j < dim; ++j) {
    std::array<Pack, strains> in_C;
    for (std::size_t c = 0; c < strains; ++c) in_C[c] = with_axis(density.in_CC.col(static_cast<int>(c)), j);
    for (std::size_t i = j; i < dim; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        Pack A{}; // row k of d(stress)/dF, per volume
        for (std::size_t c = 0; c < strains; ++c) A += in_axis[i][c][k] * in_C[c];
        if (i == j)
          for (std::size_t l = 0; l < 3; ++l) A[l] += S(static_cast<int>(k), static_cast<int>(l));
        if (dim == 2 && i == 0 && k == 2) A[2] += 2 * density.in_C[2];
        sums.stiff[dim * i + j][row + k] = with_nodes(A);
      }
    const auto add = [&](std::size_t scalar, double factor, const Row& of_nodes) {
      Row& sum = sums.mixed[scalar][j];
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += factor * of_nodes[c];
    };
    const Row in_p = with_nodes(with_axis(density.in_Cp, j));
    for (int r = 0; r < corners; ++r) add(static_cast<std::size_t>(r), P[r], in_p);
    for (int k = 0; has_potential() && k < dim; ++k) {
      const Row in_E = with_nodes(with_axis(density.in_CE.col(k), j));
      for (int r = 0; r < nodes; ++r) add(static_cast<std::size_t>(corners + r), E(r, k), in_E);
    }
  }
  sums.of_scalars.template topLeftCorner<corners, corners>() += (volume * density.in_pp * P) * P.transpose();
  if (has_potential())
    sums.of_scalars.template bottomRightCorner<nodes, nodes>() +=
        volume * (E * density.in_EE.topLeftCorner<dim, dim>() * E.transpose());
}

template<class Element>
std::span<const double> SolidSums<Element>::lower_triangle(int used, std::span<double> packed) const {
  constexpr std::size_t dim = Element::dim, count = nodes, rows = count / 2, lanes = materials::pack_lanes;
  const auto block = [&]<bool of_one_axis>(std::size_t i, std::size_t j) {
    const Slopes& stress = stiff[dim * i + j];
    const auto half = [&]<std::size_t first>() {
      constexpr std::size_t wide = of_one_axis ? (first + rows - 1) / lanes + 1 : packs;
      std::array<std::array<materials::Pack, wide>, rows> sum{};
      for (std::size_t k = 0; k < slope.size(); ++k)
        for (std::size_t r = 0; r < rows; ++r) {
          const double of_row = slope[k][(first + r) / lanes][(first + r) % lanes];
          for (std::size_t c = 0; c < wide; ++c) sum[r][c] += of_row * stress[k][c];
        }
      for (std::size_t r = 0; r < rows; ++r) {
        const std::size_t row = count * i + first + r;
        double* out = &packed[row * (row + 1) / 2 + count * j];
        for (std::size_t b = 0; b < (of_one_axis ? first + r + 1 : count); ++b)
          out[b] = sum[r][b / lanes][b % lanes];
      }
    };
    half.template operator()<0>();
    half.template operator()<rows>();
  };
  for (std::size_t i = 0; i < dim; ++i) {
    for (std::size_t j = 0; j < i; ++j) block.template operator()<false>(i, j);
    block.template operator()<true>(i, i);
  }
  double* out = packed.data() + motions * (motions + 1) / 2;
  for (int i = 0; i < used - motions; ++i) {
    for (const Row& of_axis : mixed[static_cast<std::size_t>(i)]) {
      std::memcpy(out, of_axis.data(), nodes * sizeof(double));
      out += nodes;
    }
    out = std::copy_n(&of_scalars(i, 0), i + 1, out);
  }
  return {packed.data(), out};
}

template<class Element>
Evaluation SolidBlock<Element>::evaluate(const State& state, int first, int last,
                                         const Scatter& scatter) const {
  Evaluation result;
  std::array<double, dofs*(dofs + 1) / 2> packed;
  const int used = dofs_per_element();
  for (int e = first; e < last; ++e) {
    if (scatter.tangent) scatter.fetch_tangent(e, static_cast<std::size_t>(used * (used + 1) / 2));
    const ElementState now = at(state, e);
    const auto wanted = scatter.tangent ? materials::Derivatives::second : materials::Derivatives::first;
    Sums sums(wanted);
    for (int p = 0; p < points; ++p) {
      const Point& here = point(e, p);
      const Eigen::Matrix3d F = now.deformation(here);
      if (!(F.topLeftCorner<dim, dim>().determinant() > 0 && (dim == 3 || F(2, 2) > 0))) {
        result.feasible = false;
        continue;
      }
      const SolidDensity density = part(e).response.potential(
          state, place(e, p), F.transpose() * F, here.pressure.dot(now.pressure), now.field(here), wanted);
      result.energy += here.volume * density.value;
      if (scatter.residual || scatter.tangent) add_point(here, F, density, sums, wanted);
    }
    const auto size = static_cast<std::size_t>(used);
    if (scatter.residual) scatter.add_residual(e, std::span(sums.first.data(), size));
    if (!scatter.tangent) continue;
    scatter.add_tangent(e, sums.lower_triangle(used, packed));
  }
  if (!std::isfinite(result.energy)) result.feasible = false; // beyond a stretch limit
  return result;
}

template<class Element>
void SolidBlock<Element>::add_mass(int element, std::span<double> packed) const {
  const double density = part(element).response.material().density;
  const auto volume = [&](int p) { return point(element, p).volume; };
  Element::for_each_mass(volume, [&](const Eigen::Vector<double, nodes>& shape, double stands_for) {
    const double mass = density * stands_for;
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b <= a; ++b)
        for (int i = 0; i < dim; ++i) {
          const int row = nodes * i + a, column = nodes * i + b;
          packed[static_cast<std::size_t>(row * (row + 1) / 2 + column)] += mass * shape[a] * shape[b];
        }
  });
}

template class SolidBlock<SolidTriangle>;
template class SolidBlock<SolidTetrahedron>;
template struct SolidElementState<SolidTriangle>;
template struct SolidSums<SolidTriangle>;
template struct SolidSums<SolidTetrahedron>;
template struct SolidElementState<SolidTetrahedron>;

std::unique_ptr<ElementBlock> make_solid_block(const meshing::Mesh& mesh, SolidCells cells,
                                               const std::vector<SolidSection>& sections,
                                               std::vector<int> potentials, Dimension dimension) {
  using meshing::CellType;
  const bool of_triangles = cells.elements.type == CellType::triangle6;
  if (!(of_triangles || cells.elements.type == CellType::tetrahedron10) || cells.elements.size() == 0)
    throw std::invalid_argument("a solid is made of 6-node triangles or 10-node tetrahedra (gmsh -order 2)");
  if (of_triangles && dimension == Dimension::spatial)
    throw std::invalid_argument("a solid of triangles is in plane strain or of revolution");
  if (!of_triangles && dimension != Dimension::spatial)
    throw std::invalid_argument("a solid of tetrahedra is in space");
  const auto count = static_cast<std::size_t>(cells.elements.size());
  if (cells.electrodes.size() != count || cells.sections.size() != count)
    throw std::invalid_argument("a solid needs one electrode number and one section for each element");
  if (!potentials.empty() && potentials.size() != mesh.nodes.size())
    throw std::invalid_argument("a solid needs the potentials of all nodes of the mesh");
  for (const SolidSection& section : sections)
    if (!(section.thickness > 0)) throw std::invalid_argument("the layers of a solid need a thickness");
  if (cells.numbers.empty()) {
    cells.numbers.resize(count);
    std::iota(cells.numbers.begin(), cells.numbers.end(), 0);
  }
  if (of_triangles)
    return std::make_unique<SolidBlock<SolidTriangle>>(mesh, cells, sections, std::move(potentials),
                                                       dimension);
  return std::make_unique<SolidBlock<SolidTetrahedron>>(mesh, cells, sections, std::move(potentials),
                                                        dimension);
}

} // namespace dielast::fem
