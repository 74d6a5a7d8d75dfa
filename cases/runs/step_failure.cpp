// SPDX-License-Identifier: GPL-3.0-or-later
// Why a step ends where it does not end by itself.
#include "cases/runs/step_run.hpp"
#include "fem/equilibrium/lowest_mode.hpp"
#include "fem/linear/rest.hpp"
#include "fem/model/contact_block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases {

namespace {

/// Eigenvalue of a mode, over the stiffness as drawn, that is one of rounding.
constexpr double no_stiffness = 1e-10;
constexpr const char* can_move =
    "the tangent is singular. Part of the device can move freely, or the state is a critical one: hold what "
    "is loose with [[support]], the edge of a shell or of beams by its turns, too, a [[body]] by its fix; "
    "with model = \"3d\" an unstretched film has no "
    "stiffness normal to itself: stretch it or use model = \"planar\"";
/// Of what friction may hold, but for what barriers and springs leave of it.
constexpr double all_of_it = 0.99;

} // namespace

/// Integration points at which wrinkled film has no width that balances the field of these loads, and how
/// many there are; empty where there is none.
std::vector<std::size_t> StepRun::lost_film(double s) const {
  const auto film = model().sample(loaded(last(), s)).film;
  const auto lost =
      static_cast<std::size_t>(std::ranges::count_if(film, [](const fem::MembraneSample& sample) {
        return sample.tension == materials::Tension::lost && sample.voltage != 0;
      }));
  return lost == 0 ? std::vector<std::size_t>{} : std::vector{lost, film.size()};
}

/// Whether a motion meets no stiffness in the last state: the sign of its eigenvalue is then one of rounding.
bool StepRun::moves_freely() const {
  const auto mode = fem::lowest_mode(equilibrium_, loaded(last(), progress_.ramp.load_factor));
  return mode && std::abs(mode->eigenvalue) < no_stiffness;
}

Outcome end_at_rest(fem::Equilibrium& equilibrium, const fem::State& last) {
  if (!fem::moves_freely(equilibrium, last)) return {};
  return {Ending::gave_up, "singular tangent", fmt::format("at the end {}", can_move)};
}

Outcome StepRun::failure(const Trouble& trouble) const {
  Outcome outcome = cause(trouble, ways_on_);
  if (!timed() && fem::skew_stiffness(equilibrium_, last()) > fem::negligible_skew)
    outcome.message +=
        ". Moments about axes that stay act on what turns about several axes: what is judged here leaves "
        "out a part of their stiffness, so the path may well go on, as on_instability = \"follow\" or "
        "another order of loads shows";
  if (fem::has_friction(model()) && fem::contact_force(model(), last()) > equilibrium_.round_off())
    outcome.message += ". Where friction takes hold of much at once, more increments may lead on";
  return outcome;
}

std::string WaysOn::words() const {
  return fmt::format("{}{}{}", follow ? "\"follow\"" : "", follow && jump ? " or " : "",
                     jump ? "\"jump\"" : "");
}

Outcome StepRun::singular() const {
  return {Ending::gave_up, "singular tangent",
          fmt::format("step \"{}\" stopped at {}: {}", step_.name, load_text(progress_.ramp.load_factor),
                      can_move)};
}

Outcome StepRun::cause(const Trouble& trouble, WaysOn ways_on) const {
  const double reached = progress_.ramp.load_factor;
  if (trouble.ramp.failure.outcome == fem::Outcome::singular) return singular();
  if (fem::edges_meet(model(), last()))
    return {Ending::gave_up, "edges meet",
            fmt::format("step \"{}\" stopped at {}: edges of surfaces in [contact] meet between the points "
                        "at which the barrier acts; round them, or refine the mesh along them",
                        step_.name, load_text(reached))};
  if (const auto lost = lost_film(trouble.ramp.failed_at); !lost.empty())
    return {Ending::gave_up, "electromechanical loss",
            fmt::format("step \"{}\" stopped at {}: beyond it the field pulls wrinkled film wider without "
                        "limit (in {} of {} integration points at {}), whatever its wrinkles take up. Lower "
                        "the drive or stretch the film more",
                        step_.name, load_text(reached), lost[0], lost[1], load_text(trouble.ramp.failed_at))};
  // without tension, or stiffness, any load leads far away, and seems to be too large
  if (reached == 0 && !timed() && fem::moves_freely(equilibrium_, loaded(last(), 0))) return singular();
  if (!trouble.critical && !timed() && is_slack())
    return {Ending::gave_up, "slack film",
            fmt::format("slack film: step \"{}\" stopped at {}, where the film carries no tension, and no "
                        "state was found in which it carries the loads at {}. {}",
                        step_.name, load_text(reached), load_text(trouble.ramp.failed_at),
                        options_.newton.wrinkles
                            ? "Stretch it a little"
                            : "Let it wrinkle (wrinkling = \"tension field\") or stretch it a little, or let "
                              "solver.smallest_increment be smaller")};
  const std::string ways = ways_on.words();
  const std::string go_on = ways.empty() ? "" : "; or let the step go on with on_instability = " + ways;
  const std::string more =
      " Lower what drives it, or stiffen the device or stretch the film more, to stay below it" + go_on;
  const char* of_edges =
      fem::contact_pressure(model(), last()).empty() || fem::contact_force(model(), last(), "") == 0
          ? ""
          : ". Where surfaces in [contact] end on each other an edge may slip off: let one reach over the "
            "other by contact.thickness, or refine the mesh there. Where the nodes of both stand over each "
            "other, as in symmetric devices, move one part along by 1e-3 of an element, or model one half";
  if (trouble.critical) {
    const bool branches_off = trouble.critical->kind == fem::Instability::bifurcation;
    const bool may_switch =
        branches_off && step_.on_bifurcation != OnBifurcation::switch_branch && ways_on.follow;
    if (timed())
      return {
          Ending::gave_up, "limit point",
          fmt::format(
              "limit point near {}, at {:.4g} s: beyond it no equilibrium follows at the pace of the step.{}",
              load_text(last(), reached), last().time, more)};
    return {
        Ending::gave_up, "limit point",
        fmt::format(
            "limit point near {}: equilibrium found {}, none {}at {}{}.{}",
            load_text(trouble.critical->load_factor),
            reached > 0 ? "up to " + load_text(reached) : "at the beginning of the step",
            trouble.unstable_modes > 0 ? "that is stable " : "", load_text(trouble.ramp.failed_at),
            branches_off ? "; a mode that the load does no work on (a bifurcation) makes it unstable" : "",
            more +
                (may_switch ? ", or along the branch that leaves there with on_bifurcation = \"switch\""
                            : "") +
                of_edges)};
  }
  const bool off_path = trouble.ramp.failure.outcome == fem::Outcome::off_path;
  if ((trouble.unstable_modes > 0 || off_path) && moves_freely()) return singular();
  if (trouble.unstable_modes > 0)
    return {Ending::gave_up, "instability",
            fmt::format(
                "step \"{}\" stopped at {}: the equilibrium at {} has {} unstable mode{}, so a device would "
                "leave it. Change what makes it unstable (compressed film, a voltage beyond a limit point){}",
                step_.name, load_text(reached), load_text(trouble.ramp.failed_at), trouble.unstable_modes,
                trouble.unstable_modes == 1 ? "" : "s", go_on)};
  if (off_path)
    return {Ending::gave_up, "limit point",
            fmt::format("limit point near {}: however small the increment, Newton's method finds only states "
                        "of another branch beyond it.{}",
                        load_text(last(), reached), more)};
  if (!timed() && fem::moves_freely(equilibrium_, loaded(last(), reached))) return singular();
  const char* slides =
      fem::friction_in_use(model(), last()) < all_of_it
          ? "A"
          : "All that is pressed slides: what nothing but friction holds has no equilibrium. Otherwise a";
  return {Ending::gave_up, "no equilibrium",
          fmt::format("step \"{}\" stopped at {}: no equilibrium found at {}, and the increments are smaller "
                      "than solver.smallest_increment. {} finer mesh may help, a smaller "
                      "solver.smallest_increment or more solver.max_iterations{}",
                      step_.name, load_text(reached), load_text(trouble.ramp.failed_at), slides,
                      timed() ? go_on : "")};
}

} // namespace dielast::cases
