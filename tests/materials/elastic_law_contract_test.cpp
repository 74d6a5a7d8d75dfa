#include "materials/dual.hpp"
#include "materials/material.hpp"
#include "materials/plane_stress.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <random>
#include <string>
#include <tuple>
#include <variant>

namespace dielast::materials {
namespace {

/// One example of every law: a new law adds its own here, and everything below holds for it.
const std::tuple examples{NeoHookean{45e3}};

template<class Variant>
struct AlternativesOf;
template<class... Laws>
struct AlternativesOf<std::variant<Laws...>> {
  using Types = testing::Types<Laws...>;
};

struct LawName {
  template<class Law>
  static std::string GetName(int) {
    std::string name(Law::name);
    std::ranges::replace(name, '-', '_');
    return name;
  }
};

constexpr int states = 100;

template<class Law>
class ElasticLawContract : public testing::Test {
 protected:
  const Law law = std::get<Law>(examples);
  std::mt19937 random{1};

  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random); }
  static Eigen::Matrix2d rotation(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }
  /// Principal stretches 0.5..3.5 along any axes.
  Eigen::Matrix2d random_C() {
    const Eigen::Vector2d stretch(uniform(0.5, 3.5), uniform(0.5, 3.5));
    const Eigen::Matrix2d Q = rotation(uniform(0, 3.2));
    return Q * stretch.cwiseAbs2().asDiagonal() * Q.transpose();
  }
  static InPlaneC<double> in_plane(const Eigen::Matrix2d& C) { return {C(0, 0), C(1, 1), C(0, 1)}; }
  double energy(const Eigen::Matrix2d& C, double k) { return membrane_energy(law, in_plane(C), k); }
  /// Stiffness of the undeformed state, a positive number that scales stresses (Pa).
  double modulus() const { return membrane_potential(law, InPlaneC<double>{1, 1, 0}, 0.0).second[0]; }
};

TYPED_TEST_SUITE(ElasticLawContract, AlternativesOf<ElasticLaw>::Types, LawName);

TYPED_TEST(ElasticLawContract, undeformed_state_has_no_energy_and_no_stress) {
  const auto at_rest = membrane_potential(this->law, InPlaneC<double>{1, 1, 0}, 0.0);
  EXPECT_EQ(at_rest.value, 0);
  for (const double first : at_rest.first) EXPECT_NEAR(first, 0, 1e-15 * this->modulus());
}

// An isotropic incompressible sheet has Poisson's ratio 1/2 and one modulus m: d2Psi/dC2 = m (1, 1, 1, 1/2,
// 0, 0).
TYPED_TEST(ElasticLawContract, undeformed_tangent_is_that_of_an_incompressible_sheet_and_positive_definite) {
  const double m = this->modulus();
  ASSERT_GT(m, 0);
  const auto s = membrane_potential(this->law, InPlaneC<double>{1, 1, 0}, 0.0).second;
  const std::array<double, 6> expected{m, m, m, m / 2, 0, 0};
  for (std::size_t p = 0; p < 6; ++p) EXPECT_NEAR(s[p], expected[p], 1e-13 * m);
  Eigen::Matrix3d tangent;
  tangent << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
  EXPECT_GT(tangent.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.1 * m);
}

TYPED_TEST(ElasticLawContract, invariant_derivatives_are_those_of_the_energy) {
  for (int n = 0; n < states; ++n) {
    const double I1 = this->uniform(3, 20), I2 = this->uniform(3, 20);
    const Dual<2> W = this->law.energy(Dual<2>::variable(I1, 0), Dual<2>::variable(I2, 1));
    const InvariantDerivatives<double> d = this->law.derivatives(I1, I2);
    const double tolerance = 1e-12 * (this->modulus() + W.gradient.norm() + W.hessian.norm());
    EXPECT_NEAR(d.W1, W.gradient[0], tolerance);
    EXPECT_NEAR(d.W2, W.gradient[1], tolerance);
    EXPECT_NEAR(d.W11, W.hessian(0, 0), tolerance);
    EXPECT_NEAR(d.W12, W.hessian(0, 1), tolerance);
    EXPECT_NEAR(d.W22, W.hessian(1, 1), tolerance);
    if (TypeParam::linear_in_first_invariant) {
      EXPECT_EQ(W.gradient[1], 0);
      EXPECT_EQ(W.hessian.norm(), 0);
    }
  }
}

TYPED_TEST(ElasticLawContract, membrane_derivatives_are_those_of_the_energy_with_and_without_voltage) {
  using Dual3 = Dual<3>;
  constexpr std::array<std::array<int, 2>, 6> pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  for (int n = 0; n < 2 * states; ++n) {
    const InPlaneC<double> C = this->in_plane(this->random_C());
    const double k = n % 2 ? this->uniform(0, 1) * this->modulus() : 0.0;
    const auto potential = membrane_potential(this->law, C, k);
    const Dual3 oracle = membrane_energy(
        this->law,
        InPlaneC<Dual3>{Dual3::variable(C.C11, 0), Dual3::variable(C.C22, 1), Dual3::variable(C.C12, 2)},
        Dual3(k));
    EXPECT_NEAR(potential.value, oracle.value, 1e-12 * std::abs(oracle.value));
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(potential.first[i], oracle.gradient[i], 1e-12 * oracle.gradient.norm());
    for (std::size_t p = 0; p < 6; ++p)
      EXPECT_NEAR(potential.second[p], oracle.hessian(pairs[p][0], pairs[p][1]),
                  1e-12 * oracle.hessian.norm());
    EXPECT_LT((oracle.hessian - oracle.hessian.transpose()).norm(), 1e-14 * oracle.hessian.norm());
  }
}

// Everything depends on C, so that a rotation of the deformed film changes nothing by construction. The law
// must also not see a rotation of the undeformed film.
TYPED_TEST(ElasticLawContract, rotating_the_undeformed_film_turns_the_stress_with_it) {
  for (int n = 0; n < states; ++n) {
    const Eigen::Matrix2d C = this->random_C(), Q = this->rotation(this->uniform(0, 6.3));
    const double k = this->uniform(0, 1) * this->modulus();
    const double scale = this->modulus() * C.norm();
    EXPECT_NEAR(this->energy(Q * C * Q.transpose(), k), this->energy(C, k), 1e-12 * scale * C.norm());
    const auto stress = [&](const Eigen::Matrix2d& at) {
      const auto first = membrane_potential(this->law, this->in_plane(at), k).first;
      return Eigen::Matrix2d{{2 * first[0], first[2]}, {first[2], 2 * first[1]}};
    };
    const Eigen::Matrix2d turned = stress(Q * C * Q.transpose());
    EXPECT_LT((turned - Q * stress(C) * Q.transpose()).norm(), 1e-12 * (scale + stress(C).norm()));
  }
}

TYPED_TEST(ElasticLawContract, parameters_have_names_units_and_ranges) {
  for (const Parameter& parameter : TypeParam::parameters) {
    EXPECT_FALSE(parameter.name.empty());
    EXPECT_FALSE(parameter.unit.empty());
    EXPECT_FALSE(parameter.meaning.empty());
    EXPECT_LT(parameter.above, parameter.below);
  }
}

} // namespace
} // namespace dielast::materials
