// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/material_point.hpp"

#include "materials/catalog.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace dielast::materials::material_point_test {
namespace {

/// A material point that remembers its steps of time, from rest at t = 0.
class TimedPoint {
 public:
  TimedPoint(const Material& material, Mode mode) : point_(material, mode) {}

  /// Nominal stress at the stretch l, dt after the last accepted time.
  double stress(double l, double dt) { return point_.stress(l, scheme(dt)); }
  void accept(double l, double dt) {
    point_.accept(l, scheme(dt));
    last_ = dt;
  }
  const Internal& internal(std::size_t branch) const { return point_.internal(branch); }

  /// The equal-biaxial stretch that balances the field k = eps (Phi/H)^2, from l on, by secants.
  double balanced(double k, double l, double dt) {
    const auto left = [&](double x) { return stress(x, dt) - k * x * x * x; };
    double other = l * (1 + 1e-5), there = left(other);
    for (int i = 0; i < 60 && std::abs(other - l) > 1e-13; ++i) {
      const double here = left(l);
      if (here == there) break;
      const double next = l - here * (l - other) / (here - there);
      other = l;
      there = here;
      l = next;
    }
    return l;
  }

 private:
  TimeScheme scheme(double dt) const {
    if (dt == 0) return TimeScheme::frozen();
    return last_ > 0 ? TimeScheme::bdf2(dt, last_) : TimeScheme::backward_euler(dt);
  }
  MaterialPoint point_;
  double last_ = 0;
};

struct Cycle {
  double rate;                    ///< 1/s
  std::vector<double> stress_kPa; ///< nominal, at 1.25, 1.5 ... 2.5, 2.25 ... 1
};

// VHB 4910 with the eight-chain law and three neo-Hookean branches (Wang et al. 2016) pulled to 2.5 and back:
// independent high-accuracy integration of the same equations.
TEST(MaterialPoint, vhb_4910_in_uniaxial_cycles_at_three_rates) {
  const std::vector<Cycle> cycles{
      {0.01,
       {18.46277461809938, 25.709117712409697, 30.552841147362898, 34.567881695862596, 38.399616744812704,
        42.2944037176978, 32.804189683308735, 25.601534815464206, 18.15140664552123, 9.6590291185511,
        -1.1054595320879752, -16.838543566954453}},
      {0.03,
       {24.697660240490464, 33.768064440995204, 39.12721699556229, 43.17299946197781, 46.66662172070475,
        49.987735687332304, 37.014055727580306, 27.434274855692507, 18.037933691042223, 7.340037114135326,
        -6.520892809934006, -27.36483113321988}},
      {0.05,
       {27.805369119793642, 38.69224250196154, 44.61758574198634, 48.80695908158371, 52.295259179866456,
        55.50107775571274, 40.78747014227616, 29.554794669064826, 18.62266713513823, 6.366443121512359,
        -9.381540992831585, -33.029400743423885}}};
  const auto named = std::ranges::find(named_films(), "VHB 4910", &NamedFilm::name);
  ASSERT_NE(named, named_films().end());
  for (const Cycle& cycle : cycles) {
    TimedPoint vhb(named->material, Mode::uniaxial);
    const int steps = 400; // between two rows
    const double dt = 0.25 / cycle.rate / steps;
    double l = 1;
    for (std::size_t row = 0; row < cycle.stress_kPa.size(); ++row) {
      double stress = 0;
      for (int n = 0; n < steps; ++n) {
        l += (row < 6 ? 0.25 : -0.25) / steps;
        stress = vhb.stress(l, dt);
        vhb.accept(l, dt);
      }
      EXPECT_NEAR(stress / 1e3, cycle.stress_kPa[row], 1e-4 * std::abs(cycle.stress_kPa[row])) << l;
    }
  }
}

struct Creep {
  double mu_a, J_a, J_b, Vt;
  std::vector<std::array<double, 3>> table; ///< t/tau, stretch, viscous stretch
};

// A free film with a Gent spring beside a Gent branch under a voltage that is switched on (equal-biaxial, sum
// of the moduli 1): high-accuracy integration, 7 to 8 digits.
TEST(MaterialPoint, creep_under_voltage_of_the_standard_solid_with_gent_springs) {
  const std::vector<Creep> cases{{0.5,
                                  100,
                                  100,
                                  0.4,
                                  {{0, 1.031594, 1.0},
                                   {0.1, 1.0333496, 1.0029644},
                                   {0.5, 1.0397876, 1.0137769},
                                   {1, 1.0466555, 1.0252111},
                                   {5, 1.0731949, 1.0684692},
                                   {20, 1.0810981, 1.08108}}},
                                 {0.3,
                                  110,
                                  55,
                                  0.3,
                                  {{0, 1.0163965, 1.0},
                                   {0.1, 1.0176028, 1.0015828},
                                   {0.5, 1.0221735, 1.0075681},
                                   {1, 1.0273545, 1.0143304},
                                   {5, 1.0536257, 1.0482736},
                                   {20, 1.0723302, 1.0721104}}}};
  for (const Creep& creep : cases) {
    const double mu_b = 1 - creep.mu_a, k = creep.Vt * creep.Vt;
    TimedPoint film(
        {.law = Gent{creep.mu_a, creep.J_a}, .branches = {{Gent{mu_b, creep.J_b}, Dashpot::log, mu_b}}},
        Mode::equal_biaxial);
    const double dt = 0.005;
    double l = film.balanced(k, 1, 0);
    int n = 0;
    for (const auto& [time, stretch, viscous] : creep.table) {
      for (; n < std::lround(time / dt); ++n) {
        l = film.balanced(k, l, dt);
        film.accept(l, dt);
      }
      EXPECT_NEAR(l - 1, stretch - 1, 1e-4 * (stretch - 1) + 1e-7) << time;
      EXPECT_NEAR(std::sqrt(film.internal(0)[0]) - 1, viscous - 1, 1e-4 * (viscous - 1) + 1e-7) << time;
    }
  }
}

// A Gent branch (J = 200) with nominal dashpot held in pure shear at the stretch 1.5: t mu/eta, xi,
// stress/mu.
TEST(MaterialPoint, relaxation_of_the_rolled_muscles_branch) {
  const std::vector<std::array<double, 3>> table{{0, 1.0, 1.2078978},          {0.05, 1.0772046, 0.95104052},
                                                 {0.1, 1.13561, 0.78227896},   {0.2, 1.2202785, 0.56661451},
                                                 {0.5, 1.3572867, 0.26844055}, {1, 1.4463801, 0.097158049},
                                                 {2, 1.4913373, 0.015445297},  {5, 1.4999585, 7.3714319e-05}};
  const Branch branch{Gent{1, 200}, Dashpot::nominal, 1, {true, false}};
  TimedPoint film({.law = NeoHookean{0}, .branches = {branch}}, Mode::pure_shear);
  const double dt = 2e-4;
  double stress = film.stress(1.5, 0);
  int n = 0;
  for (const auto& [time, viscous, expected] : table) {
    for (; n < std::lround(time / dt); ++n) {
      stress = film.stress(1.5, dt);
      film.accept(1.5, dt);
    }
    EXPECT_NEAR(film.internal(0)[0], viscous, 1e-6) << time;
    EXPECT_NEAR(stress, expected, 1e-4 * expected) << time;
  }
}

struct PullIn {
  ElasticLaw law;
  double stretch, nominal_field, true_field;
};

// Free film, fields in units of sqrt(mu/eps): where dk/dlambda of the balance k(lambda) vanishes.
TEST(MaterialPoint, equal_biaxial_pull_in_with_and_without_stiffening) {
  const std::vector<PullIn> cases{{NeoHookean{1}, 1.2599210498948732, 0.6873648184993013, 1.0911236359717214},
                                  {Gent{1, 100}, 1.2638044443828862, 0.6893632220278523, 1.101052091970083},
                                  {Gent{1, 120}, 1.2631379691672047, 0.689025355403234, 1.0993520325759432}};
  for (const auto& [law, stretch, nominal_field, true_field] : cases) {
    const auto potential = [&of_case = law](double l) { // Clang 14 captures no structured binding
      return std::visit([l](const auto& one) { return axisymmetric_potential(one, Dielectric{}, l, l, 0); },
                        of_case);
    };
    const auto k = [&](double l) { return potential(l).first[0] / (l * l * l); };
    double stable = 1, unstable = 1.6;
    while (unstable - stable > 1e-12) {
      const double l = (stable + unstable) / 2;
      const double slope = potential(l).second[0] + potential(l).second[2]; // of the stress, both axes alike
      (slope - 3 * k(l) * l * l > 0 ? stable : unstable) = l;
    }
    EXPECT_NEAR(stable, stretch, 1e-8);
    EXPECT_NEAR(std::sqrt(k(stable)), nominal_field, 1e-10);
    EXPECT_NEAR(std::sqrt(k(stable)) * stable * stable, true_field, 1e-8);
  }
}

// At its pull-in voltage a Gent film snaps to a stretch on the stiff side.
TEST(MaterialPoint, gent_film_snaps_to_its_stiff_side) {
  for (const auto& [J, nominal_field, snapped] : {std::array{100.0, 0.6893632220278523, 7.026280627848488},
                                                  {120.0, 0.689025355403234, 7.705271906881713}}) {
    TimedPoint film({.law = Gent{1, J}}, Mode::equal_biaxial);
    EXPECT_NEAR(film.balanced(nominal_field * nominal_field, snapped + 0.05, 0), snapped, 1e-8);
  }
}

// The stretch grows as exp(r t): a Newtonian liquid beside the rubber adds 2 eta d, d the rate of
// deformation.
TEST(MaterialPoint, a_dashpot_beside_the_law_is_a_newtonian_liquid) {
  const double mu = 1e5, eta = 1e4, rate = 1, dt = 1e-3;
  const Material material{.law = NeoHookean{mu}, .viscosity = eta};
  struct Pulled {
    Mode mode;
    double power, liquid;
  };
  for (const auto& [mode, power, liquid] :
       {Pulled{Mode::uniaxial, 2, 3}, Pulled{Mode::pure_shear, 3, 4}, Pulled{Mode::equal_biaxial, 5, 6}}) {
    TimedPoint point(material, mode);
    double l = 1;
    for (int i = 0; i < 700; ++i) {
      l *= std::exp(rate * dt);
      const double stress = point.stress(l, dt);
      if (i > 50) {
        const double exact = mu * (l - std::pow(l, -power)) + liquid * eta * rate / l;
        EXPECT_NEAR(stress, exact, 1e-3 * exact) << l;
      }
      point.accept(l, dt);
    }
    EXPECT_GT(point.stress(1.001 * l, 0), 3 * mu); // in no time it is all but rigid
  }
}

} // namespace
} // namespace dielast::materials::material_point_test
