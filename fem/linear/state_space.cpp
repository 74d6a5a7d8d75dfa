// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/state_space.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/algebra/orientation.hpp"
#include "fem/linear/harmonic.hpp"
#include "fem/linear/modal.hpp"
#include "fem/linear/rigid_motions.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace dielast::fem {

namespace {

/// Energy of a static response, over the whole, below which the modes say it all.
constexpr double negligible = 1e-10;
constexpr double energy_round_off = 1e-13; ///< likewise
constexpr double propped_by = 1e-3;        ///< of the lowest mode's omega^2

/// Columns that span `responses` besides the modes, orthonormal in K, oriented with this weight.
Eigen::MatrixXd residual_responses(const Linearisation& linear, const Eigen::MatrixXd& modes,
                                   Eigen::MatrixXd responses, const Eigen::VectorXd& weight) {
  const auto& K = linear.stiffness();
  for (Eigen::Index i = 0; i < responses.cols(); ++i)
    responses.col(i) /= std::sqrt(projected(K, K.values, responses.col(i))(0, 0));
  Eigen::MatrixXd both(modes.rows(), modes.cols() + responses.cols());
  both << modes, responses;
  const Eigen::MatrixXd shares =
      projected(K, linear.mass(), both).topRightCorner(modes.cols(), responses.cols());
  responses -= modes * shares;
  const SymmetricEigen energy = symmetric_eigen(projected(K, K.values, responses));
  const Eigen::Index kept = (energy.values.array() > negligible).count(); // ascending: the last ones
  Eigen::VectorXd energies = energy.values.tail(kept);
  Eigen::MatrixXd residual =
      responses * energy.vectors.rightCols(kept) * energies.cwiseSqrt().cwiseInverse().asDiagonal();
  orient(residual, energies, energy_round_off, weight);
  return residual;
}

/// Vibration modes, then static responses.
struct Basis {
  Eigen::Index modes = 0;
  Eigen::MatrixXd V;
};

Basis basis_of(Equilibrium& equilibrium, State state, const Linearisation& linear,
               const ModalBasis& options) {
  if (options.drifts && std::ranges::any_of(linear.damping(), [](double c) { return c != 0; }))
    throw std::domain_error(
        "nothing but dampers holds the device: it drifts, which no linear model here does");
  const auto found = vibration_modes(equilibrium, state, {.count = options.modes, .drifts = options.drifts});
  if (!found) throw std::domain_error("no vibration modes were found at the operating point");
  if (!found->empty() && found->front().stiffness <= 0)
    throw std::domain_error("the operating point is not stable");
  Eigen::MatrixXd modes(linear.stiffness().size, 0), responses = modes;
  for (const VibrationMode& mode : *found)
    if (mode.frequency() <= options.highest_frequency) append_columns(modes, mode.shape);
  std::ranges::fill(state.supply, Supply::voltage);
  // What drifts has no static response; with a little of its mass as stiffness it has, but for the modes'
  // part.
  if (options.drifts && !found->empty())
    state.motion_scheme = mass_times(propped_by * found->front().stiffness);
  Eigen::VectorXd response;
  for (const auto& scheme : {materials::TimeScheme::relaxed(), materials::TimeScheme::frozen()}) {
    if (scheme.is_frozen() && linear.rates().empty()) continue;
    state.scheme = scheme;
    if (!equilibrium.factor(state)) throw std::domain_error("the operating point is not stable");
    for (const auto& port : linear.ports()) {
      if (port.coupling.isZero(0)) continue;
      equilibrium.tangent().solve(port.coupling, response);
      append_columns(responses, response);
    }
  }
  Basis basis{modes.cols(), modes};
  if (responses.cols() == 0) return basis;
  const Eigen::MatrixXd residual =
      residual_responses(linear, modes, responses, equilibrium.weight().head(modes.rows()).cwiseInverse());
  append_columns(basis.V, residual);
  return basis;
}

/// A quantity as a linear function of x and u.
struct Linear {
  Eigen::MatrixXd x, u;
};

} // namespace

Eigen::MatrixXcd StateSpace::transfer(std::complex<double> s) const {
  Eigen::MatrixXcd resolvent = -A.cast<std::complex<double>>();
  resolvent.diagonal().array() += s;
  return C.cast<std::complex<double>>() * solve_dense(resolvent, B.cast<std::complex<double>>()) + D;
}

StateSpace state_space(Equilibrium& equilibrium, const State& state, const Channels& channels,
                       const ModalBasis& options) {
  using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
  const Linearisation linear(equilibrium, state, options.drifts);
  if (linear.rates_vary())
    throw std::domain_error("nominal dashpots relax at different rates everywhere: no state-space model");
  const auto& ports = linear.ports();
  const auto [n, V] = basis_of(equilibrium, state, linear, options);
  const Index size = V.cols(), still = size - n, memories = static_cast<Index>(linear.rates().size());
  const auto inputs = static_cast<Index>(channels.inputs.size());

  // x: amplitudes and velocities of the modes, what is remembered at each rate, charges of circuits.
  const Index memory = 2 * n, charge = memory + memories * size;
  std::vector<Index> charge_of(ports.size(), -1);
  Index states = charge;
  for (std::size_t p = 0; p < ports.size(); ++p)
    if (flows(ports[p].supply)) charge_of[p] = states++;
  MatrixXd given = MatrixXd::Zero(static_cast<Index>(ports.size()), inputs); // per port
  for (Index i = 0; i < inputs; ++i)
    given(static_cast<Index>(channels.inputs[static_cast<std::size_t>(i)]), i) = 1;

  // (K + sum K_r + B B^T/C_el) q = sum K_r z_r + B Q/C_el - inertia, voltages given instead where they are
  const auto& pattern = linear.stiffness();
  MatrixXd K = projected(pattern, pattern.values, V);
  Linear force{MatrixXd::Zero(size, states), MatrixXd::Zero(size, inputs)};
  for (Index r = 0; r < memories; ++r) {
    const MatrixXd K_r = projected(pattern, linear.relaxing()[static_cast<std::size_t>(r)], V);
    K += K_r;
    force.x.middleCols(memory + r * size, size) = K_r;
  }
  MatrixXd B(size, static_cast<Index>(ports.size()));
  for (std::size_t p = 0; p < ports.size(); ++p) {
    const auto at = static_cast<Index>(p);
    B.col(at) = V.transpose() * ports[p].coupling;
    const double elastance = 1 / ports[p].capacitance;
    if (ports[p].supply == Supply::voltage) {
      force.u += B.col(at) * given.row(at);
      continue;
    }
    K += elastance * B.col(at) * B.col(at).transpose();
    if (charge_of[p] >= 0)
      force.x.col(charge_of[p]) = elastance * B.col(at);
    else
      force.u += elastance * B.col(at) * given.row(at);
  }

  // What has no inertia follows at once.
  Linear q{MatrixXd::Zero(size, states), MatrixXd::Zero(size, inputs)};
  q.x.topLeftCorner(n, n).setIdentity();
  if (still > 0) {
    const Eigen::LLT<MatrixXd> soft(K.bottomRightCorner(still, still));
    MatrixXd right = force.x.bottomRows(still);
    right.leftCols(n) -= K.bottomLeftCorner(still, n);
    q.x.bottomRows(still) = soft.solve(right);
    q.u.bottomRows(still) = soft.solve(force.u.bottomRows(still));
  }

  StateSpace model{MatrixXd::Zero(states, states), MatrixXd::Zero(states, inputs), {}, {}};
  model.A.block(0, n, n, n).setIdentity();
  model.A.middleRows(n, n) = (force.x - K * q.x).topRows(n);
  model.A.block(n, n, n, n) -= projected(pattern, linear.damping(), V).topLeftCorner(n, n);
  model.B.middleRows(n, n) = (force.u - K * q.u).topRows(n);
  for (Index r = 0; r < memories; ++r) {
    const double rate = linear.rates()[static_cast<std::size_t>(r)];
    model.A.middleRows(memory + r * size, size) = rate * q.x;
    model.A.block(memory + r * size, memory + r * size, size, size).diagonal().array() -= rate;
    model.B.middleRows(memory + r * size, size) = rate * q.u;
  }
  const auto charges = [&](std::size_t p) { // of port p
    Linear Q{MatrixXd::Zero(1, states), MatrixXd::Zero(1, inputs)};
    const auto at = static_cast<Index>(p);
    if (charge_of[p] >= 0)
      Q.x(0, charge_of[p]) = 1;
    else if (ports[p].supply == Supply::charge)
      Q.u = given.row(at);
    else
      Q = {B.col(at).transpose() * q.x, B.col(at).transpose() * q.u + ports[p].capacitance * given.row(at)};
    return Q;
  };
  for (std::size_t p = 0; p < ports.size(); ++p) {
    if (charge_of[p] < 0) continue;
    const auto at = static_cast<Index>(p);
    const double drain = (ports[p].conductance + ports[p].leakage) / ports[p].capacitance; // per charge
    model.A.row(charge_of[p]) = drain * B.col(at).transpose() * q.x;
    model.A(charge_of[p], charge_of[p]) -= drain;
    model.B.row(charge_of[p]) = drain * B.col(at).transpose() * q.u + ports[p].conductance * given.row(at);
  }
  const Index rows = channels.rows.rows();
  model.C.resize(channels.output_count(), states);
  model.D.resize(channels.output_count(), inputs);
  model.C.topRows(rows) = channels.rows * V * q.x;
  model.D.topRows(rows) = channels.rows * V * q.u;
  for (std::size_t i = 0; i < channels.charges.size(); ++i) {
    const Linear Q = charges(channels.charges[i]);
    model.C.row(rows + static_cast<Index>(i)) = Q.x;
    model.D.row(rows + static_cast<Index>(i)) = Q.u;
  }

  // States as roots of energies: amplitudes times the root of their stiffness, charges over that of theirs.
  VectorXd unit = VectorXd::Ones(states);
  const VectorXd root = K.diagonal().cwiseSqrt();
  unit.head(n) = root.head(n);
  for (Index r = 0; r < memories; ++r) unit.segment(memory + r * size, size) = root;
  for (std::size_t p = 0; p < ports.size(); ++p)
    if (charge_of[p] >= 0) unit[charge_of[p]] = 1 / std::sqrt(ports[p].capacitance);
  model.A = unit.asDiagonal() * model.A * unit.cwiseInverse().asDiagonal();
  model.B = unit.asDiagonal() * model.B;
  model.C = model.C * unit.cwiseInverse().asDiagonal();
  return model;
}

double largest_error(const StateSpace& model, const Linearisation& full, const Channels& channels,
                     std::span<const double> frequencies) {
  double largest = 0;
  for (std::size_t i = 0; i < channels.inputs.size(); ++i) {
    const HarmonicDrive drive = HarmonicDrive::at_port(full.model(), channels.inputs[i]);
    for (const HarmonicResponse& response : harmonic_response(full, drive, frequencies)) {
      Eigen::VectorXcd y(channels.output_count());
      y.head(channels.rows.rows()) = channels.rows * response.displacement;
      for (std::size_t c = 0; c < channels.charges.size(); ++c)
        y[channels.rows.rows() + static_cast<Eigen::Index>(c)] =
            response.charge[static_cast<Eigen::Index>(channels.charges[c])];
      const Eigen::VectorXcd of_model =
          model.transfer({0, response.frequency}).col(static_cast<Eigen::Index>(i));
      largest = std::max(largest, ((of_model - y).cwiseAbs().array() / y.cwiseAbs().array()).maxCoeff());
    }
  }
  return largest;
}

} // namespace dielast::fem
