// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/devices/pins.hpp"

#include "cases/case/holding.hpp"
#include "fem/algebra/dense_algebra.hpp"
#include "fem/linear/rest.hpp"
#include "fem/linear/rigid_motions.hpp"
#include "fem/paths/renumbering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::cases {

std::vector<Pin> pin(std::span<const Eigen::Vector3d> nodes, fem::Dimension dimension, int quarters,
                     fem::DofMap& dofs) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& x : nodes) middle += x / static_cast<double>(nodes.size());
  std::vector<char> tied(static_cast<std::size_t>(dofs.node_count()));
  for (const fem::Tie& tie : dofs.ties()) tied[static_cast<std::size_t>(tie.node)] = 1;
  const auto unturned = [quarters](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    const Eigen::Vector3d half = quarters % 2 == 0 ? x : Eigen::Vector3d(x.y(), -x.x(), x.z());
    return quarters < 2 ? half : Eigen::Vector3d(-half.x(), -half.y(), half.z());
  };
  const auto drawn = [&](int n) { return unturned(nodes[static_cast<std::size_t>(n)]); };
  const auto best = [&](auto&& cost) {
    int found = static_cast<int>(std::ranges::find(tied, 0) - tied.begin());
    for (int n = found + 1; n < std::ssize(nodes); ++n)
      if (!tied[static_cast<std::size_t>(n)] && cost(drawn(n)) < cost(drawn(found))) found = n;
    return found;
  };
  const int first = best([&](const Eigen::Vector3d& x) { return (x - unturned(middle)).norm(); });
  if (dimension == fem::Dimension::axisymmetric) { // it moves along the axis alone
    dofs.hold(first, 2);
    return {{first, 2}};
  }
  const Eigen::Vector3d anchor = drawn(first);
  tied[static_cast<std::size_t>(first)] = 1; // no other is that one
  // Along two axes as exactly as nodes allow: what is beside turns the body with its strain.
  const auto beside = [&anchor](const Eigen::Vector3d& x, int axis) {
    const Eigen::Vector3d from = x - anchor;
    return from[axis] + 2 * (from.cwiseAbs().sum() - std::abs(from[axis]));
  };
  const auto along = [&](int axis) {
    return best([&](const Eigen::Vector3d& x) { return beside(x, axis); });
  };
  const auto straightest = [&](int one, int other) { // the former, but where nothing lies along it
    const double of_one = beside(drawn(along(one)), one);
    return of_one < 0 || of_one <= beside(drawn(along(other)), other) ? one : other;
  };
  const bool in_space = dimension == fem::Dimension::spatial;
  const int long_way = in_space ? straightest(straightest(0, 1), 2) : straightest(0, 1);
  const int next = long_way == 0 ? 1 : 0, last = in_space ? 3 - long_way - next : next,
            wide = in_space ? straightest(next, last) : next, across = 3 - long_way - wide;
  const int far = along(long_way), beside_it = in_space ? along(wide) : far;
  std::vector<Pin> pins;
  for (const Pin& one :
       {Pin{first, 0}, {first, 1}, {far, wide}, {first, 2}, {far, across}, {beside_it, across}}) {
    const Pin turned{one.node, one.axis < 2 && quarters % 2 == 1 ? 1 - one.axis : one.axis};
    if (!fem::moves(dimension, turned.axis)) continue;
    dofs.hold(turned.node, turned.axis);
    pins.push_back(turned);
  }
  return pins;
}

namespace {

/// Where a film lies: its centroid, and how it has turned.
struct Lie {
  Eigen::Vector3d drawn, now;
  Eigen::Matrix3d turn;
  double height = 0; ///< of the drawn film along `axis`, m
};

std::optional<Lie> lie_of(const meshing::Mesh& mesh, const fem::State& state, int axis) {
  const meshing::CellBlock& film = *mesh.film();
  Eigen::MatrixXd drawn(3, film.size()), now(3, film.size());
  Eigen::VectorXd area(film.size());
  for (int cell = 0; cell < film.size(); ++cell) {
    const auto nodes = film.cell(cell);
    const auto at = [&](std::size_t corner) { return mesh.nodes[static_cast<std::size_t>(nodes[corner])]; };
    area[cell] = nodes.size() < 3 ? 0 : (at(1) - at(0)).cross(at(2) - at(0)).norm();
    drawn.col(cell).setZero();
    now.col(cell).setZero();
    for (const int node : nodes) {
      const auto n = static_cast<std::size_t>(node);
      drawn.col(cell) += mesh.nodes[n] / static_cast<double>(nodes.size());
      now.col(cell) += (mesh.nodes[n] + state.displacement[n]) / static_cast<double>(nodes.size());
    }
  }
  if (!(area.sum() > 0)) return std::nullopt;
  Lie lie{drawn * area / area.sum(),
          now * area / area.sum(),
          {},
          drawn.row(axis).maxCoeff() - drawn.row(axis).minCoeff()};
  const fem::SingularValues svd = fem::singular_values((now.colwise() - lie.now) * area.asDiagonal() *
                                                       (drawn.colwise() - lie.drawn).transpose());
  Eigen::Vector3d sides(1, 1, (svd.U * svd.V.transpose()).determinant() < 0 ? -1 : 1); // no mirror image
  lie.turn = svd.U * sides.asDiagonal() * svd.V.transpose();
  return lie;
}

/// The turn in the plane of axes l and w that brings the component w of d to `wanted`, by the least angle.
Eigen::Matrix3d turn_in_plane(const Eigen::Vector3d& d, int l, int w, double wanted) {
  const double now = std::atan2(d[w], d[l]);
  const double ahead = std::asin(std::clamp(wanted / std::hypot(d[l], d[w]), -1.0, 1.0));
  const double by = std::abs(now) <= std::numbers::pi / 2
                        ? ahead - now
                        : std::remainder(std::numbers::pi - ahead - now, 2 * std::numbers::pi);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(l, l) = turn(w, w) = std::cos(by);
  turn(w, l) = std::sin(by);
  turn(l, w) = -std::sin(by);
  return turn;
}

} // namespace

std::optional<fem::State> upright(const Device& device, const fem::State& state) {
  constexpr double flat = 1e-9;
  if (device.pins.size() != 6 || state.motion) return std::nullopt;
  const fem::DofMap& dofs = device.model.dofs;
  const std::vector<Eigen::Vector3d>& drawn = device.mesh.nodes;
  const int across = device.pins[5].axis, wide = device.pins[2].axis, long_way = 3 - across - wide;
  const auto lie = lie_of(device.mesh, state, across);
  if (!lie) return std::nullopt;
  const Eigen::Vector3d up = Eigen::Vector3d::Unit(across), normal = lie->turn * up;
  if ((normal - up).norm() < flat && std::abs((lie->now - lie->drawn)[across]) < flat * device.model.extent)
    return std::nullopt;
  const auto first = static_cast<std::size_t>(device.pins[0].node),
             far = static_cast<std::size_t>(device.pins[2].node);
  const auto place = [&](std::size_t n) -> Eigen::Vector3d { return drawn[n] + state.displacement[n]; };
  const Eigen::Matrix3d raised = Eigen::Quaterniond::FromTwoVectors(normal, up).toRotationMatrix();
  Eigen::Matrix3d turn = lie->turn.transpose();
  if (lie->height < flat * device.model.extent) // the pins are in its plane
    turn = turn_in_plane(raised * (place(far) - place(first)), long_way, wide,
                         (drawn[far] - drawn[first])[wide]) *
           raised;
  Eigen::Vector3d origin = drawn[first];
  origin[across] = lie->drawn[across] - (turn * (lie->now - place(first)))[across];
  const Eigen::Quaterniond by(turn);
  fem::State told = state;
  for (std::size_t n = 0; n < drawn.size(); ++n) {
    told.displacement[n] = turn * (place(n) - place(first)) + origin - drawn[n];
    told.rotation[n] = by * state.rotation[n];
    told.angle[n] = fem::angle_near(told.rotation[n], state.angle[n]);
    for (const int from : {0, 3}) { // dead forces and moments turn along
      Eigen::Vector3d acts = Eigen::Vector3d::Zero();
      for (int c = 0; c < 3; ++c)
        if (const int e = dofs.equation(static_cast<int>(n), from + c); e != fem::DofMap::absent)
          acts[c] = state.dead_force[e];
      acts = turn * acts;
      for (int c = 0; c < 3; ++c)
        if (const int e = dofs.equation(static_cast<int>(n), from + c); e != fem::DofMap::absent)
          told.dead_force[e] = acts[c];
    }
  }
  return told;
}

int quarter_turns(const Case& one) {
  std::optional<int> common;
  for (const Part& part : one.parts) {
    if (!part.has_mesh()) continue;
    const double turned = part.turned / (std::numbers::pi / 2);
    const int quarters = static_cast<int>(std::lround(turned));
    if (std::abs(turned - quarters) > 1e-9 || (common && *common != quarters)) return 0;
    common = quarters;
  }
  return ((common.value_or(0) % 4) + 4) % 4;
}

WithoutPins::WithoutPins(const Case& one, const Device& device, fem::Equilibrium& equilibrium,
                         const fem::State& state)
    : given_(device), equilibrium_(equilibrium), state_(state) {
  if (device.pins.empty() || !drifts()) return;
  own_.emplace(build_device(held_by(one, {std::vector<char>(one.supports.size()), false})));
  own_equilibrium_.emplace(own_->model, equilibrium.assembler().workers().count());
  state_ = fem::Renumbering(device.model.dofs, own_->model.dofs)(state);
}

void WithoutPins::take_off_drift(std::vector<fem::HarmonicResponse>& responses) {
  if (!drifts()) return;
  const fem::State at = fem::relaxed(state_);
  const fem::RigidMotions rigid =
      fem::rigid_motions(equilibrium(), at, fem::free_mass(equilibrium(), at), true);
  Eigen::MatrixXd parts(rigid.motions.rows(), 2);
  for (fem::HarmonicResponse& response : responses) {
    parts << response.displacement.real(), response.displacement.imag();
    rigid.take_off(parts);
    response.displacement.real() = parts.col(0);
    response.displacement.imag() = parts.col(1);
  }
}

} // namespace dielast::cases
