// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "fem/model/dofs.hpp"
#include "meshing/mesh.hpp"

#include <span>
#include <string>
#include <vector>

namespace dielast::cases {

/// A sentence for every [[load]] of which nothing moves the device: along or about some axis all nodes of its
/// place are held in every step in which it acts. `dofs` numbered, with the supports of `one`.
std::vector<std::string> load_warnings(const Case& one, const meshing::Mesh& mesh, const fem::DofMap& dofs);

/// A sentence where a support moves the device as it is, as nothing else holds it along that axis. Empty with
/// inertia, which resists.
std::vector<std::string> carrying_warnings(const Case& one);

/// A sentence on the step that comes before all others where what is drawn is not in balance: what is
/// attached to the film pulls on it, or it is stretched and free.
std::string settle_warning(const Case& one, bool attachments_pull);

/// A sentence for every body that gravity pulls aside, where it follows along another axis alone.
std::vector<std::string> weight_warnings(const Case& one);

/// A sentence for every [[point_mass]], [[spring]] and [[linkage]] that has no effect, as nothing moves its
/// places in any step, or both are one. `dofs` as above.
std::vector<std::string> idle_attachments(const Case& one, const meshing::Mesh& mesh,
                                          const fem::DofMap& dofs);

/// A sentence for every displacement that the user asks for and that is always 0, as nothing moves its place
/// in any step. `dofs` as above.
std::vector<std::string> warnings_of_held_quantities(const Case& one, const meshing::Mesh& mesh,
                                                     const fem::DofMap& dofs);

/// A sentence for every incompressible solid that is held in all of its nodes: nothing tells its pressures.
/// `parts`: of the film's cells, numbers in Case::parts. `dofs` as above.
std::vector<std::string> pressure_warnings(const Case& one, const meshing::Mesh& mesh,
                                           std::span<const int> parts, const fem::DofMap& dofs);

} // namespace dielast::cases
