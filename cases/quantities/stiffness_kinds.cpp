// SPDX-License-Identifier: GPL-3.0-or-later
// What small forces and vibrations about a state at rest find.
#include "cases/case/holding.hpp"
#include "cases/devices/pins.hpp"
#include "cases/language/conditions.hpp"
#include "cases/quantities/probing.hpp"
#include "fem/linear/modal.hpp"
#include "fem/linear/rest.hpp"
#include "fem/model/contact_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace dielast::cases {
namespace {

bool at_rest(const Measured& measured) {
  return measured.may_rest && !fem::has_friction(measured.equilibrium.model()) &&
         fem::unrest(measured.equilibrium, measured.state).empty() &&
         fem::skew_stiffness(measured.equilibrium, measured.state) <= fem::negligible_skew;
}

/// How a relaxed device goes along with a place along an axis: per unknown, free ones first, then held ones,
/// over the mean of the place's displacement, and the force on the place that this takes, N/m; NaN where the
/// state is not at rest, or the place is held otherwise than in all of its nodes alike.
struct Give {
  Eigen::VectorXd displacement;
  double force = no_value;
};

/// The nodes by which supports hold all of a place along an axis: its own, or those of bodies that carry them
/// and do not turn; empty where they do not.
std::vector<int> holders(const fem::DofMap& dofs, const std::vector<int>& place,
                         const Eigen::Vector3d& axis) {
  std::map<int, int> carried;
  for (const fem::Tie& tie : dofs.ties()) carried[tie.node] = tie.master;
  std::set<int> found;
  for (int node : place) {
    const bool is_carried = carried.contains(node);
    for (auto by = carried.find(node); by != carried.end(); by = carried.find(node)) node = by->second;
    for (int c = 0; c < fem::DofMap::components; ++c) {
      const int e = dofs.equation(node, c);
      const bool asked = c < 3 ? axis[c] != 0 : is_carried;
      if (asked && e != fem::DofMap::absent && !dofs.is_held(e)) return {};
      if (c < 3 && asked && e == fem::DofMap::absent) return {};
    }
    found.insert(node);
  }
  return {found.begin(), found.end()};
}

/// As the supports of a place move, by differences of the forces and the tangent of what is free.
Give give_of_held(fem::Equilibrium& equilibrium, const fem::State& state, const std::vector<int>& nodes,
                  const Eigen::Vector3d& axis) {
  constexpr double step = 3e-7; // of the extent
  const fem::Model& model = equilibrium.model();
  const Eigen::Index free = model.dofs.free_count(), all = free + model.dofs.held_count();
  Give give{Eigen::VectorXd::Zero(all)};
  for (const int node : nodes)
    for (int c = 0; c < 3; ++c)
      if (axis[c] != 0) give.displacement[model.dofs.equation(node, c)] = axis[c];
  Eigen::VectorXd change = Eigen::VectorXd::Zero(all);
  for (const double way : {step * model.extent, -step * model.extent}) {
    fem::State moved = state;
    for (const int node : nodes) moved.displacement[static_cast<std::size_t>(node)] += way * axis;
    model.dofs.carry(moved);
    fem::Balance balance;
    equilibrium.balance(moved, balance);
    change += balance.force.head(all) / (2 * way);
  }
  Eigen::VectorXd follows;
  if (!equilibrium.factor(state)) return {};
  equilibrium.tangent().solve(-change.head(free), follows);
  give.displacement.head(free) = follows;
  give.force = give.displacement.dot(change);
  return give;
}

/// Where the place is free a force, spread evenly over it, moves it.
Give give_of(const Probing& probing, const std::string& place, const Measured& measured,
             const fem::State& state) {
  if (probing.device.free_body) return {}; // it goes along
  const Eigen::Vector3d axis = probing.axis();
  const fem::DofMap& dofs = probing.device.model.dofs;
  const auto& nodes = probing.device.mesh.node_sets.at(place);
  const std::vector<double>& shares = probing.device.shares.at(place).of_nodes;
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(dofs.count());
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(nodes[n], c); e != fem::DofMap::absent) unit[e] += shares[n] * axis[c];
  unit = (dofs.jacobian(state).transpose() * unit).eval();
  const std::vector<int> held = unit.isZero() ? holders(dofs, nodes, axis) : std::vector<int>{};
  if ((unit.isZero() && held.empty()) || !at_rest(measured)) return {};
  if (!held.empty()) return give_of_held(measured.equilibrium, state, held, axis);
  if (!measured.equilibrium.factor(state)) return {};
  Give give;
  measured.equilibrium.tangent().solve(unit, give.displacement);
  const double own = unit.dot(give.displacement);
  give.displacement /= own;
  give.force = 1 / own;
  return give;
}

/// With the charge Q = C(u) Phi the electrode pulls with Phi^2/2 dC/du; that moves the place by Phi^2/2 times
/// the flexibility's product with dC/du, and the force that takes it back is that over its own. Capacitance
/// and length are those as drawn: a strip free across itself has 1/2, one of held width 1. Of wrinkled film C
/// depends on the voltage, too: what another volt adds, per Phi.
double coupling(const Probing& probing, const Measured& measured) {
  const fem::Model& model = probing.device.model;
  const std::size_t e = probing.electrode();
  fem::State connected = fem::relaxed(measured.state);
  connected.supply[e] = fem::Supply::voltage; // which the force is per square of, whoever has charged it
  const Give give = give_of(probing, probing.quantity.place, measured, connected);
  if (std::isnan(give.force)) return no_value;
  constexpr double hardly_any = 1e-6; // V
  fem::State charged = measured.state;
  double& voltage = charged.voltage[e];
  if (std::abs(voltage) < hardly_any) voltage = hardly_any;
  charged.sheet_drop.setZero();
  fem::Charges charges = model.charges(charged, true);
  model.dofs.gather(charged, charges.coupling[e]);
  const double force =
      charges.coupling[e].head(give.displacement.size()).dot(give.displacement) / (2 * voltage);
  const double drawn = model.charges(model.initial_state(), false).capacitance[e] -
                       probing.one.electrodes[e].stray_capacitance;
  return force * probing.quantity.length / drawn;
}

/// From the lowest, negative ones first. NaN where nothing has a mass, or the state is not at rest.
double modal_stiffness(const Probing& probing, const Measured& measured) {
  if (!at_rest(measured)) return no_value;
  const Quantity& quantity = probing.quantity;
  WithoutPins loose(probing.one, probing.device, measured.equilibrium, measured.state);
  const auto modes = fem::vibration_modes(loose.equilibrium(), loose.state(),
                                          {.count = quantity.mode, .drifts = loose.drifts()});
  if (!modes || std::ssize(*modes) < quantity.mode) return no_value;
  return (*modes)[static_cast<std::size_t>(quantity.mode) - 1].stiffness;
}

std::vector<Key> coupling_keys() {
  return {
      electrode_key(),
      text("place", to(&Quantity::place), "the place that would be held").refers_to(Reference::place),
      measure("length", "m", to(&Quantity::length), "length of the electrode along the axis, as drawn")
          .above(0),
      word("along", axes_and_gravity(), to(&Quantity::along), "direction").only_with(when::moves_along_it())};
}

std::vector<Key> mode_keys() {
  return {integer("mode", to(&Quantity::mode), "its number, from the lowest frequency")
              .at_least(1)
              .at_most(100)
              .otherwise("1")};
}

/// What slides goes on sliding or sticks, as it is pushed on or back.
std::string with_friction(const Case& one) {
  return slides_with_friction(one) ? "has no value here: with friction it depends on the way to go on" : "";
}

std::string without_support(const Case& one, const Quantity& quantity) {
  if (const std::string slides = with_friction(one); !slides.empty()) return slides;
  const auto at = std::ranges::find(one.steps, quantity.at, &Step::name);
  const Holding holding = holding_in(one, one.steps, static_cast<int>(at - one.steps.begin()));
  return is_free(one, holding.supports)
             ? "has no value here: nothing holds the device, a force takes it along; hold it with [[support]]"
             : "";
}

std::string without_mass(const Case& one, const Quantity&) {
  return has_mass(one) ? with_friction(one) : "has no value here: nothing has a mass";
}

} // namespace

std::vector<QuantityKind> stiffness_kinds() {
  return {
      {.word = "stiffness",
       .meaning =
           "force on a place per displacement along an axis, branches relaxed; of one that supports hold as "
           "they move; none where the state is not at rest (N/m)",
       .unit = "N/m",
       .keys =
           [] {
             return std::vector<Key>{place_key(), axis_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("force on {} per displacement{}{}", q.of, along_words(q), at_words(q));
           },
       .probe = [](const Probing& probing) -> Probe {
         return [probing](const Measured& measured) {
           return give_of(probing, probing.quantity.of, measured, fem::relaxed(measured.state)).force;
         };
       },
       .idle = without_support,
       .shares = true},
      {.word = "coupling",
       .meaning =
           "force on a held place per squared voltage, over the capacitance per length of what the "
           "electrode covers, both as drawn, branches relaxed; none where the state is not at rest (-)",
       .unit = "1",
       .keys = coupling_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format(
                 "force on {} held{} per squared voltage of {}, over its drawn capacitance per length{}",
                 q.place, along_words(q), q.of, at_words(q));
           },
       .probe = [](const Probing& probing) -> Probe {
         return [probing](const Measured& measured) { return coupling(probing, measured); };
       },
       .idle = without_support,
       .shares = true},
      {.word = "natural frequency",
       .meaning = "of small vibrations about the state, at given voltages or charges as the state is held, "
                  "branches relaxed, those of a device that nothing holds without its rigid motions; none "
                  "where it is not at rest (rad/s)",
       .unit = "rad/s",
       .keys = mode_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format("natural frequency number {}{}", q.mode, at_words(q));
           },
       .probe = [](const Probing& probing) -> Probe {
         return [probing](const Measured& measured) { // NaN where it is unstable
           return std::sqrt(modal_stiffness(probing, measured));
         };
       },
       .idle = without_mass,
       .vibrates = true},
      {.word = "modal stiffness",
       .meaning =
           "square of a natural frequency, from the lowest: negative where the state is unstable (1/s^2)",
       .unit = "1/s^2",
       .keys = mode_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format("square of natural frequency number {}, negative where it is unstable{}",
                                q.mode, at_words(q));
           },
       .probe = [](const Probing& probing) -> Probe {
         return [probing](const Measured& measured) { return modal_stiffness(probing, measured); };
       },
       .idle = without_mass,
       .vibrates = true},
  };
}

} // namespace dielast::cases
