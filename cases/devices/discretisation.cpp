// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/discretisation.hpp"

#include <algorithm>
#include <optional>

namespace dielast::cases {

namespace {

constexpr int fewer_increments = 3;

/// The key that says how fine a mesh is, and the smallest number that serves.
struct Density {
  int MeshOptions::*elements = nullptr;
  int fewest = 0;
};

std::optional<Density> density_of(const Geometry& geometry) {
  if (std::holds_alternative<Honeycomb>(geometry)) return Density{&MeshOptions::wall_elements, 1};
  if (std::holds_alternative<Balloon>(geometry)) return Density{&MeshOptions::rings, 4};
  if (std::holds_alternative<Disc>(geometry) || std::holds_alternative<Annulus>(geometry))
    return Density{&MeshOptions::rings, 2};
  return std::nullopt;
}

/// Elements larger by a factor; returns by how much they are, 1 where that cannot be.
double coarsen_mesh(Case& one, int factor) {
  MeshOptions& mesh = one.mesh;
  if (std::holds_alternative<MeshFile>(one.geometry)) {
    const int times = factor == 2 ? 1 : 2;
    if (mesh.refine < times) return 1;
    mesh.refine -= times;
    return factor;
  }
  const auto density = density_of(one.geometry);
  if (!density) return 1;
  int& elements = mesh.*density->elements;
  const int fine = elements;
  if (fine / factor < density->fewest) return 1;
  elements = fine / factor;
  return static_cast<double>(fine) / elements;
}

/// Time steps longer by a factor, in which a scheme of second order has a local error larger by its cube. The
/// states of static steps do not depend on their increments: few will do.
void coarsen_steps(Case& one, int factor) {
  for (Step& step : one.steps) {
    const int divisor = step.duration ? factor : fewer_increments;
    step.increments = (step.increments + divisor - 1) / divisor;
    step.record.reset();
  }
  one.solver.time_tolerance = std::min(0.1, one.solver.time_tolerance * factor * factor * factor);
}

} // namespace

bool takes_time(const Case& one) {
  return std::ranges::any_of(one.steps, [](const Step& step) { return step.duration.has_value(); });
}

std::vector<Discretisation> other_discretisations(const Case& one) {
  std::vector<Discretisation> others;
  if (std::holds_alternative<MeshFile>(one.geometry) && one.mesh.refine == 0) {
    Discretisation& finer = others.emplace_back(Discretisation{one, 0.5});
    ++finer.one.mesh.refine;
    coarsen_steps(finer.one, 2);
    return others;
  }
  const bool timed = takes_time(one);
  if (std::holds_alternative<Patch>(one.geometry) && !timed) {
    Discretisation& fewer = others.emplace_back(Discretisation{one, fewer_increments});
    coarsen_steps(fewer.one, 1);
    return others;
  }
  double coarsest_mesh = 1;
  for (const int factor : {2, 4}) {
    Discretisation coarser{one};
    const double elements = coarsen_mesh(coarser.one, factor);
    if (elements < coarsest_mesh || (elements == 1 && !timed)) break;
    coarsest_mesh = elements;
    coarsen_steps(coarser.one, factor);
    coarser.size = elements > 1 ? elements : factor;
    others.push_back(std::move(coarser));
  }
  return others;
}

} // namespace dielast::cases
