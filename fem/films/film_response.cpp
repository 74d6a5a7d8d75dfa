// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/films/film_response.hpp"

#include "materials/branches/branch.hpp"
#include "materials/branches/relaxation.hpp"
#include "materials/laws/plane_stress.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace dielast::fem {

namespace {

using Potential = FilmResponse::Potential;

materials::Internal read(const std::vector<double>& all, std::size_t place) {
  if (all.empty()) return {}; // no such past: its weight is 0
  return {all[place], all[place + 1], all[place + 2]};
}

void write(std::vector<double>& all, std::size_t place, const materials::Internal& values) {
  std::copy(values.begin(), values.end(), all.begin() + static_cast<std::ptrdiff_t>(place));
}

Potential scaled(Potential p, double factor) {
  p.value *= factor;
  for (double& x : p.first) x *= factor;
  for (double& x : p.second) x *= factor;
  return p;
}

Potential sum(Potential p, const Potential& q) {
  p.value += q.value;
  for (std::size_t i = 0; i < p.first.size(); ++i) p.first[i] += q.first[i];
  for (std::size_t i = 0; i < p.second.size(); ++i) p.second[i] += q.second[i];
  return p;
}

/// By the signs of the principal stresses.
materials::Tension tension_of(const Potential& p) {
  const Eigen::Matrix2d S = materials::tension_field::stress(p);
  if (S.determinant() < 0) return materials::Tension::wrinkled;
  return S.trace() < 0 ? materials::Tension::slack : materials::Tension::taut;
}

} // namespace

FilmResponse::Potential FilmResponse::simple(const C& at, double k) const {
  return std::visit(
      [&](const auto& law) { return materials::membrane_potential(law, material_.dielectric, at, k); },
      material_.law);
}

materials::MembranePotential<Lanes> FilmResponse::simple(const materials::InPlaneC<Lanes>& at,
                                                         const Lanes& k) const {
  return std::visit(
      [&](const auto& law) { return materials::membrane_potential(law, material_.dielectric, at, k); },
      material_.law);
}

materials::TensionField FilmResponse::resolve(const State& state, int point, const C& at, double k,
                                              const Potential& simple) const {
  const Potential taut = with_branches(state, point, at, simple);
  if (!tension_field_) return {tension_of(taut), taut, at};
  materials::TensionField field = materials::relax(
      [&](const C& wider) { return with_branches(state, point, wider, this->simple(wider, k)); }, at, taut);
  if (wrinkles(field)) field.potential = sum(scaled(field.potential, 1 - wrinkled_), scaled(taut, wrinkled_));
  return field;
}

FilmResponse::ChargeDensity FilmResponse::charge_density(const materials::TensionField& field,
                                                         const C& at) const {
  const auto of = [&](const C& film) {
    const auto q = materials::capacitance_ratio(material_.dielectric, film.trace(), film.det());
    return ChargeDensity{q.value, {q.dT + q.dD * film.C22, q.dT + q.dD * film.C11, -2.0 * q.dD * film.C12}};
  };
  const ChargeDensity natural = of(field.natural);
  if (!wrinkles(field)) return natural;
  const ChargeDensity taut = of(at);
  return {(1 - wrinkled_) * natural.value + wrinkled_ * taut.value,
          (1 - wrinkled_) * (field.carry * natural.slope) + wrinkled_ * taut.slope,
          (1 - wrinkled_) * natural.slope.dot(field.give * natural.slope) / 2};
}

EnergyParts FilmResponse::energies(const State& state, int point, const materials::TensionField& field,
                                   const C& at) const {
  EnergyParts parts;
  const double share = wrinkles(field) ? wrinkled_ : 0;
  if (share > 0) parts.regularised = share * simple(at, 0.0).value;
  parts.elastic = (1 - share) * simple(field.natural, 0.0).value + parts.regularised;
  for (int b = 0; b < branches(); ++b) {
    const auto& branch = material_.branches[static_cast<std::size_t>(b)];
    const materials::BranchPower power =
        materials::branch_power(branch, field.natural, read(state.history->now, place(point, b)));
    parts.branches += power.stored;
    parts.dissipation += power.dissipation;
  }
  return parts;
}

FilmResponse::Potential FilmResponse::relaxation(const State& state, int point, const C& at, double k,
                                                 const RateWeight& weight) const {
  if (wrinkles(shape(state, point, at, k)))
    throw std::domain_error("wrinkled film with branches cannot be linearised");
  Potential psi{};
  for (int b = 0; b < branches(); ++b) {
    const auto& branch = material_.branches[static_cast<std::size_t>(b)];
    const materials::Internal now = read(state.history->now, place(point, b));
    if (!materials::is_relaxed(branch, at, now))
      throw std::domain_error("branches cannot be linearised while their dashpots flow");
    const materials::RelaxationSpectrum<3> spectrum = materials::relaxation_spectrum(branch, at, now);
    for (int j = 0; j < spectrum.count; ++j) {
      const auto& [w, rate] = spectrum.element[static_cast<std::size_t>(j)];
      const double factor = weight(rate);
      for (std::size_t p = 0; p < psi.second.size(); ++p)
        psi.second[p] += factor * w[materials::component_pairs[p][0]] * w[materials::component_pairs[p][1]];
    }
  }
  return psi;
}

bool FilmResponse::alike(const State& state, int before, int point, const materials::InPlaneC<Lanes>& at,
                         int l) const {
  if (at.C11[l] != at.C11[l - 1] || at.C22[l] != at.C22[l - 1] || at.C12[l] != at.C12[l - 1]) return false;
  const auto same = [&](const std::vector<double>& all) {
    const auto of = [&](int p) { return all.begin() + static_cast<std::ptrdiff_t>(place(p, 0)); };
    return all.empty() || branches() == 0 || std::equal(of(before), of(before) + history_size(1), of(point));
  };
  return !state.history || (same(state.history->now) && same(state.history->before));
}

void FilmResponse::place_history(int first, int points) {
  first_ = first;
  if (branches() > 0 && !tension_field_)
    kept_.assign(static_cast<std::size_t>(points * kept_size()), std::numeric_limits<double>::quiet_NaN());
}

void FilmResponse::start_history(int points, std::vector<double>& all) const {
  for (int p = 0; p < points; ++p)
    for (int b = 0; b < branches(); ++b) write(all, place(p, b), materials::undeformed());
}

void FilmResponse::advance_history(const State& state, int point, const materials::TensionField& field,
                                   std::vector<double>& all) const {
  for (int b = 0; b < branches(); ++b) {
    const std::size_t i = place(point, b);
    write(all, i,
          materials::advance(material_.branches[static_cast<std::size_t>(b)], field.natural, state.scheme,
                             read(state.history->now, i), read(state.history->before, i)));
  }
}

bool FilmResponse::repeats(const State& state, int point, int points, const materials::InPlaneC<Lanes>& at,
                           int l, std::vector<double>& all) const {
  if (tension_field_ || l == 0 || !alike(state, point - points, point, at, l)) return false;
  const auto of = [&](int p) { return all.begin() + static_cast<std::ptrdiff_t>(place(p, 0)); };
  std::copy_n(of(point - points), history_size(1), of(point));
  return true;
}

FilmResponse::Potential FilmResponse::with_branches(const State& state, int point, const C& at,
                                                    const Potential& psi) const {
  if (branches() == 0) return psi;
  if (kept_.empty()) return sum(psi, of_branches(state, point, at));
  // The tangent is asked for where the residual was: what the branches do is kept with all that it depends
  // on. A thread has its own points.
  const materials::TimeScheme& scheme = state.scheme;
  const std::array<double, 7> given{at.C11, at.C22, at.C12, scheme.dt, scheme.a0, scheme.h1, scheme.h2};
  const int past = history_size(1);
  const auto begin = static_cast<std::ptrdiff_t>(place(point, 0));
  const auto now = state.history->now.begin() + begin;
  const bool remembers = scheme.h2 != 0;
  const auto before = remembers ? state.history->before.begin() + begin : now;
  double* const kept = kept_.data() + static_cast<std::ptrdiff_t>(point) * kept_size();
  double* const known = kept + given.size() + 2 * past;
  if (!(std::equal(given.begin(), given.end(), kept) && std::equal(now, now + past, kept + given.size()) &&
        std::equal(before, before + past, kept + given.size() + past))) {
    const Potential made = of_branches(state, point, at);
    std::copy_n(before, past, std::copy_n(now, past, std::copy(given.begin(), given.end(), kept)));
    *known = made.value;
    std::ranges::copy(made.second, std::ranges::copy(made.first, known + 1).out);
    return sum(psi, made);
  }
  Potential made{*known, {}, {}};
  std::copy_n(known + 1, made.first.size(), made.first.begin());
  std::copy_n(known + 1 + made.first.size(), made.second.size(), made.second.begin());
  return sum(psi, made);
}

FilmResponse::Potential FilmResponse::of_branches(const State& state, int point, const C& at) const {
  Potential psi{};
  for (int b = 0; b < branches(); ++b) {
    const std::size_t i = place(point, b);
    psi = sum(psi,
              materials::branch_potential(material_.branches[static_cast<std::size_t>(b)], at, state.scheme,
                                          read(state.history->now, i), read(state.history->before, i)));
  }
  return psi;
}

} // namespace dielast::fem
