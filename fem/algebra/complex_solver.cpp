// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/complex_solver.hpp"

#include "fem/algebra/nested_dissection.hpp"

#include <zmumps_c.h>

#include <new>

namespace dielast::fem {

struct ComplexSolver::Factorisation {
  static constexpr int use_comm_world = -987654; // MUMPS' own constant

  explicit Factorisation(const SparseSymmetric& matrix) {
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
    mumps.icntl[5] = 0;                                                               // no permutation,
    mumps.icntl[11] = 1;  // usual ordering: both would read the values in the analysis
    mumps.icntl[23] = 1;  // detect null pivots
    mumps.icntl[13] = 50; // % spare workspace
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
  }
  ~Factorisation() { call(-2); }
  Factorisation(const Factorisation&) = delete;
  Factorisation& operator=(const Factorisation&) = delete;

  void call(int job) {
    mumps.job = job;
    zmumps_c(&mumps);
  }

  ZMUMPS_STRUC_C mumps{};
  std::vector<int> rows, columns, order;
};

ComplexSolver::ComplexSolver(const SparseSymmetric& matrix)
    : factorisation_(matrix.size > 0 ? std::make_unique<Factorisation>(matrix) : nullptr) {}
ComplexSolver::~ComplexSolver() = default;

bool ComplexSolver::factor(std::vector<std::complex<double>>& values) {
  if (!factorisation_) return true;
  constexpr int workspace_too_small = -9;
  auto& mumps = factorisation_->mumps;
  mumps.a = reinterpret_cast<ZMUMPS_COMPLEX*>(values.data());
  for (factorisation_->call(2); mumps.infog[0] == workspace_too_small && mumps.icntl[13] < 1000;
       factorisation_->call(2))
    mumps.icntl[13] *= 2;
  return mumps.infog[0] >= 0 && mumps.infog[27] == 0;
}

Eigen::MatrixXcd ComplexSolver::solve(Eigen::MatrixXcd B) {
  if (!factorisation_ || B.cols() == 0) return B;
  auto& mumps = factorisation_->mumps;
  mumps.nrhs = static_cast<MUMPS_INT>(B.cols());
  mumps.lrhs = static_cast<MUMPS_INT>(B.rows());
  mumps.rhs = reinterpret_cast<ZMUMPS_COMPLEX*>(B.data());
  factorisation_->call(3);
  return B;
}

} // namespace dielast::fem
