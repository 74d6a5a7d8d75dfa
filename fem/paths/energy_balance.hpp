// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/energy_point.hpp"

#include <vector>

namespace dielast::fem {

/// Work done since the beginning, J.
struct Work {
  double electrical = 0; ///< on electrodes and film: sum of int Phi dQ, and what leaks takes out of sheets
  double mechanical = 0; ///< by loads and moved supports: int f . du
  double dissipated = 0; ///< in dashpots, dampers and sheets; never falls
  double released = 0;   ///< when the device is cut free or jumps: what neither source nor load accounts for
  double resistance = 0; ///< heat in the resistances (and limits of current) of circuits
  double leak = 0;       ///< heat in leaking films

  /// What the sources of circuits gave: int U i dt.
  double source() const { return electrical + resistance + leak; }
};

/// The energy balance of a run, increment by increment: electrical + mechanical work = change of stored
/// energy + dissipated + released.
///
/// A work is the integral of a force along an increment: the trapezoidal rule, corrected by the curvature of
/// the path through the increment before (order 4). It is exact for forces or coordinates that stay. What the
/// balance then leaves belongs to the works whose forces and coordinates both change, in proportion to the
/// products of these changes; so that works of quasi-static increments in which one load changes are changes
/// of a potential, whatever the size of the increment. Where no such work is done, and where dashpots are let
/// go while the loads stay, the rest is heat. With
/// inertia the rest stays: it is the error of the time scheme. Where supports strike masses the force has no
/// value of its own: the work of the impulse is added (work_of_impulses()).
///
/// Dashpots turn into heat the power of their flow rules, a sum of squares. Where its integral is not close
/// to what the energy loses at fixed shape, between the dashpots' states at both ends of an increment, the
/// increment is too long for it, and the latter is the heat: robust, but of lower order.
///
/// Where a source that drives a sheet's terminal jumps, the charge of the nodes there stands for what flows
/// into the film about them right after the jump: the source gives it at its new voltage, and what is not
/// stored of that is heat in the sheet.
class EnergyBalance {
 public:
  /// The next accepted state on a smooth path.
  void add(EnergyPoint point);
  /// The path has a corner at the last state: no curvature is taken across it.
  void corner();
  /// Sources are connected otherwise from the last state on, which is that of `point`.
  void reconnect(const EnergyPoint& point);
  /// Energy that a jump set free, J. Loads that went on meanwhile did their work at forces between those at
  /// both ends, which is known no better than to `doubt`.
  struct JumpRelease {
    double energy = 0, doubt = 0;
  };
  /// The next state was reached by a jump, at fixed loads or at loads that went on a little meanwhile.
  JumpRelease add_after_jump(EnergyPoint point);
  /// From the last state on these dead forces are taken away: what they would do is released.
  void cut(const Eigen::VectorXd& forces) {
    record_.points.back().mechanical.force.head(forces.size()) -= forces;
    corner();
  }
  /// The next state was reached on that way; its forces are without what is left of those.
  void add_cut_free(EnergyPoint point);

  const Work& work() const { return record_.work; }
  double stored() const;
  const EnergyParts& parts() const { return record_.points.back().energy; }
  /// Estimate of the error of works and heat, J, not negative: sums of what rules of different order differ
  /// by, and what the balance leaves where nothing can take it.
  double error() const;
  /// An error beside the energies that it is compared with, J.
  struct Resolution {
    double error = 0;     ///< beyond rounding
    double exchanged = 0; ///< largest energy so far that went in or out, was stored or turned into heat, and
                          ///< was known to half of itself at least; without what cuts set free,
                          ///< unless `given`
    bool given = false;   ///< of all that sources gave, the heat of resistances and leaks, too, or without it
    double told = 0;      ///< error() then, rounding included
    int row = 0, step = 0; ///< of the result
    /// Beyond 1 % of what was exchanged.
    bool is_poor() const { return error > 0.01 * exchanged; }
  };
  /// Takes notice of the last state as a result, the run's `row`th, in the `step`th of its steps. `scale`:
  /// Equilibrium::energy_scale(), J.
  void judge(double scale, int row = 0, int step = 0);
  /// Of the worst result so far. A result that has exchanged less than a thousandth of what the run has so
  /// far, cuts included, is compared with that thousandth: about an instant at which a wave sets in, every
  /// rule is poor.
  Resolution worst() const;

  bool empty() const { return record_.points.empty(); }

  /// All there is, for a checkpoint.
  struct Record {
    Work work;
    double stored_at_start = 0, exchanged = 0;
    double given = 0;                ///< `exchanged` with the heat of resistances and leaks, J
    double cut = 0;                  ///< what cuts set free, J
    double without_cuts = 0;         ///< `exchanged` but for that, J
    double doubt = 0;                ///< sum of differences of rules, J
    double doubt_of_circuits = 0;    ///< likewise, of the heat of resistances and leaks
    double rest = 0;                 ///< left by the balance where nothing can take it, J
    std::vector<Resolution> poor;    ///< results that are, or may become, the worst; ratios of errors fall
    std::vector<EnergyPoint> points; ///< the last one, and the one before where no corner is between
    Eigen::VectorXd before_jump;     ///< charges per port from which those of a jump are counted, C
  };
  const Record& record() const { return record_; }
  explicit EnergyBalance(Record record) : record_(std::move(record)) {}
  EnergyBalance() = default;

 private:
  double given_at_jump(const EnergyPoint& point) const;
  void account(const EnergyPoint& point, bool is_cut = false);
  void stand();
  void arrive(EnergyPoint point);
  Resolution weighed(const Resolution& result) const;

  Record record_;
};

} // namespace dielast::fem
