// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/moving_bodies.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/model/inertia.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <vector>

namespace dielast::fem {

namespace {

constexpr double shared = 0.1; ///< mass between a body and its surroundings, over its own
constexpr double no_inertia = 1e-9;

using Groups = std::map<int, std::vector<const Tie*>>; ///< by master

Groups groups_of(const DofMap& dofs) {
  Groups groups;
  for (const Tie& tie : dofs.ties()) groups[tie.master].push_back(&tie);
  return groups;
}

Eigen::Vector3d rate_of(const DofMap& dofs, int node, const Eigen::VectorXd& rates) {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c)
    if (const int e = dofs.equation(node, c); e != DofMap::absent) rate[c] = rates[e];
  return rate;
}

Eigen::Vector3d arm_of(const State& state, const Tie& tie) {
  return state.rotation[static_cast<std::size_t>(tie.master)] * tie.arm;
}

/// How fast a body turns, rad/s, by the velocities of what is tied to it: least squares, and nothing where
/// that does not tell.
Eigen::Vector3d turning(const DofMap& dofs, const State& state, int master,
                        const std::vector<const Tie*>& ties, const Eigen::VectorXd& velocity) {
  const Eigen::Vector3d of_master = rate_of(dofs, master, velocity);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  for (const Tie* tie : ties)
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(tie->node, c); e != DofMap::absent) {
        const Eigen::Vector3d lever = arm_of(state, *tie).cross(Eigen::Vector3d::Unit(c));
        inertia += lever * lever.transpose();
        momentum += lever * (velocity[e] - of_master[c]);
      }
  const SymmetricEigen axes = symmetric_eigen(inertia);
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k)
    if (axes.values[k] > no_inertia * axes.values[2])
      omega += axes.vectors.col(k) * axes.vectors.col(k).dot(momentum) / axes.values[k];
  return omega;
}

void carry_group(const DofMap& dofs, const State& state, int master, const std::vector<const Tie*>& ties,
                 const Eigen::Vector3d& omega, Eigen::VectorXd& acceleration) {
  const Eigen::Vector3d of_master = rate_of(dofs, master, acceleration);
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  const std::array<int, 3> turns = dofs.turns(master);
  for (std::size_t k = 0; k < 3; ++k)
    if (turns[k] != DofMap::absent) turn[static_cast<Eigen::Index>(k)] = acceleration[turns[k]];
  for (const Tie* tie : ties) {
    const Eigen::Vector3d centripetal = omega.cross(omega.cross(arm_of(state, *tie)));
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs.equation(tie->node, c); e != DofMap::absent)
        acceleration[e] = of_master[c] + dofs.lever(*tie, state, c).dot(turn) + centripetal[c];
  }
}

/// A body that carries its own mass.
struct MovingBody {
  std::vector<int> equations; ///< of its master and of what is tied to it, ascending
  Eigen::MatrixXd ways;       ///< how they move with those of the master that are free, a column each
  Eigen::MatrixXd mass;       ///< between the ways
};

std::vector<int> equations_of(const DofMap& dofs, int master, const std::vector<const Tie*>& ties) {
  std::set<int> equations;
  const auto add = [&](int e) {
    if (e != DofMap::absent) equations.insert(e);
  };
  for (int c = 0; c < 3; ++c) add(dofs.equation(master, c));
  for (const int e : dofs.turns(master)) add(e);
  for (const Tie* tie : ties)
    for (int c = 0; c < 3; ++c) add(dofs.equation(tie->node, c));
  return {equations.begin(), equations.end()};
}

/// `rates`: zero for all unknowns, and so again behind it.
Eigen::MatrixXd ways_of(const DofMap& dofs, const State& state, int master,
                        const std::vector<const Tie*>& ties, const std::vector<int>& equations,
                        Eigen::VectorXd& rates) {
  std::vector<Eigen::VectorXd> columns;
  const std::vector<int> own = equations_of(dofs, master, {});
  for (const int e : own)
    if (dofs.is_free(e)) {
      rates[e] = 1;
      carry_group(dofs, state, master, ties, Eigen::Vector3d::Zero(), rates);
      columns.emplace_back(rates(equations));
      rates[e] = 0;
    }
  for (const int e : equations) rates[e] = 0;
  Eigen::MatrixXd ways(std::ssize(equations), std::ssize(columns));
  for (std::size_t k = 0; k < columns.size(); ++k) ways.col(static_cast<Eigen::Index>(k)) = columns[k];
  return ways;
}

/// Nothing where the body shares too much of its mass with its surroundings.
std::optional<Eigen::MatrixXd> mass_of(const std::vector<int>& equations, const Eigen::MatrixXd& ways,
                                       const Eigen::SparseMatrix<double>& mass) {
  Eigen::MatrixXd momenta = Eigen::MatrixXd::Zero(ways.rows(), ways.cols());
  double own = 0, beyond = 0;
  for (Eigen::Index i = 0; i < ways.rows(); ++i) {
    const int e = equations[static_cast<std::size_t>(i)];
    for (Eigen::SparseMatrix<double>::InnerIterator at(mass, e); at; ++at) {
      const auto row = std::ranges::lower_bound(equations, static_cast<int>(at.row()));
      if (row == equations.end() || *row != at.row()) {
        beyond += std::abs(at.value());
        continue;
      }
      momenta.row(row - equations.begin()) += at.value() * ways.row(i);
      if (at.row() == e) own += at.value();
    }
  }
  if (!(own > 0) || beyond > shared * own) return std::nullopt;
  return Eigen::MatrixXd(ways.transpose() * momenta);
}

/// The x with A x = b of the least size, A positive semidefinite.
Eigen::VectorXd least_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  const Eigen::VectorXd size = A.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = (size.array() > 0).select(size.cwiseInverse(), 0);
  const SymmetricEigen axes = symmetric_eigen(scale.asDiagonal() * A * scale.asDiagonal());
  const Eigen::VectorXd inverse = (axes.values.array() > no_inertia).select(axes.values.cwiseInverse(), 0);
  return scale.asDiagonal() *
         (axes.vectors * (inverse.asDiagonal() * (axes.vectors.transpose() * (scale.asDiagonal() * b))));
}

} // namespace

void carry_accelerations(const DofMap& dofs, const State& state, const Eigen::VectorXd& velocity,
                         Eigen::VectorXd& acceleration) {
  for (const auto& [master, ties] : groups_of(dofs))
    carry_group(dofs, state, master, ties, turning(dofs, state, master, ties, velocity), acceleration);
}

void accelerate_bodies(const Model& model, const State& state, Motion& motion) {
  const DofMap& dofs = model.dofs;
  const Inertia& inertia = model.inertia();
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(dofs.count()), &acceleration = motion.acceleration_now;
  std::vector<MovingBody> bodies;
  for (const auto& [master, ties] : groups_of(dofs)) {
    std::vector<int> equations = equations_of(dofs, master, ties);
    Eigen::MatrixXd ways = ways_of(dofs, state, master, ties, equations, rates);
    auto mass = mass_of(equations, ways, inertia.mass);
    if (!mass) continue;
    for (const int e : equations_of(dofs, master, {}))
      if (dofs.is_free(e)) acceleration[e] = 0;
    carry_group(dofs, state, master, ties, turning(dofs, state, master, ties, motion.velocity), acceleration);
    if (ways.cols() == 0) continue; // held altogether
    bodies.push_back({std::move(equations), std::move(ways), *std::move(mass)});
  }
  if (bodies.empty()) return;
  const Eigen::VectorXd force =
      inertia.mass * acceleration + inertia.resistance(motion.velocity) + motion.unbalanced;
  for (const MovingBody& body : bodies)
    acceleration(body.equations) -=
        body.ways * least_solution(body.mass, body.ways.transpose() * force(body.equations));
}

} // namespace dielast::fem
