// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solids/solid_response.hpp"

#include "materials/branches/relaxation.hpp"
#include "materials/laws/solid_field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dielast::fem {

namespace {

materials::SolidInternal read(const std::vector<double>& all, std::size_t place) {
  materials::SolidInternal values{};
  if (!all.empty())
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(place), values.size(), values.begin());
  return values;
}

void write(std::vector<double>& all, std::size_t place, const materials::SolidInternal& values) {
  std::copy(values.begin(), values.end(), all.begin() + static_cast<std::ptrdiff_t>(place));
}

} // namespace

SolidResponse::SolidResponse(const SolidSection& section)
    : material_(materials::with_dashpot(section.material)),
      has_pressure_(!std::holds_alternative<materials::StVenantKirchhoff>(section.material.law)),
      compliance_(1 / section.bulk_modulus) {}

SolidDensity SolidResponse::electric(const Eigen::Matrix3d& C, const materials::SolidPotential& J,
                                     const Eigen::Vector3d& E0, materials::Derivatives wanted) const {
  const double half = -material_.dielectric.permittivity / 2;
  const materials::SolidField field = materials::solid_field(C, J, E0, wanted);
  SolidDensity density;
  density.value = half * field.value;
  density.in_C = half * field.in_C;
  density.in_E = half * field.in_E;
  if (wanted == materials::Derivatives::first) return density;
  density.in_CC = half * field.in_CC;
  density.in_Cp.setZero();
  density.in_CE = half * field.in_CE;
  density.in_EE = half * field.in_EE;
  return density;
}

SolidDensity SolidResponse::potential(const State& state, int point, const Eigen::Matrix3d& C, double p,
                                      const Eigen::Vector3d& E0, materials::Derivatives wanted) const {
  const bool second = wanted == materials::Derivatives::second;
  const materials::SolidPotential J = materials::volume_ratio(C, wanted);
  SolidDensity density = electric(C, J, E0, wanted);
  const auto add = [&](const materials::SolidPotential& part) {
    density.value += part.value;
    density.in_C += part.first;
    if (second) density.in_CC += part.second;
  };
  add(materials::solid_potential(material_.law, C, 0, wanted));
  for (int b = 0; b < branches(); ++b) {
    const std::size_t i = place(point, b);
    add(materials::solid_branch_potential(material_.branches[static_cast<std::size_t>(b)], C, state.scheme,
                                          read(state.history->now, i), read(state.history->before, i)));
  }
  if (has_pressure_) {
    density.value -= p * (J.value - 1) + compliance_ * p * p / 2;
    density.in_C -= p * J.first;
    density.in_p = 1 - J.value - compliance_ * p;
    density.in_Cp = -J.first;
    density.in_pp = -compliance_;
    if (second) density.in_CC -= p * J.second;
  }
  return density;
}

SolidDensity SolidResponse::relaxation(const State& state, int point, const Eigen::Matrix3d& C,
                                       const RateWeight& weight) const {
  constexpr double still = 1e-4; // of internal variables, which are of order one
  SolidDensity density;
  density.in_C.setZero();
  density.in_E.setZero();
  density.in_CC.setZero();
  density.in_Cp.setZero();
  density.in_CE.setZero();
  density.in_EE.setZero();
  for (int b = 0; b < branches(); ++b) {
    const auto& branch = material_.branches[static_cast<std::size_t>(b)];
    const materials::SolidInternal now = read(state.history->now, place(point, b));
    const materials::SolidInternal rest =
        materials::solid_branch_advance(branch, C, materials::TimeScheme::relaxed(), now, {});
    for (std::size_t i = 0; i < now.size(); ++i)
      if (std::abs(rest[i] - now[i]) > still * std::max(1.0, std::abs(now[i])))
        throw std::domain_error("branches cannot be linearised while their dashpots flow");
    const materials::RelaxationSpectrum<6> spectrum =
        materials::relaxation_spectrum<6>(branch, [&](const materials::TimeScheme& scheme) {
          return Eigen::Matrix<double, 6, 6>(
              materials::solid_branch_potential(branch, C, scheme, now, {}).second);
        });
    for (int j = 0; j < spectrum.count; ++j) {
      const auto& [w, rate] = spectrum.element[static_cast<std::size_t>(j)];
      density.in_CC += weight(rate) * w * w.transpose();
    }
  }
  return density;
}

EnergyParts SolidResponse::energies(const State& state, int point, const Eigen::Matrix3d& C, double p) const {
  EnergyParts parts;
  parts.elastic = materials::solid_potential(material_.law, C, 0).value;
  if (has_pressure_) parts.elastic += compliance_ * p * p / 2;
  for (int b = 0; b < branches(); ++b) {
    const materials::BranchPower power = materials::solid_branch_power(
        material_.branches[static_cast<std::size_t>(b)], C, read(state.history->now, place(point, b)));
    parts.branches += power.stored;
    parts.dissipation += power.dissipation;
  }
  return parts;
}

void SolidResponse::start_history(int points, std::vector<double>& all) const {
  for (int p = 0; p < points; ++p)
    for (int b = 0; b < branches(); ++b) write(all, place(p, b), materials::undeformed_solid());
}

void SolidResponse::advance_history(const State& state, int point, const Eigen::Matrix3d& C,
                                    std::vector<double>& all) const {
  for (int b = 0; b < branches(); ++b) {
    const std::size_t i = place(point, b);
    write(all, i,
          materials::solid_branch_advance(material_.branches[static_cast<std::size_t>(b)], C, state.scheme,
                                          read(state.history->now, i), read(state.history->before, i)));
  }
}

} // namespace dielast::fem
