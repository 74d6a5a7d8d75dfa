// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/dofs.hpp"
#include "fem/model/samples.hpp"
#include "fem/model/sheet.hpp"
#include "fem/model/state.hpp"

#include <functional>
#include <span>
#include <vector>

namespace dielast::fem {

/// Of elements whose unknowns stand node by node, so many of each; others may stand behind them.
struct NodeOrder {
  int nodes = 0, unknowns = 0;

  int pairs() const { return nodes * (nodes - 1) / 2; }
};

/// Where a block adds what it computes: element dof -> equation, element dof pair -> place in the sparse
/// tangent; negative where there is none (an unknown that does not exist, a tangent entry of a held one).
/// Where two unknowns of an element share an equation, their off-diagonal entry counts twice on its diagonal:
/// the place is then twice(place).
struct Scatter {
  static constexpr int none = -1;
  static constexpr int twice(int place) { return -2 - place; }

  const int* equation = nullptr; ///< dofs_per_element entries per element
  const int* slot = nullptr;     ///< lower triangle, row by row, dofs*(dofs+1)/2 entries per element
  double* residual = nullptr;    ///< null: not wanted
  double* tangent = nullptr;     ///< null: not wanted
  /// Of blocks with a NodeOrder, which have slots for few elements only: see add_by_nodes().
  const int *pair = nullptr, *column_start = nullptr;

  void add_residual(int element, std::span<const double> values) const {
    add_residual(element, values, values.size());
  }
  /// Of the first of `all` dofs of the element.
  void add_residual(int element, std::span<const double> values, std::size_t all) const {
    const int* e = equation + static_cast<std::ptrdiff_t>(element) * static_cast<std::ptrdiff_t>(all);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (e[i] >= 0) residual[e[i]] += values[i];
  }
  /// Has an element's places fetched that add_tangent() will write, while the element is computed: most of
  /// what adding takes is waiting for them.
  void fetch_tangent(int element, std::size_t entries) const {
    const int* s = slot + static_cast<std::ptrdiff_t>(element) * static_cast<std::ptrdiff_t>(entries);
    for (std::size_t i = 0; i < entries; ++i)
      if (s[i] >= 0) __builtin_prefetch(tangent + s[i], 1);
  }
  void add_tangent(int element, std::span<const double> packed) const {
    add_tangent(element, packed, packed.size());
  }
  /// Likewise, of the first of `all` entries.
  void add_tangent(int element, std::span<const double> packed, std::size_t all) const {
    const int* s = slot + static_cast<std::ptrdiff_t>(element) * static_cast<std::ptrdiff_t>(all);
    for (std::size_t i = 0; i < packed.size(); ++i) {
      if (s[i] >= 0)
        tangent[s[i]] += packed[i];
      else if (s[i] != none)
        tangent[twice(s[i])] += 2 * packed[i];
    }
  }
};

/// What a range of elements says of a trial state besides what it scattered.
struct Evaluation {
  double energy = 0;    ///< J
  bool feasible = true; ///< false: some element cannot be in this state (inverted, beyond a limit)
  /// Where the tangent was wanted: it is known that every displacement but a translation costs energy, so
  /// that a model of such blocks that is held has a positive definite tangent. False: not known.
  bool convex = false;
};

/// What the ports hold at a state: Q_p = -dE/dPhi_p of the energy E(u, Phi) that the blocks give. Of a
/// chamber it is the volume: minus the derivative with respect to the pressure.
struct Charges {
  std::vector<double> charge; ///< per port, C, or m^3
  /// dQ_p/dPhi_p at fixed u, F (m^3/Pa); without couplings at the present width of wrinkled film, too: Q/Phi.
  std::vector<double> capacitance;
  std::vector<Eigen::VectorXd> coupling; ///< dQ_p/du per port, count() entries; left out when not wanted
};

/// Where the energy of a state is.
struct EnergyParts {
  double elastic = 0;     ///< stored by the equilibrium laws and the walls, J
  double branches = 0;    ///< stored by the springs of the branches, J
  double electric = 0;    ///< of the field: sum of Q Phi / 2, J
  double kinetic = 0;     ///< of everything that has a mass, J
  double regularised = 0; ///< part of `elastic` that only keeps wrinkled film from being singular, J
  double dissipation = 0; ///< power that dashpots turn into heat by their flow rules, W
};

/// A factor for each rate of relaxation, 1/s.
using RateWeight = std::function<double(double rate)>;

/// Elements of one type in contiguous arrays. Pure functions of the state: energy, residual = dE/du, tangent
/// = d2E/du2 (u: displacements and spins about the current rotation). One virtual call for a range of
/// elements, never per element.
class ElementBlock {
 public:
  virtual ~ElementBlock() = default;

  virtual int element_count() const = 0;
  virtual int dofs_per_element() const = 0;
  /// Elements with so many equal nodes have their tangents added node by node, by add_by_nodes().
  virtual NodeOrder node_order() const { return {}; }
  /// Whether it is film that across itself resists nothing but by its tension, and slack nothing at all.
  virtual bool may_be_slack() const { return false; }
  /// See MembraneSection::wrinkled, of film; 0: it is none.
  virtual double left_where_wrinkled() const { return 0; }
  /// Elements are evaluated in multiples of this many.
  virtual int granularity() const { return 1; }
  /// Adds this block's scalars and remembers their places; to be called before the unknowns are numbered.
  virtual void place_scalars(DofMap& /*dofs*/) {}
  /// Adds the unknowns of this block's nodes, as far as the model can move.
  virtual void claim_dofs(DofMap& dofs, Dimension dimension) = 0;
  /// Equations of one element, DofMap::absent where an unknown does not exist.
  virtual void element_equations(int element, const DofMap& dofs, std::span<int> equations) const = 0;
  /// Evaluates elements first..last-1 and scatters what is wanted.
  virtual Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const = 0;
  /// Adds what it exerts besides dE/du on equations that rest, and that its energy therefore does not know
  /// (N, with the sign of a residual; at other equations nothing but rounding).
  virtual void add_forces_at_rest(const State& /*state*/, const DofMap& /*dofs*/,
                                  Eigen::VectorXd& /*residual*/) const {}
  /// Appends this block's integration points.
  virtual void sample(const State& state, Samples& samples) const = 0;

  /// Adds this block's share of the electrodes' charges; `dofs` asks for dQ/du as well.
  virtual void add_charges(const State& /*state*/, const DofMap* /*dofs*/, Charges& /*charges*/) const {}
  /// Puts the potentials among this block's scalars in equilibrium at fixed displacements and voltages.
  virtual void balance_field(State& /*state*/) const {}
  /// By how much dQ/dPhi of an electrode is smaller where this block's potentials follow, F.
  virtual double screened_capacitance(const State& /*state*/, std::size_t /*electrode*/) const { return 0; }
  /// Claims the points of the sheets that this block's elements lie under.
  virtual void place_sheets(SheetMap& /*sheets*/) {}
  /// Adds its share of the sheets' matrices; conductances of 1/Ohm per square.
  virtual void add_sheets(const State& /*state*/, SheetMatrices& /*matrices*/) const {}
  virtual void add_energies(const State& state, EnergyParts& parts) const {
    parts.elastic += evaluate(state, 0, element_count(), {}).energy;
  }
  /// Adds the element's mass matrix, which does not change (kg, lower triangle row by row as in Scatter).
  virtual void add_mass(int /*element*/, std::span<double> /*packed*/) const {}
  /// Adds what it resists motion with, likewise (N s/m).
  virtual void add_damping(int /*element*/, std::span<double> /*packed*/) const {}
  /// Adds what it resists the square of velocity with, per dof of the element: d in d |v| v (N s^2/m^2).
  virtual void add_drag(int /*element*/, std::span<double> /*drag*/) const {}
  /// Adds sum_j weight(rate_j) K_j to the tangent: what relaxed branches resist besides their equilibrium
  /// tangent, taken apart by rates (see Relaxation). Throws std::domain_error where branches are not relaxed
  /// or their film is wrinkled.
  virtual void add_relaxation(const State& /*state*/, const RateWeight& /*weight*/,
                              const Scatter& /*scatter*/) const {}
  /// Number of internal variables of this block.
  virtual int history_size() const { return 0; }
  /// Tells where the block's variables start in the model's.
  virtual void place_history(int /*first*/) {}
  /// Internal variables of the undeformed, relaxed block.
  virtual void start_history(std::vector<double>& /*all*/) const {}
  /// Writes the internal variables at a converged state, reached by state.scheme, to their places in `all`.
  virtual void advance_history(const State& /*state*/, std::vector<double>& /*all*/) const {}
};

} // namespace dielast::fem
