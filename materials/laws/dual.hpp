// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <cmath>

namespace dielast::materials {

/// Second-order forward dual number in N variables: a value with its exact gradient and Hessian. The oracle
/// that the hand-written derivatives are tested against, and a path for laws that only give an energy; not
/// for element loops. Its operations are loops over numbers: expressions of Eigen cost the compiler several
/// times as much for every N.
template<int N>
struct Dual {
  double value = 0;
  Eigen::Vector<double, N> gradient = Eigen::Vector<double, N>::Zero();
  Eigen::Matrix<double, N, N> hessian = Eigen::Matrix<double, N, N>::Zero();

  Dual() = default;
  Dual(double constant) : value(constant) {} // NOLINT: a constant is a dual number

  static Dual variable(double value, int index) {
    Dual x(value);
    x.gradient[index] = 1;
    return x;
  }

  /// phi(x) from phi, phi' and phi'' at x.value.
  Dual chain(double phi, double phi_1, double phi_2) const {
    Dual y(phi);
    const double *g = gradient.data(), *H = hessian.data();
    double *y_1 = y.gradient.data(), *y_2 = y.hessian.data();
    for (int i = 0; i < N; ++i) {
      y_1[i] = phi_1 * g[i];
      for (int j = 0; j < N; ++j) y_2[i * N + j] = phi_1 * H[i * N + j] + phi_2 * g[i] * g[j];
    }
    return y;
  }

  Dual& operator+=(const Dual& b) {
    value += b.value;
    for (int i = 0; i < N; ++i) gradient.data()[i] += b.gradient.data()[i];
    for (int i = 0; i < N * N; ++i) hessian.data()[i] += b.hessian.data()[i];
    return *this;
  }
  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(const Dual& a) { return a.chain(-a.value, -1, 0); }
  friend Dual operator-(const Dual& a, const Dual& b) { return a + (-b); }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual y(a.value * b.value);
    const double *a_1 = a.gradient.data(), *b_1 = b.gradient.data();
    const double *a_2 = a.hessian.data(), *b_2 = b.hessian.data();
    double *y_1 = y.gradient.data(), *y_2 = y.hessian.data();
    for (int i = 0; i < N; ++i) {
      y_1[i] = a.value * b_1[i] + b.value * a_1[i];
      for (int j = 0; j < N; ++j)
        y_2[i * N + j] =
            a.value * b_2[i * N + j] + b.value * a_2[i * N + j] + a_1[i] * b_1[j] + b_1[i] * a_1[j];
    }
    return y;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double inverse = 1 / b.value;
    return a * b.chain(inverse, -inverse * inverse, 2 * inverse * inverse * inverse);
  }
  friend Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.value);
    return a.chain(root, 0.5 / root, -0.25 / (root * a.value));
  }
  friend Dual log(const Dual& a) { return a.chain(std::log(a.value), 1 / a.value, -1 / (a.value * a.value)); }
  friend Dual log1p(const Dual& a) {
    const double inverse = 1 / (1 + a.value);
    return a.chain(std::log1p(a.value), inverse, -inverse * inverse);
  }
  friend Dual pow(const Dual& a, double exponent) {
    const double power = std::pow(a.value, exponent);
    return a.chain(power, exponent * power / a.value,
                   exponent * (exponent - 1) * power / (a.value * a.value));
  }
  friend Dual sin(const Dual& a) { return a.chain(std::sin(a.value), std::cos(a.value), -std::sin(a.value)); }
  friend Dual cos(const Dual& a) {
    return a.chain(std::cos(a.value), -std::sin(a.value), -std::cos(a.value));
  }
};

} // namespace dielast::materials
