// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/tie_reduction.hpp"

#include <algorithm>

namespace dielast::fem {

namespace {

constexpr int one = 0; ///< place of the factor 1; those of the levers follow, three per tied displacement

} // namespace

TieReduction::TieReduction(const DofMap& dofs, const SparseSymmetric& full) : dofs_(dofs) {
  const int free = dofs.free_count();
  of_tied_.resize(static_cast<std::size_t>(full.size - free));
  for (const Tie& tie : dofs.ties())
    for (int c = 0; c < 3; ++c) {
      const int e = dofs.equation(tie.node, c);
      if (e == DofMap::absent) continue;
      const int place = e - free - dofs.held_count();
      auto& terms = of_tied_[static_cast<std::size_t>(place)];
      if (const int m = dofs.equation(tie.master, c); dofs.is_free(m)) terms.push_back({m, one});
      const std::array<int, 3> turns = dofs.turns(tie.master);
      for (int k = 0; k < 3; ++k)
        if (const int m = turns[static_cast<std::size_t>(k)];
            (k != c || dofs.tilts(tie.master)) && dofs.is_free(m))
          terms.push_back({m, 1 + 3 * place + k});
    }

  // Every product of terms, with its place as (column, row) until the pattern is known.
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(free));
  for (int column = 0; column < free; ++column) rows[static_cast<std::size_t>(column)].push_back(column);
  const auto each_product = [&](auto&& use) {
    full.for_each_entry([&](std::size_t at, int column, int row) {
      const std::vector<Term> left = terms(column), right = terms(row);
      for (std::size_t i = 0; i < left.size(); ++i)
        for (std::size_t j = row == column ? i : 0; j < right.size(); ++j) {
          const auto [low, high] = std::minmax(left[i].equation, right[j].equation);
          // Off the diagonal an entry stands for two.
          const bool twice = low == high && !(row == column && i == j);
          for (int n = 0; n < (twice ? 2 : 1); ++n)
            use(static_cast<int>(at), low, high, left[i].factor, right[j].factor);
        }
    });
  };
  each_product([&](int /*at*/, int column, int row, int, int) {
    auto& of_column = rows[static_cast<std::size_t>(column)];
    if (of_column.back() != row) of_column.push_back(row);
  });
  pattern_.size = free;
  pattern_.column_start.assign(1, 0);
  for (auto& of_column : rows) {
    std::sort(of_column.begin(), of_column.end());
    of_column.erase(std::unique(of_column.begin(), of_column.end()), of_column.end());
    pattern_.rows.insert(pattern_.rows.end(), of_column.begin(), of_column.end());
    pattern_.column_start.push_back(static_cast<int>(pattern_.rows.size()));
  }
  pattern_.values.assign(pattern_.rows.size(), 0.0);
  each_product([&](int at, int column, int row, int first, int second) {
    const int to = pattern_.place(column, row);
    if (first == one && second == one)
      copies_.push_back({at, to});
    else
      products_.push_back({at, to, first, second});
  });
}

std::vector<TieReduction::Term> TieReduction::terms(int unknown) const {
  if (unknown < dofs_.free_count()) return {{unknown, one}};
  return of_tied_[static_cast<std::size_t>(unknown - dofs_.free_count())];
}

std::vector<double> TieReduction::reduce(const State& state, const std::vector<double>& full) const {
  std::vector<double> factor(1 + 3 * of_tied_.size(), 1.0);
  for (const Tie& tie : dofs_.ties())
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs_.equation(tie.node, c); e != DofMap::absent) {
        const Eigen::Vector3d lever = dofs_.lever(tie, state, c);
        const auto first = 1 + 3 * static_cast<std::size_t>(e - dofs_.free_count() - dofs_.held_count());
        for (int k = 0; k < 3; ++k) factor[first + static_cast<std::size_t>(k)] = lever[k];
      }
  std::vector<double> values(pattern_.values.size(), 0.0);
  for (const auto [from, to] : copies_)
    values[static_cast<std::size_t>(to)] += full[static_cast<std::size_t>(from)];
  for (const Product& p : products_)
    values[static_cast<std::size_t>(p.to)] += factor[static_cast<std::size_t>(p.first)] *
                                              factor[static_cast<std::size_t>(p.second)] *
                                              full[static_cast<std::size_t>(p.from)];
  return values;
}

void TieReduction::add_geometric(const State& state, const Eigen::VectorXd& force,
                                 std::vector<double>& values) const {
  for (const Tie& tie : dofs_.ties()) {
    Eigen::Vector3d f = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c)
      if (const int e = dofs_.equation(tie.node, c); e != DofMap::absent) f[c] = force[e];
    if (f.isZero(0)) continue;
    const Eigen::Vector3d arm = state.rotation[static_cast<std::size_t>(tie.master)] * tie.arm;
    // d2(exp(theta) arm)/dtheta_k dtheta_l = (e_k arm_l + e_l arm_k)/2 - delta_kl arm, along its axes
    const Eigen::Matrix3d axes = dofs_.turn_axes(state, tie.master);
    const Eigen::Matrix3d G =
        axes.transpose() *
        ((f * arm.transpose() + arm * f.transpose()) / 2 - f.dot(arm) * Eigen::Matrix3d::Identity()) * axes;
    const std::array<int, 3> turns = dofs_.turns(tie.master);
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l <= k; ++l) {
        const int p = turns[static_cast<std::size_t>(k)], q = turns[static_cast<std::size_t>(l)];
        if (dofs_.is_free(p) && dofs_.is_free(q))
          values[static_cast<std::size_t>(pattern_.place(std::min(p, q), std::max(p, q)))] += G(k, l);
      }
  }
}

} // namespace dielast::fem
