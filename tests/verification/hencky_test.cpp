// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/equilibrium.hpp"
#include "meshing/meridian.hpp"
#include "tests/fem/chamber_models.hpp"
#include "tests/verification/meridian_stress.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace dielast::fem::hencky_test {
namespace {

struct Row {
  double poisson_ratio, deflection, centre_stress, edge_stress;
};

/// Hencky 1915, Zeitschrift fuer Mathematik und Physik 63: w = c a (q a/(Y H))^(1/3), sigma = c (Y q^2
/// a^2/H^2)^(1/3).
constexpr Row rows[] = {{0.0, 0.7183192384646042, 0.4051032738928807, 0.28937196097497836},
                        {0.16, 0.6862948493668766, 0.4170858995372229, 0.31011422217844675},
                        {0.2, 0.6774353258045668, 0.42068309043443264, 0.3161092885207235},
                        {0.3, 0.6534433446927002, 0.4311010161097088, 0.33295680687218154},
                        {0.34, 0.6429980370738186, 0.4359665584628759, 0.34058978772620613},
                        {0.4, 0.6262550793641554, 0.4442176589463796, 0.3532327451353503},
                        {0.45, 0.6111705582293576, 0.452161398702177, 0.36508341886931417},
                        {0.5, 0.5948790299688793, 0.4613276765718386, 0.37841206627676366}};

// A flat clamped disc without tension under a pressure so small that it stays shallow.
TEST(Hencky, a_pressed_disc_has_his_deflection_and_stresses) {
  constexpr double a = 0.02, H = 1e-3, Y = 1e6, load = 1e-6; // q a/(Y H)
  const meshing::Mesh mesh = meshing::disc_meridian(a, a / 2, 40, 2);
  const int rim = mesh.node_sets.at("rim").front(), centre = mesh.node_sets.at("centre").front();
  for (const Row& row : rows) {
    SCOPED_TRACE(row.poisson_ratio);
    MembraneSection film = test::vhb();
    if (row.poisson_ratio < 0.5)
      film.material.law = materials::StVenantKirchhoff{Y, row.poisson_ratio};
    else
      film.material.law = materials::NeoHookean{Y / 3};
    const auto model = test::inflatable(mesh, film, a);
    for (const int c : {0, 2}) model->dofs.hold(rim, c);
    model->dofs.hold(centre, 0);
    model->dofs.number();
    Equilibrium equilibrium(*model, 1);
    State state = model->initial_state();
    state.voltage = {load * Y * H / a};
    ASSERT_EQ(equilibrium.solve(state, {.tolerance = 1e-9, .max_iterations = 60}).outcome,
              Outcome::converged);
    const double w = state.displacement[static_cast<std::size_t>(centre)].z();
    EXPECT_NEAR(w / (a * std::cbrt(load)), row.deflection, 1e-3 * row.deflection);
    const double unit = Y * std::pow(load, 2.0 / 3);
    EXPECT_NEAR(model->sample(state).film.back().S(0, 0) / unit, row.centre_stress, 1e-3 * row.centre_stress);
    Eigen::VectorXd force;
    equilibrium.internal_force(state, force);
    const double edge = test::pull(model->dofs, mesh, {rim}, force).norm() / (2 * std::numbers::pi * a * H);
    EXPECT_NEAR(edge / unit, row.edge_stress, 1e-3 * row.edge_stress);
  }
}

} // namespace
} // namespace dielast::fem::hencky_test
