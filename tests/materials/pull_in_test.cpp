// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/laws/plane_stress.hpp"
#include "materials/material.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <cmath>

namespace dielast::materials::pull_in_test {
namespace {

/// Closed forms of the neo-Hookean ideal dielectric film (Zhao & Suo 2007, Appl. Phys. Lett. 91, 061921); mu
/// = 1.
const NeoHookean law{1.0};

/// Second Piola-Kirchhoff stress along both axes under the stretches along them.
Eigen::Vector2d stress(double lambda_1, double lambda_2, double k) {
  const auto first =
      membrane_potential(law, Dielectric{}, InPlaneC<double>{lambda_1 * lambda_1, lambda_2 * lambda_2, 0}, k)
          .first;
  return {2 * first[0], 2 * first[1]};
}

/// k/mu that holds a free film at the equal-biaxial stretch.
double free_film(double lambda) { return std::pow(lambda, -2) - std::pow(lambda, -8); }

TEST(PullIn, free_equal_biaxial_film_is_in_equilibrium) {
  for (double lambda = 1; lambda < 2; lambda += 0.05)
    EXPECT_LT(stress(lambda, lambda, free_film(lambda)).norm(), 1e-14);
}

TEST(PullIn, limit_stretch_is_the_cube_root_of_two) {
  // The stiffness against a further equal-biaxial stretch falls to zero there.
  const auto stiffness = [](double lambda) {
    const auto s =
        membrane_potential(law, Dielectric{}, InPlaneC<double>{lambda * lambda, lambda * lambda, 0},
                           free_film(lambda))
            .second;
    return s[0] + s[1] + 2 * s[3];
  };
  double stable = 1, unstable = 2;
  while (unstable - stable > 1e-14) {
    const double middle = (stable + unstable) / 2;
    (stiffness(middle) > 0 ? stable : unstable) = middle;
  }
  // Reference: maximum of k(lambda), lambda^6 = 4.
  EXPECT_NEAR(stable, 1.2599210498948732, 1e-12);
  const double nominal_field = std::sqrt(free_film(stable)); // (Phi/H) sqrt(eps/mu)
  EXPECT_NEAR(nominal_field, 0.6873648184993013, 1e-12);
  EXPECT_NEAR(nominal_field * stable * stable, 1.0911236359717214, 1e-12); // true field
}

TEST(PullIn, plane_strain_film_has_no_limit) {
  for (double lambda = 1.1; lambda < 6; lambda *= 1.3)
    EXPECT_NEAR(stress(lambda, 1, 1 - std::pow(lambda, -4))[0], 0, 1e-14);
}

TEST(PullIn, clamped_film_loses_its_tension) {
  for (const double lambda : {1.5, 2.0, 3.0, 4.0}) {
    const double k = 0.3 * free_film(lambda);
    const double nominal = lambda - std::pow(lambda, -5) - k * std::pow(lambda, 3);
    EXPECT_NEAR(lambda * stress(lambda, lambda, k)[0], nominal, 1e-13);
    EXPECT_NEAR(stress(lambda, lambda, free_film(lambda)).norm(), 0, 1e-13);
  }
}

} // namespace
} // namespace dielast::materials::pull_in_test
