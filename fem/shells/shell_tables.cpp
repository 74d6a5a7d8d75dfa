// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/shells/shell_tables.hpp"

#include "fem/films/triangle.hpp"

#include <Eigen/LU>

#include <cmath>
#include <vector>

namespace dielast::fem {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Gradients = Eigen::Matrix<double, 6, 2>;

/// A condition on an interpolated field: a row of the field's coefficients and the form that it must equal.
struct Condition {
  Eigen::RowVectorXd row;
  Matrix6 form;
};

struct SidePoint {
  double r, s;
  Eigen::Vector2d along; ///< the side
};

/// Two Gauss points of each side.
std::vector<SidePoint> side_points() {
  const double a = (1 - 1 / std::sqrt(3.0)) / 2;
  std::vector<SidePoint> all;
  for (const double t : {a, 1 - a}) {
    all.push_back({t, 0, {1, 0}});
    all.push_back({0, t, {0, 1}});
    all.push_back({1 - t, t, {-1, 1}});
  }
  return all;
}

/// The values of components that are linear in r and s: of the sum of of[c] times component c, by their
/// coefficients (1, r, s of each component).
Eigen::RowVectorXd row(const Eigen::VectorXd& of, double r, double s) {
  Eigen::RowVectorXd all(3 * of.size());
  for (Eigen::Index c = 0; c < of.size(); ++c) {
    all[3 * c] = of[c];
    all[3 * c + 1] = of[c] * r;
    all[3 * c + 2] = of[c] * s;
  }
  return all;
}

/// Values of the interpolated components at (r, s), components x coefficients, times the coefficients as
/// forms.
std::vector<Matrix6> interpolate(const std::vector<Condition>& conditions, const Eigen::MatrixXd& values) {
  const auto count = static_cast<Eigen::Index>(conditions.size());
  Eigen::MatrixXd rows(count, count);
  for (Eigen::Index i = 0; i < count; ++i) rows.row(i) = conditions[static_cast<std::size_t>(i)].row;
  const Eigen::MatrixXd weights = values * rows.inverse();
  std::vector<Matrix6> forms(static_cast<std::size_t>(values.rows()), Matrix6::Zero());
  for (Eigen::Index c = 0; c < values.rows(); ++c)
    for (Eigen::Index i = 0; i < count; ++i)
      forms[static_cast<std::size_t>(c)] += weights(c, i) * conditions[static_cast<std::size_t>(i)].form;
  return forms;
}

/// Of rr, ss, rs.
std::vector<Matrix6> metric_forms(double r, double s) {
  std::vector<Condition> conditions;
  for (const SidePoint& at : side_points()) {
    const Eigen::Vector<double, 6> slope = shape_gradients<6>(at.r, at.s) * at.along;
    const Eigen::Vector2d& t = at.along;
    conditions.push_back({row(Eigen::Vector3d(t[0] * t[0], t[1] * t[1], 2 * t[0] * t[1]), at.r, at.s),
                          slope * slope.transpose()});
  }
  for (int c = 0; c < 3; ++c) {
    Matrix6 mean = Matrix6::Zero();
    for (const TrianglePoint& at : triangle_rule(3)) {
      const Gradients dN = shape_gradients<6>(at.xi, at.eta);
      const Matrix6 rs = dN.col(0) * dN.col(1).transpose();
      mean += 2 * at.weight *
              (c == 2 ? Matrix6((rs + rs.transpose()) / 2) : Matrix6(dN.col(c) * dN.col(c).transpose()));
    }
    conditions.push_back({row(Eigen::Vector3d::Unit(c), 1.0 / 3, 1.0 / 3), mean});
  }
  Eigen::MatrixXd values(3, 9);
  for (int c = 0; c < 3; ++c) values.row(c) = row(Eigen::Vector3d::Unit(c), r, s);
  return interpolate(conditions, values);
}

/// Of the component along `of`: linear fields, and (-rs, r^2) and (-s^2, rs), which have no component along
/// the sides but what is linear there.
Eigen::RowVectorXd shear_row(const Eigen::Vector2d& of, double r, double s) {
  Eigen::RowVectorXd all(8);
  all << row(of, r, s), r * (of[1] * r - of[0] * s), s * (of[1] * r - of[0] * s);
  return all;
}

Matrix6 shear_form(const Eigen::Vector2d& of, double r, double s) {
  return shape_gradients<6>(r, s) * of * shape_values<6>(r, s).transpose();
}

/// Of the components along r and s.
std::vector<Matrix6> shear_forms(double r, double s) {
  std::vector<Condition> conditions;
  for (const SidePoint& at : side_points())
    conditions.push_back({shear_row(at.along, at.r, at.s), shear_form(at.along, at.r, at.s)});
  Eigen::MatrixXd values(2, 8);
  for (int c = 0; c < 2; ++c) {
    const Eigen::Vector2d of = Eigen::Vector2d::Unit(c);
    Condition mean{Eigen::RowVectorXd::Zero(8), Matrix6::Zero()};
    for (const TrianglePoint& at : triangle_rule(6)) {
      mean.row += 2 * at.weight * shear_row(of, at.xi, at.eta);
      mean.form += 2 * at.weight * shear_form(of, at.xi, at.eta);
    }
    conditions.push_back(mean);
    values.row(c) = shear_row(of, r, s);
  }
  return interpolate(conditions, values);
}

template<std::size_t Rows, std::size_t Columns, class Matrix>
std::array<std::array<double, Columns>, Rows> array_of(const Matrix& matrix) {
  std::array<std::array<double, Columns>, Rows> all;
  for (std::size_t a = 0; a < Rows; ++a)
    for (std::size_t b = 0; b < Columns; ++b)
      all[a][b] = matrix(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
  return all;
}

ShellTables make_tables() {
  ShellTables tables;
  for (std::size_t p = 0; p < ShellTables::points; ++p) {
    const TrianglePoint& at = triangle_rule(ShellTables::points)[p];
    ShellTables::Point& point = tables.point[p];
    point.weight = at.weight;
    const Eigen::Vector<double, 6> shape = shape_values<6>(at.xi, at.eta);
    for (std::size_t a = 0; a < 6; ++a) point.shape[a] = shape[static_cast<Eigen::Index>(a)];
    point.gradient = array_of<6, 2>(shape_gradients<6>(at.xi, at.eta));
    const auto metric = metric_forms(at.xi, at.eta), shear = shear_forms(at.xi, at.eta);
    for (std::size_t c = 0; c < 3; ++c) point.metric[c] = array_of<6, 6>(metric[c]);
    for (std::size_t c = 0; c < 2; ++c) point.shear[c] = array_of<6, 6>(shear[c]);
  }
  const std::array<std::array<double, 2>, 6> place{{{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}};
  for (std::size_t a = 0; a < 6; ++a)
    tables.node[a] = array_of<6, 2>(shape_gradients<6>(place[a][0], place[a][1]));
  return tables;
}

} // namespace

const ShellTables& shell_tables() {
  static const ShellTables tables = make_tables();
  return tables;
}

} // namespace dielast::fem
