// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/branches/solid_branch.hpp"
#include "tests/materials/law_examples.hpp"

#include <stdexcept>

namespace dielast::materials::test::solid_branch_test {
namespace {

using Vector6 = Eigen::Vector<double, 6>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A branch of every law in a solid. The relaxation time is 2 s.
template<class Law>
class SolidBranch : public LawTest<Law> {
 protected:
  const Branch branch{this->law, Dashpot::log, 2 * this->modulus()};
  static constexpr bool compressible = std::same_as<Law, StVenantKirchhoff>;

  static Eigen::Matrix3d matrix(const SolidInternal& y) {
    return Eigen::Matrix3d{{y[0], y[3], y[5]}, {y[3], y[1], y[4]}, {y[5], y[4], y[2]}};
  }
  static SolidInternal components(const Eigen::Matrix3d& A) {
    return {A(0, 0), A(1, 1), A(2, 2), A(0, 1), A(1, 2), A(0, 2)};
  }
  /// With the film's normal as axis 3.
  static Eigen::Matrix3d thick(const InPlaneC<double>& C, double C33) {
    return Eigen::Matrix3d{{C.C11, C.C12, 0}, {C.C12, C.C22, 0}, {0, 0, C33}};
  }
  static SolidInternal of_film(const Internal& y) {
    const InPlaneC<double> Cv{y[0], y[1], y[2]};
    return components(thick(Cv, 1 / Cv.det()));
  }
  Eigen::Matrix3d rotation_in_space() {
    return Eigen::Quaterniond(this->uniform(-1, 1), this->uniform(-1, 1), this->uniform(-1, 1),
                              this->uniform(-1, 1))
        .normalized()
        .toRotationMatrix();
  }
  std::array<TimeScheme, 2> schemes() {
    const double dt = std::pow(10, this->uniform(-2, 1));
    return {TimeScheme::backward_euler(dt), TimeScheme::bdf2(dt, dt * this->uniform(0.7, 1.5))};
  }
  /// `potential` has the derivatives that differences of fourth order find.
  template<class Potential>
  void expect_consistent(const Potential& potential, const Eigen::Matrix3d& C) const {
    const SolidPotential at = potential(C);
    const double h = 2e-4, size = this->modulus();
    for (int a = 0; a < 6; ++a) {
      const auto there = [&](double x) {
        Eigen::Matrix3d moved = C;
        const auto [i, j] = solid_components[static_cast<std::size_t>(a)];
        moved(i, j) += x;
        if (i != j) moved(j, i) += x;
        return potential(moved);
      };
      const SolidPotential p1 = there(h), m1 = there(-h), p2 = there(2 * h), m2 = there(-2 * h);
      const double slope = (8 * (p1.value - m1.value) - (p2.value - m2.value)) / (12 * h);
      const Vector6 column = (8 * (p1.first - m1.first) - (p2.first - m2.first)) / (12 * h);
      EXPECT_NEAR(at.first[a], slope, 1e-7 * (size + at.first.norm()));
      EXPECT_LT((at.second.col(a) - column).norm(), 1e-7 * (size + at.second.norm()));
    }
    EXPECT_LT((at.second - at.second.transpose()).norm(), 1e-13 * (size + at.second.norm()));
  }
};

TYPED_TEST_SUITE(SolidBranch, AlternativesOf<ElasticLaw>::Types, LawName);

// The derivative contract leaves these states out, as its oracles are singular there.
TYPED_TEST(SolidBranch, derivatives_are_regular_where_principal_stretches_are_equal) {
  for (int n = 0; n < states; ++n) {
    Eigen::Vector3d c;
    for (double& x : c) x = std::pow(this->uniform(0.7, 1.8), 2);
    if (n % 3 == 0) c[1] = c[0];
    if (n % 3 == 1) c.setConstant(c[0]);
    if (n % 3 == 2) c[2] = c[1] * (1 + 1e-9);
    const Eigen::Matrix3d Q = this->rotation_in_space(), C = Q * c.asDiagonal() * Q.transpose();
    this->expect_consistent([&](const Eigen::Matrix3d& at) { return solid_potential(this->law, at, 1e6); },
                            C);
    const Eigen::Vector3d cv = n % 2 ? Eigen::Vector3d(c.cwiseSqrt()) : Eigen::Vector3d::Ones();
    const SolidInternal now = this->components(Q * (cv / std::cbrt(cv.prod())).asDiagonal() * Q.transpose());
    const TimeScheme s = n % 4 < 2 ? this->schemes()[0] : TimeScheme::frozen();
    this->expect_consistent(
        [&](const Eigen::Matrix3d& at) { return solid_branch_potential(this->branch, at, s, now, now); }, C);
  }
}

// The film's thickness follows from its area, or, for the compressible law, from the stress across it.
TYPED_TEST(SolidBranch, under_plane_stress_is_the_branch_of_a_film) {
  for (int n = 0; n < states; ++n) {
    const InPlaneC<double> C = this->in_plane(this->random_C(0.8, 1.6));
    const Eigen::Matrix2d Cv = this->random_C(0.9, 1.3);
    const Internal before{Cv(0, 0), Cv(1, 1), Cv(0, 1)};
    Internal now = before;
    for (double& x : now) x += this->uniform(-0.03, 0.03);
    for (const TimeScheme& s : this->schemes()) {
      const auto film = branch_potential(this->branch, C, s, now, before);
      const Internal film_end = advance(this->branch, C, s, now, before);
      double C33 = 1 / C.det(), C33_slope = -C33 * C33;
      if constexpr (TestFixture::compressible) {
        // E33 = -nu/(1 - nu) (E11 + E22) of the elastic deformation; no stress across
        const double nu = this->law.poisson_ratio,
                     Cv_det = film_end[0] * film_end[1] - film_end[2] * film_end[2];
        const double trace = (C.C11 * film_end[1] + C.C22 * film_end[0] - 2 * C.C12 * film_end[2]) / Cv_det;
        C33 = (1 - nu / (1 - nu) * (trace - 2)) / Cv_det;
        C33_slope = 0;
      }
      const Eigen::Matrix3d C_thick = this->thick(C, C33);
      const SolidInternal last = this->of_film(now), first = this->of_film(before);
      const auto thick = solid_branch_potential(this->branch, C_thick, s, last, first);
      const double scale = this->modulus() + this->stress(film).norm();
      EXPECT_NEAR(thick.value, film.value, 1e-10 * scale);
      EXPECT_NEAR(thick.first[0] + thick.first[2] * C33_slope * C.C22, film.first[0], 1e-9 * scale);
      EXPECT_NEAR(thick.first[1] + thick.first[2] * C33_slope * C.C11, film.first[1], 1e-9 * scale);
      EXPECT_NEAR(thick.first[3] - thick.first[2] * C33_slope * 2 * C.C12, film.first[2], 1e-9 * scale);
      const SolidInternal end = solid_branch_advance(this->branch, C_thick, s, last, first);
      EXPECT_LT((this->matrix(end) - this->matrix(this->of_film(film_end))).norm(), 1e-8);
      const BranchPower a = solid_branch_power(this->branch, C_thick, end),
                        b = branch_power(this->branch, C, film_end);
      EXPECT_NEAR(a.stored, b.stored, 1e-8 * scale);
      EXPECT_NEAR(a.dissipation, b.dissipation, 1e-7 * scale);
    }
  }
}

TYPED_TEST(SolidBranch, power_balances_what_a_held_branch_loses) {
  for (int n = 0; n < states; ++n) {
    const Eigen::Matrix3d Q = this->rotation_in_space(), R = this->rotation_in_space();
    const Eigen::Vector3d c(this->uniform(0.7, 2), this->uniform(0.7, 2), this->uniform(0.7, 2)),
        cv(this->uniform(0.8, 1.5), this->uniform(0.8, 1.5), this->uniform(0.8, 1.5));
    const Eigen::Matrix3d C = Q * c.asDiagonal() * Q.transpose(),
                          Cv = R * (cv / std::cbrt(cv.prod())).asDiagonal() * R.transpose();
    const SolidInternal now = this->components(Cv);
    const BranchPower power = solid_branch_power(this->branch, C, now);
    const auto loss = [&](double dt) {
      const SolidInternal end =
          solid_branch_advance(this->branch, C, TimeScheme::backward_euler(dt), now, now);
      EXPECT_NEAR(this->matrix(end).determinant(), 1, 1e-12);
      return (power.stored - solid_branch_power(this->branch, C, end).stored) / dt;
    };
    const double dt = 2e-6; // s
    EXPECT_NEAR(power.dissipation, 2 * loss(dt / 2) - loss(dt), 1e-5 * (power.dissipation + power.stored));
    EXPECT_DOUBLE_EQ(power.stored,
                     solid_branch_potential(this->branch, C, TimeScheme::frozen(), now, now).value);
  }
}

TYPED_TEST(SolidBranch, frozen_is_the_limit_of_short_steps_and_relaxed_of_long_ones) {
  const Eigen::Matrix3d C{{1.5, 0.2, 0.1}, {0.2, 1.1, -0.1}, {0.1, -0.1, 1.05}};
  const Eigen::Matrix3d tilted{{1.2, 0.1, 0}, {0.1, 0.9, 0.1}, {0, 0.1, 1}};
  const SolidInternal now = this->components(tilted / std::cbrt(tilted.determinant()));
  const auto at = [&](const TimeScheme& s) { return solid_branch_potential(this->branch, C, s, now, now); };
  const auto frozen = at(TimeScheme::frozen()), fast = at(TimeScheme::backward_euler(1e-7));
  const auto relaxed = at(TimeScheme::relaxed()), slow = at(TimeScheme::backward_euler(1e7));
  const double mu = this->modulus();
  EXPECT_NEAR(fast.value, frozen.value, 1e-6 * mu);
  EXPECT_LT((fast.first - frozen.first).norm(), 1e-6 * mu);
  EXPECT_LT((fast.second - frozen.second).norm(), 1e-5 * mu);
  EXPECT_LT((slow.first - relaxed.first).norm(), 1e-6 * mu);
  EXPECT_LT((slow.second - relaxed.second).norm(), 1e-5 * mu);
  // only a change of volume is left, in the law that stores one: no deviatoric stress
  const Eigen::Matrix3d S{{2 * relaxed.first[0], relaxed.first[3], relaxed.first[5]},
                          {relaxed.first[3], 2 * relaxed.first[1], relaxed.first[4]},
                          {relaxed.first[5], relaxed.first[4], 2 * relaxed.first[2]}};
  const Eigen::Matrix3d CS = C * S;
  EXPECT_LT((CS - CS.trace() / 3 * Eigen::Matrix3d::Identity()).norm(), 1e-12 * mu);
  EXPECT_EQ(S.norm() > 1e-3 * mu, this->compressible);
  const Eigen::Matrix3d end =
      this->matrix(solid_branch_advance(this->branch, C, TimeScheme::relaxed(), now, now));
  EXPECT_LT((end - C / std::cbrt(C.determinant())).norm(), 1e-13);
}

TYPED_TEST(SolidBranch, an_undeformed_branch_carries_nothing_and_stays) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  for (const TimeScheme& s : {TimeScheme::frozen(), TimeScheme::backward_euler(0.1),
                              TimeScheme::bdf2(0.1, 0.2), TimeScheme::relaxed()}) {
    const auto at = solid_branch_potential(this->branch, one, s, undeformed_solid(), undeformed_solid());
    EXPECT_NEAR(at.value, 0, 1e-13 * this->modulus());
    EXPECT_LT(at.first.norm(), 1e-14 * this->modulus());
    const SolidInternal end =
        solid_branch_advance(this->branch, one, s, undeformed_solid(), undeformed_solid());
    EXPECT_LT((this->matrix(end) - one).norm(), 1e-14);
  }
}

TYPED_TEST(SolidBranch, a_stretch_beyond_the_limit_flows_where_there_is_time_and_is_refused_where_not) {
  const Eigen::Matrix3d C = Eigen::Vector3d(60, 60, 1.0 / 3600).asDiagonal();
  const auto after = [&](const TimeScheme& s) {
    return solid_branch_potential(this->branch, C, s, undeformed_solid(), undeformed_solid()).value;
  };
  EXPECT_TRUE(std::isfinite(after(TimeScheme::backward_euler(10))));
  EXPECT_EQ(std::isfinite(after(TimeScheme::frozen())), this->law.admits(120));
}

TYPED_TEST(SolidBranch, a_history_that_cannot_be_extrapolated_is_continued_by_backward_euler) {
  const Eigen::Matrix3d C = Eigen::Vector3d(1.5, 1.2, 0.6).asDiagonal();
  const SolidInternal now{0.6, 0.6, 1 / 0.36, 0, 0, 0}, before{3, 3, 1.0 / 9, 0, 0, 0};
  EXPECT_EQ(solid_branch_advance(this->branch, C, TimeScheme::bdf2(1, 0.5), now, before),
            solid_branch_advance(this->branch, C, TimeScheme::backward_euler(1), now, before));
}

TYPED_TEST(SolidBranch, nominal_dashpots_are_refused) {
  const Branch nominal{this->law, Dashpot::nominal, this->modulus()};
  EXPECT_THROW(solid_branch_potential(nominal, Eigen::Matrix3d::Identity(), TimeScheme::frozen(),
                                      undeformed_solid(), undeformed_solid()),
               std::invalid_argument);
}

} // namespace
} // namespace dielast::materials::test::solid_branch_test
