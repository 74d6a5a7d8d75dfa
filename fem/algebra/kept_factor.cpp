// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/algebra/kept_factor.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace dielast::fem {

namespace {

/// Pivots over their diagonal entries below which single precision tells too little.
constexpr double least_pivot = 1e-4;
/// Operations of a factorisation in the time in which a solve reads an entry of the factor twice.
constexpr double operations_per_entry = 40;
/// Iterations with a factor of the matrix itself after which a solve gives up.
constexpr int most_iterations = 50;
/// Square of what corrections may be over those foreseen; they were 0.15 to 0.4 times those.
constexpr double foreseen = 10;

/// Into how many blocks columns are divided, whatever the number of threads, and how many columns are worth
/// it.
constexpr int most_blocks = 8, least_columns = 4096;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// b over its largest entry, which is returned: the range of single precision is small.
double scale(const Eigen::VectorXd& b, Eigen::VectorXd& scaled) {
  const double largest = b.lpNorm<Eigen::Infinity>();
  if (largest != 0) scaled = b / largest;
  return largest;
}

} // namespace

double KeptFactor::cost(const Supernodes& supernodes) {
  double operations = 0, entries = 0;
  for (int s = 0; s < supernodes.count(); ++s) {
    const double width = supernodes.width(s), below = supernodes.below(s);
    operations += width * (width * width / 3 + width * below + below * below);
    entries += width * (width / 2 + below);
  }
  return 1 + operations / (operations_per_entry * entries);
}

KeptFactor::KeptFactor(const SparseSymmetric& matrix, const Supernodes& supernodes, Workers& workers)
    : matrix_(matrix), workers_(workers), factor_(supernodes, workers), cost_(cost(supernodes)) {
  divide_columns();
}

void KeptFactor::divide_columns() {
  const int count = std::clamp(matrix_.size / least_columns, 1, most_blocks);
  std::vector<int> place(at(matrix_.size), -1);
  for (int b = 0; b < count; ++b) {
    Block block{static_cast<int>(static_cast<std::int64_t>(matrix_.size) * b / count),
                static_cast<int>(static_cast<std::int64_t>(matrix_.size) * (b + 1) / count),
                {},
                {},
                {}};
    for (int c = block.first; c < block.last; ++c)
      for (int k = matrix_.column_start[at(c)]; k < matrix_.column_start[at(c) + 1]; ++k) {
        const int row = matrix_.rows[at(k)];
        if (row < block.last) continue;
        if (place[at(row)] < 0) {
          place[at(row)] = static_cast<int>(block.row.size());
          block.row.push_back(row);
        }
        block.place.push_back(place[at(row)]);
      }
    for (const int row : block.row) place[at(row)] = -1;
    block.spilled.resize(block.row.size());
    blocks_.push_back(std::move(block));
  }
  sums_.resize(blocks_.size());
}

/// y = A x.
void KeptFactor::multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  y.resize(matrix_.size);
  workers_.run(blocks_.size(), [&](std::size_t b) {
    Block& block = blocks_[b];
    std::ranges::fill(block.spilled, 0.0);
    y.segment(block.first, block.last - block.first).setZero();
    const int* place = block.place.data();
    for (int c = block.first; c < block.last; ++c) {
      const double of_column = x[c];
      auto k = at(matrix_.column_start[at(c)]);
      const auto end = at(matrix_.column_start[at(c) + 1]);
      double sum = matrix_.values[k] * of_column;
      for (++k; k < end && matrix_.rows[k] < block.last; ++k) {
        sum += matrix_.values[k] * x[matrix_.rows[k]];
        y[matrix_.rows[k]] += matrix_.values[k] * of_column;
      }
      for (; k < end; ++k) {
        sum += matrix_.values[k] * x[matrix_.rows[k]];
        block.spilled[at(*place++)] += matrix_.values[k] * of_column;
      }
      y[c] += sum;
    }
  });
  for (const Block& block : blocks_)
    for (std::size_t i = 0; i < block.row.size(); ++i) y[block.row[i]] += block.spilled[i];
}

/// f(first, count) of each block's range.
template<class Function>
void KeptFactor::for_blocks(const Function& f) {
  workers_.run(blocks_.size(),
               [&](std::size_t b) { f(blocks_[b].first, blocks_[b].last - blocks_[b].first); });
}

double KeptFactor::dot(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  workers_.run(blocks_.size(), [&](std::size_t b) {
    const int first = blocks_[b].first, count = blocks_[b].last - first;
    sums_[b] = x.segment(first, count).dot(y.segment(first, count));
  });
  return std::accumulate(sums_.begin(), sums_.end(), 0.0);
}

bool KeptFactor::prove(const Eigen::VectorXd* right) {
  if (memory_.fails) return false;
  return make(true, right && scale(*right, ahead_) > 0 ? &ahead_ : nullptr);
}

bool KeptFactor::make(bool proves, const Eigen::VectorXd* right) {
  ++factorisations_;
  memory_.values = matrix_.values;
  memory_.fresh = memory_.debt = 0;
  memory_.proves = proves;
  is_ahead_ = right != nullptr;
  memory_.fails = !factor_of_memory(right);
  return !memory_.fails;
}

bool KeptFactor::factor_of_memory(const Eigen::VectorXd* right) {
  return factor_.factor(memory_.values, memory_.proves ? rounded : 0, right) &&
         factor_.smallest_pivot().relative > least_pivot;
}

void KeptFactor::recall(FactorMemory memory) {
  memory_ = std::move(memory);
  is_ahead_ = false;
  if (!memory_.fails && !memory_.values.empty()) memory_.fails = !factor_of_memory(nullptr);
}

bool KeptFactor::prepare() {
  if (memory_.fails) return false;
  if (!memory_.values.empty() && memory_.debt < cost_) return true;
  return make();
}

/// z = A^-1 r, as far as the factor tells.
void KeptFactor::apply_factor() {
  if (is_ahead_ && ahead_ == r_)
    factor_.finish(z_);
  else
    factor_.solve(r_, z_);
  is_ahead_ = false;
  ++solves_;
}

/// Iterations until a correction of x is small enough, none where `most` do not suffice. `square`: that of
/// the norm of x.
std::optional<int> KeptFactor::iterate(Eigen::VectorXd& x, double& square, double tolerance, int most) {
  double product = 0, correction = 0;
  // By what the next correction will be told before it is made: as much smaller as this one is than the
  // last, or three times less. The second falls faster than others, but with a factor of the matrix itself.
  const auto suffices = [&](int iteration, double now, double last) {
    const double least = tolerance * tolerance * (square + now);
    return now <= least || (iteration > (memory_.proves ? 1 : 2) && foreseen * now * now <= least * last);
  };
  for (int iteration = 1; iteration <= most; ++iteration) {
    apply_factor();
    const double rz = dot(r_, z_);
    if (rz == 0) return iteration;
    const double kept = iteration == 1 ? 0 : rz / product;
    if (iteration == 1) p_.setZero(z_.size());
    for_blocks([&](int first, int count) {
      p_.segment(first, count) = z_.segment(first, count) + kept * p_.segment(first, count);
    });
    if (memory_.proves && iteration > 1 &&
        suffices(iteration, rz, correction)) { // its step is 1 but for as small a part
      x += p_;
      square += rz;
      return iteration;
    }
    product = rz;
    multiply(p_, Ap_);
    const double curvature = dot(p_, Ap_);
    if (!(curvature > 0)) return std::nullopt;
    for_blocks([&](int first, int count) {
      x.segment(first, count) += rz / curvature * p_.segment(first, count);
      r_.segment(first, count) -= rz / curvature * Ap_.segment(first, count);
    });
    const double last = std::exchange(correction, rz / curvature * rz);
    const bool enough = suffices(iteration, correction, last);
    square += correction;
    if (enough) return iteration;
  }
  return std::nullopt;
}

bool KeptFactor::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance) {
  x.setZero(b.size());
  const double largest = scale(b, r_);
  if (largest == 0) return true;
  if (tolerance >= 1) {
    apply_factor();
    x = largest * z_;
    return true;
  }
  double square = 0;
  const bool fresh = memory_.fresh == 0;
  const double decades = -std::log10(tolerance), expected = memory_.fresh * decades;
  const int worth = static_cast<int>(std::ceil(expected + cost_));
  if (const auto iterations = iterate(x, square, tolerance, fresh ? most_iterations : worth)) {
    if (fresh)
      memory_.fresh = *iterations / decades;
    else
      memory_.debt += std::max(0.0, *iterations - expected);
  } else {
    memory_.fails = fresh || !make() || !iterate(x, square, tolerance, most_iterations);
    memory_.debt = cost_; // the next matrix may be as far from this one
  }
  x *= largest;
  return !memory_.fails;
}

} // namespace dielast::fem
