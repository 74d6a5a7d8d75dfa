// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/axisymmetric.hpp"
#include "materials/laws/solid.hpp"
#include "materials/material_point.hpp"
#include "tests/materials/law_examples.hpp"

namespace dielast::materials::test::reductions_test {
namespace {

template<class Law>
class Reductions : public LawTest<Law> {
 protected:
  static constexpr double bulk = 1e6;

  Eigen::Matrix3d rotation_in_space() {
    return Eigen::Quaterniond(this->uniform(-1, 1), this->uniform(-1, 1), this->uniform(-1, 1),
                              this->uniform(-1, 1))
        .normalized()
        .toRotationMatrix();
  }
};

TYPED_TEST_SUITE(Reductions, AlternativesOf<ElasticLaw>::Types, LawName);

TYPED_TEST(Reductions, axisymmetric_stresses_are_equal_where_the_stretches_are) {
  for (const double l : {0.6, 1.0, 2.3}) {
    const auto p = axisymmetric_potential(this->law, Dielectric{}, l, l, 0.1 * this->modulus());
    EXPECT_DOUBLE_EQ(p.first[0], p.first[1]);
    EXPECT_DOUBLE_EQ(p.second[0], p.second[1]);
  }
}

TYPED_TEST(Reductions, undeformed_tangents_of_homogeneous_tests_are_the_moduli_of_the_sheet) {
  const double mu = this->modulus(), h = 1e-4;
  double nu = 0.5;
  if constexpr (std::same_as<TypeParam, StVenantKirchhoff>) nu = this->law.poisson_ratio;
  for (const auto& [mode, modulus] :
       {std::pair{Mode::uniaxial, 2 * (1 + nu) * mu}, std::pair{Mode::pure_shear, 2 * mu / (1 - nu)},
        std::pair{Mode::equal_biaxial, 2 * mu * (1 + nu) / (1 - nu)}}) {
    MaterialPoint point({.law = this->law}, mode);
    const auto stress = [&](double l) { return point.stress(l, TimeScheme::frozen()); };
    EXPECT_NEAR((stress(1 + h) - stress(1 - h)) / (2 * h), modulus, 1e-6 * mu);
  }
}

TYPED_TEST(Reductions, a_strip_pulled_along_one_axis_is_as_wide_as_it_is_without_a_force) {
  const double l = 1.3;
  MaterialPoint point({.law = this->law}, Mode::uniaxial);
  double across = 1 / std::sqrt(l);
  if constexpr (std::same_as<TypeParam, StVenantKirchhoff>)
    across = std::sqrt(1 - this->law.poisson_ratio * (l * l - 1));
  const auto film = axisymmetric_potential(this->law, Dielectric{}, l, across, 0);
  EXPECT_NEAR(film.first[1], 0, 1e-12 * this->modulus());
  EXPECT_NEAR(point.stress(l, TimeScheme::frozen()), film.first[0], 1e-11 * this->modulus());
}

TYPED_TEST(Reductions, undeformed_solid_has_no_stress_and_the_elastic_constants) {
  const auto at = solid_potential(this->law, Eigen::Matrix3d::Identity(), this->bulk);
  const double mu = this->modulus();
  double lambda = this->bulk - 2 * mu / 3;
  if constexpr (std::same_as<TypeParam, StVenantKirchhoff>) lambda = this->law.first_lame();
  EXPECT_NEAR(at.value, 0, 1e-14 * mu);
  EXPECT_LT(at.first.norm(), 1e-14 * this->bulk);
  Eigen::Matrix<double, 6, 6> expected = Eigen::Matrix<double, 6, 6>::Zero(); // d2W/dC2 = C_el/4, shear once
  expected.topLeftCorner<3, 3>().setConstant(lambda / 4);
  expected.diagonal().head<3>().array() += mu / 2;
  expected.diagonal().tail<3>().setConstant(mu);
  EXPECT_LT((at.second - expected).norm(), 1e-12 * this->bulk);
}

TYPED_TEST(Reductions, rotating_the_undeformed_solid_turns_the_stress_with_it) {
  for (int n = 0; n < states; ++n) {
    const Eigen::Vector3d c =
        Eigen::Vector3d(this->uniform(0.5, 3), this->uniform(0.5, 3), this->uniform(0.5, 3));
    const Eigen::Matrix3d Q = this->rotation_in_space();
    const auto straight = solid_potential(this->law, c.asDiagonal(), this->bulk);
    const auto turned = solid_potential(this->law, Q * c.asDiagonal() * Q.transpose(), this->bulk);
    EXPECT_NEAR(turned.value, straight.value, 1e-11 * (this->bulk + straight.value));
    const Eigen::Matrix3d S = 2 * straight.first.template head<3>().asDiagonal();
    const auto& f = turned.first;
    const Eigen::Matrix3d S_turned{{2 * f[0], f[3], f[5]}, {f[3], 2 * f[1], f[4]}, {f[5], f[4], 2 * f[2]}};
    EXPECT_LT((S_turned - Q * S * Q.transpose()).norm(), 1e-11 * (this->bulk + S.norm()));
  }
}

// A solid that keeps its volume stores what the film does whose thickness follows from its area.
TYPED_TEST(Reductions, solid_of_constant_volume_stores_what_the_film_does) {
  if (std::same_as<TypeParam, StVenantKirchhoff>) GTEST_SKIP() << "compressible";
  for (int n = 0; n < states; ++n) {
    const Eigen::Matrix2d C = this->random_C();
    Eigen::Matrix3d solid = Eigen::Matrix3d::Zero();
    solid.topLeftCorner<2, 2>() = C;
    solid(2, 2) = 1 / C.determinant();
    const double film = membrane_potential(this->law, Dielectric{}, this->in_plane(C), 0.0).value;
    EXPECT_NEAR(solid_potential(this->law, solid, this->bulk).value, film, 1e-11 * (this->modulus() + film));
  }
}

// Chains that are far from straight store what neo-Hookean film does, to rounding.
TEST(ArrudaBoyceLaw, of_long_chains_is_the_neo_hookean_law) {
  const double I1 = 5.0625;
  for (const double locking_stretch : {1e5, 1e6})
    EXPECT_NEAR((ArrudaBoyce{40e3, locking_stretch}.energy(I1)), NeoHookean{40e3}.energy(I1), 1e-4);
}

} // namespace
} // namespace dielast::materials::test::reductions_test
