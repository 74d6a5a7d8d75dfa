// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/results/common_errors.hpp"

#include "post/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::cases {

BarrierChanges changes_by_barrier(const Case& one, const Solution& own,
                                  const std::vector<Discretisation>& discretisations,
                                  const std::vector<Solution>& others, int threads) {
  constexpr double all_over_half = 2 + std::numbers::sqrt2; // 1 / (1 - 0.5^0.5)
  BarrierChanges changes{std::vector<double>(own.values.size(), 0.0), ""};
  if (!one.contact) return changes;
  Discretisation thinner{one};
  const Solution* thick = &own;
  for (std::size_t i = 0; i < others.size(); ++i)
    if (others[i].size > thinner.size) thinner = discretisations[i], thick = &others[i];
  thinner.one.contact->thickness /= 2;
  const Solution thin = solve(thinner, false, threads);
  if (const std::string reason = why_not(*thick, thin); !thin.trouble.empty() || !reason.empty())
    changes.unknown = fmt::format("half of contact.thickness, which tells what it changes, {}",
                                  thin.trouble.empty() ? "takes the device another way"
                                                       : "does not lead to the end (" + thin.trouble + ")");
  for (std::size_t q = 0; q < thin.values.size() && changes.unknown.empty(); ++q)
    changes.of_quantities[q] =
        all_over_half * std::abs(on_its_side(thin.values[q], own, thick->values[q]) - thick->values[q]);
  return changes;
}

namespace {

/// Whether most of a shell's elements are longer than the layer along its edges in which bending gives way to
/// tension, sqrt(D/N) = h sqrt(mu/(3 sigma)): larger elements do not know then what it does.
bool hides_edge_layer(const Case& one, const Simulation& run) {
  constexpr double resolved = 4; // layers long an element may be
  const meshing::Mesh& mesh = run.device().mesh;
  const meshing::CellBlock& film = *mesh.film();
  if (!meshing::is_triangle(film.type) || run.device().solid) return false;
  int hidden = 0, all = 0;
  for (const fem::MembraneSample& sample : run.device().model.sample(run.state()).film) {
    const Part& part =
        one.parts[static_cast<std::size_t>(run.device().film_parts[static_cast<std::size_t>(sample.cell)])];
    if (part.film->section != FilmSection::shell) continue;
    const post::FilmPoint point(sample);
    const auto corner = [&](std::size_t k) {
      return mesh.nodes[static_cast<std::size_t>(film.cell(sample.cell)[k])];
    };
    const double size = (corner(1) - corner(0)).norm(), stress = point.principal_stress()[1];
    const double modulus = materials::initial_shear_modulus(part.film->material.law);
    hidden += stress > 0 && size > resolved * point.thickness * std::sqrt(modulus / (3 * stress));
    ++all;
  }
  return 2 * hidden > all;
}

} // namespace

std::vector<double> changes_by_bending(const Case& one, const Simulation& run, const Solution& own,
                                       int threads) {
  constexpr double cautious = 1.25;
  std::vector<double> changes(own.values.size(), 0.0);
  const auto layered = [](const Film& film) { return !film.further_layers.empty() || film.offset != 0; };
  if (one.any_film(layered) || !hides_edge_layer(one, run)) return changes;
  Discretisation membrane{one};
  for (Part& part : membrane.one.parts)
    if (part.film && part.film->section == FilmSection::shell) part.film->section = FilmSection::membrane;
  for (Support& support : membrane.one.supports) std::fill_n(support.fixed.begin() + 3, 3, false);
  const Solution flexible = solve(membrane, false, threads);
  if (!flexible.trouble.empty()) return changes;
  for (std::size_t q = 0; q < changes.size(); ++q)
    changes[q] = cautious * std::abs(on_its_side(flexible.values[q], own, own.values[q]) - own.values[q]);
  return changes;
}

} // namespace dielast::cases
