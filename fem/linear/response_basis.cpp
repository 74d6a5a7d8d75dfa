// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/response_basis.hpp"

#include "fem/algebra/dense_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::fem {
namespace {

constexpr double negligible_residual = 1e-11; ///< residual, over the right side
constexpr double part_spanned = 1e-12;        ///< part of a vector that is round-off
constexpr Eigen::Index widest = 240;          ///< basis

void widen(Eigen::MatrixXd& matrix, const Eigen::MatrixXd& columns) {
  matrix.conservativeResize(Eigen::NoChange, matrix.cols() + columns.cols());
  matrix.rightCols(columns.cols()) = columns;
}

/// Per equation the root of its stiffness; of a multiplier, whose diagonal is not positive, as far as it is
/// that of what it acts on.
Eigen::VectorXd scale_of(const SparseSymmetric& K) {
  const auto diagonal = [&K](int i) { // it is the first of its column
    return K.values[static_cast<std::size_t>(K.column_start[static_cast<std::size_t>(i)])];
  };
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(K.size);
  for (int c = 0; c < K.size; ++c)
    for (int k = K.column_start[static_cast<std::size_t>(c)];
         k < K.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
      const int r = K.rows[static_cast<std::size_t>(k)];
      const double squared = std::pow(K.values[static_cast<std::size_t>(k)], 2);
      for (const auto& [i, j] : {std::pair{r, c}, {c, r}})
        if (i == j ? diagonal(i) > 0 : diagonal(i) <= 0 && diagonal(j) > 0)
          stiffness[i] = std::max(stiffness[i], squared / diagonal(j));
    }
  return stiffness.unaryExpr([](double value) { return value > 0 ? std::sqrt(value) : 1.0; });
}

} // namespace

ResponseBasis::ResponseBasis(const Linearisation& at, Eigen::MatrixXd B)
    : at_(at), columns_(B.cols()), scale_(scale_of(at.stiffness())), solver_(at.stiffness()),
      scaled_(B.rows(), 0), V_(scaled_), TV_(at.terms().size(), V_), P_(at.terms().size()) {
  for (Eigen::Index c = 0; c < columns_; ++c)
    if (!B.col(c).isZero(0)) of_.push_back(c);
  B_ = B(Eigen::all, of_);
}

Eigen::MatrixXd ResponseBasis::times(const std::vector<double>& values,
                                     const Eigen::MatrixXd& columns) const {
  const SparseSymmetric& K = at_.stiffness();
  const Eigen::Map<const Eigen::SparseMatrix<double>> lower(
      K.size, K.size, static_cast<Eigen::Index>(values.size()), K.column_start.data(), K.rows.data(),
      values.data());
  return lower.selfadjointView<Eigen::Lower>() * columns;
}

std::optional<Eigen::MatrixXcd> ResponseBasis::interpolated(Complex s) const {
  if (V_.cols() == 0) return std::nullopt;
  const std::vector<Complex> weights = at_.weights(s);
  Eigen::MatrixXcd Z = Eigen::MatrixXcd::Zero(V_.cols(), V_.cols());
  for (std::size_t k = 0; k < weights.size(); ++k) Z += weights[k] * P_[k];
  const auto [storage, loss] = at_.varying(s);
  std::array<Eigen::MatrixXd, 2> varying;
  if (!storage.empty()) {
    varying = {times(storage, V_), times(loss, V_)};
    Z += V_.transpose() * varying[0] + Complex(0, 1) * (V_.transpose() * varying[1]);
  }
  const Eigen::Index size = V_.cols(), right = B_.cols();
  const Eigen::MatrixXcd y = solve_dense(Z, (V_.transpose() * B_).cast<Complex>());
  if (!y.allFinite()) return std::nullopt;
  Eigen::MatrixXd parts(size, 2 * right), residual(B_.rows(), 2 * right); // real, then imaginary
  residual.leftCols(right) = B_;
  residual.rightCols(right).setZero();
  const auto subtract = [&](const Eigen::MatrixXd& T, Complex weight) {
    parts.leftCols(right) = (weight * y).real();
    parts.rightCols(right) = (weight * y).imag();
    residual.noalias() -= T * parts;
  };
  for (std::size_t k = 0; k < weights.size(); ++k)
    if (TV_[k].size() > 0) subtract(TV_[k], weights[k]);
  if (!storage.empty()) {
    subtract(varying[0], 1);
    subtract(varying[1], {0, 1});
  }
  const auto size_of = [this](const auto& column) { return column.cwiseQuotient(scale_).norm(); };
  for (Eigen::Index c = 0; c < right; ++c)
    if (!(std::hypot(size_of(residual.col(c)), size_of(residual.col(right + c))) <=
          negligible_residual * size_of(B_.col(c))))
      return std::nullopt;
  Eigen::MatrixXcd X(B_.rows(), right);
  X.real() = V_ * y.real();
  X.imag() = V_ * y.imag();
  return X;
}

void ResponseBasis::add(const Eigen::MatrixXcd& X) {
  const Eigen::Index before = V_.cols();
  for (Eigen::Index i = 0; i < 2 * X.cols() && scaled_.cols() < widest; ++i) {
    Eigen::VectorXd x = X.col(i / 2).real();
    if (i % 2 == 1) x = X.col(i / 2).imag();
    x = x.cwiseProduct(scale_);
    const double whole = x.norm();
    for (int twice = 0; twice < 2; ++twice) x -= scaled_ * (scaled_.transpose() * x); // once loses digits
    const double left = x.norm();
    if (left > part_spanned * whole) widen(scaled_, x / left);
  }
  const Eigen::Index now = scaled_.cols();
  if (now == before) return;
  const Eigen::MatrixXd fresh = scale_.cwiseInverse().asDiagonal() * scaled_.rightCols(now - before);
  widen(V_, fresh);
  const auto terms = at_.terms();
  for (std::size_t k = 0; k < terms.size(); ++k) {
    widen(TV_[k], times(*terms[k], fresh));
    P_[k].conservativeResize(now, now);
    P_[k].rightCols(fresh.cols()) = V_.transpose() * TV_[k].rightCols(fresh.cols());
    P_[k].bottomLeftCorner(fresh.cols(), before) = P_[k].topRightCorner(before, fresh.cols()).transpose();
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
  add(X);
  all(Eigen::all, of_) = X;
  return all;
}

} // namespace dielast::fem
