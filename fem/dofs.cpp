// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/dofs.hpp"

#include <algorithm>
#include <numeric>

namespace dielast::fem {

void DofMap::add(int node, int component) {
  int& mark = equation_[static_cast<std::size_t>(node)][static_cast<std::size_t>(component)];
  if (mark == absent) mark = free_mark;
}

void DofMap::hold(int node, int component) {
  int& mark = equation_[static_cast<std::size_t>(node)][static_cast<std::size_t>(component)];
  if (mark != absent) mark = held_mark;
}

void DofMap::share(int node, int component, int other, int other_component) {
  shared_.push_back({node, component, other, other_component});
}

void DofMap::number() {
  // Union-find over (node, component): the smallest index of a group stands for it.
  const auto index = [](int node, int component) {
    return static_cast<std::size_t>(node * components + component);
  };
  std::vector<std::size_t> leader(equation_.size() * components);
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (leader[i] != i) i = leader[i] = leader[leader[i]];
    return i;
  };
  const auto mark = [&](std::size_t i) -> int& { return equation_[i / components][i % components]; };
  for (const auto& [node, component, other, other_component] : shared_) {
    const std::size_t a = find(index(node, component)), b = find(index(other, other_component));
    const std::size_t low = std::min(a, b), high = std::max(a, b);
    leader[high] = low;
    if (mark(high) == held_mark) mark(low) = held_mark;
  }
  free_count_ = count_ = 0;
  for (std::size_t i = 0; i < leader.size(); ++i)
    if (find(i) == i && mark(i) != absent) {
      free_count_ += mark(i) == free_mark;
      ++count_;
    }
  int free = 0, held = free_count_;
  for (std::size_t i = 0; i < leader.size(); ++i) {
    if (mark(i) == absent) continue;
    const std::size_t first = find(i); // numbered before i
    mark(i) = first != i ? mark(first) : mark(i) == free_mark ? free++ : held++;
  }
}

void DofMap::advance(State& state, const Eigen::VectorXd& increment, double scale) const {
  for (std::size_t n = 0; n < equation_.size(); ++n) {
    const auto& equation = equation_[n];
    Eigen::Vector3d spin = Eigen::Vector3d::Zero();
    bool turns = false;
    for (int c = 0; c < components; ++c) {
      const int e = equation[static_cast<std::size_t>(c)];
      if (e == absent || e >= free_count_) continue;
      if (c < 3) {
        state.displacement[n][c] += scale * increment[e];
      } else {
        spin[c - 3] = scale * increment[e];
        turns = true;
      }
    }
    if (turns) state.rotation[n] = rotation_of(spin) * state.rotation[n];
  }
}

Eigen::VectorXd DofMap::increment(const State& from, const State& to) const {
  Eigen::VectorXd increment = Eigen::VectorXd::Zero(free_count_);
  for (std::size_t n = 0; n < equation_.size(); ++n) {
    const auto& equation = equation_[n];
    const auto is_free = [this](int e) { return e != absent && e < free_count_; };
    for (int c = 0; c < 3; ++c)
      if (const int e = equation[static_cast<std::size_t>(c)]; is_free(e))
        increment[e] = to.displacement[n][c] - from.displacement[n][c];
    if (std::none_of(equation.begin() + 3, equation.end(), is_free)) continue;
    const Eigen::Vector3d spin = spin_of(to.rotation[n] * from.rotation[n].conjugate());
    for (int c = 3; c < components; ++c)
      if (const int e = equation[static_cast<std::size_t>(c)]; is_free(e)) increment[e] = spin[c - 3];
  }
  return increment;
}

} // namespace dielast::fem
