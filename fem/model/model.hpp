// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/chamber.hpp"
#include "fem/model/circuit.hpp"
#include "fem/model/element_block.hpp"
#include "fem/model/inertia.hpp"
#include "fem/model/turnover.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace dielast::fem {

/// The sum of its terms, and its constraints. The solver sees only this.
struct Model {
  DofMap dofs;
  std::vector<std::unique_ptr<ElementBlock>> blocks;
  std::vector<std::string> electrodes; ///< names; a state has one voltage for each
  std::vector<Chamber> chambers; ///< at most one; a state has one pressure for each, behind the voltages
  std::vector<Circuit> circuits; ///< at most one per electrode
  std::vector<Sheet> sheets;     ///< at most one per electrode
  Inertia inertia;               ///< Inertia::of(blocks, dofs), where something has a mass
  double length_scale = 1; ///< m, an element's size: makes moments comparable with forces in residual norms
  double extent = 1;       ///< m, the whole mesh's: tells which forces are round-off
  std::vector<Eigen::Vector3d>
      drawn; ///< m, nodes of the mesh; needed for `corners` and where a film starts without tension
  std::vector<ElementCorners> corners; ///< of the elements that no increment may turn over; may be empty

  std::size_t circuit_history = 0; ///< place of the first circuit's internal variable, by place_histories()
  std::vector<SheetPoint> sheet_points; ///< theirs come behind the circuits'; by place_histories(), too

  std::size_t port_count() const { return electrodes.size() + chambers.size(); }
  /// Tells every block where its internal variables and the points of its sheets are; to be called once, when
  /// blocks, circuits and sheets are there. Throws std::invalid_argument for sheets that cannot be.
  void place_histories();
  /// Everything at rest as drawn: no displacement, no voltage, no dead force; branches relaxed.
  State initial_state() const;

  Samples sample(const State& state) const;
  /// Of the electrodes, C, and the volumes of the chambers, m^3.
  Charges charges(const State& state, bool with_coupling) const;
  /// dQ/dPhi of an electrode at fixed displacements, the potentials of solids in equilibrium, F; without such
  /// it is Charges::capacitance.
  double capacitance(const State& state, std::size_t electrode) const;
  /// Puts the potentials of solids in equilibrium with the state's voltages and displacements.
  void balance_fields(State& state) const;
  /// The same with what the circuits draw added, and less what there is given: `charge` is 0 in balance.
  Charges surplus(const State& state, bool with_coupling) const;
  /// Energy that goes with it: the sum of the integrals of given minus drawn charge over voltage, J.
  double supply_energy(const State& state) const;
  const Circuit* circuit_of(std::size_t electrode) const;
  /// What the circuit of an electrode whose supply `flows` takes over the time step that the state ends.
  Circuit::Drawn taken(const State& state, std::size_t electrode) const;
  /// What leaks of an electrode, A: under a sheet by the voltages there.
  double leak(const State& state, std::size_t electrode) const;
  SheetMatrices sheet_matrices(const State& state) const;
  /// (h1 q_n + h2 q_{n-1})/a0 of the charges at the points of the sheets, C.
  Eigen::VectorXd past_sheet_charges(const State& state) const;
  EnergyParts energies(const State& state) const;
  /// Puts the charges that the electrodes hold at `state` into the memory of the circuits.
  void charge_circuits(State& state) const;
  /// The history after a converged state that state.scheme led to: the next increment starts from it.
  std::shared_ptr<const History> advanced_history(const State& state) const;
  /// A converged state as the next increment starts from it: with that history, its dashpots frozen, and the
  /// motion that it has arrived with.
  State settled(State state) const;
  /// What an electrode must hold, with what its circuit has drawn, C; the own volume that a chamber of a
  /// given pumped volume must have at the state's pressure, m^3.
  double given_charge(const State& state, std::size_t port) const;
  /// Port of the chamber whose pumped volume is given; nothing: there is none, or its pressure is.
  std::optional<std::size_t> closed_chamber(const State& state) const;
  /// Moves the free unknowns along `direction` until the closed chamber has the volume that it must have at
  /// the state's pressure, to rounding. False where there is no such place.
  [[nodiscard]] bool fill(State& state, const Eigen::VectorXd& direction) const;
  /// Null: the port is an electrode.
  const Chamber* chamber_of(std::size_t port) const {
    return port < electrodes.size() ? nullptr : &chambers[port - electrodes.size()];
  }

 private:
  std::size_t sheet_history() const { return circuit_history + circuits.size(); }
  void weigh_sheets();
  /// m^3, below which a chamber's compliance stays as it is: an empty one's is none.
  double least_volume() const { return 1e-12 * extent * extent * extent; }
};

} // namespace dielast::fem
