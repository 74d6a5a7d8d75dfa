// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/results/error_estimate.hpp"

#include "cases/case/quantities.hpp"
#include "cases/console/terminal.hpp"
#include "cases/devices/bonded_corners.hpp"
#include "cases/language/conditions.hpp"
#include "cases/results/common_errors.hpp"
#include "cases/runs/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dielast::cases {

namespace {

/// Part of what a jump releases by which that depends on where it sets out: near a critical load that is
/// known to 1e-7.
constexpr double from_where = 1e-5;
constexpr const char* did_not_end = "the run did not reach its end";
constexpr int most_to_refine = 20000; ///< triangles of a user's own mesh
constexpr int few_triangles = 300;    ///< whose numbers need not converge yet
/// Cells that are refined unasked where larger ones tell nothing: triangles of a plane, of shells (which have
/// five unknowns a node), tetrahedra.
constexpr int most_triangles = 6000, most_of_shells = 1500, most_tetrahedra = 300;

/// Whether electrodes end within a solid whose potential is an unknown: the field there is singular, like
/// 1/sqrt(r), and so are the stresses.
bool has_fringes(const Case& one) {
  return std::ranges::any_of(one.parts, [](const Part& part) {
    const auto* slab = std::get_if<Slab>(&part.geometry);
    return slab && part.film && part.film->potential && (slab->electrode || slab->electrode_width);
  });
}

/// Where the held sides of a solid or a shell end displacements go as r^0.5 (along a flat side) or r^0.6 (at
/// a right angle), and no number on a mesh that does not grade towards the place is known to converge faster.
constexpr OrderRange next_to_a_bonded_corner{0.5, 1};
/// The corner of a shell is in its plane only, and most of what it does bends: between larger elements its
/// numbers converge as elsewhere.
constexpr double order_of_large_shells = 2;

/// The corners of solids and shells; whether they are a solid's, whose extremes are there, and whether there
/// is a field in the cells around these. (A shell's layers are strained by bending, too, and most often
/// elsewhere.)
struct BondedCorners {
  bool any = false, of_solid = false, charged = false;
};

BondedCorners corners_of(const Simulation& run) {
  const std::vector<int> nodes = bonded_corners(run.device());
  if (nodes.empty() || !run.device().solid) return {.any = !nodes.empty()};
  const meshing::CellBlock& film = *run.device().mesh.film();
  const fem::Samples samples = run.device().model.sample(run.state());
  return {true, true, std::ranges::any_of(samples.film, [&](const fem::MembraneSample& at) {
            return at.solid && at.solid->field.norm() > 0 &&
                   std::ranges::any_of(film.cell(at.cell),
                                       [&](int node) { return std::ranges::binary_search(nodes, node); });
          })};
}

/// Whether a field of the film is singular where its strains are.
bool is_singular_with_strain(const std::string& field, const BondedCorners& corners) {
  if (field == "electric_field" || field == "breakdown_ratio") return corners.charged;
  constexpr std::array bounded{"tension_state", "voltage", "slope"};
  return std::ranges::find(bounded, field) == bounded.end();
}

/// How many times elements may be halved before they are too many to be computed unasked.
int most_halvings(const Simulation& own) {
  const meshing::CellBlock* film = own.device().mesh.film();
  if (!film) return 1;
  const bool is_solid = meshing::is_tetrahedron(film->type);
  const bool is_shell = own.device().bears_compression && !own.device().solid;
  const int most = is_solid ? most_tetrahedra : is_shell ? most_of_shells : most_triangles;
  int halvings = 0;
  for (int cells = film->size(); cells <= most; cells *= is_solid ? 8 : 4) ++halvings;
  return halvings;
}

/// The other discretisations. Where there are bonded corners, edges of a few sides, or few elements at all,
/// larger ones tell nothing of what all of them do not resolve, and the meshes of several parts cannot always
/// be made coarser alike: smaller ones are compared with, too, as long as these are not too many.
std::vector<Discretisation> compared_with(const Case& one, const Simulation& own, bool corners) {
  std::vector<Discretisation> all = other_discretisations(one);
  const bool none_of_parts = all.empty() && one.parts.size() > 1;
  const meshing::CellBlock* film = own.device().mesh.film();
  const bool few =
      film && meshing::is_triangle(film->type) && film->size() <= few_triangles && !takes_time(one);
  const bool blind = corners || few || (!all.empty() && divides_edges_alike(one, all.front().one));
  const int most = most_halvings(own);
  if ((!blind && !none_of_parts) || (!all.empty() && all.front().size < 1) || most == 0) return all;
  int halvings = 1;
  std::optional<Discretisation> finer = finer_discretisation(one);
  while (finer && halvings < most && divides_edges_alike(one, finer->one))
    finer = finer_discretisation(one, ++halvings);
  if (!finer) return all;
  if (all.size() > 1) all.resize(1);
  all.insert(all.begin(), *std::move(finer));
  return all;
}

/// Whether elements of second order show it.
bool is_smooth(const Case& one, const Simulation& own) {
  const meshing::CellType type = own.device().mesh.film()->type;
  const bool corners = std::ranges::any_of(one.parts, [](const Part& part) { return part.traits().corners; });
  return !corners && (type == meshing::CellType::triangle6 || type == meshing::CellType::meridian3 ||
                      type == meshing::CellType::tetrahedron10);
}

/// Orders that the elements may have, measured on the cases of docs/verification.md.
OrderRange orders_of(const QuantityKind& kind, const Case& one, bool smooth, const BondedCorners& corners) {
  if (corners.any) {
    OrderRange orders = next_to_a_bonded_corner;
    orders.least = std::min(orders.least, orders_of(kind, one, smooth, {}).least);
    if (!corners.of_solid) orders.of_larger = order_of_large_shells;
    return orders;
  }
  if (has_fringes(one) && (kind.fields || !kind.orders)) return {0.5, 1};
  if (kind.orders) return {(*kind.orders)[0], (*kind.orders)[1]};
  return {1, smooth && !takes_time(one) ? 3.0 : 2.0};
}

/// An error is no less than what all discretisations have in common.
void raise(ErrorEstimate& estimate, double in_common) {
  if (estimate.error) estimate.error = std::max(*estimate.error, in_common);
}

/// Where waves turn and controllers measure, every run has a time step: where these are most of them, longer
/// or shorter ones tell nothing of what they leave out.
bool divides_time_alike(const Solution& own, const Solution& other) {
  constexpr double alike = 0.7;
  const auto [fewer, more] = std::minmax(own.time_steps, other.time_steps);
  return fewer > alike * more;
}

int direction_of(const Quantity& quantity) {
  if (!quantity.kind->extreme) return 0;
  return quantity.extreme == post::Extreme::maximum ? 1 : -1;
}

/// Why the case is not compared with other discretisations; empty where it is.
std::string why_not_compared(const Case& one, const Device& device,
                             const std::vector<Discretisation>& discretisations) {
  if (discretisations.empty())
    return one.parts.size() > 1 ? "the meshes of its parts cannot all be made coarser alike"
                                : "the mesh is the coarsest already";
  if (divides_edges_alike(one, discretisations.front().one))
    return "its smallest circle has as few sides with other elements, too; more mesh.rings tell what they "
           "change";
  const bool refined = discretisations.front().size < 1;
  if (refined && device.tension_field)
    return "a finer mesh of film that wrinkles may take far longer than this one; one by [mesh] tells what "
           "it changes";
  if (refined && device.mesh.film()->size() > most_to_refine)
    return fmt::format("the mesh has more than {} triangles, which are not refined unasked; mesh.refine = 1 "
                       "tells what it changes",
                       most_to_refine);
  return "";
}

} // namespace

Estimates estimate_errors(const Case& one, const Simulation& own_run, const Outcome& outcome,
                          std::span<const post::StepRecord> records, const std::vector<Margin>& margins,
                          int threads) {
  Estimates estimates;
  if (outcome.ending != Ending::complete && (outcome.kind != "limit point" || takes_time(one))) {
    estimates.reason = did_not_end;
    return estimates;
  }
  const BondedCorners bonded = corners_of(own_run);
  const std::vector<Discretisation> discretisations = compared_with(one, own_run, bonded.any);
  estimates.reason = why_not_compared(one, own_run.device(), discretisations);
  if (!estimates.reason.empty()) return estimates;
  const Solution own = solution_of(own_run, outcome, records, margins);
  const bool with_margins = own.trouble.empty() && std::ranges::any_of(margins, [](const Margin& margin) {
                              return margin.factor.has_value();
                            });
  std::vector<Solution> others;
  for (const Discretisation& discretisation : discretisations) {
    Solution other = solve(discretisation, with_margins, threads);
    if (interrupted()) {
      estimates.reason = "interrupted";
      break;
    }
    if (const std::string reason = why_not(own, other); reason.empty()) {
      others.push_back(std::move(other));
    } else {
      if (others.empty()) estimates.reason = reason;
      if (others.empty() && !own.trouble.empty() && !other.last.step.empty())
        estimates.events = {{own.trouble, "depends on the mesh: " + reason}};
      break;
    }
  }
  if (!estimates.reason.empty()) return estimates;

  const bool smooth = is_smooth(one, own_run);
  const bool viscous =
      std::ranges::any_of(one.film_materials(), [](const auto* material) { return material->viscosity > 0; });
  const bool jumps = own.passes("jump");
  const double unknown_release = jumps ? from_where * std::abs(own_run.energy().work().released) : 0;
  const double of_steps = divides_time_alike(own, others.front()) ? own_run.time_steps().error : 0;
  const double spring = viscous ? 1 / materials::stiffness_before_viscosity : 0;
  if (!own.trouble.empty()) {
    estimates.reason = did_not_end;
    estimates.events = {remark_on_end(one, own, others, orders_of({}, one, smooth, bonded))};
    return estimates;
  }
  const BarrierChanges of_barrier = changes_by_barrier(one, own, discretisations, others, threads);
  const std::vector<double> of_bending = changes_by_bending(one, own_run, own, threads);
  estimates.reason = interrupted() ? "interrupted" : of_barrier.unknown;
  if (!estimates.reason.empty()) return estimates;
  const auto singular = [&](const Quantity& quantity) {
    if (!quantity.kind->extreme) return "";
    if (has_fringes(one)) return "singular where an electrode ends: no converged value";
    if (bonded.of_solid && is_singular_with_strain(quantity.of, bonded))
      return "singular where a held side ends: no converged value";
    return "";
  };
  const auto estimated = [&](std::size_t q, const Quantity& quantity, const auto& sample) {
    std::vector<Sampled> sampled;
    for (const Solution& other : others) sampled.push_back(sample(other));
    OrderRange orders = orders_of(*quantity.kind, one, smooth, bonded);
    const OrderRange of_course = orders_of(*one.quantities[q].kind, one, smooth, bonded);
    orders.least = std::min(orders.least, of_course.least);
    orders.most = std::min(orders.most, of_course.most);
    return estimate_error(sample(own), sampled, orders, direction_of(quantity),
                          unit_of(quantity, one.quantities) == "Pa" ? smallest_stress(one) : 0);
  };
  /// What the discretisations have in common, and do not tell.
  const auto raise_all = [&](std::size_t q, ErrorEstimate& estimate, double value) {
    if (takes_time(one)) // the steps were chosen to be no better than that
      raise(estimate, std::max({one.solver.time_tolerance, spring, of_steps}) * std::abs(value));
    raise(estimate, of_bending[q]);
    if (estimate.error) *estimate.error += of_barrier.of_quantities[q];
  };
  for (std::size_t q = 0; q < one.quantities.size(); ++q) {
    const Quantity& quantity = measured(one.quantities[q], one.quantities);
    ErrorEstimate& estimate = estimates.quantities.emplace_back();
    const auto without = quantity.kind->without_error;
    if (const std::string remark = without ? without(quantity) : ""; !remark.empty()) {
      estimate.remark = remark;
    } else if (const std::string remark_on_place = singular(quantity); !remark_on_place.empty()) {
      estimate.singular = true;
      estimate.remark = remark_on_place;
    } else {
      estimate = estimated(q, quantity, [&](const Solution& s) {
        return Sampled{s.size, on_its_side(s.values[q], own, own.values[q]), s.rises[q]};
      });
      if (quantity.kind->of_balance && quantity.kind->of_balance(quantity))
        raise(estimate, own_run.energy().error() + unknown_release);
      if (quantity.kind->of_run) raise(estimate, margin_accuracy * std::abs(own.values[q]));
      raise(estimate, own_run.error_of_course(one.quantities[q])); // all stop at the same corners of waves
      raise_all(q, estimate, own.values[q]);
    }
  }
  for (const Margin& margin : margins) {
    ErrorEstimate& estimate = estimates.margins.emplace_back();
    if (!margin.factor) continue;
    if (is_singular_there(one, margin.limit, estimates.quantities)) {
      estimate.remark = "falls as the mesh is refined: no converged value";
      continue;
    }
    std::vector<Sampled> sampled;
    for (const Solution& other : others)
      sampled.push_back({other.size, factor_to(margin.limit, other.margins)});
    if (std::isfinite(sampled.front().value)) {
      estimate = estimate_error({1, *margin.factor}, sampled, orders_of({}, one, smooth, bonded), 0);
      raise(estimate, margin_accuracy * *margin.factor);
    } else {
      estimate.remark = fmt::format("not reached with {}: no error estimate", size_text(others.front().size));
    }
  }
  std::vector<ErrorEstimate> of_farthest; // events may have been on the way
  for (std::size_t q = 0; q < one.quantities.size(); ++q) {
    const Quantity& quantity = one.quantities[q];
    ErrorEstimate& estimate = of_farthest.emplace_back();
    if (!quantity.kind->extreme) continue;
    estimate.singular = *singular(quantity) != '\0';
    if (estimate.singular) continue;
    estimate = estimated(q, quantity, [&](const Solution& s) {
      return Sampled{s.size, s.farthest[q].value, s.farthest[q].rise};
    });
    raise_all(q, estimate, own.farthest[q].value);
  }
  estimates.events = event_remarks(one, own_run.device(), own, others, of_farthest);
  return estimates;
}

} // namespace dielast::cases
