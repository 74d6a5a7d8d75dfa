// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solids/solid_block.hpp"

#include "fem/films/membrane_block.hpp"
#include "fem/films/triangle.hpp"
#include "fem/solids/solid_elements.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

namespace dielast::fem {

Eigen::Matrix3d SolidElementState::deformation(const SolidPoint& at) const {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.topLeftCorner<2, 2>() += displacement * at.gradient;
  F(2, 2) += displacement.row(0) * at.hoop;
  return F;
}

Eigen::Vector3d SolidElementState::field(const SolidPoint& at) const {
  if (given_field) return *given_field;
  Eigen::Vector3d field = Eigen::Vector3d::Zero();
  field.head<2>() = -at.gradient.transpose() * potential;
  return field;
}

SolidBlock::SolidBlock(const meshing::Mesh& mesh, const SolidCells& cells,
                       const std::vector<SolidSection>& sections, std::vector<int> potentials,
                       Dimension dimension)
    : plane_(dimension == Dimension::axisymmetric ? revolution : plane_strain),
      count_(cells.triangles.size()), nodes_(cells.triangles.nodes), numbers_(cells.numbers),
      electrodes_(cells.electrodes), sections_(cells.sections), potentials_(std::move(potentials)) {
  for (const SolidSection& section : sections) {
    Part& part = parts_.emplace_back(Part{SolidResponse(section), section.thickness, section.width, {}, 0});
    for (int i = 0; i < 3; ++i) part.normal[i] = section.normal[plane_.axis[static_cast<std::size_t>(i)]];
  }
  for (const int section : sections_) place_.push_back(parts_[static_cast<std::size_t>(section)].elements++);
  const materials::Material& first = sections.front().material;
  pressure_unit_ = materials::initial_shear_modulus(first.law);
  potential_unit_ = sections.front().thickness * std::sqrt(pressure_unit_ / first.dielectric.permittivity);
  geometry_.resize(static_cast<std::size_t>(count_ * points));
  for (int e = 0; e < count_; ++e) place_element(mesh, e);
}

void SolidBlock::place_element(const meshing::Mesh& mesh, int element) {
  Eigen::Matrix<double, 2, nodes> X;
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < 2; ++i)
      X(i, a) =
          mesh.nodes[static_cast<std::size_t>(node(element, a))][plane_.axis[static_cast<std::size_t>(i)]];
  for (int p = 0; p < points; ++p) {
    const TrianglePoint& at = triangle_rule(points)[static_cast<std::size_t>(p)];
    const Eigen::Matrix<double, nodes, 2> slope = shape_gradients<nodes>(at.xi, at.eta);
    const Eigen::Vector<double, nodes> shape = shape_values<nodes>(at.xi, at.eta);
    const Eigen::Matrix2d jacobian = X * slope;
    const double det = jacobian.determinant(), radius = X.row(0) * shape;
    if (!(det > 0))
      throw std::invalid_argument("triangle " + std::to_string(numbers_[static_cast<std::size_t>(element)]) +
                                  " is inverted or degenerate as drawn");
    if (plane_.of_revolution && !(radius > 0))
      throw std::invalid_argument("triangle " + std::to_string(numbers_[static_cast<std::size_t>(element)]) +
                                  " of a solid of revolution is not at x > 0");
    SolidPoint& place = geometry_[static_cast<std::size_t>(element * points + p)];
    const double width = plane_.of_revolution ? 2 * std::numbers::pi * radius : part(element).width;
    place.gradient = slope * jacobian.inverse();
    place.hoop = plane_.of_revolution ? Eigen::Vector<double, nodes>(shape / radius)
                                      : Eigen::Vector<double, nodes>(Eigen::Vector<double, nodes>::Zero());
    place.pressure = shape_values<corners>(at.xi, at.eta);
    place.volume = at.weight * det * width;
  }
}

/// A corner has one pressure for each section and electrode of an element there.
void SolidBlock::place_scalars(DofMap& dof_map) {
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

void SolidBlock::claim_dofs(DofMap& dof_map, Dimension /*that of the block*/) const {
  for (const int n : nodes_)
    for (const int i : {0, 1}) dof_map.add(n, plane_.axis[static_cast<std::size_t>(i)]);
}

void SolidBlock::element_equations(int element, const DofMap& dof_map, std::span<int> equations) const {
  std::size_t at = 0;
  const auto scalar = [&](int number) {
    return number == none ? DofMap::absent : dof_map.scalar_equation(number);
  };
  for (int a = 0; a < nodes; ++a)
    for (const std::size_t i : {0, 1}) equations[at++] = dof_map.equation(node(element, a), plane_.axis[i]);
  for (int a = 0; a < corners; ++a)
    equations[at++] = scalar(pressure_scalar_[static_cast<std::size_t>(element * corners + a)]);
  for (int a = 0; a < nodes; ++a)
    equations[at++] = has_potential() ? scalar(potential_scalar_[static_cast<std::size_t>(node(element, a))])
                                      : DofMap::absent;
}

double SolidBlock::potential_at(const State& state, int node) const {
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

SolidElementState SolidBlock::at(const State& state, int element) const {
  SolidElementState now;
  for (int a = 0; a < nodes; ++a) {
    const Eigen::Vector3d& u = state.displacement[static_cast<std::size_t>(node(element, a))];
    for (const std::size_t i : {0, 1}) now.displacement(static_cast<int>(i), a) = u[plane_.axis[i]];
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

/// Variables of a point: C11, C22, C33, C12 (the others do not change), p, E1, E2.
void SolidBlock::add_point(const SolidPoint& at, const Eigen::Matrix3d& F, const SolidDensity& density,
                           Vector& residual, Matrix* tangent) const {
  constexpr int in_plane = 4, variables = 7, pressure = 2 * nodes, potential = pressure + corners;
  Eigen::Matrix<double, variables, dofs> B = Eigen::Matrix<double, variables, dofs>::Zero();
  for (int a = 0; a < nodes; ++a) {
    const double g1 = at.gradient(a, 0), g2 = at.gradient(a, 1);
    for (int i = 0; i < 2; ++i) {
      B(0, 2 * a + i) = 2 * F(i, 0) * g1;
      B(1, 2 * a + i) = 2 * F(i, 1) * g2;
      B(3, 2 * a + i) = F(i, 0) * g2 + F(i, 1) * g1;
    }
    B(2, 2 * a) = 2 * F(2, 2) * at.hoop[a];
    B(5, potential + a) = -potential_unit_ * g1;
    B(6, potential + a) = -potential_unit_ * g2;
  }
  B.block<1, corners>(4, pressure) = pressure_unit_ * at.pressure.transpose();
  Eigen::Vector<double, variables> slope;
  slope << density.in_C.head<in_plane>(), density.in_p, density.in_E.head<2>();
  residual += at.volume * (B.transpose() * slope);
  if (!tangent) return;
  Eigen::Matrix<double, variables, variables> H = Eigen::Matrix<double, variables, variables>::Zero();
  H.topLeftCorner<in_plane, in_plane>() = density.in_CC.topLeftCorner<in_plane, in_plane>();
  H.block<in_plane, 1>(0, 4) = density.in_Cp.head<in_plane>();
  H.block<1, in_plane>(4, 0) = density.in_Cp.head<in_plane>().transpose();
  H(4, 4) = density.in_pp;
  H.block<in_plane, 2>(0, 5) = density.in_CE.topLeftCorner<in_plane, 2>();
  H.block<2, in_plane>(5, 0) = density.in_CE.topLeftCorner<in_plane, 2>().transpose();
  H.bottomRightCorner<2, 2>() = density.in_EE.topLeftCorner<2, 2>();
  const Eigen::Matrix<double, variables, dofs> HB = at.volume * (H * B);
  tangent->noalias() += B.transpose() * HB;
  Eigen::Matrix2d S; // second Piola-Kirchhoff
  S << 2 * density.in_C[0], density.in_C[3], density.in_C[3], 2 * density.in_C[1];
  const Eigen::Matrix<double, nodes, nodes> geometric =
      at.volume * (at.gradient * S * at.gradient.transpose());
  const Eigen::Matrix<double, nodes, nodes> hoop =
      2 * at.volume * density.in_C[2] * (at.hoop * at.hoop.transpose());
  for (int a = 0; a < nodes; ++a)
    for (int b = 0; b < nodes; ++b) {
      (*tangent)(2 * a, 2 * b) += geometric(a, b) + hoop(a, b);
      (*tangent)(2 * a + 1, 2 * b + 1) += geometric(a, b);
    }
}

Evaluation SolidBlock::evaluate(const State& state, int first, int last, const Scatter& scatter) const {
  Evaluation result;
  std::array<double, dofs*(dofs + 1) / 2> packed;
  for (int e = first; e < last; ++e) {
    const SolidElementState now = at(state, e);
    Vector residual = Vector::Zero();
    Matrix tangent = Matrix::Zero();
    for (int p = 0; p < points; ++p) {
      const SolidPoint& here = point(e, p);
      const Eigen::Matrix3d F = now.deformation(here);
      if (!(F.topLeftCorner<2, 2>().determinant() > 0 && F(2, 2) > 0)) {
        result.feasible = false;
        continue;
      }
      const SolidDensity density = part(e).response.potential(
          state, place(e, p), F.transpose() * F, here.pressure.dot(now.pressure), now.field(here));
      result.energy += here.volume * density.value;
      if (scatter.residual || scatter.tangent)
        add_point(here, F, density, residual, scatter.tangent ? &tangent : nullptr);
    }
    if (scatter.residual) scatter.add_residual(e, std::span(residual.data(), dofs));
    if (!scatter.tangent) continue;
    std::size_t k = 0;
    for (int i = 0; i < dofs; ++i)
      for (int j = 0; j <= i; ++j) packed[k++] = tangent(i, j);
    scatter.add_tangent(e, packed);
  }
  if (!std::isfinite(result.energy)) result.feasible = false; // beyond a stretch limit
  return result;
}

/// Consistent.
void SolidBlock::add_mass(int element, std::span<double> packed) const {
  for (int p = 0; p < points; ++p) {
    const TrianglePoint& where = triangle_rule(points)[static_cast<std::size_t>(p)];
    const Eigen::Vector<double, nodes> shape = shape_values<nodes>(where.xi, where.eta);
    const double mass = part(element).response.material().density * point(element, p).volume;
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b <= a; ++b)
        for (int i = 0; i < 2; ++i) {
          const int row = 2 * a + i, column = 2 * b + i;
          packed[static_cast<std::size_t>(row * (row + 1) / 2 + column)] += mass * shape[a] * shape[b];
        }
  }
}

std::unique_ptr<ElementBlock> make_solid_block(const meshing::Mesh& mesh, SolidCells cells,
                                               const std::vector<SolidSection>& sections,
                                               std::vector<int> potentials, Dimension dimension) {
  if (cells.triangles.type != meshing::CellType::triangle6 || cells.triangles.size() == 0)
    throw std::invalid_argument("a solid is made of 6-node triangles");
  if (dimension == Dimension::spatial)
    throw std::invalid_argument("a solid of triangles is in plane strain or of revolution");
  const auto count = static_cast<std::size_t>(cells.triangles.size());
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
  return std::make_unique<SolidBlock>(mesh, cells, sections, std::move(potentials), dimension);
}

} // namespace dielast::fem
