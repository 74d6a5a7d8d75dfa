#pragma once

#include "fem/equilibrium.hpp"

#include <deque>

namespace dielast::fem {

/// What a state contributes to the energy balance.
struct EnergyPoint {
  double parameter = 0;            ///< place on the path, increasing
  double time = 0;                 ///< s
  Eigen::VectorXd force, position; ///< per equation: external forces (reactions at held ones), displacements
  std::vector<double> voltage, charge; ///< per electrode, V and C
  EnergyParts energy;
};

/// Work done since the beginning, J.
struct Work {
  double electrical = 0; ///< by the sources: sum of int Phi dQ
  double mechanical = 0; ///< by loads and moved supports: int f . du
  double dissipated = 0; ///< in the dashpots: int power dt
  double released = 0;   ///< when the device is cut free or jumps: what neither source nor load accounts for
};

/// The energy balance of a run: electrical + mechanical work = change of stored energy + dissipated +
/// released.
///
/// Both works are integrals along the path, of which only the accepted states are known. They are taken of
/// the polynomials through up to `most_points` neighbouring states, in the path's parameter, so that the
/// balance closes far better than with the trapezoidal rule; what is left tells how well the increments
/// resolve the path and, in time, the flow of the dashpots.
class EnergyBalance {
 public:
  static constexpr std::size_t most_points = 12;

  /// The next accepted state on a smooth path.
  void add(EnergyPoint point);
  /// The path has a corner at the last state: polynomials do not reach across it.
  void corner();
  /// The next state was reached by a jump at fixed loads.
  void add_after_jump(EnergyPoint point);
  /// The next state was reached by taking away a frame that did no work.
  void add_cut_free(EnergyPoint point);

  Work work() const;
  double stored() const;
  /// Work - change of stored energy - dissipated - released, J: 0 if everything were resolved.
  double error() const { return error(work()); }
  /// The same, where work() is known already.
  double error(const Work& work) const;

  bool empty() const { return record_.window.empty(); }

  /// All there is, for a checkpoint.
  struct Record {
    Work settled;
    double stored_at_start = 0;
    bool first_settled = false;
    std::deque<EnergyPoint> window;
  };
  const Record& record() const { return record_; }
  explicit EnergyBalance(Record record) : record_(std::move(record)) {}
  EnergyBalance() = default;

 private:
  Work over(std::size_t first, std::size_t last) const;

  Record record_;
};

/// Collects an energy point at an equilibrium.
EnergyPoint energy_point(Equilibrium& equilibrium, const State& state, double parameter);

} // namespace dielast::fem
