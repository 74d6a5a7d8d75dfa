// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "meshing/mesh.hpp"
#include "tests/cases/patch_oracle.hpp"

#include <algorithm>
#include <string>
#include <unordered_map>

namespace dielast::test {

/// A planar neo-Hookean film of 3-node triangles with logarithmic branches, held at some nodes, whose
/// electrode resists the current along the film: displacements in equilibrium with the charges of the sheet's
/// corners, charges and viscous deformations integrated by the classical Runge-Kutta method in steps far
/// below their times, works and heat along them. Takes the drawn mesh and nothing else of the program.
class SheetOracle {
 public:
  struct Branch {
    double modulus = 0, time = 0; ///< Pa, s
  };
  using Loads = PatchOracle::Loads; ///< `along` is not used
  using Supply = PatchOracle::Supply;

  double modulus = 0, permittivity = 0, thickness = 0, prestretch = 1;
  std::vector<Branch> branches;
  double sheet_resistance = 0; ///< Ohm per square of the deformed film
  Supply supply = Supply::voltage;
  double resistance = 0, leakage = 0, current_limit = 1e300;

  Account account;

  /// To be called when everything is set: the film as drawn, without charges. `held` does not move,
  /// `terminal` is where the electrode over the triangles `electrode` is connected; all sorted.
  void begin(const meshing::Mesh& mesh, const std::string& electrode, const std::string& terminal,
             const std::string& held) {
    const meshing::CellBlock& film = *mesh.film();
    position_.resize(2 * mesh.node_count());
    for (int n = 0; n < mesh.node_count(); ++n)
      position_.segment<2>(2 * n) = mesh.nodes[static_cast<std::size_t>(n)].head<2>();
    const auto in = [](const std::vector<int>& set, int n) { return std::ranges::binary_search(set, n); };
    for (int n = 0; n < mesh.node_count(); ++n)
      if (!in(mesh.node_sets.at(held), n)) free_.insert(free_.end(), {2 * n, 2 * n + 1});
    std::unordered_map<int, int>
        number; // of a node's corner of the sheet; all of the terminal is one, the last
    for (int c = 0; c < film.size(); ++c)
      if (in(mesh.cell_sets.at(electrode).cells, c))
        for (const int n : film.cell(c))
          if (!in(mesh.node_sets.at(terminal), n)) number.try_emplace(n, std::ssize(number));
    corners_ = std::ssize(number) + 1;
    for (int c = 0; c < film.size(); ++c) {
      const auto cell = film.cell(c);
      Triangle triangle{.node = {cell[0], cell[1], cell[2]}};
      Eigen::Matrix2d sides;
      for (int i = 0; i < 2; ++i)
        sides.col(i) = (position_.segment<2>(2 * cell[static_cast<std::size_t>(i) + 1]) -
                        position_.segment<2>(2 * cell[0])) /
                       prestretch;
      triangle.area = sides.determinant() / 2;
      triangle.slope.bottomRows<2>() = sides.inverse();
      triangle.slope.row(0) = -triangle.slope.bottomRows<2>().colwise().sum();
      for (std::size_t a = 0; a < 3; ++a)
        for (int i = 0; i < 2; ++i)
          triangle.B.block<2, 2>(2 * i, 2 * static_cast<Eigen::Index>(a)) =
              triangle.slope(static_cast<Eigen::Index>(a), i) * Eigen::Matrix2d::Identity();
      if (in(mesh.cell_sets.at(electrode).cells, c))
        for (std::size_t a = 0; a < 3; ++a) {
          const auto found = number.find(cell[a]);
          triangle.corner[a] = found == number.end() ? corners_ - 1 : found->second;
        }
      triangles_.push_back(triangle);
    }
    state_.charge = Eigen::VectorXd::Zero(corners_);
    state_.viscous.assign(triangles_.size() * branches.size(),
                          prestretch * prestretch * Eigen::Matrix2d::Identity()); // relaxed as drawn
    const Eigen::VectorXd drawn = capacitances();
    leak_ = leakage * drawn / drawn.sum();
  }

  /// Loads change at once, straight, while nothing flows, but for what follows a source at the terminal: that
  /// has its new voltage all the while.
  void jump(const Loads& from, const Loads& to) {
    constexpr int parts = 200;
    Film now = film(from.electrode, state_);
    const double before = account.electrical, charge = now.charge[corners_ - 1];
    for (int part = 1; part <= parts; ++part) {
      const Film next =
          film(std::lerp(from.electrode, to.electrode, static_cast<double>(part) / parts), state_);
      if (supply != Supply::circuit) add_work(now, next);
      now = next;
    }
    if (supply == Supply::voltage) {
      const double given = to.electrode * (now.charge[corners_ - 1] - charge);
      account.dissipated += before + given - account.electrical;
      account.electrical = before + given;
    }
    keep(now);
  }
  /// Time passes from t0 to t1, in `least` equal steps or more.
  void pass(const std::function<Loads(double)>& loads, double t0, double t1, int least) {
    const auto source = [&](double t) { return loads(t).electrode; };
    Film now = film(source(t0), state_);
    const int steps = std::max(least, static_cast<int>((t1 - t0) * fastest(now) / 0.3));
    const double h = (t1 - t0) / steps;
    for (int step = 0; step < steps; ++step) {
      const double t = t0 + step * h;
      const Rates k1 = rates(now), k2 = rates(film(source(t + h / 2), moved(k1, h / 2))),
                  k3 = rates(film(source(t + h / 2), moved(k2, h / 2))),
                  k4 = rates(film(source(t + h), moved(k3, h)));
      const auto mean = [h](const auto& a, const auto& b, const auto& c, const auto& d) {
        return (h / 6 * (a + 2 * b + 2 * c + d));
      };
      state_.charge += mean(k1.charge, k2.charge, k3.charge, k4.charge).eval();
      for (std::size_t i = 0; i < state_.viscous.size(); ++i)
        state_.viscous[i] += mean(k1.viscous[i], k2.viscous[i], k3.viscous[i], k4.viscous[i]).eval();
      account.dissipated += mean(k1.heat, k2.heat, k3.heat, k4.heat);
      account.resistance += mean(k1.resistance, k2.resistance, k3.resistance, k4.resistance);
      account.leak += mean(k1.leak, k2.leak, k3.leak, k4.leak);
      account.electrical += mean(k1.work, k2.work, k3.work, k4.work);
      const Film next = film(source(t + h), state_);
      if (supply != Supply::circuit) add_work(now, next);
      now = next;
      keep(now);
    }
  }

 private:
  struct Triangle {
    std::array<int, 3> node{};
    std::array<Eigen::Index, 3> corner{-1, -1, -1}; ///< of the sheet
    double area = 0;                                ///< of the unstretched film
    Eigen::Matrix<double, 3, 2> slope = Eigen::Matrix<double, 3, 2>::Zero();
    Eigen::Matrix<double, 4, 6> B = Eigen::Matrix<double, 4, 6>::Zero(); ///< column by column of F
    bool charged() const { return corner[0] >= 0; }
  };
  /// What changes with time alone. The last charge, the terminal's, is known from the source where that is no
  /// circuit.
  struct Internal {
    Eigen::VectorXd charge;
    std::vector<Eigen::Matrix2d> viscous; ///< Cv in the plane, per triangle and branch
  };
  struct Film {
    double source = 0;
    Eigen::VectorXd charge, capacitance, voltage;
    std::vector<Eigen::Matrix2d> gradient, viscous;
  };
  struct Rates {
    Eigen::VectorXd charge;
    std::vector<Eigen::Matrix2d> viscous;
    double heat = 0, resistance = 0, leak = 0, work = 0;
  };

  Eigen::Matrix2d gradient(const Triangle& triangle) const {
    Eigen::Matrix2d F = Eigen::Matrix2d::Zero();
    for (std::size_t a = 0; a < 3; ++a)
      F += position_.segment<2>(2 * triangle.node[a]) * triangle.slope.row(static_cast<Eigen::Index>(a));
    return F;
  }
  Eigen::VectorXd capacitances() const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(corners_);
    for (const Triangle& triangle : triangles_)
      if (triangle.charged())
        for (const Eigen::Index corner : triangle.corner)
          sum[corner] +=
              permittivity * triangle.area / thickness / 3 * std::pow(gradient(triangle).determinant(), 2);
    return sum;
  }
  double terminal_charge(double source, const Internal& internal) const {
    if (supply == Supply::charge) return source - internal.charge.head(corners_ - 1).sum();
    return internal.charge[corners_ - 1];
  }

  /// Equilibrium at these charges (and the terminal's voltage, where that is the source).
  Film film(double source, const Internal& internal) {
    Film film{.source = source, .charge = internal.charge, .viscous = internal.viscous};
    const Eigen::Index last = corners_ - 1;
    film.charge[last] = terminal_charge(source, internal);
    for (int iteration = 0; iteration < 60; ++iteration) {
      film.capacitance = capacitances();
      Eigen::VectorXd force = Eigen::VectorXd::Zero(position_.size());
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(position_.size(), position_.size()),
                      slopes = Eigen::MatrixXd::Zero(position_.size(), corners_); // of the capacitances
      film.voltage = film.charge.cwiseQuotient(film.capacitance);
      if (supply == Supply::voltage) film.voltage[last] = source;
      for (std::size_t e = 0; e < triangles_.size(); ++e) add_triangle(e, internal, film, force, K, slopes);
      // where charges stay, voltages fall as capacitances grow
      Eigen::VectorXd falls = film.voltage.cwiseAbs2().cwiseQuotient(film.capacitance);
      if (supply == Supply::voltage) falls[last] = 0;
      const Eigen::MatrixXd moved = slopes(free_, Eigen::all);
      const Eigen::MatrixXd stiffness = K(free_, free_) + moved * falls.asDiagonal() * moved.transpose();
      const Eigen::VectorXd step = stiffness.ldlt().solve(force(free_));
      position_(free_) -= step;
      if (step.lpNorm<Eigen::Infinity>() < 1e-11 * position_.lpNorm<Eigen::Infinity>()) break;
    }
    film.capacitance = capacitances();
    film.voltage = film.charge.cwiseQuotient(film.capacitance);
    if (supply == Supply::voltage) {
      film.voltage[last] = source;
      film.charge[last] = source * film.capacitance[last];
    }
    for (const Triangle& triangle : triangles_) film.gradient.push_back(gradient(triangle));
    return film;
  }
  void add_triangle(std::size_t e, const Internal& internal, const Film& film, Eigen::VectorXd& force,
                    Eigen::MatrixXd& K, Eigen::MatrixXd& slopes) const {
    const Triangle& triangle = triangles_[e];
    const Eigen::Matrix2d F = gradient(triangle);
    const Eigen::Vector4d f = F.reshaped();
    Eigen::Matrix4d G = Eigen::Matrix4d::Zero(); // second derivative of det F
    G(0, 3) = G(3, 0) = 1;
    G(1, 2) = G(2, 1) = -1;
    const Eigen::Vector4d cofactor = G * f;
    const double J = F.determinant();
    const auto volumetric = [&](double factor, Eigen::Vector4d& P, Eigen::Matrix4d& A) { // factor/(2 J^2)
      P -= factor / (J * J * J) * cofactor;
      A += factor / (J * J * J) * (3 / J * cofactor * cofactor.transpose() - G);
    };
    Eigen::Vector4d P = modulus * f;
    Eigen::Matrix4d A = modulus * Eigen::Matrix4d::Identity();
    volumetric(modulus, P, A);
    for (std::size_t b = 0; b < branches.size(); ++b) {
      const Eigen::Matrix2d& Cv = internal.viscous[e * branches.size() + b];
      const Eigen::Matrix2d inverse = Cv.inverse();
      Eigen::Matrix4d spring = Eigen::Matrix4d::Zero();
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          spring.block<2, 2>(2 * i, 2 * j) = inverse(i, j) * Eigen::Matrix2d::Identity();
      P += branches[b].modulus * spring * f;
      A += branches[b].modulus * spring;
      volumetric(branches[b].modulus * Cv.determinant(), P, A);
    }
    P *= triangle.area * thickness;
    A *= triangle.area * thickness;
    std::array<int, 6> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      at[2 * a] = 2 * triangle.node[a];
      at[2 * a + 1] = 2 * triangle.node[a] + 1;
    }
    if (triangle.charged()) {
      const double c = permittivity * triangle.area / thickness / 3;
      for (const Eigen::Index corner : triangle.corner) {
        const double square = std::pow(film.voltage[corner], 2);
        P -= square * c * J * cofactor; // of -C V^2/2 with C = c J^2, and of q^2/(2 C)
        A -= square * c * (cofactor * cofactor.transpose() + J * G);
        slopes(at, corner) += triangle.B.transpose() * (2 * c * J * cofactor);
      }
    }
    force(at) += triangle.B.transpose() * P;
    K(at, at) += triangle.B.transpose() * A * triangle.B;
  }
  Eigen::MatrixXd conductance(const Film& film) const {
    Eigen::MatrixXd L = Eigen::MatrixXd::Zero(corners_, corners_);
    for (std::size_t e = 0; e < triangles_.size(); ++e) {
      const Triangle& triangle = triangles_[e];
      if (!triangle.charged()) continue;
      const Eigen::Matrix2d F = film.gradient[e];
      const Eigen::Matrix<double, 3, 2> slope = triangle.slope * F.inverse(); // in the deformed film
      const Eigen::Matrix3d local =
          triangle.area * F.determinant() / sheet_resistance * slope * slope.transpose();
      for (Eigen::Index a = 0; a < 3; ++a)
        for (Eigen::Index b = 0; b < 3; ++b)
          L(triangle.corner[static_cast<std::size_t>(a)], triangle.corner[static_cast<std::size_t>(b)]) +=
              local(a, b);
    }
    return L;
  }
  Rates rates(const Film& film) const {
    const Eigen::Index last = corners_ - 1;
    const Eigen::MatrixXd L = conductance(film);
    const Eigen::VectorXd leaking = leak_.cwiseProduct(film.voltage), out = L * film.voltage + leaking;
    Rates rates{.charge = -out};
    const double phi = film.voltage[last];
    rates.heat = film.voltage.dot(L * film.voltage);
    rates.leak = leaking.dot(film.voltage);
    // The work on film and sheet; where the source gives the voltage or charge, add_work() has the rest.
    if (supply == Supply::voltage) rates.work = phi * out[last] - rates.leak;
    if (supply == Supply::circuit) {
      const double drop = film.source - phi;
      const double current = std::clamp(drop / resistance, -current_limit, current_limit);
      rates.charge[last] += current;
      rates.resistance = drop * current;
      rates.work = phi * current - rates.leak;
    }
    for (std::size_t i = 0; i < film.viscous.size(); ++i) {
      const Branch& branch = branches[i % branches.size()];
      const Triangle& triangle = triangles_[i / branches.size()];
      const Eigen::Matrix2d &F = film.gradient[i / branches.size()], &Cv = film.viscous[i];
      const Eigen::Matrix2d C = F.transpose() * F, M = C * Cv.inverse();
      const double across = Cv.determinant() / C.determinant(); // C33/Cv33
      const double first = M.trace() + across;
      rates.viscous.push_back((C - first / 3 * Cv) / branch.time);
      rates.heat += triangle.area * thickness * branch.modulus / (2 * branch.time) *
                    ((M * M).trace() + across * across - first * first / 3);
    }
    return rates;
  }
  Internal moved(const Rates& rates, double h) const {
    Internal internal = state_;
    internal.charge += h * rates.charge;
    for (std::size_t i = 0; i < internal.viscous.size(); ++i) internal.viscous[i] += h * rates.viscous[i];
    return internal;
  }
  /// Rate that bounds all others, 1/s.
  double fastest(const Film& film) const {
    const Eigen::MatrixXd L = conductance(film);
    double rate = 0;
    for (Eigen::Index a = 0; a < corners_; ++a)
      if (a < corners_ - 1 || supply == Supply::circuit)
        rate = std::max(rate, (2 * L(a, a) + leak_[a]) / film.capacitance[a]);
    if (supply == Supply::circuit) rate += 1 / (resistance * film.capacitance[corners_ - 1]);
    if (supply == Supply::charge) rate += 2 * L(corners_ - 1, corners_ - 1) / film.capacitance[corners_ - 1];
    return rate;
  }
  /// What the source does on the charge that follows it at once.
  void add_work(const Film& from, const Film& to) {
    const Eigen::Index last = corners_ - 1;
    const double phi = (from.voltage[last] + to.voltage[last]) / 2;
    account.electrical +=
        phi * (supply == Supply::charge ? to.source - from.source : to.charge[last] - from.charge[last]);
  }
  void keep(const Film& film) { state_.charge[corners_ - 1] = film.charge[corners_ - 1]; }

  std::vector<Triangle> triangles_;
  std::vector<int> free_; ///< coordinates
  Eigen::VectorXd position_, leak_;
  Eigen::Index corners_ = 0;
  Internal state_;
};

} // namespace dielast::test
