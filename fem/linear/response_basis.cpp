// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/response_basis.hpp"

#include "fem/algebra/dense_algebra.hpp"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::fem {
namespace {

constexpr double negligible_residual = 1e-11; ///< residual, over the right side
constexpr double part_spanned = 1e-12;        ///< part of a vector that is round-off

/// Columns of a basis: so many that a problem of theirs is small beside one of all equations, and that what
/// is kept of them fits into half a gigabyte.
Eigen::Index widest_of(Eigen::Index equations, std::size_t terms) {
  constexpr double bytes = 5e8, most = 240;
  const double per_column = sizeof(double) * static_cast<double>(terms + 2) * static_cast<double>(equations);
  return static_cast<Eigen::Index>(std::min(most, bytes / std::max(per_column, 1.0)));
}

/// Per equation the root of its stiffness; of a multiplier, whose diagonal is not positive, as far as it is
/// that of what it acts on.
Eigen::VectorXd scale_of(const SparseSymmetric& K) {
  const auto diagonal = [&K](int i) { // it is the first of its column
    return K.values[static_cast<std::size_t>(K.column_start[static_cast<std::size_t>(i)])];
  };
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(K.size);
  K.for_each_entry([&](std::size_t k, int column, int row) {
    const double squared = std::pow(K.values[k], 2);
    for (const auto& [i, j] : {std::pair{row, column}, {column, row}})
      if (i == j ? diagonal(i) > 0 : diagonal(i) <= 0 && diagonal(j) > 0)
        stiffness[i] = std::max(stiffness[i], squared / diagonal(j));
  });
  return stiffness.unaryExpr([](double value) { return value > 0 ? std::sqrt(value) : 1.0; });
}

} // namespace

ResponseBasis::ResponseBasis(const Linearisation& at, Eigen::MatrixXd B)
    : at_(at), columns_(B.cols()), scale_(scale_of(at.stiffness())), solver_(at.stiffness()),
      scaled_(B.rows(), 0), V_(scaled_), widest_(widest_of(B.rows(), at.terms().size())),
      TV_(at.terms().size(), V_), P_(at.terms().size()) {
  for (Eigen::Index c = 0; c < columns_; ++c)
    if (!B.col(c).isZero(0)) of_.push_back(c);
  B_ = B(Eigen::all, of_);
}

std::optional<Eigen::MatrixXcd> ResponseBasis::interpolated(Complex s) const {
  if (V_.cols() == 0) return std::nullopt;
  const std::vector<Complex> weights = at_.weights(s);
  Eigen::MatrixXcd Z = Eigen::MatrixXcd::Zero(V_.cols(), V_.cols());
  for (std::size_t k = 0; k < weights.size(); ++k) Z += weights[k] * P_[k];
  const Eigen::MatrixXcd y = solve_dense(Z, (V_.transpose() * B_).cast<Complex>());
  if (!y.allFinite()) return std::nullopt;
  Eigen::MatrixXcd X(B_.rows(), B_.cols());
  for (Eigen::Index c = 0; c < X.cols(); ++c) { // a product of two matrices would copy the first
    Eigen::VectorXd real = B_.col(c), imaginary = Eigen::VectorXd::Zero(B_.rows());
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const Eigen::VectorXcd part = weights[k] * y.col(c);
      real.noalias() -= TV_[k] * part.real();
      imaginary.noalias() -= TV_[k] * part.imag();
    }
    const double residual =
        std::hypot(real.cwiseQuotient(scale_).norm(), imaginary.cwiseQuotient(scale_).norm());
    if (!(residual <= negligible_residual * B_.col(c).cwiseQuotient(scale_).norm())) return std::nullopt;
    X.col(c).real() = V_ * y.col(c).real();
    X.col(c).imag() = V_ * y.col(c).imag();
  }
  return X;
}

void ResponseBasis::add(const Eigen::MatrixXcd& X) {
  const Eigen::Index before = V_.cols();
  for (Eigen::Index i = 0; i < 2 * X.cols() && scaled_.cols() < widest_; ++i) {
    Eigen::VectorXd x = X.col(i / 2).real();
    if (i % 2 == 1) x = X.col(i / 2).imag();
    x = x.cwiseProduct(scale_);
    const double whole = x.norm();
    for (int twice = 0; twice < 2; ++twice) x -= scaled_ * (scaled_.transpose() * x); // once loses digits
    const double left = x.norm();
    if (left > part_spanned * whole) append_columns(scaled_, x / left);
  }
  const Eigen::Index now = scaled_.cols(), more = now - before;
  if (more == 0) return;
  const Eigen::MatrixXd fresh = scale_.cwiseInverse().asDiagonal() * scaled_.rightCols(more);
  append_columns(V_, fresh);
  const SparseSymmetric& K = at_.stiffness();
  const auto terms = at_.terms();
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const Eigen::Map<const Eigen::SparseMatrix<double>> lower(
        K.size, K.size, static_cast<Eigen::Index>(terms[k]->size()), K.column_start.data(), K.rows.data(),
        terms[k]->data());
    append_columns(TV_[k], lower.selfadjointView<Eigen::Lower>() * fresh);
    P_[k].conservativeResize(now, now);
    P_[k].rightCols(more) = V_.transpose() * TV_[k].rightCols(more);
    P_[k].bottomLeftCorner(more, before) = P_[k].topRightCorner(before, more).transpose();
  }
}

std::optional<Eigen::MatrixXcd> ResponseBasis::solve(Complex s) {
  Eigen::MatrixXcd all = Eigen::MatrixXcd::Zero(B_.rows(), columns_);
  if (auto X = interpolated(s)) {
    all(Eigen::all, of_) = *X;
    return all;
  }
  std::vector<Complex> Z = at_.dynamic_stiffness(s);
  if (!solver_.factor(Z)) return std::nullopt;
  ++factorisations_;
  const Eigen::MatrixXcd X = solver_.solve(B_.cast<Complex>());
  if (!TV_.empty()) add(X);
  all(Eigen::all, of_) = X;
  return all;
}

} // namespace dielast::fem
