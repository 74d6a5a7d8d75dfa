// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "fem/model/inertia.hpp"
#include "fem/model/ports.hpp"
#include "fem/model/turnover.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace dielast::fem {

/// The sum of its terms, and its constraints. The solver sees only this.
struct Model {
  DofMap dofs;
  std::vector<std::unique_ptr<ElementBlock>> blocks;
  Ports ports;             ///< a state has one voltage (pressure) for each; at most one chamber
  double length_scale = 1; ///< m, an element's size: makes moments comparable with forces in residual norms
  double extent = 1;       ///< m, the whole mesh's: tells which forces are round-off
  std::vector<Eigen::Vector3d>
      drawn; ///< m, nodes of the mesh; needed for `corners` and where a film starts without tension
  std::vector<ElementCorners> corners; ///< of the elements that no increment may turn over; may be empty
  mutable std::optional<Inertia> known_inertia{}; ///< see inertia()

  /// Of the blocks and unknowns as they are when it is first asked for: most models never move in time.
  const Inertia& inertia() const;

  /// Tells every block and the ports where their internal variables and the points of sheets are; to be
  /// called once, when they are there. Throws std::invalid_argument for sheets that cannot be.
  void place_histories();
  /// Everything at rest as drawn: no displacement, no voltage, no dead force; branches relaxed.
  State initial_state() const;

  Samples sample(const State& state) const;
  /// Of the electrodes, C, and volumes of chambers, m^3, by ports.
  Charges charges(const State& state, bool with_coupling) const;
  /// dQ/dPhi of an electrode at fixed displacements, the potentials of solids in equilibrium, F; without such
  /// it is Charges::capacitance.
  double capacitance(const State& state, std::size_t electrode) const;
  /// Puts the potentials of solids in equilibrium with the state's voltages and displacements.
  void balance_fields(State& state) const;
  /// The same with what the circuits draw added, and less what there is given: `charge` is 0 in balance.
  Charges surplus(const State& state, bool with_coupling) const;
  SheetMatrices sheet_matrices(const State& state) const;
  EnergyParts energies(const State& state) const;
  /// Puts the charges that the electrodes hold at `state` into the memory of the circuits.
  void charge_circuits(State& state) const;
  /// The history after a converged state that state.scheme led to: the next increment starts from it.
  std::shared_ptr<const History> advanced_history(const State& state) const;
  /// A converged state as the next increment starts from it: with that history, its dashpots frozen, and the
  /// motion that it has arrived with.
  State settled(State state) const;
  /// Moves the free unknowns along `direction` until the closed chamber has the volume that it must have at
  /// the state's pressure, to rounding. False where there is no such place.
  [[nodiscard]] bool fill(State& state, const Eigen::VectorXd& direction) const;

 private:
  /// m^3, below which a chamber's compliance stays as it is: an empty one's is none.
  double least_volume() const { return 1e-12 * extent * extent * extent; }
};

} // namespace dielast::fem
