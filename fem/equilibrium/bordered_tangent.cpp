// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/bordered_tangent.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/algebra/kept_factor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::fem {

namespace {

/// Compliance over that of the diagonal as drawn, from which on elimination loses too many digits.
constexpr double nearly_singular = 1e10;
/// Eigenvalues of Schur complements (scaled to 1) below this are round-off.
constexpr double round_off = 1e-12;

int negative_eigenvalues(const Eigen::MatrixXd& symmetric) {
  if (symmetric.size() == 0) return 0;
  return static_cast<int>((symmetric_eigen(symmetric).values.array() < -round_off).count());
}

} // namespace

bool any_follows(const State& state) {
  return std::ranges::any_of(state.supply, [](Supply s) { return s != Supply::voltage; });
}

BorderedTangent::BorderedTangent(const Model& model, const Assembler& assembler,
                                 const Eigen::VectorXd& stiffness)
    : model_(model), assembler_(assembler), matrix_(assembler.matrix()), stiffness_(stiffness) {
  follow_pattern();
}

void BorderedTangent::follow_pattern() {
  if (pattern_ == assembler_.patterns()) return;
  pattern_ = assembler_.patterns();
  if (solver_) earlier_ = work();
  solver_ = std::make_unique<SymmetricSolver>(matrix_, assembler_.workers(), model_.dofs.scalar_count() > 0);
}

void BorderedTangent::recall(FactorMemory memory) {
  follow_pattern();
  if (memory.values.size() == matrix_.values.size() || memory.values.empty())
    solver_->recall(std::move(memory));
}

SymmetricSolver::Work BorderedTangent::work() const {
  const SymmetricSolver::Work now = solver_->work();
  return {earlier_.factorisations + now.factorisations, earlier_.solves + now.solves};
}

void BorderedTangent::append_border(const Eigen::VectorXd& column, const Eigen::VectorXd& row,
                                    double corner) {
  const Eigen::Index last = columns_.cols();
  columns_.conservativeResize(matrix_.size, last + 1);
  rows_.conservativeResize(matrix_.size, last + 1);
  corner_.conservativeResize(last + 1);
  columns_.col(last) = column;
  rows_.col(last) = row;
  corner_[last] = corner;
}

void BorderedTangent::set_borders(const State& state, const PathBorder* path) {
  columns_.resize(matrix_.size, 0);
  rows_.resize(matrix_.size, 0);
  corner_.resize(0);
  following_.clear();
  paths_ = path ? 1 : 0;
  if (path) append_border(path->column, path->row, path->corner);
  if (!any_follows(state)) return;
  Charges charges = model_.surplus(state, true);
  root_capacitance_.resize(static_cast<Eigen::Index>(state.supply.size()));
  for (std::size_t e = 0; e < state.supply.size(); ++e) {
    if (state.supply[e] == Supply::voltage) continue;
    const double root = std::sqrt(charges.capacitance[e]);
    model_.dofs.gather(state, charges.coupling[e]);
    const Eigen::VectorXd column = -charges.coupling[e].head(matrix_.size) / root;
    append_border(column, column, -1);
    root_capacitance_[std::ssize(following_)] = root;
    following_.push_back(e);
  }
}

void BorderedTangent::eliminate() {
  solved_.resize(matrix_.size, columns_.cols());
  Eigen::VectorXd x;
  for (Eigen::Index i = 0; i < columns_.cols(); ++i) {
    solver_->solve(columns_.col(i), x);
    solved_.col(i) = x;
  }
  schur_ = -rows_.transpose() * solved_;
  schur_.diagonal() += corner_;
}

/// Where the borders find K almost without stiffness.
std::optional<int> BorderedTangent::weakest_equation() const {
  for (Eigen::Index i = 0; i < columns_.cols(); ++i) {
    const Eigen::ArrayXd energy = stiffness_.array() * solved_.col(i).array().square();
    const double stiff = (columns_.col(i).array().square() / stiffness_.array()).sum();
    if (energy.sum() <= nearly_singular * nearly_singular * stiff) continue;
    Eigen::Index weakest = 0;
    energy.maxCoeff(&weakest);
    return static_cast<int>(weakest);
  }
  return std::nullopt;
}

bool BorderedTangent::shift(int equation, const Eigen::VectorXd* added) {
  const double sigma = stiffness_[equation];
  Eigen::VectorXd stiffer = added ? *added : Eigen::VectorXd::Zero(matrix_.size);
  stiffer[equation] += sigma;
  if (!solver_->factor(&stiffer)) return false;
  const Eigen::VectorXd column = -std::sqrt(sigma) * Eigen::VectorXd::Unit(matrix_.size, equation);
  append_border(column, column, 1);
  eliminate();
  return true;
}

void BorderedTangent::count_modes(bool shifted) {
  const Eigen::Index symmetric = columns_.cols() - paths_;
  negative_pivots_ = solver_->negative_pivots() - model_.dofs.scalar_count();
  unstable_modes_ = negative_pivots_ + negative_eigenvalues(schur_.bottomRightCorner(symmetric, symmetric)) -
                    static_cast<int>(following_.size());
  if (shifted) negative_pivots_ += negative_eigenvalues(schur_.bottomRightCorner(1, 1));
}

bool BorderedTangent::factor(const State& state, const PathBorder* path, const Eigen::VectorXd* added) {
  follow_pattern();
  set_borders(state, path);
  const bool regular = solver_->factor(added);
  if (columns_.cols() == 0) {
    if (regular) negative_pivots_ = unstable_modes_ = solver_->negative_pivots() - model_.dofs.scalar_count();
    return regular;
  }
  if (!columns_.allFinite()) return false;
  std::optional<int> weakest;
  if (regular) {
    eliminate();
    weakest = weakest_equation();
  } else {
    weakest = solver_->singular_equation();
    if (*weakest < 0) return false;
  }
  if (weakest && !shift(*weakest, added)) return false;
  count_modes(weakest.has_value());
  lu_.compute(schur_);
  return lu_.isInvertible();
}

bool BorderedTangent::precondition(const State& state, bool close, const Eigen::VectorXd* right) {
  if (any_follows(state)) return factor(state);
  follow_pattern();
  set_borders(state, nullptr);
  if (!solver_->precondition(assembler_.convex(), close, right)) return false;
  negative_pivots_ = unstable_modes_ = solver_->negative_pivots() - model_.dofs.scalar_count();
  return true;
}

double BorderedTangent::solve(const Eigen::VectorXd& f, Eigen::VectorXd& du, double g, double tolerance) {
  solver_->solve(f, du, tolerance);
  if (columns_.cols() == 0) { // it may have found out that the matrix is not positive definite
    negative_pivots_ = unstable_modes_ = solver_->negative_pivots() - model_.dofs.scalar_count();
    return 0;
  }
  Eigen::VectorXd right = -rows_.transpose() * du;
  if (paths_) right[0] += g;
  border_unknowns_ = lu_.solve(right);
  du -= solved_ * border_unknowns_;
  return paths_ ? border_unknowns_[0] : 0.0;
}

double BorderedTangent::voltage_step(std::size_t port) const {
  const Eigen::Index i = std::ranges::find(following_, port) - following_.begin();
  return border_unknowns_[paths_ + i] / root_capacitance_[i];
}

Eigen::VectorXd BorderedTangent::response(std::size_t port) const {
  const Eigen::Index i = std::ranges::find(following_, port) - following_.begin();
  return -root_capacitance_[i] * solved_.col(paths_ + i);
}

} // namespace dielast::fem
