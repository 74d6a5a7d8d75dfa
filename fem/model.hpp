#pragma once

#include "fem/element_block.hpp"

#include <memory>
#include <string>
#include <vector>

namespace dielast::fem {

/// The sum of its terms, and its constraints. The solver sees only this.
struct Model {
  DofMap dofs;
  std::vector<std::unique_ptr<ElementBlock>> blocks;
  std::vector<std::string> electrodes; ///< names; a state has one voltage for each
  double length_scale = 1; ///< m, an element's size: makes moments comparable with forces in residual norms
  double extent = 1;       ///< m, the whole mesh's: tells which forces are round-off

  /// Tells every block where its internal variables are; to be called once, when all blocks are there.
  void place_histories();
  /// Everything at rest as drawn: no displacement, no voltage, no dead force; branches relaxed.
  State initial_state() const;

  Samples sample(const State& state) const;
  Charges charges(const State& state, bool with_coupling) const;
  EnergyParts energies(const State& state) const;
  /// The history after a converged state that state.scheme led to: the next increment starts from it.
  std::shared_ptr<const History> advanced_history(const State& state) const;
  /// A converged state as the next increment starts from it: with that history, its dashpots frozen.
  State settled(State state) const;
};

} // namespace dielast::fem
