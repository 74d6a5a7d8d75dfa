// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fem/diaphragm.hpp"
#include "tests/verification/meridian_stress.hpp"

#include <numbers>

namespace dielast::fem::diaphragm_test {
namespace {

struct Row {
  double shear_modulus, mass, voltage;
  double drop, stiffness, inner_stretch, outer_stretch, capacitance; ///< m, N/m, -, -, F
};

/// The film's meridian and the plate's balance (He, Zhao & Suo 2009) integrated as differential equations.
constexpr Row rows[] = {{25e3, 0.05, 0, 5.3467315e-3, 91.831374, 2.0590921, 2.0023674, 2.39291e-9},
                        {25e3, 0.1, 0, 10.679107e-3, 92.153971, 2.2272887, 2.0093566, 2.44586e-9},
                        {25e3, 0.1, 5e3, 12.847552e-3, 76.578541, 2.3726043, 2.0078324, 2.47806e-9},
                        {40e3, 0.1, 0, 6.6815559e-3, 147.04374, 2.0916249, 2.0036901, 2.40286e-9},
                        {40e3, 0.1, 5e3, 7.4691849e-3, 131.59316, 2.1247034, 2.0035043, 2.40980e-9}};

void expect_row(const Row& row, int elements, int rings, double tolerance) {
  SCOPED_TRACE(testing::Message() << row.shear_modulus << " Pa, " << row.mass << " kg, " << row.voltage
                                  << " V");
  const test::Diaphragm diaphragm(
      {.shear_modulus = row.shear_modulus, .mass = row.mass, .elements = elements, .rings = rings});
  Equilibrium equilibrium(diaphragm.model, 1);
  const State state = diaphragm.settled(equilibrium, row.voltage);
  const DofMap& dofs = diaphragm.model.dofs;
  const auto expect = [&](const char* what, double found, double expected) {
    EXPECT_NEAR(found, expected, tolerance * expected) << what;
  };
  expect("drop", diaphragm.drop(state), row.drop);

  ASSERT_TRUE(equilibrium.factor(state));
  Eigen::VectorXd moved;
  equilibrium.tangent().solve(Eigen::VectorXd::Unit(dofs.free_count(), diaphragm.plate), moved);
  expect("stiffness", 1 / moved[diaphragm.plate], row.stiffness);

  Eigen::VectorXd force;
  equilibrium.internal_force(state, force);
  const double nominal = row.voltage / 1e-3;
  const double k = 4.7 * 8.8541878128e-12 * nominal * nominal / row.shear_modulus;
  const auto stretch = [&](const char* edge, double drawn_radius) {
    const double around = 2 * std::numbers::pi * drawn_radius / 2 * 1e-3; // of the unstretched film, m^2
    const double stress =
        test::pull(dofs, diaphragm.mesh, diaphragm.mesh.node_sets.at(edge), force).norm() / around;
    return test::meridional_stretch(stress / row.shear_modulus, 2, k);
  };
  expect("inner stretch", stretch("inner", 12.7e-3), row.inner_stretch);
  expect("outer stretch", stretch("outer", 68.58e-3), row.outer_stretch);
  expect("capacitance", diaphragm.model.charges(state, false).capacitance[0], row.capacitance);
}

TEST(Diaphragm, of_meridians_has_the_reference_states) {
  for (const Row& row : rows) expect_row(row, 40, 0, 1e-5);
}

TEST(Diaphragm, of_triangles_has_the_reference_states) {
  for (const Row& row : rows) expect_row(row, 0, 9, 1e-3);
}

} // namespace
} // namespace dielast::fem::diaphragm_test
