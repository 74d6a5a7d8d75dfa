// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/films/membrane_block.hpp"
#include "fem/solids/solid_elements.hpp"

#include <Eigen/LU>

#include <array>
#include <limits>
#include <span>

namespace dielast::fem {

template<class Element>
void SolidBlock<Element>::sample(const State& state, Samples& samples) const {
  constexpr double none_here = std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix3d in_space = Eigen::Matrix3d::Zero(); // columns: the local axes
  for (int i = 0; i < 3; ++i) in_space(axes_.axis[static_cast<std::size_t>(i)], i) = 1;
  const auto turned = [&](const Eigen::Matrix3d& tensor) -> Eigen::Matrix3d {
    return in_space * tensor * in_space.transpose();
  };
  for (int e = 0; e < count_; ++e) {
    const ElementState now = at(state, e);
    for (int p = 0; p < points; ++p) {
      const Point& here = point(e, p);
      const Eigen::Matrix3d F = now.deformation(here), C = F.transpose() * F;
      const Eigen::Vector3d E0 = now.field(here);
      const SolidDensity density = part(e).response.potential(
          state, place(e, p), C, here.pressure.dot(now.pressure), E0, materials::Derivatives::first);
      Eigen::Matrix3d S; // second Piola-Kirchhoff
      for (std::size_t a = 0; a < 6; ++a) {
        const auto [i, j] = materials::solid_components[a];
        S(i, j) = S(j, i) = (i == j ? 2 : 1) * density.in_C[static_cast<int>(a)];
      }
      const Eigen::Matrix3d inverse = F.inverse();
      const double across = (inverse.transpose() * part(e).normal).norm();
      const double J = F.determinant();
      MembraneSample s;
      s.cell = numbers_[static_cast<std::size_t>(e)];
      s.volume = here.volume;
      s.F.setConstant(none_here);
      s.S.setConstant(none_here);
      s.thickness = part(e).thickness;
      const Eigen::Vector3d towards = has_potential() ? E0.stableNormalized() : part(e).normal;
      s.breakdown_field = part(e).response.material().dielectric.breakdown_field_at(
          J * J * towards.dot(C.inverse() * towards)); // square of the area's stretch
      if (has_potential()) {
        s.voltage = now.potential.dot(Element::template shape<nodes>(p));
      } else if (electrode(e) != passive) {
        s.electrode = electrode(e);
        s.voltage = state.voltage[static_cast<std::size_t>(s.electrode)];
      }
      s.bears_compression = true;
      s.solid = std::make_shared<const SolidSample>(
          SolidSample{turned(F), turned(F * S * F.transpose() / J), in_space * (inverse.transpose() * E0),
                      has_potential() ? none_here : part(e).thickness / across});
      samples.film.push_back(std::move(s));
    }
  }
}

template<class Element>
void SolidBlock<Element>::add_charges(const State& state, const DofMap* dof_map, Charges& charges) const {
  constexpr int potential = potential_place;
  std::array<int, dofs> all_equations;
  const std::span equations = std::span(all_equations).first(static_cast<std::size_t>(dofs_per_element()));
  for (int e = 0; e < count_; ++e) {
    std::vector<int> local; // potentials of electrodes
    for (int a = 0; has_potential() && a < nodes; ++a)
      if (potentials_[static_cast<std::size_t>(node(e, a))] >= 0) local.push_back(a);
    const bool layers = !has_potential() && electrode(e) != passive;
    if (local.empty() && !layers) continue;
    const ElementState now = at(state, e);
    using materials::Derivatives;
    Sums sums(Derivatives::second);  // of the energy, or of minus the charge of layers
    double slope = 0, curvature = 0; // of the energy in the voltage of layers
    for (int p = 0; p < points; ++p) {
      const Point& here = point(e, p);
      const Eigen::Matrix3d F = now.deformation(here);
      const SolidDensity electric = part(e).response.electric(F.transpose() * F, now.field(here));
      if (!layers) {
        add_point(here, F, electric, sums, Derivatives::second);
        continue;
      }
      const Eigen::Vector3d per_volt = part(e).normal / part(e).thickness;
      slope += here.volume * electric.in_E.dot(per_volt);
      curvature += here.volume * per_volt.dot(electric.in_EE * per_volt);
      SolidDensity mixed = part(e).response.electric(F.transpose() * F, Eigen::Vector3d::Zero());
      mixed.in_C = electric.in_CE * per_volt;
      if (dof_map) add_point(here, F, mixed, sums, Derivatives::first);
    }
    if (dof_map) element_equations(e, *dof_map, equations);
    const auto couple = [&](std::size_t port, const auto& minus) {
      for (std::size_t i = 0; dof_map && i < equations.size(); ++i)
        if (equations[i] >= 0) charges.coupling[port][equations[i]] -= minus[static_cast<int>(i)];
    };
    if (layers) {
      const auto port = static_cast<std::size_t>(electrode(e));
      charges.charge[port] -= slope;
      charges.capacitance[port] -= curvature;
      couple(port, sums.first);
    }
    for (const int a : local) {
      const auto port = static_cast<std::size_t>(potentials_[static_cast<std::size_t>(node(e, a))]);
      charges.charge[port] -= sums.first[potential + a] / potential_unit_;
      for (const int b : local)
        if (potentials_[static_cast<std::size_t>(node(e, b))] == static_cast<int>(port))
          charges.capacitance[port] -=
              sums.of_scalars(corners + a, corners + b) / (potential_unit_ * potential_unit_);
      Eigen::Vector<double, dofs> minus;
      const auto& in_motions = sums.mixed[static_cast<std::size_t>(corners + a)];
      for (std::size_t i = 0; i < dim; ++i)
        for (std::size_t b = 0; b < nodes; ++b)
          minus[static_cast<int>(nodes * i + b)] =
              in_motions[i][b / materials::pack_lanes][b % materials::pack_lanes];
      minus.template tail<dofs - motions>() = sums.of_scalars.row(corners + a);
      couple(port, Eigen::Vector<double, dofs>(minus / potential_unit_));
    }
  }
}

template<class Element>
void SolidBlock<Element>::add_energies(const State& state, EnergyParts& parts) const {
  for (int e = 0; e < count_; ++e) {
    const ElementState now = at(state, e);
    for (int p = 0; p < points; ++p) {
      const Point& here = point(e, p);
      const Eigen::Matrix3d F = now.deformation(here);
      const EnergyParts density =
          part(e).response.energies(state, place(e, p), F.transpose() * F, here.pressure.dot(now.pressure));
      parts.elastic += here.volume * density.elastic;
      parts.branches += here.volume * density.branches;
      parts.dissipation += here.volume * density.dissipation;
    }
  }
}

template<class Element>
void SolidBlock<Element>::add_relaxation(const State& state, const RateWeight& weight,
                                         const Scatter& scatter) const {
  if (history_size() == 0) return;
  std::array<double, dofs*(dofs + 1) / 2> packed;
  const int used = dofs_per_element();
  for (int e = 0; e < count_; ++e) {
    const ElementState now = at(state, e);
    Sums sums(materials::Derivatives::second);
    for (int p = 0; p < points; ++p) {
      const Point& here = point(e, p);
      const Eigen::Matrix3d F = now.deformation(here);
      add_point(here, F, part(e).response.relaxation(state, place(e, p), F.transpose() * F, weight), sums,
                materials::Derivatives::second);
    }
    scatter.add_tangent(e, sums.lower_triangle(used, packed));
  }
}

template<class Element>
int SolidBlock<Element>::history_size() const {
  int size = 0;
  for (const Part& part : parts_) size += part.response.history_size(part.elements * points);
  return size;
}

template<class Element>
void SolidBlock<Element>::place_history(int first) {
  for (Part& part : parts_) {
    part.response.place_history(first);
    first += part.response.history_size(part.elements * points);
  }
}

template<class Element>
void SolidBlock<Element>::start_history(std::vector<double>& all) const {
  for (const Part& part : parts_) part.response.start_history(part.elements * points, all);
}

template<class Element>
void SolidBlock<Element>::advance_history(const State& state, std::vector<double>& all) const {
  if (history_size() == 0) return;
  for (int e = 0; e < count_; ++e) {
    const ElementState now = at(state, e);
    for (int p = 0; p < points; ++p) {
      const Eigen::Matrix3d F = now.deformation(point(e, p));
      part(e).response.advance_history(state, place(e, p), F.transpose() * F, all);
    }
  }
}

template void SolidBlock<SolidTriangle>::sample(const State&, Samples&) const;
template void SolidBlock<SolidTriangle>::add_charges(const State&, const DofMap*, Charges&) const;
template void SolidBlock<SolidTriangle>::add_energies(const State&, EnergyParts&) const;
template void SolidBlock<SolidTriangle>::add_relaxation(const State&, const RateWeight&,
                                                        const Scatter&) const;
template int SolidBlock<SolidTriangle>::history_size() const;
template void SolidBlock<SolidTriangle>::place_history(int);
template void SolidBlock<SolidTriangle>::start_history(std::vector<double>&) const;
template void SolidBlock<SolidTriangle>::advance_history(const State&, std::vector<double>&) const;
template void SolidBlock<SolidTetrahedron>::sample(const State&, Samples&) const;
template void SolidBlock<SolidTetrahedron>::add_charges(const State&, const DofMap*, Charges&) const;
template void SolidBlock<SolidTetrahedron>::add_energies(const State&, EnergyParts&) const;
template void SolidBlock<SolidTetrahedron>::add_relaxation(const State&, const RateWeight&,
                                                           const Scatter&) const;
template int SolidBlock<SolidTetrahedron>::history_size() const;
template void SolidBlock<SolidTetrahedron>::place_history(int);
template void SolidBlock<SolidTetrahedron>::start_history(std::vector<double>&) const;
template void SolidBlock<SolidTetrahedron>::advance_history(const State&, std::vector<double>&) const;

} // namespace dielast::fem
