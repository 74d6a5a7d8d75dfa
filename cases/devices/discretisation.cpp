// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/discretisation.hpp"

#include "cases/case/part_kind.hpp"
#include "cases/language/conditions.hpp"
#include "cases/tables/regions.hpp"
#include "meshing/regions/region_mesh.hpp"
#include "meshing/rings.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::cases {

namespace {

constexpr int fewer_increments = 3;

/// Elements of a part larger by a factor; returns by how much they are, 1 where that cannot be.
double coarsen_mesh(Part& part, int factor) {
  MeshOptions& mesh = part.mesh;
  if (std::holds_alternative<MeshFile>(part.geometry)) {
    const int times = factor == 2 ? 1 : 2;
    if (mesh.refine < times) return 1;
    mesh.refine -= times;
    return factor;
  }
  const GeometryTraits& geometry = part.traits();
  if (!geometry.elements) return 1;
  int& elements = mesh.*geometry.elements;
  const int fine = elements;
  if (fine / factor < geometry.fewest) return 1;
  elements = fine / factor;
  return static_cast<double>(fine) / elements;
}

/// Whether larger elements would change nothing, or there are none.
bool is_exact(const Part& part) {
  return !part.has_mesh() || std::holds_alternative<Patch>(part.geometry) || is_one_element(part);
}

/// Elements of all parts that are not exact larger by a factor; returns by how much they are, 1 where they
/// cannot all be.
double coarsen_meshes(Case& one, int factor) {
  double coarser = 1;
  for (Part& part : one.parts) {
    if (is_exact(part)) continue;
    const double by = coarsen_mesh(part, factor);
    if (by == 1 || (coarser > 1 && by != coarser)) return 1;
    coarser = by;
  }
  return coarser;
}

/// Whether all meshes are the user's own; and there is one.
bool has_own_meshes_only(const Case& one) {
  return one.any_geometry<MeshFile>() && std::ranges::all_of(one.parts, [](const Part& part) {
           return !part.has_mesh() || std::holds_alternative<MeshFile>(part.geometry);
         });
}

/// Time steps longer by a factor, in which a scheme of second order has a local error larger by its cube. The
/// states of static steps do not depend on their increments: few will do.
void coarsen_steps(Case& one, int factor) {
  for (Step& step : one.steps) {
    const int divisor = step.duration ? factor : fewer_increments;
    step.increments = (step.increments + divisor - 1) / divisor;
    if (step.record) step.record = std::min(*step.duration, factor * *step.record); // steps end there, too
  }
  one.solver.time_tolerance = std::min(0.1, one.solver.time_tolerance * factor * factor * factor);
}

/// Larger by a factor to its fourth power: what keeps wrinkled film regular is an error like those of a mesh,
/// and is told with them.
void stiffen_wrinkles(Case& one, int factor) {
  for (Part& part : one.parts)
    if (part.film) part.film->wrinkled *= std::pow(factor, 4);
}

/// Sides that the smallest circle has which is an edge of a film, or sixths of these; 0: there is none.
int sides_of_edge(const Part& part) {
  if (const auto regions = regions_of(part); !regions.empty())
    return meshing::fewest_sides(*round_film(part), regions, part.mesh.rings,
                                 std::max(1.0, part.mesh.grading));
  if (const auto* annulus = std::get_if<Annulus>(&part.geometry))
    return meshing::rings_of_hole(annulus->inner_radius, annulus->outer_radius, part.mesh.rings);
  if (const auto* disc = std::get_if<Disc>(&part.geometry))
    return meshing::rings_of_electrode(disc->radius, disc->electrode_radius.value_or(disc->radius),
                                       part.mesh.rings);
  return 0;
}

} // namespace

bool divides_edges_alike(const Case& one, const Case& other) {
  if (one.dimension == fem::Dimension::axisymmetric) return false;
  for (std::size_t p = 0; p < one.parts.size(); ++p)
    if (const int sides = sides_of_edge(other.parts[p]); sides > 0 && sides == sides_of_edge(one.parts[p]))
      return true;
  return false;
}

std::optional<Discretisation> finer_discretisation(const Case& one, int halvings) {
  if (std::ranges::all_of(one.parts, is_exact)) return std::nullopt;
  Discretisation finer{one, std::ldexp(1.0, -halvings)};
  for (Part& part : finer.one.parts) {
    if (is_exact(part)) continue;
    if (std::holds_alternative<MeshFile>(part.geometry))
      part.mesh.refine += halvings;
    else if (const auto elements = part.traits().elements)
      part.mesh.*elements <<= halvings;
    else
      return std::nullopt;
  }
  coarsen_steps(finer.one, 2);
  return finer;
}

std::vector<Discretisation> other_discretisations(const Case& one) {
  std::vector<Discretisation> others;
  if (has_own_meshes_only(one) &&
      std::ranges::any_of(one.parts, [](const Part& p) { return p.has_mesh() && p.mesh.refine == 0; })) {
    others.push_back(*finer_discretisation(one));
    return others;
  }
  const bool exact = std::ranges::all_of(one.parts, is_exact);
  if (exact && !takes_time(one)) {
    Discretisation& fewer = others.emplace_back(Discretisation{one, fewer_increments});
    coarsen_steps(fewer.one, 1);
    stiffen_wrinkles(fewer.one, 2);
    return others;
  }
  double coarsest_mesh = 1;
  for (const int factor : {2, 4}) {
    Discretisation coarser{one};
    const double elements = coarsen_meshes(coarser.one, factor);
    if (elements < coarsest_mesh || (elements == 1 && !exact)) break;
    coarsest_mesh = elements;
    coarsen_steps(coarser.one, factor);
    stiffen_wrinkles(coarser.one, factor);
    coarser.size = elements > 1 ? elements : factor;
    others.push_back(std::move(coarser));
  }
  return others;
}

} // namespace dielast::cases
