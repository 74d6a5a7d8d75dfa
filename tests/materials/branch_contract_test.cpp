// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/branches/branch.hpp"
#include "tests/materials/law_examples.hpp"

namespace dielast::materials::test::branch_contract_test {
namespace {

/// A branch of every law with both dashpots. The relaxation time is 2 s.
template<class Law>
class BranchContract : public LawTest<Law> {
 protected:
  Branch branch(Dashpot dashpot) const { return {this->law, dashpot, 2 * this->modulus(), {true, true}}; }
  Internal history(Dashpot dashpot) {
    if (dashpot == Dashpot::nominal) return {this->uniform(0.8, 1.5), this->uniform(0.8, 1.5), 0};
    const Eigen::Matrix2d C = this->random_C(0.8, 1.5);
    return {C(0, 0), C(1, 1), C(0, 1)};
  }
  std::array<TimeScheme, 2> schemes() {
    const double dt = std::pow(10, this->uniform(-2, 1));
    return {TimeScheme::backward_euler(dt), TimeScheme::bdf2(dt, dt * this->uniform(0.7, 1.5))};
  }
};

TYPED_TEST_SUITE(BranchContract, AlternativesOf<ElasticLaw>::Types, LawName);

// eta (a0 Cv - H)/dt = 2 dW/dG - alpha Cv in three dimensions. The energy's derivatives come from dual
// numbers with G33 = 1/det G taken along; the normal component gives the multiplier.
TYPED_TEST(BranchContract, logarithmic_flow_follows_its_rule) {
  for (int n = 0; n < states; ++n) {
    const Branch branch = this->branch(Dashpot::log);
    const Internal before = this->history(Dashpot::log);
    Internal now = before;
    for (double& x : now) x += this->uniform(-0.03, 0.03);
    const InPlaneC<double> C = this->in_plane(this->random_C(0.7, 2.2));
    for (const TimeScheme& s : this->schemes()) {
      const Internal end = advance(branch, C, s, now, before);
      const auto matrix = [](const Internal& y) { return Eigen::Matrix2d{{y[0], y[2]}, {y[2], y[1]}}; };
      const Eigen::Matrix2d Cv = matrix(end), H = s.h1 * matrix(now) + s.h2 * matrix(before);
      const double H33 = s.h1 / matrix(now).determinant() + s.h2 / matrix(before).determinant();
      const Eigen::Matrix2d G = Cv.inverse();
      const InPlaneC<Dual<3>> g = variables(this->in_plane(G));
      const Dual<3> W = planar_energy(this->law, Dual<3>(C.C11 * g.C11 + C.C22 * g.C22 + 2.0 * C.C12 * g.C12),
                                      C.det() * g.det());
      const Eigen::Matrix2d N{{2 * W.gradient[0], W.gradient[2]}, {W.gradient[2], 2 * W.gradient[1]}};
      const double rate = branch.viscosity / s.dt;
      const double multiplier = rate * (s.a0 - H33 * Cv.determinant());
      const Eigen::Matrix2d residual = rate * (s.a0 * Cv - H) - N - multiplier * Cv;
      EXPECT_LT(residual.norm(), 1e-9 * (rate * H.norm() + N.norm()));
    }
  }
}

// eta (a0 xi - h)/dt = -dW/dxi
TYPED_TEST(BranchContract, nominal_flow_follows_its_rule_in_the_directions_that_flow) {
  for (int n = 0; n < states; ++n) {
    Branch branch = this->branch(Dashpot::nominal);
    branch.directions = {n % 3 != 1, n % 3 != 2};
    const auto fixed = [&](Internal y) {
      for (std::size_t i = 0; i < 2; ++i)
        if (!branch.directions[i]) y[i] = 1;
      return y;
    };
    const Internal before = fixed(this->history(Dashpot::nominal));
    const Internal now =
        fixed({before[0] + this->uniform(-0.03, 0.03), before[1] + this->uniform(-0.03, 0.03), 0});
    const InPlaneC<double> C = this->in_plane(this->random_C(0.7, 2.2));
    for (const TimeScheme& s : this->schemes()) {
      using Dual2 = Dual<2>;
      const Internal end = advance(branch, C, s, now, before);
      const Dual2 x = Dual2::variable(end[0], 0), y = Dual2::variable(end[1], 1);
      const Dual2 W = planar_energy(this->law, Dual2(C.C11 / (x * x) + C.C22 / (y * y)),
                                    Dual2(C.det() / (x * x * y * y)));
      for (std::size_t i = 0; i < 2; ++i) {
        const double rate = branch.viscosity / s.dt, h = s.h1 * now[i] + s.h2 * before[i];
        if (branch.directions[i])
          EXPECT_NEAR(rate * (s.a0 * end[i] - h), -W.gradient[static_cast<int>(i)],
                      1e-9 * (rate + W.gradient.norm()));
        else
          EXPECT_EQ(end[i], 1);
      }
    }
  }
}

TYPED_TEST(BranchContract, an_undeformed_branch_carries_nothing_and_stays) {
  for (const Dashpot dashpot : {Dashpot::log, Dashpot::nominal})
    for (const TimeScheme& scheme : {TimeScheme::frozen(), TimeScheme::backward_euler(0.1),
                                     TimeScheme::bdf2(0.1, 0.2), TimeScheme::relaxed()}) {
      const auto at = branch_potential(this->branch(dashpot), {1, 1, 0}, scheme, undeformed(), undeformed());
      EXPECT_NEAR(at.value, 0, 1e-13 * this->modulus());
      for (const double first : at.first) EXPECT_NEAR(first, 0, 1e-14 * this->modulus());
      const Internal end = advance(this->branch(dashpot), {1, 1, 0}, scheme, undeformed(), undeformed());
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(end[i], undeformed()[i], 1e-14);
    }
}

TYPED_TEST(BranchContract, frozen_is_the_limit_of_short_steps_and_relaxed_of_long_ones) {
  for (const Dashpot dashpot : {Dashpot::log, Dashpot::nominal}) {
    const Branch branch = this->branch(dashpot);
    const InPlaneC<double> C{1.9, 1.2, 0};
    const Internal now = dashpot == Dashpot::log ? Internal{1.3, 0.9, 0.1} : Internal{1.1, 0.95, 0};
    const auto at = [&](const TimeScheme& scheme) { return branch_potential(branch, C, scheme, now, now); };
    const auto frozen = at(TimeScheme::frozen()), fast = at(TimeScheme::backward_euler(1e-7));
    EXPECT_NEAR(fast.value, frozen.value, 1e-6 * this->modulus());
    const auto relaxed = at(TimeScheme::relaxed()), slow = at(TimeScheme::backward_euler(1e7));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(fast.first[i], frozen.first[i], 1e-6 * this->modulus());
      EXPECT_NEAR(slow.first[i], relaxed.first[i], 1e-6 * this->modulus());
      EXPECT_NEAR(relaxed.first[i], 0, 1e-9 * this->modulus());
    }
    for (std::size_t p = 0; p < 6; ++p) {
      EXPECT_NEAR(fast.second[p], frozen.second[p], 1e-5 * this->modulus());
      EXPECT_NEAR(slow.second[p], relaxed.second[p], 1e-5 * this->modulus());
    }
    const Internal end = advance(branch, C, TimeScheme::relaxed(), now, now);
    const double root = dashpot == Dashpot::log ? 1 : 0.5;
    EXPECT_NEAR(end[0], std::pow(C.C11, root), 1e-9);
    EXPECT_NEAR(end[1], std::pow(C.C22, root), 1e-9);
    EXPECT_NEAR(end[2], 0, 1e-12);
  }
}

// A stretch that comes all at once, beyond what the law admits from the old viscous deformation.
TYPED_TEST(BranchContract, a_stretch_beyond_the_limit_flows_where_there_is_time_and_is_refused_where_not) {
  const InPlaneC<double> C{60, 60, 0};
  for (const Dashpot dashpot : {Dashpot::log, Dashpot::nominal}) {
    const Branch branch = this->branch(dashpot);
    const auto after = [&](const TimeScheme& scheme) {
      return branch_potential(branch, C, scheme, undeformed(), undeformed()).value;
    };
    EXPECT_TRUE(std::isfinite(after(TimeScheme::backward_euler(10))));
    EXPECT_EQ(std::isfinite(after(TimeScheme::frozen())), this->law.admits(120));
  }
}

TYPED_TEST(BranchContract, power_balances_what_a_held_branch_loses) {
  for (const Dashpot dashpot : {Dashpot::log, Dashpot::nominal})
    for (int n = 0; n < states; ++n) {
      const Branch branch = this->branch(dashpot);
      Internal now = this->history(dashpot);
      const InPlaneC<double> C = this->in_plane(this->random_C(0.7, 2.2));
      const BranchPower power = branch_power(branch, C, now);
      const auto loss = [&](double dt) {
        const Internal end = advance(branch, C, TimeScheme::backward_euler(dt), now, now);
        return (power.stored - branch_power(branch, C, end).stored) / dt;
      };
      const double dt = 2e-6; // s
      const double extrapolated = 2 * loss(dt / 2) - loss(dt);
      EXPECT_NEAR(power.dissipation, extrapolated, 1e-5 * (power.dissipation + power.stored));
      EXPECT_GE(power.dissipation, 0);
      // a law's invariants may be summed in another order
      EXPECT_NEAR(power.stored, branch_potential(branch, C, TimeScheme::frozen(), now, now).value,
                  1e-13 * power.stored);
    }
}

} // namespace
} // namespace dielast::materials::test::branch_contract_test
