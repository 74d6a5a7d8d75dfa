// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/symmetric_solver.hpp"

#include "fem/algebra/kept_factor.hpp"
#include "fem/algebra/mumps.hpp"

#include <dmumps_c.h>

#include <limits>
#include <optional>
#include <utility>

namespace dielast::fem {

namespace {

/// A pivot below this fraction of its diagonal entry is round-off.
constexpr double singular_pivot = 1e-13;

} // namespace

struct SymmetricSolver::Cholesky {
  Cholesky(const SparseSymmetric& matrix, Workers& threads)
      : supernodes(matrix, threads.count()), workers(threads) {}

  bool decompose(const std::vector<double>& values) {
    if (!factor) factor.emplace(supernodes, workers);
    return factor->factor(values);
  }

  KeptFactor& keep(const SparseSymmetric& matrix) {
    return kept ? *kept : kept.emplace(matrix, supernodes, workers);
  }

  Supernodes supernodes;
  Workers& workers;
  std::optional<MultifrontalCholesky<double>> factor;
  std::optional<KeptFactor> kept;
};

struct SymmetricSolver::Indefinite : Mumps<DMUMPS_STRUC_C, dmumps_c> {
  explicit Indefinite(const SparseSymmetric& matrix) : Mumps(matrix, true) {}
};

SymmetricSolver::SymmetricSolver(const SparseSymmetric& matrix, Workers& workers, bool indefinite)
    : matrix_(matrix),
      cholesky_(matrix.size > 0 && !indefinite ? std::make_unique<Cholesky>(matrix, workers) : nullptr) {}
SymmetricSolver::~SymmetricSolver() = default;

bool SymmetricSolver::factor(const Eigen::VectorXd* added) {
  if (matrix_.size == 0) return true;
  if (added) {
    shifted_ = matrix_.values;
    for (int c = 0; c < matrix_.size; ++c)
      shifted_[static_cast<std::size_t>(matrix_.column_start[static_cast<std::size_t>(c)])] += (*added)[c];
  }
  const std::vector<double>& values = added ? shifted_ : matrix_.values;
  iterates_ = false;
  ++work_.factorisations;
  definite_ = cholesky_ && cholesky_->decompose(values);
  if (definite_) {
    const auto [relative, equation] = cholesky_->factor->smallest_pivot();
    singular_equation_ = equation;
    return relative > singular_pivot;
  }
  if (!indefinite_) indefinite_ = std::make_unique<Indefinite>(matrix_);
  const bool regular = indefinite_->factor(const_cast<double*>(values.data()));
  singular_equation_ = indefinite_->singular_equation();
  return regular;
}

int SymmetricSolver::negative_pivots() const { return definite_ ? 0 : indefinite_->negative_pivots(); }

bool SymmetricSolver::precondition(bool known, bool close, const Eigen::VectorXd* right) {
  if (close && !known && iterates_) return true;
  const double least = known ? KeptFactor::least_cost : KeptFactor::least_cost_to_prove;
  if (!cholesky_ || KeptFactor::cost(cholesky_->supernodes) < least) return factor();
  KeptFactor& kept = cholesky_->keep(matrix_);
  if (!(known ? kept.prepare() : kept.prove(right))) return factor();
  definite_ = iterates_ = true;
  return true;
}

void SymmetricSolver::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance) {
  if (matrix_.size == 0) {
    x.resize(0);
    return;
  }
  if (iterates_) {
    if (cholesky_->kept->solve(b, x, tolerance)) return;
    if (!factor()) {
      x.setConstant(b.size(), std::numeric_limits<double>::quiet_NaN());
      return;
    }
  }
  ++work_.solves;
  if (definite_)
    cholesky_->factor->solve(b, x);
  else
    indefinite_->solve((x = b).data(), 1);
}

const FactorMemory* SymmetricSolver::memory() const {
  return cholesky_ && cholesky_->kept ? &cholesky_->kept->memory() : nullptr;
}

void SymmetricSolver::recall(FactorMemory memory) {
  if (cholesky_) cholesky_->keep(matrix_).recall(std::move(memory));
}

SymmetricSolver::Work SymmetricSolver::work() const {
  Work work = work_;
  if (cholesky_ && cholesky_->kept) {
    work.factorisations += cholesky_->kept->factorisations();
    work.solves += cholesky_->kept->solves();
  }
  return work;
}

} // namespace dielast::fem
