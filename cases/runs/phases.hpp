// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/holding.hpp"
#include "fem/model/dofs.hpp"
#include "meshing/mesh.hpp"

namespace dielast::cases {

/// Throws CaseError where in one step two supports move the same unknown to different places. What a support
/// merely holds another one may move. `dofs` numbered.
void require_one_motion(const Case& one, const meshing::Mesh& mesh, const fem::DofMap& dofs);

/// Throws as build_device() where the device cannot be with the supports of one of its steps; `first`: what
/// holds at first.
void require_devices(const Case& one, const std::vector<Step>& steps, const Holding& first);

} // namespace dielast::cases
