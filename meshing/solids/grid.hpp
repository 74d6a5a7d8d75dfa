// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"

#include <functional>

namespace dielast::meshing {

/// Places at which a line is divided, ascending, such that steps are about `finest` at the points `fine` and
/// grow by a quarter of the distance from them up to `coarsest`; every one of `breaks` (ascending, the ends
/// among them) is a place. Without points in `fine` all steps are about `coarsest`.
std::vector<double> graded_line(const std::vector<double>& breaks, const std::vector<double>& fine,
                                double finest, double coarsest);

/// The places and the middles between them.
std::vector<double> with_middles(const std::vector<double>& lines);

/// A grid of quadrilaterals between the lines u and v, each split into two 6-node triangles with the nodes at
/// place(u, v), counter-clockwise where (u, v) is.
class TriangleGrid {
 public:
  TriangleGrid(std::vector<double> u, std::vector<double> v,
               const std::function<Eigen::Vector3d(double u, double v)>& place);

  /// Names the triangles whose middle is such; nothing where there are none.
  void name_triangles(const std::string& name, const std::function<bool(double u, double v)>& such);
  /// Names the nodes that are such.
  void name_nodes(const std::string& name, const std::function<bool(double u, double v)>& such);
  Mesh take() { return std::move(mesh_); }

 private:
  std::vector<double> u_, v_; ///< of the nodes: lines and the middles between them
  Mesh mesh_;
};

} // namespace dielast::meshing
