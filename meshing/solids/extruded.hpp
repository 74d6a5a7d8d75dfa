// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <functional>

namespace dielast::meshing {

/// Tetrahedra of a drawing of 6-node triangles that is drawn out along `levels` (ascending, at least two).
/// Each triangle makes a prism between two levels, and each prism three 10-node tetrahedra that fit their
/// neighbours' (Dompierre et al. 1999: the diagonal of a side begins at its smallest node). A node that is
/// drawn at x comes to place(x, level), middle nodes half way between two levels.
///
/// Cell k of the prisms over triangle c between the levels l and l + 1 of a drawing of n triangles is
/// 3 (l n + c) + k. Places are drawn out with their triangles and nodes; the nodes of the lowest and the
/// highest level are the places `lowest` and `highest`. Throws std::invalid_argument for other drawings.
Mesh extruded(const Mesh& drawing, const std::vector<double>& levels,
              const std::function<Eigen::Vector3d(const Eigen::Vector3d& drawn, double level)>& place,
              const std::string& lowest, const std::string& highest);

} // namespace dielast::meshing
