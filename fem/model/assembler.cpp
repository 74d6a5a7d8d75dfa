// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/model/assembler.hpp"

#include "fem/model/contact_block.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace dielast::fem {

namespace {

/// Entries of the tangent that a thread clears at once, not less.
constexpr int cleared_together = 1 << 16;

/// Below this many elements waking and waiting for threads costs more than they save.
constexpr int worth_threads = 16000;

/// Elements that are computed one after the other. The more, the more of what they add to is still near from
/// the neighbours before, but threads must find enough chunks of a colour. By the model alone: it is the
/// order of the sums.
int chunk_size(int elements) {
  constexpr int chunks = 64, least = 256, most = 1024;
  return elements < worth_threads ? elements : std::clamp(elements / chunks, least, most);
}

int element_count(const Model& model) {
  int elements = 0;
  for (const auto& block : model.blocks) elements += block->element_count();
  return elements;
}

} // namespace

Assembler::Assembler(const Model& model, int threads) : model_(model) {
  equations_.resize(model_.blocks.size());
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    number_elements(b);
    if (auto* contact = dynamic_cast<ContactBlock*>(model_.blocks[b].get()))
      contacts_.push_back({b, contact, contact->choose_elements(model_.initial_state())});
  }
  for (const Contact& contact : contacts_) number_elements(contact.block);
  workers_ = std::make_unique<Workers>(element_count(model_) < worth_threads ? 1 : threads);
  find_pattern();
  colour_chunks();
  block_residual_.assign(model_.blocks.size(), Eigen::VectorXd::Zero(model_.dofs.count()));
}

void Assembler::number_elements(std::size_t b) {
  const ElementBlock& block = *model_.blocks[b];
  const int dofs = block.dofs_per_element();
  equations_[b].resize(static_cast<std::size_t>(block.element_count() * dofs));
  for (int e = 0; e < block.element_count(); ++e)
    block.element_equations(
        e, model_.dofs,
        std::span(equations_[b]).subspan(static_cast<std::size_t>(e * dofs), static_cast<std::size_t>(dofs)));
}

/// Residuals need no pattern: of trial states that are not taken none is found.
void Assembler::choose_elements(const State& state) {
  bool changed = false;
  for (Contact& contact : contacts_) {
    const std::size_t choice = contact.elements->choose_elements(state);
    if (choice == contact.choice) continue;
    contact.choice = choice;
    number_elements(contact.block);
    changed = stale_ = true;
  }
  if (changed) colour_chunks();
}

void Assembler::find_pattern() {
  stale_ = false;
  ++patterns_;
  matrix_ = {};
  build_pattern();
  slots_.assign(equations_.size(), {});
  pairs_.assign(equations_.size(), {});
  for (std::size_t b = 0; b < equations_.size(); ++b) place_elements(b);
  if (model_.dofs.ties().empty()) return;
  reduction_.emplace(model_.dofs, matrix_);
  reduced_ = reduction_->pattern();
}

/// The free ones, then those of tied nodes.
int Assembler::unknown(int equation) const {
  const DofMap& map = model_.dofs;
  return map.is_free(equation)   ? equation
         : map.is_tied(equation) ? equation - map.held_count()
                                 : DofMap::absent;
}

void Assembler::build_pattern() {
  const int n = model_.dofs.count() - model_.dofs.held_count();
  matrix_.size = n;

  // Elements at each equation.
  struct ElementRef {
    int block, element;
    bool operator==(const ElementRef&) const = default;
  };
  std::vector<int> start(static_cast<std::size_t>(n) + 1, 0);
  for (const auto& equations : equations_)
    for (const int equation : equations)
      if (const int u = unknown(equation); u >= 0) ++start[static_cast<std::size_t>(u) + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<ElementRef> elements(static_cast<std::size_t>(start.back()));
  std::vector<int> fill(start.begin(), start.end() - 1);
  for (std::size_t b = 0; b < equations_.size(); ++b) {
    const int dofs = model_.blocks[b]->dofs_per_element();
    for (std::size_t i = 0; i < equations_[b].size(); ++i)
      if (const int u = unknown(equations_[b][i]); u >= 0)
        elements[static_cast<std::size_t>(fill[static_cast<std::size_t>(u)]++)] = {
            static_cast<int>(b), static_cast<int>(i) / dofs};
  }

  // Rows of each column; an unknown without elements keeps its diagonal so that the factorisation reports it.
  // Unknowns of one node have the same elements, and so the same rows but for those above the diagonal.
  matrix_.column_start.assign(1, 0);
  std::vector<int> seen(static_cast<std::size_t>(n), -1);
  const auto elements_of = [&](int column) {
    const auto u = static_cast<std::size_t>(column);
    return std::span(elements).subspan(static_cast<std::size_t>(start[u]),
                                       static_cast<std::size_t>(start[u + 1] - start[u]));
  };
  for (int column = 0; column < n; ++column) {
    const std::size_t first = matrix_.rows.size();
    const auto above = column > 0 ? static_cast<std::size_t>(matrix_.column_start.rbegin()[1]) : 0;
    if (first > above + 1 && matrix_.rows[above + 1] == column &&
        std::ranges::equal(elements_of(column - 1), elements_of(column))) {
      matrix_.rows.resize(2 * first - above - 1);
      std::copy_n(matrix_.rows.begin() + static_cast<std::ptrdiff_t>(above) + 1, first - above - 1,
                  matrix_.rows.begin() + static_cast<std::ptrdiff_t>(first));
    } else {
      matrix_.rows.push_back(column);
      seen[static_cast<std::size_t>(column)] = column;
      for (const auto& [block, element] : elements_of(column)) {
        const int dofs = model_.blocks[static_cast<std::size_t>(block)]->dofs_per_element();
        const int* equation = equations_[static_cast<std::size_t>(block)].data() + element * dofs;
        for (int i = 0; i < dofs; ++i)
          if (const int u = unknown(equation[i]); u > column && seen[static_cast<std::size_t>(u)] != column) {
            seen[static_cast<std::size_t>(u)] = column;
            matrix_.rows.push_back(u);
          }
      }
      std::sort(matrix_.rows.begin() + static_cast<std::ptrdiff_t>(first), matrix_.rows.end());
    }
    if (matrix_.rows.size() > INT32_MAX) throw std::length_error("the tangent has more than 2^31 entries");
    matrix_.column_start.push_back(static_cast<int>(matrix_.rows.size()));
  }
  matrix_.values.assign(matrix_.rows.size(), 0.0);
}

/// Whether the unknowns of every node follow one another, and likewise what its columns have in common with
/// the other nodes: places of the pairs, see add_by_nodes().
bool Assembler::place_by_nodes(NodeOrder order, std::span<const int> equations, std::span<int> pairs) const {
  const auto first_of = [&](int node) { return equations[static_cast<std::size_t>(node * order.unknowns)]; };
  const auto start_of = [&](int column) { return matrix_.column_start[static_cast<std::size_t>(column)]; };
  const auto all = static_cast<std::size_t>(order.nodes * order.unknowns);
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const auto place = static_cast<int>(i);
    if (i < all ? !model_.dofs.is_free(equations[i]) ||
                      equations[i] != first_of(place / order.unknowns) + place % order.unknowns
                : unknown(equations[i]) >= 0)
      return false;
  }
  std::size_t pair = 0;
  for (int a = 0; a < order.nodes; ++a)
    for (int b = 0; b < a; ++b, ++pair) {
      const int column = std::min(first_of(a), first_of(b)), row = std::max(first_of(a), first_of(b));
      if (column == row) return false;
      const int length = start_of(column + 1) - start_of(column);
      int place = pairs[pair] = matrix_.place(column, row);
      for (int j = 0; j < order.unknowns; place += length - ++j)
        if (place < start_of(column + j) || place >= start_of(column + j + 1) ||
            matrix_.rows[static_cast<std::size_t>(place)] != row)
          return false;
    }
  return true;
}

void Assembler::place_elements(std::size_t b) {
  const auto dofs = static_cast<std::size_t>(model_.blocks[b]->dofs_per_element());
  const NodeOrder order = model_.blocks[b]->node_order();
  const auto pairs = static_cast<std::size_t>(order.pairs()),
             elements = static_cast<std::size_t>(model_.blocks[b]->element_count());
  std::vector<int>& slots = slots_[b];
  if (pairs == 0) slots.reserve(equations_[b].size() * (dofs + 1) / 2);
  pairs_[b].resize(elements * pairs);
  int with_slots = 0;
  for (std::size_t e = 0; e < elements; ++e) {
    const auto equations = std::span(equations_[b]).subspan(e * dofs, dofs);
    if (pairs > 0) {
      const auto places = std::span(pairs_[b]).subspan(e * pairs, pairs);
      if (place_by_nodes(order, equations, places)) continue;
      places[0] = -1 - with_slots++;
    }
    for (std::size_t i = 0; i < dofs; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        const int p = unknown(equations[i]), q = unknown(equations[j]);
        if (p < 0 || q < 0) {
          slots.push_back(Scatter::none);
          continue;
        }
        const int place = matrix_.place(std::min(p, q), std::max(p, q));
        slots.push_back(p == q && i != j ? Scatter::twice(place) : place);
      }
  }
}

Scatter Assembler::scatter(std::size_t b, double* residual, double* tangent) const {
  return {equations_[b].data(), slots_[b].data(),           residual, tangent,
          pairs_[b].data(),     matrix_.column_start.data()};
}

/// The lower triangle of its part of the elements' unknowns.
int Assembler::equation(int unknown) const {
  return model_.dofs.is_free(unknown) ? unknown : unknown + model_.dofs.held_count();
}

const Assembler::Resistance& Assembler::resistance() const {
  if (resistance_.of_pattern != patterns_)
    resistance_ = {on_pattern(model_.inertia().mass), on_pattern(model_.inertia().damping), patterns_};
  return resistance_;
}

std::vector<double> Assembler::on_pattern(const Eigen::SparseMatrix<double>& constant) const {
  if (constant.nonZeros() == 0) return {};
  std::vector<double> values(matrix_.values.size(), 0.0);
  matrix_.for_each_entry([&](std::size_t at, int column, int row) {
    values[at] = constant.coeff(equation(row), equation(column));
  });
  return values;
}

void Assembler::colour_chunks() {
  constexpr int most_colours = 64;
  colours_.clear();
  const int size = chunk_size(element_count(model_));
  std::vector<Chunk> alone;
  std::vector<std::uint64_t> taken(static_cast<std::size_t>(model_.dofs.count()), 0);
  for (std::size_t b = 0; b < equations_.size(); ++b) {
    const ElementBlock& block = *model_.blocks[b];
    const int step = (size + block.granularity() - 1) / block.granularity() * block.granularity();
    for (int first = 0; first < block.element_count(); first += step) {
      const Chunk chunk{static_cast<int>(b), first, std::min(first + step, block.element_count())};
      const auto begin =
          equations_[b].begin() + static_cast<std::ptrdiff_t>(chunk.first) * block.dofs_per_element();
      const auto end =
          equations_[b].begin() + static_cast<std::ptrdiff_t>(chunk.last) * block.dofs_per_element();
      std::uint64_t used = 0;
      for (auto e = begin; e != end; ++e)
        if (*e != DofMap::absent) used |= taken[static_cast<std::size_t>(*e)];
      int colour = 0;
      while (colour < most_colours && (used >> colour & 1)) ++colour;
      if (colour == most_colours) { // too many neighbours: a colour of its own
        alone.push_back(chunk);
        continue;
      }
      for (auto e = begin; e != end; ++e)
        if (*e != DofMap::absent) taken[static_cast<std::size_t>(*e)] |= std::uint64_t{1} << colour;
      if (colours_.size() <= static_cast<std::size_t>(colour))
        colours_.resize(static_cast<std::size_t>(colour) + 1);
      colours_[static_cast<std::size_t>(colour)].push_back(chunk);
    }
  }
  for (const Chunk& chunk : alone) colours_.push_back({chunk});
}

Evaluation Assembler::run(const State& state, bool want_residual, bool want_tangent) {
  Evaluation total{.convex = true};
  for (const auto& colour : colours_) {
    parts_.assign(colour.size(), {});
    const auto evaluate = [&](std::size_t c) {
      const auto [block, first, last] = colour[c];
      const auto b = static_cast<std::size_t>(block);
      parts_[c] = model_.blocks[b]->evaluate(state, first, last,
                                             scatter(b, want_residual ? block_residual_[b].data() : nullptr,
                                                     want_tangent ? matrix_.values.data() : nullptr));
    };
    workers_->run(colour.size(), evaluate);
    for (const Evaluation& part : parts_) {
      total.energy += part.energy;
      total.feasible = total.feasible && part.feasible;
      total.convex = total.convex && part.convex;
    }
  }
  return total;
}

Evaluation Assembler::residual(const State& state, Eigen::VectorXd& residual) {
  choose_elements(state);
  for (auto& block : block_residual_) block.setZero();
  const Evaluation evaluation = run(state, true, false);
  residual = block_residual_.front();
  for (std::size_t b = 1; b < block_residual_.size(); ++b) residual += block_residual_[b];
  return evaluation;
}

std::vector<double> Assembler::relaxation(const State& state, const RateWeight& weight) const {
  std::vector<double> values(matrix_.values.size(), 0.0);
  for (std::size_t b = 0; b < equations_.size(); ++b)
    model_.blocks[b]->add_relaxation(state, weight, scatter(b, nullptr, values.data()));
  return without_ties(state, std::move(values));
}

void Assembler::tangent(const State& state) {
  choose_elements(state);
  if (stale_) find_pattern();
  workers_->run_blocks(static_cast<int>(matrix_.values.size()), cleared_together,
                       [this](int first, int last) {
                         std::fill(matrix_.values.begin() + first, matrix_.values.begin() + last, 0.0);
                       });
  convex_ = false; // tied nodes turn with their bodies, which may set energy free
  if (!reduction_) {
    convex_ = run(state, false, true).convex;
    add_inertia(state);
    return;
  }
  for (auto& block : block_residual_) block.setZero();
  run(state, true, true);
  add_inertia(state);
  reduced_.values = reduction_->reduce(state, matrix_.values);
  Eigen::VectorXd force = -state.dead_force;
  for (const auto& block : block_residual_) force += block;
  if (!state.motion_scheme.is_static() && state.motion)
    force += InertialForce(model_.inertia(), model_.dofs, state).force();
  reduction_->add_geometric(state, force, reduced_.values);
}

void Assembler::add_inertia(const State& state) {
  if (state.motion_scheme.is_static()) return;
  const auto add = [this](double factor, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) matrix_.values[i] += factor * values[i];
  };
  add(state.motion_scheme.mass_factor(), resistance().mass);
  add(state.motion_scheme.damping_factor(), resistance().damping);
  if (model_.inertia().drag.isZero(0) || !state.motion) return;
  const Eigen::VectorXd stiffness = InertialForce(model_.inertia(), model_.dofs, state).drag_stiffness();
  for (int column = 0; column < matrix_.size; ++column) // the lower triangle: a column starts on the diagonal
    matrix_.values[static_cast<std::size_t>(matrix_.column_start[static_cast<std::size_t>(column)])] +=
        stiffness[equation(column)];
}

std::vector<double> Assembler::without_ties(const State& state, std::vector<double> values) const {
  return reduction_ && !values.empty() ? reduction_->reduce(state, values) : std::move(values);
}

} // namespace dielast::fem
