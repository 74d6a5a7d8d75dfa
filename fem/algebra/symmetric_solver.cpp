// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/symmetric_solver.hpp"

#include <cholmod.h>
#include <dmumps_c.h>
#include <sys/mman.h>

#include <algorithm>
#include <new>
#include <stdexcept>

// Of the OpenMP runtime of GCC, which CHOLMOD was compiled for; the one of another compiler would be a second
// in the process.
extern "C" int omp_get_max_active_levels();
extern "C" void omp_set_max_active_levels(int);
extern "C" void openblas_set_num_threads(int) __attribute__((weak));
extern "C" void dpotrf_(const char* uplo, const int* n, double* A, const int* stride, int* info);

namespace dielast::fem {

namespace {

/// Above this many unknowns nested dissection repays its slower analysis.
constexpr int nested_dissection_from = 60000;

/// A pivot below this fraction of its diagonal entry is round-off.
constexpr double singular_pivot = 1e-13;

/// CHOLMOD opens as many OpenMP threads as it was compiled for, whatever the machine has, around loops that
/// are too short for them: switched off while it works. A BLAS that threads by itself would make results
/// depend on the number of threads, so it gets one.
class OneThread {
 public:
  OneThread() : levels_(omp_get_max_active_levels()) {
    omp_set_max_active_levels(0);
    if (openblas_set_num_threads) openblas_set_num_threads(1);
  }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_;
};

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
  const int one = 1;
  double number = 1;
  int info = 0;
  dpotrf_("L", &one, &number, &one, &info);
  return true;
}

} // namespace

struct SymmetricSolver::Cholesky {
  explicit Cholesky(const SparseSymmetric& matrix) {
    [[maybe_unused]] static const bool has_buffer = has_blas_buffer();
    const OneThread one_thread;
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.final_ll = 1;
    common.quick_return_if_not_posdef = 1;
    common.error_handler = nullptr;
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = matrix.size < nested_dissection_from ? CHOLMOD_AMD : CHOLMOD_METIS;
    common.postorder = 1;
    A.nrow = A.ncol = static_cast<std::size_t>(matrix.size);
    A.nzmax = matrix.rows.size();
    A.p = const_cast<int*>(matrix.column_start.data());
    A.i = const_cast<int*>(matrix.rows.data());
    A.x = const_cast<double*>(matrix.values.data()); // set again by factor(): the vector may have moved
    A.stype = -1;
    A.itype = CHOLMOD_INT;
    A.xtype = CHOLMOD_REAL;
    A.dtype = CHOLMOD_DOUBLE;
    A.sorted = 1;
    A.packed = 1;
    L = cholmod_analyze(&A, &common);
    if (!L) throw std::bad_alloc();
  }
  ~Cholesky() {
    cholmod_free_dense(&X, &common);
    cholmod_free_dense(&Y, &common);
    cholmod_free_dense(&E, &common);
    cholmod_free_factor(&L, &common);
    cholmod_finish(&common);
  }
  Cholesky(const Cholesky&) = delete;
  Cholesky& operator=(const Cholesky&) = delete;

  bool factor(const std::vector<double>& values) {
    const OneThread one_thread;
    A.x = const_cast<double*>(values.data());
    cholmod_factorize(&A, L, &common);
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    return common.status == CHOLMOD_OK && L->minor == A.nrow;
  }
  struct Pivot {
    double relative = 1; ///< over the diagonal entry that it came from: no units
    int equation = -1;
  };
  /// Round-off when the matrix is singular.
  Pivot smallest_pivot(const std::vector<double>& entries) const {
    const auto* super = static_cast<const int*>(L->super);
    const auto* row_start = static_cast<const int*>(L->pi);
    const auto* value_start = static_cast<const int*>(L->px);
    const auto* permutation = static_cast<const int*>(L->Perm);
    const auto* values = static_cast<const double*>(L->x);
    const auto* column_start = static_cast<const int*>(A.p);
    Pivot smallest;
    for (std::size_t s = 0; s < L->nsuper; ++s)
      for (int k = super[s]; k < super[s + 1]; ++k) {
        const int column = k - super[s], height = row_start[s + 1] - row_start[s];
        const double root = values[value_start[s] + column + column * height];
        const int equation = permutation[k];
        const double relative = root * root / entries[static_cast<std::size_t>(column_start[equation])];
        if (relative < smallest.relative) smallest = {relative, equation};
      }
    return smallest;
  }
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
    const OneThread one_thread;
    cholmod_dense B{};
    B.nrow = B.d = B.nzmax = A.nrow;
    B.ncol = 1;
    B.x = const_cast<double*>(b.data());
    B.xtype = CHOLMOD_REAL;
    B.dtype = CHOLMOD_DOUBLE;
    if (!cholmod_solve2(CHOLMOD_A, L, &B, nullptr, &X, nullptr, &Y, &E, &common)) throw std::bad_alloc();
    x = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(X->x),
                                          static_cast<Eigen::Index>(A.nrow));
  }

  cholmod_common common{};
  cholmod_sparse A{};
  cholmod_factor* L = nullptr;
  cholmod_dense *X = nullptr, *Y = nullptr, *E = nullptr; // kept workspaces
};

struct SymmetricSolver::Indefinite {
  static constexpr int use_comm_world = -987654; // MUMPS' own constant

  explicit Indefinite(const SparseSymmetric& matrix) {
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
    mumps.n = matrix.size;
    mumps.nnz = static_cast<MUMPS_INT8>(rows.size());
    mumps.irn = rows.data();
    mumps.jcn = columns.data();
    call(1);
    if (mumps.infog[0] < 0) throw std::bad_alloc();
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
  std::vector<int> rows, columns;
};

SymmetricSolver::SymmetricSolver(const SparseSymmetric& matrix, bool indefinite)
    : matrix_(matrix),
      cholesky_(matrix.size > 0 && !indefinite ? std::make_unique<Cholesky>(matrix) : nullptr) {}
SymmetricSolver::~SymmetricSolver() = default;

bool SymmetricSolver::factor(const Eigen::VectorXd* added) {
  if (matrix_.size == 0) return true;
  if (added) {
    shifted_ = matrix_.values;
    for (int c = 0; c < matrix_.size; ++c)
      shifted_[static_cast<std::size_t>(matrix_.column_start[static_cast<std::size_t>(c)])] += (*added)[c];
  }
  const std::vector<double>& values = added ? shifted_ : matrix_.values;
  definite_ = cholesky_ && cholesky_->factor(values);
  if (definite_) {
    const auto [relative, equation] = cholesky_->smallest_pivot(values);
    singular_equation_ = equation;
    return relative > singular_pivot;
  }
  if (!indefinite_) indefinite_ = std::make_unique<Indefinite>(matrix_);
  const bool regular = indefinite_->factor(values);
  singular_equation_ = indefinite_->singular_equation();
  return regular;
}

int SymmetricSolver::negative_pivots() const { return definite_ ? 0 : indefinite_->negative_pivots(); }

void SymmetricSolver::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  if (matrix_.size == 0)
    x.resize(0);
  else if (definite_)
    cholesky_->solve(b, x);
  else
    indefinite_->solve(b, x);
}

} // namespace dielast::fem
