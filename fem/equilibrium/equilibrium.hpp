// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/equilibrium/bordered_tangent.hpp"
#include "fem/equilibrium/sheet_conduction.hpp"
#include "fem/model/assembler.hpp"

#include <algorithm>
#include <functional>

namespace dielast::fem {

/// One line of the iteration log.
struct Iteration {
  int number = 0;
  double residual = 0;     ///< relative
  double step_length = 0;  ///< fraction of the Newton step taken to get here
  int negative_pivots = 0; ///< of the tangent at fixed voltages whose step led here
};

struct NewtonOptions {
  double tolerance = 1e-9; ///< on |R_free| over the largest norm of a block's nodal forces (of the reactions,
                           ///< where one block is held), and on the correction over the extent
  int max_iterations = 25;
  bool wrinkles = false; ///< film carries no compression: where Newton's method fails damped steps go on, as
                         ///< with friction
};

enum class Outcome {
  converged,
  infeasible,
  not_converged,
  singular,
  off_path, ///< converged to a state that the path of the states before does not lead to
  refused,  ///< converged to a state that RampObserver::admits does not accept
};

struct NewtonResult {
  Outcome outcome{};
  int iterations = 0;
  double residual = 0;     ///< relative norm at the end
  int negative_pivots = 0; ///< unstable directions at fixed voltages, of the tangent at the end, or at most
                           ///< one small step before it
  int unstable_modes = 0;  ///< the same under the actual control: charges are kept where they are given
};

/// How well the forces of a state balance.
struct Balance {
  double energy = 0; ///< J, under the control: with Ports::supply_energy
  bool feasible = false;
  Eigen::VectorXd force; ///< internal minus dead ones, per equation
  double norm = 0;       ///< of the free ones, moments over the model's length scale, N
  double scale = 0;      ///< largest norm of a block's forces, N
};

/// CPU seconds of this process, by task; not read in models of a few unknowns.
struct Timings {
  double residual = 0, tangent = 0, factor = 0, solve = 0;
  int iterations = 0;
};

/// Whether Newton's method may end where the forces are balanced and the next step would be a correction of
/// this size (of step_size()): it is no more than is admitted, or, up to a millionth of the extent, the steps
/// no longer converge as they do but to a state that they can resolve. That is told by the `last_step`, a
/// full one (or infinity), from a state with a relative residual of `last_residual`: rounding, or a singular
/// tangent.
bool is_settled(double correction, double admitted, double last_step, double last_residual);

/// Finds states in which the internal forces balance the dead ones: Newton's method with backtracking on the
/// potential energy where the tangent is positive definite under the control, on the residual where it is
/// not.
///
/// Electrodes whose charge is given: E(u, Phi) + sum Q Phi is stationary in Phi where the film holds the
/// charges Q; this is solved for Phi at every u, so that Newton's method sees the energy at fixed charges, a
/// function of u with the tangent K + B C^-1 B^T (see BorderedTangent). Over a time step a circuit is the
/// same with more capacitance (see Circuit), and inertia one more quadratic energy (see InertialForce).
///
/// A closed chamber's pressure would follow a hardly compressible filling by orders of magnitude: there the
/// pressure is an unknown beside u, and every trial state is moved along the response to the pressure until
/// it has the volume that the filling takes (Model::fill).
///
/// Sheets: forces are balanced at fixed drops of voltage, then the drops follow the film (SheetConduction),
/// in turns, until the latter change no voltage by more than the tolerance; relaxed as in Aitken's method. So
/// stability is that at fixed drops.
///
/// Friction: forces are balanced with given bounds, then the bounds follow the normal forces, in turns, until
/// they stay. With those of the state before what stands would slide.
class Equilibrium {
 public:
  /// `threads`: 0 uses every core. The model must outlive this.
  Equilibrium(const Model& model, int threads);

  /// Improves `state` until it converges; its voltages under sheets, and in its history the bounds of
  /// friction, are found anew. On any other outcome `state` is where the iteration stopped.
  NewtonResult solve(State& state, const NewtonOptions& options,
                     const std::function<void(const Iteration&)>& log = {});
  /// solve() with the voltages under sheets as they are.
  NewtonResult balance_forces(State& state, const NewtonOptions& options,
                              const std::function<void(const Iteration&)>& log = {});

  /// Whether film that bears nothing but tension carries none, nor a field that balances one: the tangent
  /// tells of rounding there, and no path leads on.
  bool is_slack(const State& state) const;
  /// Per free equation whether it is one of such film, or of what carries it.
  std::vector<char> moved_by_film() const { return moved_by(true); }
  /// As it, of those that no bar, shell or solid beside it resists.
  std::vector<char> moved_by_film_alone() const;
  bool film_moves_all() const { return std::ranges::count(moved_by_film(), 0) == 0; }
  /// Whether all but so many unstable modes of a state are none: of film that carries no tension rounding has
  /// the sign, and film that is slack under a field keeps a trace of its compression. Modes of what else
  /// there is are what they are, however soft it is beside the film.
  bool is_neutral(const State& state, int unstable_modes, const NewtonOptions& options);

  /// That of the state which the last solve() has converged to; null where its voltages or pressures have
  /// moved since the forces were evaluated.
  const Balance* solved() const { return solved_ ? &*solved_ : nullptr; }

  /// Lets the voltages of sheets follow, at fixed displacements.
  void conduct(State& state) {
    if (conduction_) conduction_->solve(state);
  }

  /// Lets the voltages and pressures that are not given follow, those of sheets with them, at fixed
  /// displacements (and scalars). False where there are none that do.
  [[nodiscard]] bool follow(State& state) {
    conduct(state);
    return follow_charges(state, Pressure::follows);
  }

  /// Internal forces, those on tied nodes moved to their masters (count() entries; reactions at the held
  /// equations, from free_count() on).
  Evaluation internal_force(const State& state, Eigen::VectorXd& force) {
    const Evaluation evaluation = assembler_.residual(state, force);
    model_.dofs.gather(state, force);
    return evaluation;
  }

  /// Sets the voltages that are not given to what their charges need and evaluates the forces.
  void balance(State& state, Balance& balance);
  /// What Newton's next step may at most be (its step_size()) where a balance is an equilibrium; 0 where its
  /// forces do not balance. Forces alone do not tell: stiff directions make rounding, and what is left of
  /// their residual, larger than what keeps a soft one from its place. `previous_norm` is that of the
  /// iteration before, from which a full Newton step of size `step` led here; infinity at the start.
  double admitted_correction(const Balance& balance, double tolerance, double previous_norm,
                             double step) const;
  /// Largest displacement in a step, rotations times the model's length scale, over its extent.
  double step_size(const Eigen::VectorXd& step) const;
  /// Tangent at `state`, factored; see BorderedTangent::factor.
  [[nodiscard]] bool factor(const State& state, const PathBorder* path = nullptr,
                            const Eigen::VectorXd* added = nullptr);
  /// The same for solves only, as good as their tolerance: see BorderedTangent::precondition.
  [[nodiscard]] bool precondition(const State& state, bool close = false,
                                  const Eigen::VectorXd* right = nullptr);
  BorderedTangent& tangent() { return tangent_; }
  /// A positive weight per free equation that makes displacements comparable: the diagonal of the tangent as
  /// drawn, with dashpots that have flowed (N/m, N m for rotations), not less than a small part of the
  /// largest.
  const Eigen::VectorXd& stiffness() const { return stiffness_; }
  /// What makes moments comparable with forces: 1 for forces, 1/(model's length scale) for moments, per
  /// equation.
  const Eigen::VectorXd& weight() const { return weight_; }
  /// Energy that goes with displacements as large as the model in the norm of stiffness(), J.
  double energy_scale() const { return energy_scale_; }

  /// Norm of residuals that are only rounding of the positions, N.
  double round_off() const { return round_off_; }
  const Model& model() const { return model_; }
  Assembler& assembler() { return assembler_; }
  const Timings& timings() const { return timings_; }

 private:
  NewtonResult balance_sheets(State& state, const NewtonOptions& options,
                              const std::function<void(const Iteration&)>& log);
  NewtonResult newton(State& state, const NewtonOptions& options,
                      const std::function<void(const Iteration&)>& log);
  NewtonResult descend(State& state, const NewtonOptions& options,
                       const std::function<void(const Iteration&)>& log);
  double weighted_norm(const Eigen::VectorXd& force, Eigen::Index count) const;
  /// How the pressure of a closed chamber is found.
  enum class Pressure { follows, is_unknown };
  void balance(State& state, Balance& balance, Pressure pressure);
  bool follow_charges(State& state, Pressure pressure) const;
  bool fill(State& state);
  double film_stiffness() const;
  std::vector<char> moved_by(bool film) const;
  State widened(State state, double strain) const;
  double backtrack(State& state, Balance& current, const Eigen::VectorXd& step, int halvings,
                   double balanced_to);

  const Model& model_;
  Assembler assembler_;
  Eigen::VectorXd weight_;
  Eigen::VectorXd stiffness_;
  double film_stiffness_ = 0;
  BorderedTangent tangent_;
  std::optional<SheetConduction> conduction_; ///< where there are sheets
  std::optional<Balance> solved_;
  // Workspace: Newton's method allocates in its first iteration only.
  State trial_;
  Balance there_;
  Eigen::VectorXd right_;
  double energy_scale_ = 0;
  double round_off_ = 0;
  Timings timings_;
};

} // namespace dielast::fem
