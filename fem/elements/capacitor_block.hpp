// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"

#include <memory>

namespace dielast::fem {

/// What does not deform beside the film: leads, and electrodes that lie in a clamp.
struct Capacitor {
  std::size_t electrode = 0;
  double capacitance = 0; ///< F
};

/// Energy: -C Phi^2 / 2 of the electrode's voltage; the charge C Phi is added to the film's.
std::unique_ptr<ElementBlock> make_capacitor_block(const Capacitor& capacitor);

} // namespace dielast::fem
