// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/algebra/small_matrices.hpp"
#include "tests/materials/law_examples.hpp"

#include <set>

namespace dielast::materials::test::elastic_law_contract_test {
namespace {

template<class Law>
class ElasticLawContract : public LawTest<Law> {
 protected:
  const Dielectric electrostrictive{.electrostriction = -0.05};

  MembranePotential<double> at(const Eigen::Matrix2d& C, double k = 0) const {
    return membrane_potential(this->law, Dielectric{}, this->in_plane(C), k);
  }
  double poisson_ratio() const {
    if constexpr (std::same_as<Law, StVenantKirchhoff>) return this->law.poisson_ratio;
    return 0.5;
  }
};

TYPED_TEST_SUITE(ElasticLawContract, AlternativesOf<ElasticLaw>::Types, LawName);

TYPED_TEST(ElasticLawContract, undeformed_state_has_no_energy_and_no_stress) {
  const auto at_rest = this->at(Eigen::Matrix2d::Identity());
  EXPECT_NEAR(at_rest.value, 0, 1e-15 * this->modulus());
  for (const double first : at_rest.first) EXPECT_NEAR(first, 0, 1e-15 * this->modulus());
}

// Plane stress of an isotropic sheet with the shear modulus mu: d2Psi/dC2 = mu/(2 (1 - nu)) (1, 1, 2 (1 -
// nu), nu, 0, 0).
TYPED_TEST(ElasticLawContract, undeformed_tangent_is_that_of_the_shear_modulus_and_positive_definite) {
  const double nu = this->poisson_ratio(), m = this->modulus() / (2 * (1 - nu));
  ASSERT_GT(m, 0);
  const auto s = this->at(Eigen::Matrix2d::Identity()).second;
  const std::array<double, 6> expected{m, m, 2 * (1 - nu) * m, nu * m, 0, 0};
  for (std::size_t p = 0; p < 6; ++p) EXPECT_NEAR(s[p], expected[p], 1e-13 * m) << p;
  Eigen::Matrix3d tangent;
  tangent << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
  EXPECT_GT(symmetric_eigen(tangent).values.minCoeff(), 0.1 * m);
}

TYPED_TEST(ElasticLawContract, packs_compute_what_single_numbers_do) {
  for (int n = 0; n < states; ++n) {
    InPlaneC<Pack> pack{};
    Pack k{};
    std::array<InPlaneC<double>, pack_lanes> single;
    for (int l = 0; l < pack_lanes; ++l) {
      const InPlaneC<double> C = single[static_cast<std::size_t>(l)] = this->in_plane(this->random_C());
      pack.C11[l] = C.C11;
      pack.C22[l] = C.C22;
      pack.C12[l] = C.C12;
      k[l] = this->uniform(0, 1) * this->modulus();
    }
    const auto together = membrane_potential(this->law, this->electrostrictive, pack, k);
    for (int l = 0; l < pack_lanes; ++l) {
      const auto alone =
          membrane_potential(this->law, this->electrostrictive, single[static_cast<std::size_t>(l)], k[l]);
      EXPECT_NEAR(together.value[l], alone.value, 1e-13 * (this->modulus() + std::abs(alone.value)));
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(together.first[i][l], alone.first[i],
                    1e-13 * (this->modulus() + std::abs(alone.first[i])));
      for (std::size_t p = 0; p < 6; ++p)
        EXPECT_NEAR(together.second[p][l], alone.second[p],
                    1e-12 * (this->modulus() + std::abs(alone.second[p])));
    }
  }
}

// Principal stretches that are equal, nearly equal and hardly different are one smooth family.
TYPED_TEST(ElasticLawContract, nothing_happens_where_principal_stretches_become_equal) {
  for (const double lambda : {0.7, 1.0, 2.0}) {
    const auto along = [&](double difference) {
      const Eigen::Vector2d c(lambda * lambda + difference, lambda * lambda - difference);
      const Eigen::Matrix2d Q = this->rotation(0.4);
      return this->at(Q * c.asDiagonal() * Q.transpose());
    };
    const auto equal = along(0);
    double scale = 0;
    for (const double second : equal.second) scale = std::max(scale, std::abs(second));
    for (const double difference : {1e-12, 1e-9, 1e-7}) {
      const auto near = along(difference * lambda * lambda);
      for (std::size_t p = 0; p < 6; ++p)
        EXPECT_NEAR(near.second[p], equal.second[p], (1e-13 + 30 * difference) * scale);
    }
    // Difference quotient of fourth order across the equal state, from states where the stretches differ.
    const double d = 1e-2 * lambda * lambda;
    const auto there = along(d), back = along(-d);
    const Eigen::Matrix2d Q = this->rotation(0.4);
    const Eigen::Matrix2d direction = Q * Eigen::Vector2d(1, -1).asDiagonal() * Q.transpose();
    const auto slope = [&](const MembranePotential<double>& p) {
      return p.first[0] * direction(0, 0) + p.first[1] * direction(1, 1) + p.first[2] * direction(0, 1);
    };
    const auto half = along(d / 2), half_back = along(-d / 2);
    const double second = (8 * (slope(half) - slope(half_back)) - (slope(there) - slope(back))) / (6 * d);
    const Eigen::Vector3d v(direction(0, 0), direction(1, 1), direction(0, 1));
    double exact = 0;
    for (std::size_t p = 0; p < 6; ++p)
      exact += (p < 3 ? 1 : 2) * equal.second[p] * v[component_pairs[p][0]] * v[component_pairs[p][1]];
    EXPECT_NEAR(second, exact, 1e-6 * scale);
  }
}

// Everything depends on C, so that a rotation of the deformed film changes nothing by construction. The law
// must also not see a rotation of the undeformed film.
TYPED_TEST(ElasticLawContract, rotating_the_undeformed_film_turns_the_stress_with_it) {
  for (int n = 0; n < states; ++n) {
    const Eigen::Matrix2d C = this->random_C(), Q = this->rotation(this->uniform(0, 6.3));
    const double k = this->uniform(0, 1) * this->modulus();
    const auto straight = this->at(C, k), turned = this->at(Q * C * Q.transpose(), k);
    const Eigen::Matrix2d S = this->stress(straight);
    const double scale = this->modulus() * C.norm() + S.norm();
    EXPECT_NEAR(turned.value, straight.value, 1e-12 * scale * C.norm());
    EXPECT_LT((this->stress(turned) - Q * S * Q.transpose()).norm(), 1e-12 * scale);
  }
}

TYPED_TEST(ElasticLawContract, energy_is_finite_exactly_where_the_law_admits_the_state) {
  for (double lambda = 1.02; lambda < 12; lambda *= 1.1) {
    const double c = lambda * lambda, I1 = 2 * c + 1 / (c * c);
    EXPECT_EQ(std::isfinite(this->at(c * Eigen::Matrix2d::Identity()).value), this->law.admits(I1)) << lambda;
  }
}

TYPED_TEST(ElasticLawContract, every_parameter_has_a_name_a_unit_a_range_and_its_own_member) {
  std::set<const void*> places;
  for (const auto& parameter : TypeParam::parameters) {
    EXPECT_FALSE(parameter.name.empty());
    EXPECT_FALSE(parameter.unit.empty());
    EXPECT_FALSE(parameter.meaning.empty());
    EXPECT_LT(parameter.above, parameter.below);
    ASSERT_NE(parameter.number == nullptr, parameter.list == nullptr);
    places.insert(parameter.number ? static_cast<const void*>(&(this->law.*parameter.number))
                                   : &(this->law.*parameter.list));
  }
  EXPECT_EQ(places.size(), TypeParam::parameters.size());
}

// Ogden's law holds two others as special cases; its derivatives take another way.
TEST(Ogden, exponents_2_and_minus_2_are_the_mooney_rivlin_law) {
  const Ogden ogden{{32e3, -10e3}, {2, -2}};
  const MooneyRivlin mooney_rivlin{16e3, 5e3};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> component(0.6, 3), off(-0.5, 0.5);
  for (int n = 0; n < states; ++n) {
    InPlaneC<double> C{component(random), component(random), off(random)};
    if (n % 4 == 0) C = {C.C11, C.C11, 0}; // exactly equal
    if (n % 4 == 1) C = {C.C11, C.C11 * (1 + 1e-9), 1e-10};
    const auto a = membrane_potential(ogden, Dielectric{}, C, 0.0);
    const auto b = membrane_potential(mooney_rivlin, Dielectric{}, C, 0.0);
    EXPECT_NEAR(a.value, b.value, 1e-12 * (32e3 + b.value));
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(a.first[i], b.first[i], 1e-12 * (32e3 + std::abs(b.first[i])));
    for (std::size_t p = 0; p < 6; ++p)
      EXPECT_NEAR(a.second[p], b.second[p], 1e-12 * (32e3 + std::abs(b.second[p])));
  }
}

TEST(Ogden, tells_what_is_wrong_with_its_lists) {
  EXPECT_FALSE((Ogden{{1e3, -1e3}, {2, -2}}.problem()));
  EXPECT_TRUE(Ogden{}.problem());
  EXPECT_TRUE((Ogden{{1e3, 1e3}, {2}}.problem()));
  EXPECT_TRUE((Ogden{{1e3}, {0}}.problem()));
  EXPECT_TRUE((Ogden{{1e3}, {-2}}.problem()));
}

} // namespace
} // namespace dielast::materials::test::elastic_law_contract_test
