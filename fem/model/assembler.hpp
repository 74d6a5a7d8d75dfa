// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/machine/workers.hpp"
#include "fem/model/model.hpp"
#include "fem/model/tie_reduction.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace dielast::fem {

class ContactBlock;

/// Assembles the energy, residual and tangent of a model. The sparsity pattern, the place of every element
/// entry in it and a colouring of element chunks are found once, and again where a contact chooses other
/// elements. Chunks of one colour share no unknown, so
/// that they are computed by any number of threads without locks and every sum is formed in the same order:
/// results are identical bit for bit.
class Assembler {
 public:
  /// `threads`: 0 uses every core.
  Assembler(const Model& model, int threads);

  /// Energy and residual of the internal forces (count() entries: free equations, reactions at held ones, and
  /// what acts on tied nodes, see DofMap::gather).
  Evaluation residual(const State& state, Eigen::VectorXd& residual);
  /// What each block contributed to the last residual: film and walls may balance, these show how large they
  /// are.
  const std::vector<Eigen::VectorXd>& block_residuals() const { return block_residual_; }
  /// Computes the tangent of the free equations, that of inertia included, read through matrix().
  void tangent(const State& state);
  /// Whether the last tangent is known to be positive definite where the model is held: Evaluation::convex.
  bool convex() const { return convex_; }

  /// What relaxed branches resist besides that, in the pattern of matrix(): see ElementBlock::add_relaxation.
  std::vector<double> relaxation(const State& state, const RateWeight& weight) const;

  /// Mass and damping in that pattern; empty where there is none.
  std::vector<double> mass(const State& state) const { return without_ties(state, resistance().mass); }
  std::vector<double> damping(const State& state) const { return without_ties(state, resistance().damping); }
  const SparseSymmetric& matrix() const { return reduction_ ? reduced_ : matrix_; }
  /// How often the pattern of matrix() has been found: tangent() may find another one.
  int patterns() const { return patterns_; }

  /// One where the model is too small for more.
  Workers& workers() const { return *workers_; }

 private:
  struct Chunk {
    int block, first, last;
  };

  /// A block whose elements may change, with the choice that the equations are of.
  struct Contact {
    std::size_t block;
    ContactBlock* elements;
    std::size_t choice;
  };

  /// Of the model's inertia, values in the pattern of matrix_; empty without.
  struct Resistance {
    std::vector<double> mass, damping;
    int of_pattern = 0; ///< the number of that pattern
  };

  const Resistance& resistance() const;
  void number_elements(std::size_t block);
  void choose_elements(const State& state);
  void find_pattern();
  void build_pattern();
  void place_elements(std::size_t block);
  bool place_by_nodes(NodeOrder order, std::span<const int> equations, std::span<int> pairs) const;
  void colour_chunks();
  int unknown(int equation) const; ///< of matrix_; negative: none
  int equation(int unknown) const; ///< of matrix_
  std::vector<double> on_pattern(const Eigen::SparseMatrix<double>& constant) const;
  Scatter scatter(std::size_t block, double* residual, double* tangent) const;
  Evaluation run(const State& state, bool want_residual, bool want_tangent);
  void add_inertia(const State& state);
  std::vector<double> without_ties(const State& state, std::vector<double> values) const;

  const Model& model_;
  std::unique_ptr<Workers> workers_;
  SparseSymmetric matrix_; ///< over the free unknowns, then those of tied nodes
  std::optional<TieReduction> reduction_;
  SparseSymmetric reduced_; ///< over the free unknowns, where there are ties
  int patterns_ = 0;
  bool stale_ = false; ///< the pattern is not that of the elements
  std::vector<Contact> contacts_;
  std::vector<std::vector<int>> equations_; ///< per block, see Scatter
  std::vector<std::vector<int>> slots_, pairs_;
  std::vector<std::vector<Chunk>> colours_;
  std::vector<Eigen::VectorXd> block_residual_;
  std::vector<Evaluation> parts_; ///< of the chunks of a colour
  bool convex_ = false;
  mutable Resistance resistance_;
};

} // namespace dielast::fem
