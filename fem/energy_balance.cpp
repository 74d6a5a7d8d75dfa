#include "fem/energy_balance.hpp"

#include <Eigen/Dense>

#include <limits>

namespace dielast::fem {

namespace {

double total(const EnergyParts& parts) {
  return parts.elastic + parts.branches + parts.electric + parts.kinetic;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// int_a^b L_i dL_j for the Lagrange polynomials of `nodes`; row i, column j.
Eigen::MatrixXd work_weights(const Eigen::VectorXd& nodes, double a, double b) {
  const Eigen::Index n = nodes.size();
  // Gauss-Legendre rule of 12 points: exact to degree 23
  static const Eigen::Vector<double, 6> place(0.1252334085114689, 0.3678314989981802, 0.5873179542866175,
                                              0.7699026741943047, 0.9041172563704749, 0.9815606342467193);
  static const Eigen::Vector<double, 6> weight(0.2491470458134028, 0.2334925365383548, 0.2031674267230659,
                                               0.1600783285433462, 0.1069393259953184, 0.0471753363865118);
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(n, n);
  for (int g = 0; g < 12; ++g) {
    const double x = (a + b) / 2 + (g < 6 ? 1 : -1) * place[g % 6] * (b - a) / 2;
    Eigen::VectorXd value(n), slope(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      value[i] = 1, slope[i] = 0;
      for (Eigen::Index j = 0; j < n; ++j) {
        if (j == i) continue;
        const double factor = (x - nodes[j]) / (nodes[i] - nodes[j]);
        slope[i] = slope[i] * factor + value[i] / (nodes[i] - nodes[j]);
        value[i] *= factor;
      }
    }
    W += weight[g % 6] * (b - a) / 2 * value * slope.transpose();
  }
  return W;
}

Work operator+(const Work& a, const Work& b) {
  return {a.electrical + b.electrical, a.mechanical + b.mechanical, a.dissipated + b.dissipated,
          a.released + b.released};
}

/// Scalar products of everything with everything in a window; W : these are the works.
struct Products {
  Eigen::MatrixXd electrical, mechanical, dissipated;

  explicit Products(const std::deque<EnergyPoint>& window) {
    const auto n = static_cast<Eigen::Index>(window.size());
    electrical = mechanical = dissipated = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const EnergyPoint &p = window[static_cast<std::size_t>(i)], &q = window[static_cast<std::size_t>(j)];
        electrical(i, j) = dot(p.voltage, q.charge);
        mechanical(i, j) = p.force.dot(q.position);
        dissipated(i, j) = p.energy.dissipation * q.time;
      }
  }
  Work weighted(const Eigen::MatrixXd& W) const {
    return {W.cwiseProduct(electrical).sum(), W.cwiseProduct(mechanical).sum(),
            W.cwiseProduct(dissipated).sum(), 0};
  }
};

/// Ways to place the window's points on their path: as given, and, where no time passes, by how far charges
/// and displacements have gone towards those of the last point, which is smooth even through a limit point of
/// the loads.
std::vector<Eigen::VectorXd> placements(const std::deque<EnergyPoint>& window) {
  const auto n = static_cast<Eigen::Index>(window.size());
  const EnergyPoint &first = window.front(), &last = window.back();
  const Eigen::VectorXd way = last.position - first.position;
  const double way_square = way.squaredNorm();
  std::vector<double> gain(first.charge.size());
  for (std::size_t e = 0; e < gain.size(); ++e) gain[e] = last.charge[e] - first.charge[e];
  const double gain_square = dot(gain, gain);
  Eigen::VectorXd along(n), given(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const EnergyPoint& point = window[static_cast<std::size_t>(i)];
    given[i] = point.parameter - first.parameter;
    along[i] = way_square > 0 ? way.dot(point.position - first.position) / way_square : 0;
    if (gain_square > 0) along[i] += (dot(gain, point.charge) - dot(gain, first.charge)) / gain_square;
  }
  std::vector<Eigen::VectorXd> all{given / given[n - 1]};
  const bool grows = ((along.tail(n - 1) - along.head(n - 1)).array() > 1e-6 / static_cast<double>(n)).all();
  if (last.time == first.time && grows) all.emplace_back(along / along[n - 1]);
  return all;
}

/// The same weights from all nodes but one in the middle: how much they differ tells how good they are.
Eigen::MatrixXd weights_without_one(const Eigen::VectorXd& nodes, double a, double b) {
  const Eigen::Index n = nodes.size(), left_out = n / 2;
  Eigen::VectorXd fewer(n - 1);
  fewer << nodes.head(left_out), nodes.tail(n - 1 - left_out);
  const Eigen::MatrixXd W = work_weights(fewer, a, b);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n - 1; ++i)
    for (Eigen::Index j = 0; j < n - 1; ++j) all(i + (i >= left_out), j + (j >= left_out)) = W(i, j);
  return all;
}

} // namespace

/// Works over the intervals first..last of the window's points, by the placement that depends least on its
/// points.
Work EnergyBalance::over(std::size_t first, std::size_t last) const {
  if (first >= last) return {};
  const Products products(record_.window);
  const auto all = placements(record_.window);
  Work best;
  double smallest = std::numeric_limits<double>::infinity();
  for (const Eigen::VectorXd& nodes : all) {
    const double a = nodes[static_cast<Eigen::Index>(first)], b = nodes[static_cast<Eigen::Index>(last)];
    const Work work = products.weighted(work_weights(nodes, a, b));
    if (all.size() == 1 || nodes.size() < 3) return work;
    const Work rougher = products.weighted(weights_without_one(nodes, a, b));
    const double doubt =
        std::abs(work.electrical - rougher.electrical) + std::abs(work.mechanical - rougher.mechanical);
    if (doubt < smallest) smallest = doubt, best = work;
  }
  return best;
}

void EnergyBalance::add(EnergyPoint point) {
  auto& window = record_.window;
  if (window.empty()) record_.stored_at_start = total(point.energy);
  if (window.size() == most_points) {
    // the interval in the middle is known best now; at the beginning everything before it goes with it
    constexpr std::size_t middle = most_points / 2 - 1;
    record_.settled = record_.settled + over(record_.first_settled ? middle : 0, middle + 1);
    record_.first_settled = true;
    window.pop_front();
  }
  window.push_back(std::move(point));
}

Work EnergyBalance::work() const {
  const auto& window = record_.window;
  if (window.size() < 2) return record_.settled;
  const std::size_t open = record_.first_settled ? most_points / 2 - 1 : 0;
  return record_.settled + over(open, window.size() - 1);
}

void EnergyBalance::corner() {
  auto& window = record_.window;
  if (window.empty()) return;
  record_.settled = work();
  record_.first_settled = false;
  window.erase(window.begin(), window.end() - 1);
}

void EnergyBalance::add_after_jump(EnergyPoint point) {
  corner();
  const EnergyPoint& before = record_.window.back();
  Work done; // at fixed voltages and forces
  for (std::size_t e = 0; e < point.voltage.size(); ++e)
    done.electrical += before.voltage[e] * (point.charge[e] - before.charge[e]);
  done.mechanical = before.force.dot(point.position - before.position);
  done.released = done.electrical + done.mechanical - (total(point.energy) - total(before.energy));
  record_.settled = record_.settled + done;
  record_.window = {std::move(point)};
}

void EnergyBalance::add_cut_free(EnergyPoint point) {
  corner();
  record_.settled.released -= total(point.energy) - stored();
  record_.window = {std::move(point)};
}

double EnergyBalance::stored() const {
  return record_.window.empty() ? 0 : total(record_.window.back().energy);
}

double EnergyBalance::error(const Work& done) const {
  return done.electrical + done.mechanical - (stored() - record_.stored_at_start) - done.dissipated -
         done.released;
}

EnergyPoint energy_point(Equilibrium& equilibrium, const State& state, double parameter) {
  const Model& model = equilibrium.model();
  const DofMap& dofs = model.dofs;
  EnergyPoint point;
  point.parameter = parameter;
  point.time = state.time;
  equilibrium.internal_force(state, point.force); // the reactions, at the end, are external too
  point.force.head(dofs.free_count()) = state.dead_force.head(dofs.free_count());
  if (state.motion) {
    const Motion& motion = *state.motion;
    point.force.tail(dofs.count() - dofs.free_count()) +=
        (model.inertia.mass * motion.acceleration + model.inertia.damping * motion.velocity)
            .tail(dofs.count() - dofs.free_count());
  }
  point.position = position(state, dofs);
  point.voltage = state.voltage;
  point.charge = model.charges(state, false).charge;
  // What pumps do is mechanical work.
  const auto chambers = static_cast<Eigen::Index>(model.chambers.size());
  point.force.conservativeResize(dofs.count() + chambers);
  point.position.conservativeResize(dofs.count() + chambers);
  for (Eigen::Index c = 0; c < chambers; ++c) {
    const std::size_t port = model.electrodes.size() + static_cast<std::size_t>(c);
    point.force[dofs.count() + c] = point.voltage[port];
    point.position[dofs.count() + c] = point.charge[port];
  }
  point.voltage.resize(model.electrodes.size());
  point.charge.resize(model.electrodes.size());
  point.energy = model.energies(state);
  return point;
}

} // namespace dielast::fem
