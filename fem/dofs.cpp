#include "fem/dofs.hpp"

namespace dielast::fem {

void DofMap::add(int node, int component) {
  int& mark = equation_[static_cast<std::size_t>(node)][static_cast<std::size_t>(component)];
  if (mark == absent) mark = free_mark;
}

void DofMap::hold(int node, int component) {
  int& mark = equation_[static_cast<std::size_t>(node)][static_cast<std::size_t>(component)];
  if (mark != absent) mark = held_mark;
}

void DofMap::number() {
  free_count_ = 0;
  for (const auto& node : equation_)
    for (const int mark : node) free_count_ += mark == free_mark;
  int free = 0, held = free_count_;
  for (auto& node : equation_)
    for (int& mark : node)
      if (mark != absent) mark = mark == free_mark ? free++ : held++;
  count_ = held;
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

} // namespace dielast::fem
