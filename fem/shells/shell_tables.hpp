// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace dielast::fem {

/// Strains of the 6-node shell at its integration points as forms in the positions x_a and directors d_a of
/// its nodes, in the triangle's own coordinates r, s: the numbers are those of every element.
///
/// The metric x,i . x,j (rr, ss, rs) is interpolated linearly such that the stretch along each side has its
/// moments up to the first, and the mean of the triangle is right (Regge interpolation: Neunteufel &
/// Schoeberl 2021, Comput. Methods Appl. Mech. Eng. 373, 113524): bending without stretch stays possible. The
/// transverse shear x,i . d is interpolated from its values along the sides, at two Gauss points each, and
/// its mean, by linear fields and two quadratic ones (MITC6: Lee & Bathe 2004, Comput. Struct. 82, 945; the
/// fields are those of Nedelec 1980).
struct ShellTables {
  static constexpr int nodes = 6, points = 3;
  using Form = std::array<std::array<double, nodes>, nodes>;
  using Gradient = std::array<std::array<double, 2>, nodes>;

  struct Point {
    double weight; ///< the weights add up to 1/2
    std::array<double, nodes> shape;
    Gradient gradient;          ///< N_a,r and N_a,s
    std::array<Form, 3> metric; ///< rr, ss, rs: sum_ab metric[a][b] x_a . x_b, symmetric
    std::array<Form, 2> shear;  ///< r, s: sum_ab shear[a][b] x_a . d_b
  };
  std::array<Point, points> point;
  std::array<Gradient, nodes> node; ///< gradients at the nodes
};

const ShellTables& shell_tables();

} // namespace dielast::fem
