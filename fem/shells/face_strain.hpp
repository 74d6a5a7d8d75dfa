// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/shells/section_potential.hpp"
#include "materials/laws/dual.hpp"

#include <array>
#include <optional>

namespace dielast::fem {

/// Strains of the surface at `gap` along the directors (m) beside the drawn one, to which it is fixed: the
/// face of the layers that is nearest to it, where the drawn surface is none of theirs and nothing between
/// them thins. With the square of the curvature c = b a^-1 b, as directors are normal but for the shear,
///   a' = a + 2 gap b + gap^2 c,  b' = b + gap c.
class FaceStrain {
 public:
  using Derivatives = SectionPotential::Derivatives;

  FaceStrain(const ShellStrain& drawn, double gap) : strain_(drawn), gap_(gap) {
    if (gap_ == 0) return;
    squares_.emplace();
    for (int l = 0; l < lanes; ++l) shift(l);
  }

  const ShellStrain& strain() const { return strain_; }

  /// Of derivatives by these strains, those by the drawn surface's.
  template<bool with_second>
  Derivatives by_drawn(const Derivatives& d) const {
    if (!squares_) return d;
    Derivatives all{};
    for (int l = 0; l < lanes; ++l) {
      Vector first;
      Matrix second = Matrix::Zero();
      for (int i = 0; i < 3; ++i) {
        first[i] = d.a[i][l];
        first[3 + i] = d.b[i][l];
        for (int j = 0; with_second && j < 3; ++j) {
          second(i, j) = d.aa[i][j][l];
          second(i, 3 + j) = second(3 + j, i) = d.ab[i][j][l];
          second(3 + i, 3 + j) = d.bb[i][j][l];
        }
      }
      const auto& squares = (*squares_)[static_cast<std::size_t>(l)];
      Matrix moves = Matrix::Identity(); // of these strains with the drawn surface's
      Matrix bends = Matrix::Zero();
      for (int i = 0; i < 3; ++i) {
        const Square& c = squares[static_cast<std::size_t>(i)];
        moves(i, 3 + i) = 2 * gap_;
        moves.row(i) += gap_ * gap_ * c.gradient;
        moves.row(3 + i) += gap_ * c.gradient;
        bends += gap_ * (gap_ * first[i] + first[3 + i]) * c.hessian;
      }
      first = (moves.transpose() * first).eval();
      if (with_second) second = (moves.transpose() * second * moves + bends).eval();
      for (int i = 0; i < 3; ++i) {
        all.a[i][l] = first[i];
        all.b[i][l] = first[3 + i];
        for (int j = 0; with_second && j < 3; ++j) {
          all.aa[i][j][l] = second(i, j);
          all.ab[i][j][l] = second(i, 3 + j);
          all.bb[i][j][l] = second(3 + i, 3 + j);
        }
      }
    }
    return all;
  }

 private:
  using Vector = Eigen::Vector<double, 6>;
  using Matrix = Eigen::Matrix<double, 6, 6>;
  using Square = materials::Dual<6>; ///< in a, then b

  void shift(int l) {
    const auto variable = [&](const Lanes& value, int i) { return Square::variable(value[l], i); };
    auto& [a, b] = strain_;
    const Square a11 = variable(a.C11, 0), a22 = variable(a.C22, 1), a12 = variable(a.C12, 2),
                 b11 = variable(b.C11, 3), b22 = variable(b.C22, 4), b12 = variable(b.C12, 5),
                 det = a11 * a22 - a12 * a12, i11 = a22 / det, i22 = a11 / det, i12 = -a12 / det;
    auto& c = (*squares_)[static_cast<std::size_t>(l)];
    c = {b11 * b11 * i11 + 2.0 * b11 * b12 * i12 + b12 * b12 * i22,
         b12 * b12 * i11 + 2.0 * b12 * b22 * i12 + b22 * b22 * i22,
         b11 * b12 * i11 + (b11 * b22 + b12 * b12) * i12 + b12 * b22 * i22};
    const auto move = [&](Lanes& metric, Lanes& curvature, const Square& square) {
      metric[l] += 2 * gap_ * curvature[l] + gap_ * gap_ * square.value;
      curvature[l] += gap_ * square.value;
    };
    move(a.C11, b.C11, c[0]);
    move(a.C22, b.C22, c[1]);
    move(a.C12, b.C12, c[2]);
  }

  ShellStrain strain_;
  double gap_;
  std::optional<std::array<std::array<Square, 3>, lanes>> squares_; ///< c of each lane, components 11, 22, 12
};

} // namespace dielast::fem
