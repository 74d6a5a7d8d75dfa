// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/algebra/small_matrices.hpp"
#include "tests/materials/law_examples.hpp"
#include "tests/materials/oracles.hpp"

#include <optional>

namespace dielast::materials::test::derivative_contract_test {
namespace {

enum class Time { frozen, backward_euler, bdf2, relaxed };

/// The law itself, or a branch with its spring over a step of time.
struct Part {
  const char* name;
  std::optional<Dashpot> dashpot{};
  Time time{};
};

/// Every law in every reduction below is tested as each of these parts, at 100 states each.
constexpr std::array parts{Part{"law"},
                           Part{"log, frozen", Dashpot::log, Time::frozen},
                           Part{"log, backward Euler", Dashpot::log, Time::backward_euler},
                           Part{"log, BDF2", Dashpot::log, Time::bdf2},
                           Part{"log, relaxed", Dashpot::log, Time::relaxed},
                           Part{"nominal, frozen", Dashpot::nominal, Time::frozen},
                           Part{"nominal, backward Euler", Dashpot::nominal, Time::backward_euler},
                           Part{"nominal, BDF2", Dashpot::nominal, Time::bdf2},
                           Part{"nominal, relaxed", Dashpot::nominal, Time::relaxed}};

/// Relative, of each order of derivatives.
constexpr double tolerance = 1e-9;

template<class Law>
class DerivativeContract : public LawTest<Law> {
 protected:
  static constexpr double bulk = 1e6; // Pa

  /// Relaxation time 2 s.
  Branch branch(const Part& part) const { return {this->law, *part.dashpot, 2 * this->modulus()}; }
  TimeScheme scheme(const Part& part) {
    const double dt = std::pow(10, this->uniform(-2, 0.5));
    switch (part.time) {
    case Time::frozen:
      return TimeScheme::frozen();
    case Time::backward_euler:
      return TimeScheme::backward_euler(dt);
    case Time::bdf2:
      return TimeScheme::bdf2(dt, dt * this->uniform(0.7, 1.5));
    case Time::relaxed:
      break;
    }
    return TimeScheme::relaxed();
  }
  /// Two times of a history, not far from each other.
  template<class Components>
  std::pair<Components, Components> history(const Components& now, std::size_t used) {
    Components before = now;
    for (std::size_t i = 0; i < used; ++i) before[i] += this->uniform(-0.03, 0.03);
    return {now, before};
  }
  std::pair<Internal, Internal> film_history(Dashpot dashpot, bool turned) {
    if (dashpot == Dashpot::nominal)
      return history(Internal{this->uniform(0.8, 1.5), this->uniform(0.8, 1.5), 0}, 2);
    const Eigen::Matrix2d Cv = this->random_C(0.8, 1.5);
    return history(Internal{Cv(0, 0), Cv(1, 1), turned ? Cv(0, 1) : 0}, turned ? 3 : 2);
  }
  Tensor<double> random_solid(double from, double to) {
    const Eigen::Quaterniond q(this->uniform(-1, 1), this->uniform(-1, 1), this->uniform(-1, 1),
                               this->uniform(-1, 1));
    const Eigen::Matrix3d Q = q.normalized().toRotationMatrix();
    const Eigen::Vector3d l(this->uniform(from, to), this->uniform(from, to), this->uniform(from, to));
    return components(Q * l.cwiseAbs2().asDiagonal() * Q.transpose());
  }
  /// The oracles lose their digits where principal values of an elastic deformation are nearly equal.
  template<int N>
  static bool distinct(const Eigen::Matrix<double, N, N>& C, const Eigen::Matrix<double, N, N>& G) {
    const auto root = cholesky_factor(G).value();
    const Eigen::Vector<double, N> b = symmetric_eigen<N>(root.transpose() * C * root).values;
    for (int i = 1; i < N; ++i)
      if (b[i] < 1.02 * b[i - 1]) return false;
    return true;
  }
  static Eigen::Matrix2d metric(Dashpot dashpot, const Internal& y) {
    if (dashpot == Dashpot::log) return Eigen::Matrix2d{{y[0], y[2]}, {y[2], y[1]}}.inverse();
    return Eigen::Vector2d(1 / (y[0] * y[0]), 1 / (y[1] * y[1])).asDiagonal();
  }
  static int flowing(const Part& part) {
    return part.time == Time::frozen ? 0 : part.dashpot == Dashpot::log ? 3 : 2;
  }
  /// Nothing is left in a relaxed branch whose flow reaches every deformation.
  static bool vanishes(const Part& part) {
    return part.dashpot == Dashpot::log && part.time == Time::relaxed;
  }
  template<int N>
  void expect(double value, const Eigen::Vector<double, N>& first, const Eigen::Matrix<double, N, N>& second,
              const Dual<N>& oracle) const {
    const double small = 1e-4 * this->modulus();
    EXPECT_NEAR(value, oracle.value, tolerance * (std::abs(oracle.value) + small));
    EXPECT_LT((first - oracle.gradient).norm(), tolerance * (oracle.gradient.norm() + small));
    EXPECT_LT((second - oracle.hessian).norm(), tolerance * (oracle.hessian.norm() + small));
  }
  void expect(const MembranePotential<double>& p, const Dual<3>& oracle) const {
    Eigen::Matrix3d second;
    for (std::size_t n = 0; n < 6; ++n) {
      const auto [i, j] = component_pairs[n];
      second(i, j) = second(j, i) = p.second[n];
    }
    expect<3>(p.value, {p.first[0], p.first[1], p.first[2]}, second, oracle);
  }
  void expect(const AxisymmetricPotential& p, const Dual<2>& oracle) const {
    expect<2>(p.value, {p.first[0], p.first[1]},
              Eigen::Matrix2d{{p.second[0], p.second[2]}, {p.second[2], p.second[1]}}, oracle);
  }
  void expect(const SolidPotential& p, const Dual<6>& oracle) const {
    expect<6>(p.value, p.first, p.second, oracle);
  }
};

TYPED_TEST_SUITE(DerivativeContract, AlternativesOf<ElasticLaw>::Types, LawName);

TYPED_TEST(DerivativeContract, membrane) {
  for (const Part& part : parts) {
    SCOPED_TRACE(part.name);
    for (int n = 0; n < states;) {
      const InPlaneC<double> C = this->in_plane(this->random_C(0.6, 2.4));
      if (!part.dashpot) {
        const Dielectric dielectric{.electrostriction = n % 3 == 2 ? -0.05 : 0};
        const double k = n % 3 == 0 ? 0 : this->uniform(0, 1) * this->modulus();
        this->expect(membrane_potential(this->law, dielectric, C, k),
                     membrane_energy(this->law, dielectric, variables(C), Dual<3>(k)));
        ++n;
        continue;
      }
      const Branch branch = this->branch(part);
      const TimeScheme s = this->scheme(part);
      const auto [now, before] = this->film_history(*part.dashpot, true);
      const auto p = branch_potential(branch, C, s, now, before);
      if (this->vanishes(part)) {
        this->expect(p, Dual<3>(0));
        ++n;
        continue;
      }
      const Internal end = advance(branch, C, s, now, before);
      if (!this->distinct(Eigen::Matrix2d{{C.C11, C.C12}, {C.C12, C.C22}}, this->metric(*part.dashpot, end)))
        continue;
      using Dual6 = Dual<6>;
      const InPlaneC<Dual6> x{Dual6::variable(C.C11, 0), Dual6::variable(C.C22, 1),
                              Dual6::variable(C.C12, 2)};
      this->expect(p, minimum<3>(film_step(this->law, branch, x, s, now, before, end), this->flowing(part)));
      ++n;
    }
  }
}

TYPED_TEST(DerivativeContract, axisymmetric) {
  for (const Part& part : parts) {
    SCOPED_TRACE(part.name);
    for (int n = 0; n < states;) {
      const double l1 = this->uniform(0.6, 2.4), l2 = this->uniform(0.6, 2.4);
      if (!(std::abs(std::log(l1 / l2)) > 0.05)) continue;
      if (!part.dashpot) {
        using Dual2 = Dual<2>;
        const Dielectric dielectric{.electrostriction = n % 3 == 2 ? -0.05 : 0};
        const double k = n % 3 == 0 ? 0 : this->uniform(0, 1) * this->modulus();
        const Dual2 x = Dual2::variable(l1, 0), y = Dual2::variable(l2, 1);
        this->expect(axisymmetric_potential(this->law, dielectric, l1, l2, k),
                     membrane_energy(this->law, dielectric, InPlaneC<Dual2>{x * x, y * y, 0.0}, Dual2(k)));
        ++n;
        continue;
      }
      const Branch branch = this->branch(part);
      const TimeScheme s = this->scheme(part);
      const auto [now, before] = this->film_history(*part.dashpot, false);
      const auto p = axisymmetric_branch_potential(branch, l1, l2, s, now, before);
      // The nominal viscous stretches follow the film's stretches along the same axes.
      if (part.time == Time::relaxed) {
        this->expect(p, Dual<2>(0));
        ++n;
        continue;
      }
      const Internal end = advance(branch, {l1 * l1, l2 * l2, 0}, s, now, before);
      if (!this->distinct(Eigen::Matrix2d(Eigen::Vector2d(l1 * l1, l2 * l2).asDiagonal()),
                          this->metric(*part.dashpot, end)))
        continue;
      using Dual5 = Dual<5>;
      const Dual5 x = Dual5::variable(l1, 0), y = Dual5::variable(l2, 1);
      this->expect(
          p, minimum<2>(film_step(this->law, branch, InPlaneC<Dual5>{x * x, y * y, 0.0}, s, now, before, end),
                        this->flowing(part)));
      ++n;
    }
  }
}

TYPED_TEST(DerivativeContract, solid) {
  for (const Part& part : parts) {
    if (part.dashpot == Dashpot::nominal) continue; // defined for films only
    SCOPED_TRACE(part.name);
    for (int n = 0; n < states;) {
      const Tensor<double> C = this->random_solid(0.7, 1.8);
      if (!part.dashpot) {
        if (!this->distinct(matrix(C), Eigen::Matrix3d(Eigen::Matrix3d::Identity()))) continue;
        Tensor<Dual<6>> x, G{1.0, 1.0, 1.0, 0.0, 0.0, 0.0};
        for (std::size_t i = 0; i < 6; ++i) x[i] = Dual<6>::variable(C[i], static_cast<int>(i));
        Dual<6> energy = solid_energy(this->law, x, G);
        if (!std::same_as<TypeParam, StVenantKirchhoff>) {
          const Dual<6> swelling = sqrt(det(x)) - 1.0;
          energy += 0.5 * this->bulk * swelling * swelling;
        }
        this->expect(solid_potential(this->law, matrix(C), this->bulk), energy);
        ++n;
        continue;
      }
      const Branch branch = this->branch(part);
      const TimeScheme s = this->scheme(part);
      const Tensor<double> Cv = this->random_solid(0.8, 1.4);
      const auto [now, before] = this->history(components(matrix(Cv) / std::cbrt(det(Cv))), 6);
      const auto p = solid_branch_potential(branch, matrix(C), s, now, before);
      if (this->vanishes(part) && !std::same_as<TypeParam, StVenantKirchhoff>) {
        this->expect(p, Dual<6>(0));
        ++n;
        continue;
      }
      const SolidInternal end = solid_branch_advance(branch, matrix(C), s, now, before);
      if (part.time != Time::relaxed && !this->distinct(matrix(C), Eigen::Matrix3d(matrix(end).inverse())))
        continue;
      const Dual<12> joint = solid_step(this->law, branch, C, s, now, before, end);
      this->expect(p, minimum<6>(joint, part.time == Time::frozen ? 0 : 6));
      ++n;
    }
  }
}

} // namespace
} // namespace dielast::materials::test::derivative_contract_test
