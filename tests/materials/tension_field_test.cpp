// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/branches/branch.hpp"
#include "materials/tension_field.hpp"
#include "tests/materials/law_examples.hpp"

#include <optional>

namespace dielast::materials::test::tension_field_test {
namespace {

/// Film of every law, alone or beside a branch of the same law, charged or not.
template<class Law>
class TensionFieldContract : public LawTest<Law> {
 protected:
  struct Film {
    Law law;
    double k;
    std::optional<Branch> branch{};
    Internal now{};
    TimeScheme scheme{};

    MembranePotential<double> operator()(const InPlaneC<double>& C) const {
      MembranePotential<double> p = membrane_potential(law, Dielectric{}, C, k);
      if (!branch) return p;
      const auto q = branch_potential(*branch, C, scheme, now, now);
      p.value += q.value;
      for (std::size_t i = 0; i < 3; ++i) p.first[i] += q.first[i];
      for (std::size_t i = 0; i < 6; ++i) p.second[i] += q.second[i];
      return p;
    }
    TensionField relaxed(const InPlaneC<double>& C) const { return relax(*this, C, (*this)(C)); }
  };

  static constexpr std::array<std::optional<Dashpot>, 3> kinds{std::nullopt, Dashpot::log, Dashpot::nominal};

  Film film(const std::optional<Dashpot>& dashpot) {
    Film film{this->law, this->uniform(0, 1) < 0.5 ? 0 : this->uniform(0, 0.15) * this->modulus()};
    if (!dashpot) return film;
    film.branch = Branch{this->law, *dashpot, 2 * this->modulus()};
    film.scheme = TimeScheme::backward_euler(std::pow(10, this->uniform(-2, 1)));
    if (*dashpot == Dashpot::nominal) {
      film.now = {this->uniform(0.8, 1.4), this->uniform(0.8, 1.4), 0};
    } else {
      const Eigen::Matrix2d Cv = this->random_C(0.8, 1.4);
      film.now = {Cv(0, 0), Cv(1, 1), Cv(0, 1)};
    }
    return film;
  }
  static InPlaneC<double> moved(InPlaneC<double> C, int i, double x) {
    return {C.C11 + (i == 0) * x, C.C22 + (i == 1) * x, C.C12 + (i == 2) * x};
  }
  static Eigen::Vector3d vector(const InPlaneC<double>& C) { return {C.C11, C.C22, C.C12}; }
};

TYPED_TEST_SUITE(TensionFieldContract, AlternativesOf<ElasticLaw>::Types, LawName);

TYPED_TEST(TensionFieldContract, derivatives_are_exact_in_every_state_of_tension) {
  std::array<int, 4> met{};
  for (const auto& dashpot : this->kinds)
    for (int n = 0; n < 2 * states; ++n) {
      const auto film = this->film(dashpot);
      const InPlaneC<double> C = this->in_plane(this->random_C(0.6, 1.8));
      const TensionField at = film.relaxed(C);
      const double h = 2e-4, mu = this->modulus();
      for (int i = 0; i < 3; ++i) {
        std::array<TensionField, 4> there;
        for (std::size_t s = 0; s < 4; ++s)
          there[s] = film.relaxed(this->moved(C, i, std::array{h, -h, 2 * h, -2 * h}[s]));
        if (std::ranges::any_of(there, [&](const auto& one) { return one.tension != at.tension; })) continue;
        ++met[static_cast<std::size_t>(at.tension)];
        if (at.tension == Tension::lost) continue;
        const auto difference = [&](const auto& of) {
          return ((8 * (of(there[0]) - of(there[1])) - (of(there[2]) - of(there[3]))) / (12 * h)).eval();
        };
        using One = Eigen::Vector<double, 1>;
        const double slope = difference([](const TensionField& f) { return One(f.potential.value); })[0];
        EXPECT_NEAR(at.potential.first[static_cast<std::size_t>(i)], slope, 1e-7 * mu);
        const auto first = [](const TensionField& f) { return tension_field::first(f.potential); };
        const Eigen::Matrix3d tangent = tension_field::second(at.potential);
        EXPECT_LT((tangent.col(i) - difference(first)).norm(), 1e-6 * (mu + tangent.norm()));
        if (at.tension == Tension::taut) continue;
        const auto natural = [&](const TensionField& f) { return this->vector(f.natural); };
        EXPECT_LT((at.carry.row(i).transpose() - difference(natural)).norm(), 1e-6 * (1 + at.carry.norm()));
      }
    }
  for (const Tension tension : {Tension::taut, Tension::wrinkled, Tension::slack})
    EXPECT_GT(met[static_cast<std::size_t>(tension)], 30);
}

// Also for states far from any that a film can be in, and where all directions are equal.
TYPED_TEST(TensionFieldContract, carries_no_compression_and_stores_least) {
  const double least = std::same_as<TypeParam, StVenantKirchhoff> ? 0.7 : 0.2; // softens below 0.58
  for (const auto& dashpot : this->kinds)
    for (int n = 0; n < 10 * states; ++n) {
      const auto film = this->film(dashpot);
      InPlaneC<double> C = this->in_plane(this->random_C(least, 2.5));
      if (n % 5 == 0) C = {C.C11, C.C11, 0};
      if (n % 5 == 1) C = {C.C11, C.C11 * (1 + 1e-9), 1e-10};
      const auto taut = film(C);
      if (!std::isfinite(taut.value)) continue;
      const TensionField at = relax(film, C, taut);
      if (at.tension == Tension::lost) {
        EXPECT_GT(film.k, 0) << C.C11 << ' ' << C.C22 << ' ' << C.C12;
        continue;
      }
      const double mu = this->modulus(), stiffness = tension_field::second(at.potential).norm() + mu;
      EXPECT_GT(tension_field::smallest(this->stress(at.potential)).value, -1e-8 * stiffness * C.trace());
      EXPECT_LE(at.potential.value, taut.value + 1e-12 * mu);
      // what the natural film stores, as wide as the given one or wider
      EXPECT_NEAR(film(at.natural).value, at.potential.value, 1e-10 * (mu + std::abs(taut.value)));
      const InPlaneC<double> wider{at.natural.C11 - C.C11, at.natural.C22 - C.C22, at.natural.C12 - C.C12};
      EXPECT_GT(wider.det(), -1e-9 * C.trace() * C.trace());
      EXPECT_GT(wider.trace(), -1e-9 * C.trace());
      for (int m = 0; m < 5; ++m) {
        const Eigen::Vector2d a(this->uniform(-1, 1), this->uniform(-1, 1));
        const double other = film(tension_field::plus(C, a)).value;
        EXPECT_FALSE(other < at.potential.value - 1e-10 * (mu + std::abs(taut.value)));
      }
    }
}

TYPED_TEST(TensionFieldContract, goes_from_taut_to_wrinkled_to_slack_without_jumps) {
  for (const auto& dashpot : this->kinds) {
    auto film = this->film(dashpot);
    film.now = {1, 1, 0};
    const auto at = [&](double length, double width) { return film.relaxed({length, width, 0.05}); };
    const auto expect_no_jump = [&](const auto& along, double from, double to) {
      const Tension before = along(from).tension;
      while (std::abs(to - from) > 1e-8) {
        const double middle = (to + from) / 2;
        (along(middle).tension == before ? from : to) = middle;
      }
      const TensionField a = along(from), b = along(to);
      EXPECT_NEAR(a.potential.value, b.potential.value, 1e-6 * this->modulus());
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(a.potential.first[i], b.potential.first[i], 1e-6 * this->modulus());
    };
    ASSERT_EQ(at(2, 1.5).tension, Tension::taut);
    ASSERT_EQ(at(2, 0.6).tension, Tension::wrinkled);
    ASSERT_EQ(at(0.75, 0.6).tension, Tension::slack);
    expect_no_jump([&](double width) { return at(2, width); }, 1.5, 0.6);
    expect_no_jump([&](double length) { return at(length, 0.6); }, 2, 0.75);
  }
}

TYPED_TEST(TensionFieldContract, slack_film_is_in_its_natural_state) {
  typename TestFixture::Film film{this->law, 0};
  for (int n = 0; n < states; ++n) {
    const TensionField at = film.relaxed(this->in_plane(this->random_C(0.3, 0.98)));
    ASSERT_EQ(at.tension, Tension::slack);
    EXPECT_NEAR(at.potential.value, 0, 1e-12 * this->modulus());
    EXPECT_LT((this->vector(at.natural) - Eigen::Vector3d(1, 1, 0)).norm(), 1e-9);
  }
}

TYPED_TEST(TensionFieldContract, film_at_rest_is_taut_with_the_stiffness_of_a_film) {
  typename TestFixture::Film film{this->law, 0};
  const double c = std::cos(0.3), s = std::sin(0.3); // rounding in the last digits
  const TensionField at = film.relaxed({c * c + s * s, 1 + 1e-16, c * s - s * c});
  EXPECT_EQ(at.tension, Tension::taut);
}

/// mu = 1
MembranePotential<double> neo_hookean(const InPlaneC<double>& C, double k) {
  return membrane_potential(NeoHookean{1.0}, Dielectric{}, C, k);
}
TensionField relaxed_neo_hookean(const InPlaneC<double>& C, double k) {
  return relax([k](const InPlaneC<double>& at) { return neo_hookean(at, k); }, C, neo_hookean(C, k));
}

TEST(TensionField, charged_neo_hookean_film_has_the_natural_width_of_the_closed_form) {
  for (const double l1 : {1.02, 1.3, 2.0, 3.0})
    for (const double share : {0.0, 0.3, 0.9, 0.999}) {
      const double k = share / (l1 * l1), width = std::pow(l1 * l1 * (1 - k * l1 * l1), -0.25);
      // stress along the wrinkles
      const double along = 1 - std::pow(l1, -4) / (width * width) - k * width * width;
      const TensionField at = relaxed_neo_hookean({l1 * l1, 0.04, 0}, k);
      if (along < 0) { // the field takes all tension
        EXPECT_NE(at.tension, Tension::wrinkled);
        continue;
      }
      EXPECT_EQ(at.tension, Tension::wrinkled);
      EXPECT_NEAR(std::sqrt(at.natural.C22), width, 1e-10 * width);
      EXPECT_NEAR(2 * at.potential.first[0], along, 1e-10);
    }
}

TEST(TensionField, is_lost_where_the_field_outdoes_the_law_at_any_width) {
  EXPECT_EQ(relaxed_neo_hookean({4, 0.04, 0}, 0.26).tension, Tension::lost);
  // no tension along the wrinkles, and more field than a free film can balance: k = 3/8 2^(1/3) mu
  EXPECT_EQ(relaxed_neo_hookean({0.25, 0.04, 0}, 0.48).tension, Tension::lost);
  EXPECT_EQ(relaxed_neo_hookean({0.25, 0.04, 0}, 0.47).tension, Tension::slack);
}

TEST(TensionField, a_stretch_limit_holds_what_a_neo_hookean_film_would_lose) {
  const Gent law{1, 100};
  const double k = 0.05;
  const auto psi = [&](const InPlaneC<double>& C) { return membrane_potential(law, Dielectric{}, C, k); };
  const InPlaneC<double> C{60, 0.16, 0};
  const TensionField at = relax(psi, C, psi(C));
  ASSERT_EQ(at.tension, Tension::wrinkled);
  EXPECT_EQ(relaxed_neo_hookean(C, k).tension, Tension::lost);
  // mu (1 - 1/(C11 C22^2))/(1 - (I1 - 3)/J) = k C11
  const double C22 = at.natural.C22, I1 = 60 + C22 + 1 / (60 * C22);
  EXPECT_NEAR((1 - 1 / (60 * C22 * C22)) / (1 - (I1 - 3) / 100), k * 60, 1e-10);
}

// The way to the wrinkles' width leads beyond the limit, where the law has slopes that mean nothing.
TEST(TensionField, slack_film_pulled_towards_its_stretch_limit_has_a_natural_state) {
  const Gent law{1, 30};
  for (double k = 0.5; k < 2; k += 0.01) {
    const auto psi = [&](const InPlaneC<double>& C) { return membrane_potential(law, Dielectric{}, C, k); };
    const InPlaneC<double> C{4, 1, 0};
    const TensionField at = relax(psi, C, psi(C));
    ASSERT_EQ(at.tension, Tension::slack) << k;
    const double c = at.natural.C11, I1 = 2 * c + 1 / (c * c);
    EXPECT_NEAR((1 - 1 / (c * c * c)) / (1 - (I1 - 3) / 30), k * c, 1e-9 * k * c) << k;
    EXPECT_NEAR(at.natural.C22, c, 1e-9 * c);
  }
}

TEST(TensionField, wrinkles_next_to_the_stretch_limit_too) {
  const Gent law{1, 100};
  const auto psi = [&](const InPlaneC<double>& C) { return membrane_potential(law, Dielectric{}, C, 0.0); };
  for (const double C11 : {90.0, 102.0, 102.7}) {
    const InPlaneC<double> C{C11, 0.06, 0};
    const TensionField at = relax(psi, C, psi(C));
    ASSERT_EQ(at.tension, Tension::wrinkled);
    EXPECT_NEAR(at.natural.C22, 1 / std::sqrt(C11), 1e-12); // uniaxial
  }
}

// What a dashpot takes up in a short time is known to a rounding that outdoes the film's energy: the width of
// wrinkles was not found there, and film counted as lost.
TEST(TensionField, wrinkles_of_film_with_a_dashpot_are_found_in_the_shortest_times) {
  const Branch branch{NeoHookean{1}, Dashpot::log, 1};
  const Internal now{0.9, 1.2, 0.1};
  const InPlaneC<double> C{0.35, 1.62, -0.0164};
  for (double dt = 1; dt > 1e-11; dt /= 3) {
    const TimeScheme scheme = TimeScheme::backward_euler(dt);
    const auto psi = [&](const InPlaneC<double>& at) {
      MembranePotential<double> p = membrane_potential(Gent{1, 80}, Dielectric{}, at, 0.1);
      const auto q = branch_potential(branch, at, scheme, now, now);
      p.value += q.value;
      for (std::size_t i = 0; i < 3; ++i) p.first[i] += q.first[i];
      for (std::size_t i = 0; i < 6; ++i) p.second[i] += q.second[i];
      return p;
    };
    const TensionField at = relax(psi, C, psi(C));
    ASSERT_EQ(at.tension, Tension::wrinkled) << dt;
    const Eigen::Matrix2d S = tension_field::stress(psi(at.natural));
    EXPECT_NEAR(S.determinant() / S.trace(), 0, 1e-7) << dt;
    EXPECT_GT(S.trace(), 0) << dt;
  }
}

} // namespace
} // namespace dielast::materials::test::tension_field_test
