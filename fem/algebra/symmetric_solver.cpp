// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/symmetric_solver.hpp"

#include "fem/algebra/kept_factor.hpp"
#include "fem/algebra/nested_dissection.hpp"
#include "fem/machine/memory.hpp"
#include "fem/machine/one_thread.hpp"

#include <dmumps_c.h>
#include <sys/mman.h>

#include <limits>
#include <new>
#include <optional>
#include <stdexcept>

extern "C" void dpotrf_(const char* uplo, const int* n, double* A, const int* stride, int* info);

namespace dielast::fem {

namespace {

/// A pivot below this fraction of its diagonal entry is round-off.
constexpr double singular_pivot = 1e-13;

/// OpenBLAS tries for ever to get its buffer where memory is limited: asked for beforehand, and taken at once
/// by the smallest factorisation, the buffer is there, or its lack is told.
bool has_blas_buffer() {
  if (!openblas_set_num_threads) return true;
  constexpr std::size_t buffer = (128 << 20) + (1 << 16);
  void* const memory = mmap(nullptr, buffer, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw std::runtime_error(
        "the limit of memory is too low for OpenBLAS, which needs 128 MB: see ulimit -v");
  munmap(memory, buffer);
  double number = 1;
  const int one = 1;
  int info = 0;
  dpotrf_("L", &one, &number, &one, &info);
  return info == 0;
}

} // namespace

struct SymmetricSolver::Cholesky {
  Cholesky(const SparseSymmetric& matrix, Workers& threads)
      : supernodes(matrix, threads.count()), workers(threads) {}

  bool decompose(const std::vector<double>& values) {
    if (!factor) factor.emplace(supernodes, workers);
    return factor->factor(values);
  }

  Supernodes supernodes;
  Workers& workers;
  std::optional<MultifrontalCholesky<double>> factor;
  std::optional<KeptFactor> kept;
};

struct SymmetricSolver::Indefinite {
  static constexpr int use_comm_world = -987654; // MUMPS' own constant

  explicit Indefinite(const SparseSymmetric& matrix) {
    [[maybe_unused]] static const bool has_buffer = has_blas_buffer();
    rows.reserve(matrix.rows.size());
    columns.reserve(matrix.rows.size());
    for (int c = 0; c < matrix.size; ++c)
      for (int k = matrix.column_start[static_cast<std::size_t>(c)];
           k < matrix.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
        rows.push_back(matrix.rows[static_cast<std::size_t>(k)] + 1);
        columns.push_back(c + 1);
      }
    mumps.par = 1;
    mumps.sym = 2;
    mumps.comm_fortran = use_comm_world;
    call(-1);
    for (const int output : {0, 1, 2, 3}) mumps.icntl[output] = output == 3 ? 0 : -1; // silent
    mumps.icntl[23] = 1;                                                              // detect null pivots
    mumps.icntl[13] = 50;                                                             // % spare workspace
    // Ordered by us: its own choice, SCOTCH, draws another order at random each time.
    order = metis_positions(matrix.column_start, matrix.rows);
    for (int& place : order) ++place;
    mumps.icntl[6] = 1;
    mumps.perm_in = order.data();
    mumps.n = matrix.size;
    mumps.nnz = static_cast<MUMPS_INT8>(rows.size());
    mumps.irn = rows.data();
    mumps.jcn = columns.data();
    call(1);
    if (mumps.infog[0] < 0) throw std::bad_alloc();
    constexpr double megabyte = 1e6;
    require_memory(mumps.infog[16] * megabyte,
                   "the factor of an indefinite tangent of " + std::to_string(matrix.size) + " unknowns");
  }
  ~Indefinite() { call(-2); }
  Indefinite(const Indefinite&) = delete;
  Indefinite& operator=(const Indefinite&) = delete;

  void call(int job) {
    const OneThread one_thread;
    mumps.job = job;
    dmumps_c(&mumps);
  }
  bool factor(const std::vector<double>& values) {
    constexpr int workspace_too_small = -9;
    mumps.a = const_cast<double*>(values.data());
    for (call(2); mumps.infog[0] == workspace_too_small && mumps.icntl[13] < 1000; call(2))
      mumps.icntl[13] *= 2;
    return mumps.infog[0] >= 0 && mumps.infog[27] == 0;
  }
  int negative_pivots() const { return mumps.infog[11]; }
  int singular_equation() const {
    return mumps.infog[0] >= 0 && mumps.infog[27] > 0 ? mumps.pivnul_list[0] - 1 : -1;
  }
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    x = b;
    mumps.rhs = x.data();
    call(3);
  }

  DMUMPS_STRUC_C mumps{};
  std::vector<int> rows, columns, order;
};

SymmetricSolver::SymmetricSolver(const SparseSymmetric& matrix, Workers& workers, bool indefinite)
    : matrix_(matrix), workers_(workers),
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
  const bool regular = indefinite_->factor(values);
  singular_equation_ = indefinite_->singular_equation();
  return regular;
}

int SymmetricSolver::negative_pivots() const { return definite_ ? 0 : indefinite_->negative_pivots(); }

bool SymmetricSolver::precondition(bool known) {
  const double least = known ? KeptFactor::least_cost : KeptFactor::least_cost_to_prove;
  if (!cholesky_ || KeptFactor::cost(cholesky_->supernodes) < least) return factor();
  if (!cholesky_->kept) cholesky_->kept.emplace(matrix_, cholesky_->supernodes, workers_);
  if (!(known ? cholesky_->kept->prepare() : cholesky_->kept->prove())) return factor();
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
    indefinite_->solve(b, x);
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
