// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "fem/model/model.hpp"
#include "meshing/mesh.hpp"

namespace dielast::cases {

/// What the [chamber] of a case presses on: all film, or the surface of a solid. Throws CaseError where that
/// has an edge in space.
meshing::CellBlock wall_of_chamber(const Case& one, const meshing::Mesh& mesh);

/// Adds what the [chamber] of a case presses on, if it has one; the unknowns are numbered. `free_body`:
/// nothing but pins holds the device. Throws MeshError for a place that is no surface; CaseError for an open
/// surface of a solid in space, and for one with an edge at which a pressure has no potential.
void add_chamber(const Case& one, const meshing::Mesh& mesh, bool free_body, fem::Model& model);

} // namespace dielast::cases
