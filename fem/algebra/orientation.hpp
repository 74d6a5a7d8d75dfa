// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace dielast::fem {

/// Whether two eigenvalues are one and the same: equal to 1e-6, or but for `round_off`, in their unit.
bool coincide(double a, double b, double round_off);

/// Eigenvectors are known but for their signs, k orthonormal ones of one eigenvalue (the columns of `twins`)
/// but for a rotation: rounding would choose, and so would the processor. Rotates the columns into the basis
/// that depends on their span alone: in the first row that is prominent, the first column is positive and all
/// others are zero; so on with the others. Prominent is a row whose norm over the columns, times its
/// `weight`, exceeds 0.61 of the largest, so that the order of the rows decides between equal peaks of a
/// symmetric model. Rows of weight 0 are never asked.
void orient_twins(Eigen::Ref<Eigen::MatrixXd> twins, const Eigen::VectorXd& weight);

/// The same for eigenvectors of many eigenvalues, sorted by these: each run of columns whose `eigenvalues`
/// coincide is oriented, and gets their mean.
void orient(Eigen::MatrixXd& vectors, Eigen::VectorXd& eigenvalues, double round_off,
            const Eigen::VectorXd& weight);

} // namespace dielast::fem
