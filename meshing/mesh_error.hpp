// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>

namespace dielast::meshing {

/// No usable mesh can be made or read; the message says what to change.
struct MeshError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace dielast::meshing
