// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/samples.hpp"
#include "meshing/mesh.hpp"

#include <string>

namespace dielast::cases {

/// Mean over the nodes of a place of the stretch |F e| along the radius e from the z axis. In every element
/// at the place the values at the integration points are continued to the node by a linear function (least
/// squares).
double radial_stretch(const meshing::Mesh& mesh, const fem::Samples& samples, const std::string& place);

} // namespace dielast::cases
