// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solids/solid_elements.hpp"

#include <Eigen/SparseCholesky>

#include <stdexcept>

namespace dielast::fem {

template<class Element>
auto SolidBlock<Element>::capacitances(const State& state, int element) const -> NodalMatrix {
  NodalMatrix sum = NodalMatrix::Zero();
  const ElementState now = at(state, element);
  for (int p = 0; p < points; ++p) {
    const Point& here = point(element, p);
    const Eigen::Matrix3d F = now.deformation(here);
    const SolidDensity electric = part(element).response.electric(F.transpose() * F, Eigen::Vector3d::Zero());
    const Eigen::Matrix<double, nodes, dim> slope = here.gradient.template leftCols<dim>();
    sum -= here.volume * (slope * electric.in_EE.topLeftCorner<dim, dim>() * slope.transpose());
  }
  return sum;
}

template<class Element>
auto SolidBlock<Element>::solve_field(const State& state, std::vector<double> given) const -> NodalField {
  std::vector<int> unknown(potentials_.size(), none);
  int count = 0;
  for (const int n : nodes_)
    if (int& u = unknown[static_cast<std::size_t>(n)];
        u == none && potentials_[static_cast<std::size_t>(n)] == NodePotential::follows)
      u = count++;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  std::vector<NodalMatrix> elements;
  elements.reserve(static_cast<std::size_t>(count_));
  for (int e = 0; e < count_; ++e) {
    const auto& A = elements.emplace_back(capacitances(state, e));
    for (int a = 0; a < nodes; ++a) {
      const int row = unknown[static_cast<std::size_t>(node(e, a))];
      for (int b = 0; row != none && b < nodes; ++b)
        if (const int column = unknown[static_cast<std::size_t>(node(e, b))]; column != none)
          entries.emplace_back(row, column, A(a, b));
        else
          right[row] -= A(a, b) * given[static_cast<std::size_t>(node(e, b))];
    }
  }
  if (count > 0) {
    Eigen::SparseMatrix<double> all(count, count);
    all.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(all);
    if (factor.info() != Eigen::Success)
      throw std::invalid_argument(
          "the potential of a solid is held nowhere: no electrode and no ground touches it");
    right = factor.solve(right).eval();
  }
  for (std::size_t n = 0; n < unknown.size(); ++n)
    if (unknown[n] != none) given[n] = right[unknown[n]];
  NodalField field{std::move(given), std::vector<double>(potentials_.size())};
  for (int e = 0; e < count_; ++e)
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b)
        field.charge[static_cast<std::size_t>(node(e, a))] +=
            elements[static_cast<std::size_t>(e)](a, b) *
            field.potential[static_cast<std::size_t>(node(e, b))];
  return field;
}

template<class Element>
void SolidBlock<Element>::balance_field(State& state) const {
  if (!has_potential()) return;
  std::vector<double> given(potentials_.size());
  for (const int n : nodes_)
    if (potentials_[static_cast<std::size_t>(n)] != NodePotential::follows)
      given[static_cast<std::size_t>(n)] = potential_at(state, n);
  const NodalField field = solve_field(state, std::move(given));
  for (std::size_t n = 0; n < potential_scalar_.size(); ++n)
    if (potential_scalar_[n] != none)
      state.scalar[static_cast<std::size_t>(potential_scalar_[n])] = field.potential[n];
}

template<class Element>
double SolidBlock<Element>::screened_capacitance(const State& state, std::size_t electrode) const {
  if (!has_potential()) return 0;
  const auto on_electrode = [&](std::size_t n) { return potentials_[n] == static_cast<int>(electrode); };
  std::vector<double> unit(potentials_.size());
  double fixed = 0, relaxed = 0;
  for (std::size_t n = 0; n < unit.size(); ++n) unit[n] = on_electrode(n);
  const std::vector<double> alone = unit;
  const NodalField field = solve_field(state, std::move(unit));
  for (std::size_t n = 0; n < alone.size(); ++n)
    if (on_electrode(n)) relaxed += field.charge[n];
  for (int e = 0; e < count_; ++e) {
    Eigen::Vector<double, nodes> phi;
    for (int a = 0; a < nodes; ++a) phi[a] = alone[static_cast<std::size_t>(node(e, a))];
    if (!phi.isZero(0)) fixed += phi.dot(capacitances(state, e) * phi);
  }
  return fixed - relaxed;
}

template void SolidBlock<SolidTriangle>::balance_field(State&) const;
template double SolidBlock<SolidTriangle>::screened_capacitance(const State&, std::size_t) const;
template void SolidBlock<SolidTetrahedron>::balance_field(State&) const;
template double SolidBlock<SolidTetrahedron>::screened_capacitance(const State&, std::size_t) const;

} // namespace dielast::fem
