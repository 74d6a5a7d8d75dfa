// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/kept_factor.hpp"

#include "fem/algebra/one_thread.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

/// Pivots over their diagonal entries below which single precision tells too little.
constexpr double least_pivot = 1e-4;
/// Operations of a factorisation in the time in which a solve reads an entry of the factor twice.
constexpr double operations_per_entry = 40;
/// Iterations with a factor of the matrix itself after which a solve gives up.
constexpr int most_iterations = 50;

/// y = A x.
void multiply(const SparseSymmetric& A, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  y.setZero(A.size);
  for (int c = 0; c < A.size; ++c) {
    auto k = static_cast<std::size_t>(A.column_start[static_cast<std::size_t>(c)]);
    const auto end = static_cast<std::size_t>(A.column_start[static_cast<std::size_t>(c) + 1]);
    const double of_column = x[c];
    double sum = A.values[k] * of_column;
    for (++k; k < end; ++k) {
      sum += A.values[k] * x[A.rows[k]];
      y[A.rows[k]] += A.values[k] * of_column;
    }
    y[c] += sum;
  }
}

} // namespace

double KeptFactor::cost(const Supernodes& supernodes) {
  double operations = 0, entries = 0;
  for (int s = 0; s < supernodes.count(); ++s) {
    const double width = supernodes.width(s), below = supernodes.below(s);
    operations += width * (width * width / 3 + width * below + below * below);
    entries += width * (width / 2 + below);
  }
  return 1 + operations / (operations_per_entry * entries);
}

KeptFactor::KeptFactor(const SparseSymmetric& matrix, const Supernodes& supernodes)
    : matrix_(matrix), factor_(supernodes), cost_(cost(supernodes)) {}

bool KeptFactor::make() {
  const OneThread one_thread;
  ++factorisations_;
  fresh_ = 0;
  made_ = factor_.factor(matrix_.values) &&
          factor_.smallest_pivot(matrix_, matrix_.values).relative > least_pivot;
  fails_ = !made_;
  return made_;
}

bool KeptFactor::prepare() {
  if (fails_) return false;
  if (made_ && debt_ < cost_) return true;
  debt_ = 0;
  return make();
}

/// Iterations until a correction of x is small enough, none where `most` do not suffice. `square`: that of
/// the norm of x.
std::optional<int> KeptFactor::iterate(Eigen::VectorXd& x, double& square, double tolerance, int most) {
  double product = 0;
  for (int iteration = 1; iteration <= most; ++iteration) {
    factor_.solve(r_, z_);
    ++solves_;
    const double rz = r_.dot(z_);
    if (rz == 0) return iteration;
    if (iteration == 1)
      p_ = z_;
    else
      p_ = z_ + rz / product * p_;
    product = rz;
    multiply(matrix_, p_, Ap_);
    const double curvature = p_.dot(Ap_);
    if (!(curvature > 0)) return std::nullopt;
    x += rz / curvature * p_;
    r_ -= rz / curvature * Ap_;
    const double correction = rz / curvature * rz;
    square += correction;
    if (correction <= tolerance * tolerance * square) return iteration;
  }
  return std::nullopt;
}

bool KeptFactor::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance) {
  x.setZero(b.size());
  const double largest = b.lpNorm<Eigen::Infinity>();
  if (largest == 0) return true;
  r_ = b / largest; // the range of single precision is small
  double square = 0;
  const bool fresh = fresh_ == 0;
  const double decades = -std::log10(tolerance), expected = fresh_ * decades;
  const int worth = static_cast<int>(std::ceil(expected + cost_));
  if (const auto iterations = iterate(x, square, tolerance, fresh ? most_iterations : worth)) {
    if (fresh)
      fresh_ = *iterations / decades;
    else
      debt_ += std::max(0.0, *iterations - expected);
  } else {
    debt_ = cost_; // the next matrix may be as far from this one
    fails_ = fresh || !make() || !iterate(x, square, tolerance, most_iterations);
  }
  x *= largest;
  return !fails_;
}

} // namespace dielast::fem
