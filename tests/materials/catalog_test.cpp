// SPDX-License-Identifier: GPL-3.0-or-later
#include "materials/catalog.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace dielast::materials::catalog_test {
namespace {

TEST(Catalog, every_film_says_where_its_numbers_come_from_and_can_be_stretched) {
  std::set<std::string_view> names;
  for (const NamedFilm& film : named_films()) {
    SCOPED_TRACE(film.name);
    names.insert(film.name);
    EXPECT_FALSE(film.source.empty());
    EXPECT_FALSE(film.validity.empty());
    EXPECT_GT(initial_shear_modulus(film.material.law), 0);
    EXPECT_TRUE(admits(film.material.law, 2 * 9 + 1 / 81.0)); // equal-biaxial stretch 3
    // relative permittivities of elastomers
    EXPECT_GT(film.material.dielectric.permittivity, 2 * 8.85e-12);
    EXPECT_LT(film.material.dielectric.permittivity, 6 * 8.86e-12);
    for (const Branch& branch : film.material.branches) {
      const double tau = branch.viscosity / initial_shear_modulus(branch.law); // s
      EXPECT_GT(tau, 0.1);
      EXPECT_LT(tau, 1000);
    }
  }
  EXPECT_EQ(names.size(), named_films().size());
}

TEST(Catalog, every_solid_says_where_its_numbers_come_from) {
  for (const NamedSolid& solid : named_solids()) {
    EXPECT_FALSE(solid.source.empty());
    EXPECT_FALSE(solid.validity.empty());
    EXPECT_GT(solid.solid.youngs_modulus, 0);
  }
}

} // namespace
} // namespace dielast::materials::catalog_test
