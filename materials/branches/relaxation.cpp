// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/branches/relaxation.hpp"

#include "materials/algebra/small_matrices.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace dielast::materials {

template<int Size>
RelaxationSpectrum<Size> relaxation_spectrum(const Eigen::Matrix<double, Size, Size>& frozen,
                                             const Eigen::Matrix<double, Size, Size>& relaxed,
                                             const Eigen::Matrix<double, Size, Size>& euler, double dt) {
  using Matrix = Eigen::Matrix<double, Size, Size>;
  constexpr double negligible = 1e-9; // of the largest stiffness
  const auto range = symmetric_eigen<Size>(frozen - relaxed);
  RelaxationSpectrum<Size> spectrum;
  // Where E_0 has no range, columns are zero, and so is their beta: the smallest, before those that count.
  Matrix root = Matrix::Zero(), inverse = Matrix::Zero();
  for (int i = 0; i < Size; ++i) {
    if (!(range.values[i] > negligible * frozen.norm())) continue;
    ++spectrum.count;
    root.col(i) = std::sqrt(range.values[i]) * range.vectors.col(i);
    inverse.col(i) = range.vectors.col(i) / std::sqrt(range.values[i]);
  }
  const auto beta = symmetric_eigen<Size>(inverse.transpose() * (frozen - euler) * inverse);
  for (int i = 0; i < spectrum.count; ++i) {
    const int at = Size - spectrum.count + i;
    spectrum.element[static_cast<std::size_t>(i)] = {root * beta.vectors.col(at),
                                                     beta.values[at] / (1 - beta.values[at]) / dt};
  }
  return spectrum;
}
template RelaxationSpectrum<3> relaxation_spectrum(const Eigen::Matrix3d&, const Eigen::Matrix3d&,
                                                   const Eigen::Matrix3d&, double);
template RelaxationSpectrum<6> relaxation_spectrum(const Eigen::Matrix<double, 6, 6>&,
                                                   const Eigen::Matrix<double, 6, 6>&,
                                                   const Eigen::Matrix<double, 6, 6>&, double);

RelaxationSpectrum<3> relaxation_spectrum(const Branch& branch, const InPlaneC<double>& C,
                                          const Internal& now) {
  return relaxation_spectrum<3>(branch, [&](const TimeScheme& scheme) {
    const auto psi = branch_potential(branch, C, scheme, now, {});
    Eigen::Matrix3d K;
    for (std::size_t p = 0; p < psi.second.size(); ++p) {
      const auto [i, j] = component_pairs[p];
      K(i, j) = K(j, i) = psi.second[p];
    }
    return K;
  });
}

bool is_relaxed(const Branch& branch, const InPlaneC<double>& C, const Internal& now) {
  constexpr double still = 1e-4; // of internal variables, which are of order one
  const Internal rest = advance(branch, C, TimeScheme::relaxed(), now, {});
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (std::abs(rest[i] - now[i]) > still * std::max(1.0, std::abs(now[i]))) return false;
  return true;
}

} // namespace dielast::materials
