// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/runs/phases.hpp"

#include "cases/devices/pins.hpp"
#include "cases/runs/simulation.hpp"
#include "cases/text/diagnostics.hpp"
#include "fem/paths/renumbering.hpp"
#include "post/engineering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

namespace dielast::cases {

namespace {

/// What a support moves along an axis.
struct Move {
  const Case& one;
  std::size_t number; ///< of the support
  int axis;

  const Support& support() const { return one.supports[number]; }
  const std::optional<Waveform>& wave() const { return support().motion[static_cast<std::size_t>(axis)]; }
  /// In a transient by a controller.
  bool is_controlled() const {
    return std::ranges::any_of(one.controllers, [&](const Controller& own) {
      return own.drives == DrivenLoad{Driven::displacement, support().place, axis};
    });
  }
  bool moves_in(const Step& step) const {
    return support().fixed[static_cast<std::size_t>(axis)] &&
           (wave() || (step.kind == StepKind::transient && is_controlled()));
  }
  /// Precondition: both move in that step.
  bool is_like(const Move& other, const Step& step) const {
    if (step.kind == StepKind::move) return wave()->before(0) == other.wave()->before(0);
    if (is_controlled() || other.is_controlled())
      return support().place == other.support().place && axis == other.axis;
    return *wave() == *other.wave();
  }
  bool meets(const Move& other, const meshing::Mesh& mesh, const fem::DofMap& dofs) const {
    std::vector<int> moved;
    for (const int node : mesh.node_sets.at(support().place)) moved.push_back(dofs.equation(node, axis));
    std::ranges::sort(moved);
    return std::ranges::any_of(mesh.node_sets.at(other.support().place), [&](int node) {
      const int e = dofs.equation(node, other.axis);
      return e != fem::DofMap::absent && std::ranges::binary_search(moved, e);
    });
  }
  std::string key() const { return fmt::format("support[{}].displacement.{}", number + 1, "xyz"[axis]); }
  /// Where it is written, or what has brought it.
  std::string origin() const {
    if (support().standard) return one.pivot && one.pivot->body == support().place ? "[pivot]" : "[patch]";
    const int line = one.where(key()).line;
    return key() + (line > 0 ? fmt::format(" (line {})", line) : "");
  }
};

} // namespace

void require_one_motion(const Case& one, const meshing::Mesh& mesh, const fem::DofMap& dofs) {
  for (std::size_t s = 0; s < one.steps.size(); ++s) {
    const Step& step = one.steps[s];
    if (step.kind != StepKind::move && step.kind != StepKind::transient) continue;
    const std::vector<char> holding = holding_in(one, one.steps, static_cast<int>(s)).supports;
    std::vector<Move> moves;
    for (std::size_t i = 0; i < one.supports.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        if (const Move move{one, i, axis}; holding[i] && move.moves_in(step)) moves.push_back(move);
    for (std::size_t b = 1; b < moves.size(); ++b)
      for (std::size_t a = 0; a < b; ++a) {
        if (moves[a].is_like(moves[b], step) || !moves[a].meets(moves[b], mesh, dofs)) continue;
        const bool swapped = moves[b].support().standard; // it is not written
        const Move &told = moves[swapped ? a : b], &other = moves[swapped ? b : a];
        throw one.error_at(
            told.key(),
            fmt::format("in step \"{}\" it moves nodes of \"{}\" that {} moves elsewhere, as a part of "
                        "\"{}\"; let both say the same, or let them hold in different steps",
                        step.name, told.support().place, other.origin(), other.support().place));
      }
  }
}

void require_devices(const Case& one, const std::vector<Step>& steps, const Holding& first) {
  std::vector<Holding> built{first};
  for (int step = 0; step < std::ssize(steps); ++step) {
    Holding later = holding_in(one, steps, step);
    if (std::ranges::count(built, later) > 0) continue;
    build_device(held_by(one, later));
    built.push_back(std::move(later));
  }
}

/// Supports let go and take hold at the beginning of the current step. What lets go hands its forces to the
/// loads, so that the state stays in balance.
void Simulation::change_supports(fem::State& state) {
  loads_->let_go.resize(0);
  if (holding_in(case_, steps_, step_) == holding_) return;
  const fem::DofMap before = device_.model.dofs;
  Eigen::VectorXd reaction = fem::reactions(device_.model, state, held_);
  if (holding_.pins) reaction.setZero(); // it is rounding
  if (auto lying = upright(device_, state); lying && case_.loads.empty()) state = *std::move(lying);
  enter(step_);
  const fem::Renumbering renumbered(before, device_.model.dofs);
  const Eigen::VectorXd let_go = renumbered.let_go(reaction);
  state = renumbered(std::move(state));
  state.dead_force += let_go;
  if (!let_go.isZero(0)) loads_->let_go = let_go;
  fem::EnergyBalance::Record record = energy_.record();
  for (fem::EnergyPoint& point : record.points)
    for (Eigen::VectorXd* part : {&point.mechanical.force, &point.mechanical.coordinate})
      *part = renumbered(*part);
  if (state.motion && !holding_.pins) catch_what_moves(state, record);
  energy_ = fem::EnergyBalance(std::move(record));
  come_to(state);
  measurement_.all({device_, *equilibrium_, state, energy_, scalars_, &held_}); // courses go on from there
}

void Simulation::enter(int step) {
  Holding holding = holding_in(case_, steps_, step);
  if (holding == holding_) return;
  holding_ = std::move(holding);
  const fem::DofMap before = device_.model.dofs;
  now_ = held_by(case_, holding_);
  equilibrium_.reset();
  device_ = build_device(now_);
  measurement_.prepare();
  watch_.prepare();
  equilibrium_.emplace(device_.model, threads_);
  frame_ = fem::Renumbering(before, device_.model.dofs)(frame_);
  loads_.emplace(now_, device_, steps_, signals_, frame_);
}

/// Pins bear nothing where all forces balance, but for what a device that turns in them as it strains would
/// do about itself: one whose nodes do not lie along the axes, or lie there no more, is strained by them.
/// Then refusal_ says so.
bool Simulation::pins_bear(const fem::State& given) {
  if (device_.pins.empty()) return false;
  constexpr double notable = 1e-3,
                   nothing = 1e-6; // of the largest nodal forces; of those that would strain it by one
  fem::State state = given;
  fem::Balance balance;
  equilibrium_->balance(state, balance);
  double borne = 0;
  for (const auto& [node, axis] : device_.pins)
    borne = std::max(borne, std::abs(balance.force[device_.model.dofs.equation(node, axis)]));
  const double stiff = equilibrium_->energy_scale() / device_.model.extent;
  if (borne <= std::max(notable * balance.scale, nothing * stiff)) return false;
  refusal_ = {
      Ending::gave_up, "no supports",
      fmt::format(
          "step \"{}\" stopped: nothing holds the device, and what keeps it from turning, nodes along the "
          "axes of the drawing, bears {} and strains it; draw it along x, or hold it by a [[support]]",
          steps_[static_cast<std::size_t>(step_)].name, post::engineering(borne, "N"))};
  return true;
}

/// What supports take hold of stands at once: as by a blow, its kinetic energy is released.
void Simulation::catch_what_moves(const fem::State& state, fem::EnergyBalance::Record& record) {
  constexpr double least = 1e-6; // of all that was exchanged, to be told
  double& kinetic = record.points.back().energy.kinetic;
  const double left = device_.model.energies(state).kinetic, lost = kinetic - left;
  kinetic = left;
  record.work.released += lost;
  if (lost <= least * record.exchanged) return;
  news_.push_back({"caught", "",
                   fmt::format("step \"{}\" begins with a support that takes hold of what moves: it stands "
                               "at once, and {} of kinetic energy were released",
                               steps_[static_cast<std::size_t>(step_)].name, post::engineering(lost, "J")),
                   post::Moment{0, state.time, voltages(state)}});
}

} // namespace dielast::cases
