// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"
#include "post/pictures/picture.hpp"
#include "post/pictures/plot.hpp"

#include <string>
#include <vector>

namespace dielast::post {

/// The meridian of a film of revolution in several states, z over r in mm: a curve through its nodes per
/// panel, labelled by the panel's title; values are not shown. True to shape unless the film is so flat that
/// nothing could be seen. Throws std::invalid_argument for a mesh without meridians and for a panel without a
/// position per node.
Plot profile_plot(const meshing::Mesh& mesh, const std::string& title, const std::vector<Panel>& states);

} // namespace dielast::post
