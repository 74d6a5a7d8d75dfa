// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "fem/model/model.hpp"
#include "meshing/mesh.hpp"

namespace dielast::cases {

/// Adds what the [chamber] of a case presses on, if it has one; the unknowns are numbered. `free_body`:
/// nothing but pins holds the device. Throws MeshError for a place that is no surface, and for an open
/// surface of a solid in space; CaseError for a surface with an edge at which a pressure has no potential.
void add_chamber(const Case& one, const meshing::Mesh& mesh, bool free_body, fem::Model& model);

} // namespace dielast::cases
