// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/orientation.hpp"

#include <Eigen/Householder>

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

constexpr double alike = 1e-6; ///< relative difference of eigenvalues
/// exp(-1/2): transcendental, so that no two rows of a regular mesh's polynomials and sines have this ratio.
constexpr double prominent = 0.60653065971263342;

} // namespace

bool coincide(double a, double b, double round_off) {
  return std::abs(a - b) <= alike * std::max(std::abs(a), std::abs(b)) + round_off;
}

void orient_twins(Eigen::Ref<Eigen::MatrixXd> twins, const Eigen::VectorXd& weight) {
  Eigen::VectorXd workspace(twins.rows());
  for (Eigen::Index oriented = 0; oriented < twins.cols(); ++oriented) {
    auto rest = twins.rightCols(twins.cols() - oriented);
    const Eigen::VectorXd size = rest.rowwise().norm().cwiseProduct(weight);
    const double least = prominent * size.maxCoeff();
    const Eigen::Index row =
        std::find_if(size.begin(), size.end(), [&](double s) { return s >= least; }) - size.begin();
    const Eigen::VectorXd leading = rest.row(row).transpose();
    Eigen::VectorXd essential(leading.size() - 1);
    double tau = 0, first = 0;
    leading.makeHouseholder(essential, tau, first);
    rest.applyHouseholderOnTheRight(essential, tau, workspace.data());
    if (first < 0) rest.col(0) *= -1;
  }
}

void orient(Eigen::MatrixXd& vectors, Eigen::VectorXd& eigenvalues, double round_off,
            const Eigen::VectorXd& weight) {
  for (Eigen::Index begin = 0, end = 0; begin < vectors.cols(); begin = end) {
    for (end = begin + 1; end < vectors.cols(); ++end)
      if (!coincide(eigenvalues[begin], eigenvalues[end], round_off)) break;
    orient_twins(vectors.middleCols(begin, end - begin), weight);
    eigenvalues.segment(begin, end - begin).setConstant(eigenvalues.segment(begin, end - begin).mean());
  }
}

} // namespace dielast::fem
