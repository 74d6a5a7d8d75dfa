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

  /// Everything at rest as drawn: no displacement, no voltage, no dead force.
  State initial_state() const;

  Samples sample(const State& state) const;
};

} // namespace dielast::fem
