// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/shells/shell_elements.hpp"

#include <Eigen/LU>

namespace dielast::fem {

void ShellBlock::sample(const State& state, Samples& samples) const {
  for_each_point(state, [&](const Visit& at) {
    const Layer& layer = at.place.layer;
    const auto C = lane_of(at.place.C, at.lane);
    const materials::TensionField field = layer.film.resolve(state, at.number(), C, at.place.k[at.lane]);
    const int electrode = layer.electrodes[static_cast<std::size_t>(at.element)];
    MembraneSample s;
    s.cell = numbers_[static_cast<std::size_t>(at.element)];
    s.volume = at.volume;
    const Eigen::Matrix<double, 6, 2> gradient =
        matrix(shell_tables().point[static_cast<std::size_t>(at.p)].gradient);
    const Matrix36 X = drawn(at.element);
    const Matrix32 surface = X * gradient, t = surface + (lever_ + at.place.Z) * directors(X) * gradient;
    Matrix32 moved;
    for (int i = 0; i < 2; ++i)
      for (int c = 0; c < 3; ++c)
        moved(c, i) = at.f.x[i][c][at.lane] + at.place.height[at.lane] * at.f.d[i][c][at.lane];
    s.F = moved * (axes(surface).transpose() * t).inverse() *
          Eigen::Vector2d(prestretch_[0] * layer.extra_stretch[0], prestretch_[1] * layer.extra_stretch[1])
              .asDiagonal();
    s.S = materials::tension_field::stress(field.potential);
    s.tension = field.tension;
    s.bears_compression = true;
    s.thickness = layer.thickness;
    s.voltage = electrode == passive ? 0 : state.voltage[static_cast<std::size_t>(electrode)];
    s.field_share = at.place.field[at.lane];
    s.electrode = electrode;
    s.layer = layer.number;
    s.breakdown_field = layer.film.dielectric().breakdown_field_at(C.det());
    samples.film.push_back(s);
  });
}

void ShellBlock::add_charges(const State& state, const DofMap* dof_map, Charges& charges) const {
  for (int pack = 0; pack * lanes < count_; ++pack) {
    const ShellNodes nodes = gather(state, pack);
    for (const Layer& layer : layers_) {
      ShellSum<false, 3> sum(nodes);
      const double per_volt = layer.film.dielectric().permittivity / (layer.thickness * layer.thickness);
      Lanes density{};
      for (int p = 0; p < points; ++p) {
        const ShellTables::Point& table = shell_tables().point[static_cast<std::size_t>(p)];
        const ShellPoint& here = point(pack, p);
        const ShellDeformation f = deformation(table, nodes);
        const ShellStrain strain = fem::strain(point(pack, p), f);
        SectionPotential section(strain);
        across(state, layer, pack, p, strain, [&](const Place& place) {
          section.add(place.Z, place.weight * place.field * place.field,
                      layer.in_section(layer.film.capacitance_ratio(place.C)));
        });
        density += here.area * section.value();
        sum.add(table, f, ShellStress::of<false>(here, section.derivatives<false>()));
      }
      sum.finish();
      for (int l = 0; l < lanes_of(pack); ++l) {
        const int element = pack * lanes + l;
        const int electrode = layer.electrodes[static_cast<std::size_t>(element)];
        if (electrode == passive) continue;
        const auto e = static_cast<std::size_t>(electrode);
        const double phi = state.voltage[e];
        charges.capacitance[e] += per_volt * density[l];
        charges.charge[e] += per_volt * phi * density[l];
        if (!dof_map) continue;
        std::array<int, dofs> equations;
        element_equations(element, *dof_map, equations);
        for (int i = 0; i < dofs; ++i)
          if (const int equation = equations[static_cast<std::size_t>(i)]; equation >= 0)
            charges.coupling[e][equation] += per_volt * phi * sum.residual(i)[l];
      }
    }
  }
}

void ShellBlock::add_energies(const State& state, EnergyParts& parts) const {
  for_each_point(state, [&](const Visit& at) {
    const EnergyParts density =
        at.place.layer.film.energies(state, at.number(), lane_of(at.place.C, at.lane));
    parts.elastic += at.volume * density.elastic;
    parts.branches += at.volume * density.branches;
    parts.dissipation += at.volume * density.dissipation;
  });
  for (int pack = 0; pack * lanes < count_; ++pack) {
    const ShellNodes nodes = gather(state, pack);
    Lanes energy{};
    if (!nodes.tilt) energy = ShellSum<false, 3>(nodes).add_drilling(drilling_stiffness(pack));
    for (int p = 0; p < points; ++p)
      shear_.add_energies(state, surface_points(pack, p), lanes_of(pack), point(pack, p),
                          deformation(shell_tables().point[static_cast<std::size_t>(p)], nodes), parts);
    for (int l = 0; l < lanes_of(pack); ++l) parts.elastic += energy[l];
  }
}

void ShellBlock::add_relaxation(const State& state, const RateWeight& weight, const Scatter& scatter) const {
  if (history_size() == 0) return;
  for (int pack = 0; pack * lanes < count_; ++pack) {
    const ShellNodes nodes = gather(state, pack);
    ShellSum<true, 3> sum(nodes);
    for (int p = 0; p < points; ++p) {
      const ShellTables::Point& table = shell_tables().point[static_cast<std::size_t>(p)];
      const ShellPoint& here = point(pack, p);
      const ShellDeformation f = deformation(table, nodes);
      const ShellStrain strain = fem::strain(point(pack, p), f);
      SectionPotential section(strain);
      for (const Layer& layer : layers_)
        across(state, layer, pack, p, strain, [&](const Place& place) {
          materials::MembranePotential<Lanes> psi{};
          for (int l = 0; l < lanes_of(pack); ++l)
            set_lane(psi, l,
                     layer.film.relaxation(state, place.point[static_cast<std::size_t>(l)],
                                           lane_of(place.C, l), place.k[l], weight));
          section.add(place.Z, Lanes{} + place.weight, layer.in_section(psi));
        });
      ShellStress stress = ShellStress::of<true>(here, section.derivatives<true>());
      shear_.add_relaxation(weight, here, stress);
      sum.add(table, f, stress);
    }
    sum.finish();
    scatter_pack(pack, sum, scatter);
  }
}

int ShellBlock::history_size() const {
  int size = shear_.history_size(count_ * points);
  for (const Layer& layer : layers_) size += layer.film.history_size(count_ * points * depths);
  return size;
}

void ShellBlock::place_history(int first) {
  for (Layer& layer : layers_) {
    layer.film.place_history(first);
    first += layer.film.history_size(count_ * points * depths);
  }
  shear_.place_history(first);
}

void ShellBlock::start_history(std::vector<double>& all) const {
  for (const Layer& layer : layers_) layer.film.start_history(count_ * points * depths, all);
  shear_.start_history(count_ * points, all);
}

void ShellBlock::advance_history(const State& state, std::vector<double>& all) const {
  if (history_size() == 0) return;
  for_each_point(state, [&](const Visit& at) {
    at.place.layer.film.advance_history(state, at.number(), lane_of(at.place.C, at.lane), all);
  });
  for (int pack = 0; pack * lanes < count_; ++pack) {
    const ShellNodes nodes = gather(state, pack);
    for (int p = 0; p < points; ++p)
      shear_.advance_history(state, surface_points(pack, p), lanes_of(pack), point(pack, p),
                             deformation(shell_tables().point[static_cast<std::size_t>(p)], nodes), all);
  }
}

} // namespace dielast::fem
