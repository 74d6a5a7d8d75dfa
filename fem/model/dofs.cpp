// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/dofs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace dielast::fem {

namespace {

/// Directors whose difference is less are one: roundings of flat film in any direction.
constexpr double parallel = 1e-10;

Eigen::Vector3d director(const TiltAxes& axes) { return axes.col(0).cross(axes.col(1)); }

/// Along x, or along y where the director is next to x, and to the left of that.
TiltAxes axes_about(const Eigen::Vector3d& director) {
  const int along = std::abs(director.x()) < 0.9 ? 0 : 1;
  TiltAxes axes;
  axes.col(0) = (Eigen::Vector3d::Unit(along) - director[along] * director).normalized();
  axes.col(1) = director.cross(axes.col(0));
  return axes;
}

/// Small angles by the series of the arc sine, which ends below a rounding.
double angle_over_sine(double square_of_sine, double cosine) {
  const double s = square_of_sine;
  if (s < 1e-3 && cosine > 0)
    return 1 + s * (1.0 / 6 + s * (3.0 / 40 + s * (15.0 / 336 + s * (105.0 / 3456))));
  const double sine = std::sqrt(s);
  return sine < 1e-8 ? 1 : std::atan2(sine, cosine) / sine;
}

} // namespace

void DofMap::add(int node, int component) {
  if (component >= 3) keep_spins(node);
  int& mark = equation_[static_cast<std::size_t>(node)][static_cast<std::size_t>(component)];
  if (mark == absent) mark = free_mark;
}

void DofMap::add_director(int node, const Eigen::Vector3d& director) {
  if (!tilt_axes_) tilt_axes_ = std::make_shared<std::vector<TiltAxes>>(equation_.size(), TiltAxes::Zero());
  const auto n = static_cast<std::size_t>(node);
  auto& marks = equation_[n];
  if (std::all_of(marks.begin() + 3, marks.begin() + components, [](int mark) { return mark == absent; })) {
    turns_[n] = Turns::by_tilts;
    (*tilt_axes_)[n] = axes_about(director);
  } else if (turns_[n] == Turns::by_tilts && (fem::director(axes_of(n)) - director).norm() > parallel) {
    turns_[n] = Turns::by_spins;
  }
  for (int c = 3; c < components; ++c)
    if (int& mark = marks[static_cast<std::size_t>(c)]; mark == absent) mark = free_mark;
}

void DofMap::keep_spins(int node) { turns_[static_cast<std::size_t>(node)] = Turns::by_spins; }

void DofMap::hold(int node, int component) {
  int& mark = equation_[static_cast<std::size_t>(node)][static_cast<std::size_t>(component)];
  if (mark != absent) mark = held_mark;
}

void DofMap::share(int node, int component, int other, int other_component) {
  shared_.push_back({node, component, other, other_component});
}

void DofMap::tie(const Tie& tie) {
  const auto of = [this](int node) -> int& { return tie_of_[static_cast<std::size_t>(node)]; };
  Tie root = tie;
  if (const int further = of(tie.master); further != absent) {
    if (!ties_[static_cast<std::size_t>(further)].turns)
      throw std::invalid_argument("a pinned node carries another");
    root.master = ties_[static_cast<std::size_t>(further)].master;
    root.arm += ties_[static_cast<std::size_t>(further)].arm;
  }
  if (root.node == root.master || of(tie.node) != absent) throw std::invalid_argument("a node is tied twice");
  if (carries_[static_cast<std::size_t>(root.node)])
    for (Tie& other : ties_)
      if (other.master == root.node) {
        other.master = root.master;
        other.arm += root.arm;
      }
  carries_[static_cast<std::size_t>(root.master)] = 1;
  of(root.node) = static_cast<int>(ties_.size());
  ties_.push_back(root);
}

int DofMap::add_scalar(double unit) {
  scalars_.push_back({unit, absent});
  return scalar_count() - 1;
}

void DofMap::number() {
  for (const Tie& tie : ties_)
    for (int c = 0; c < components; ++c) {
      int& mark = equation_[static_cast<std::size_t>(tie.node)][static_cast<std::size_t>(c)];
      if (mark == absent || (c >= 3 && !tie.turns)) continue;
      if (mark == held_mark) throw std::invalid_argument("an unknown of a tied node is held");
      add(tie.master, c);
      if (c < 3)
        mark = tied_mark;
      else
        share(tie.master, tie.node, c);
    }
  choose_tilts();
  // Union-find over (node, unknown): the smallest index of a group stands for it.
  const auto index = [](int node, int unknown) {
    return static_cast<std::size_t>(node * unknowns + unknown);
  };
  std::vector<std::size_t> leader(equation_.size() * unknowns);
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (leader[i] != i) i = leader[i] = leader[leader[i]];
    return i;
  };
  const auto mark = [&](std::size_t i) -> int& { return equation_[i / unknowns][i % unknowns]; };
  for (const auto& [node, component, other, other_component] : shared_) {
    const std::size_t a = find(index(node, component)), b = find(index(other, other_component));
    if (mark(a) == tied_mark || mark(b) == tied_mark)
      throw std::invalid_argument("a displacement of a tied node is shared");
    const std::size_t low = std::min(a, b), high = std::max(a, b);
    leader[high] = low;
    if (mark(high) == held_mark) mark(low) = held_mark;
  }
  free_count_ = held_count_ = count_ = 0;
  for (std::size_t i = 0; i < leader.size(); ++i)
    if (find(i) == i && mark(i) != absent) {
      free_count_ += mark(i) == free_mark;
      held_count_ += mark(i) == held_mark;
      ++count_;
    }
  int scalar = free_count_;
  for (Scalar& one : scalars_) one.equation = scalar++;
  free_count_ += scalar_count();
  count_ += scalar_count();
  int free = 0, held = free_count_, tied = free_count_ + held_count_;
  for (std::size_t i = 0; i < leader.size(); ++i) {
    if (mark(i) == absent) continue;
    const std::size_t first = find(i); // numbered before i
    mark(i) = first != i             ? mark(first)
              : mark(i) == free_mark ? free++
              : mark(i) == held_mark ? held++
                                     : tied++;
  }
}

/// It does not move where its master spins about the director. Precondition: it has no spins, which it would
/// share with its master.
bool DofMap::lies_along_director(const Tie& tie) const {
  if (!tilt_axes_) return false;
  const TiltAxes& axes = axes_of(static_cast<std::size_t>(tie.master));
  return !axes.isZero(0) && (axes.transpose() * tie.arm).norm() <= parallel * tie.arm.norm();
}

/// Instead of spins, where nothing asks for these.
void DofMap::choose_tilts() {
  for (const Tie& tie : ties_) {
    keep_spins(tie.node);
    if (!lies_along_director(tie)) keep_spins(tie.master);
  }
  for (const auto& [node, component, other, other_component] : shared_) {
    if (component >= 3) keep_spins(node);
    if (other_component >= 3) keep_spins(other);
  }
  for (std::size_t n = 0; n < equation_.size(); ++n) {
    auto& marks = equation_[n];
    const auto held = std::count(marks.begin() + 3, marks.begin() + components, held_mark);
    if (turns_[n] == Turns::by_tilts && (held == 0 || held == components - 3)) {
      std::fill(marks.begin() + tilt, marks.end(), held == 0 ? free_mark : held_mark);
      std::fill(marks.begin() + 3, marks.begin() + tilt, absent);
    } else if (tilt_axes_) {
      (*tilt_axes_)[n].setZero();
    }
  }
}

void DofMap::advance(State& state, const Eigen::VectorXd& increment, double scale) const {
  for (std::size_t n = 0; n < equation_.size(); ++n) {
    const auto& equation = equation_[n];
    Eigen::Vector3d spin = Eigen::Vector3d::Zero();
    bool turns = false;
    for (int c = 0; c < components; ++c) {
      const int e = equation[static_cast<std::size_t>(c)];
      if (!is_free(e)) continue;
      if (c < 3) {
        state.displacement[n][c] += scale * increment[e];
      } else {
        spin[c - 3] = scale * increment[e];
        turns = true;
      }
    }
    if (turns) state.rotation[n] = rotation_of(spin) * state.rotation[n];
    if (const int e = equation[tilt]; is_free(e)) {
      const Eigen::Vector3d turn = scale * (axes_of(n) * Eigen::Vector2d(increment[e], increment[e + 1]));
      spin = state.rotation[n] * turn;
      state.rotation[n] = state.rotation[n] * rotation_of(turn);
      turns = true;
    }
    if (turns) state.angle[n] = angle_near(state.rotation[n], state.angle[n] + spin);
  }
  for (std::size_t s = 0; s < scalars_.size(); ++s)
    state.scalar[s] += scale * scalars_[s].unit * increment[scalars_[s].equation];
  carry(state);
}

void DofMap::carry(State& state) const {
  for (const auto& [node, master, arm, turns] : ties_) {
    const auto m = static_cast<std::size_t>(master), n = static_cast<std::size_t>(node);
    state.displacement[n] = state.displacement[m] + (state.rotation[m] * arm - arm);
    if (!turns) continue;
    state.rotation[n] = state.rotation[m];
    state.angle[n] = state.angle[m];
  }
}

void DofMap::gather(const State& state, Eigen::VectorXd& force) const {
  for (const auto& [node, master, arm, turns_along] : ties_) {
    Eigen::Vector3d on_node = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c)
      if (const int e = equation(node, c); e != absent) on_node[c] = std::exchange(force[e], 0.0);
    const Eigen::Vector3d moment = (state.rotation[static_cast<std::size_t>(master)] * arm).cross(on_node);
    const Eigen::Vector3d on_turns = turn_axes(state, master).transpose() * moment;
    const std::array<int, 3> turns = this->turns(master);
    for (int c = 0; c < 3; ++c) {
      if (const int e = equation(master, c); e != absent) force[e] += on_node[c];
      if (const int e = turns[static_cast<std::size_t>(c)]; e != absent) force[e] += on_turns[c];
    }
  }
}

Eigen::Matrix3d DofMap::turn_axes(const State& state, int node) const {
  if (!tilts(node)) return Eigen::Matrix3d::Identity();
  const auto n = static_cast<std::size_t>(node);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
  axes.leftCols<2>() = state.rotation[n].toRotationMatrix() * axes_of(n);
  return axes;
}

Eigen::Vector3d DofMap::lever(const Tie& tie, const State& state, int component) const {
  const Eigen::Vector3d arm = state.rotation[static_cast<std::size_t>(tie.master)] * tie.arm;
  return turn_axes(state, tie.master).transpose() * arm.cross(Eigen::Vector3d::Unit(component));
}

Eigen::Vector3d DofMap::spin(const State& state, int node, const Eigen::VectorXd& values) const {
  const auto n = static_cast<std::size_t>(node);
  if (tilts(node))
    return state.rotation[n] *
           (axes_of(n) * Eigen::Vector2d(values[equation(node, tilt)], values[equation(node, tilt + 1)]));
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c)
    if (const int e = equation(node, 3 + c); e != absent) spin[c] = values[e];
  return spin;
}

Eigen::SparseMatrix<double> DofMap::jacobian(const State& state) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < free_count_; ++e) entries.emplace_back(e, e, 1.0);
  for (const Tie& tie : ties_)
    for (int c = 0; c < 3; ++c) {
      const int e = equation(tie.node, c);
      if (e == absent) continue;
      if (const int m = equation(tie.master, c); is_free(m)) entries.emplace_back(e, m, 1.0);
      const Eigen::Vector3d lever = this->lever(tie, state, c);
      const std::array<int, 3> turns = this->turns(tie.master);
      for (std::size_t k = 0; k < 3; ++k)
        if (is_free(turns[k])) entries.emplace_back(e, turns[k], lever[static_cast<Eigen::Index>(k)]);
    }
  Eigen::SparseMatrix<double> all(count_, free_count_);
  all.setFromTriplets(entries.begin(), entries.end());
  return all;
}

double DofMap::work_on_tied(const Eigen::VectorXd& force, const State& from, const State& to) const {
  double work = 0;
  for (const Tie& tie : ties_)
    for (int c = 0; c < 3; ++c)
      if (const int e = equation(tie.node, c); e != absent)
        work += force[e] * (to.displacement[static_cast<std::size_t>(tie.node)][c] -
                            from.displacement[static_cast<std::size_t>(tie.node)][c]);
  return work;
}

Eigen::VectorXd DofMap::increment(const State& from, const State& to) const {
  Eigen::VectorXd increment = Eigen::VectorXd::Zero(free_count_);
  for (std::size_t n = 0; n < equation_.size(); ++n) {
    const auto& equation = equation_[n];
    for (int c = 0; c < 3; ++c)
      if (const int e = equation[static_cast<std::size_t>(c)]; is_free(e))
        increment[e] = to.displacement[n][c] - from.displacement[n][c];
    if (const int e = equation[tilt]; is_free(e)) { // the turn without spin from one director to the other
      const TiltAxes& axes = axes_of(n);
      const Eigen::Vector3d old = director(axes), now = from.rotation[n].conjugate() * (to.rotation[n] * old);
      const Eigen::Vector2d sines(-axes.col(1).dot(now), axes.col(0).dot(now));
      increment.segment<2>(e) = angle_over_sine(sines.squaredNorm(), old.dot(now)) * sines;
      continue;
    }
    const auto free = [this](int e) { return is_free(e); };
    if (std::none_of(equation.begin() + 3, equation.begin() + components, free)) continue;
    const Eigen::Vector3d spin = spin_of(to.rotation[n] * from.rotation[n].conjugate());
    for (int c = 3; c < components; ++c)
      if (const int e = equation[static_cast<std::size_t>(c)]; is_free(e)) increment[e] = spin[c - 3];
  }
  for (std::size_t s = 0; s < scalars_.size(); ++s)
    increment[scalars_[s].equation] = (to.scalar[s] - from.scalar[s]) / scalars_[s].unit;
  return increment;
}

} // namespace dielast::fem
