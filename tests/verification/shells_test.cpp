// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/verification/shell_problem.hpp"

#include <cmath>
#include <numbers>

namespace dielast::fem::shells_test {
namespace {

using std::numbers::pi;
using test::elastic_shell;
using test::ShellProblem;

/// A quarter of a cylinder about the y axis: from its crown (u = 0) to `angle`, from its diaphragm (v = 0) to
/// its middle.
ShellProblem quarter_cylinder(int n, double radius, double half_length, double angle,
                              const ShellSection& section) {
  ShellProblem shell(
      n, n,
      [=](double u, double v) {
        return Eigen::Vector3d(radius * std::sin(angle * u), half_length * v, radius * std::cos(angle * u));
      },
      section);
  shell.hold(shell.side(1, 0), {0, 2});
  shell.hold(shell.side(1, 1), {1, 3, 5});
  shell.hold(shell.side(0, 0), {0, 4, 5});
  return shell;
}

// MacNeal & Harder 1985, Finite Elem. Anal. Des. 1, 3.
TEST(ShellObstacleCourse, the_scordelis_lo_roof_sags_as_published) {
  ShellProblem roof = quarter_cylinder(16, 25, 25, 40 * pi / 180, elastic_shell(4.32e8, 0, 0.25));
  roof.number();
  roof.load_surface(-90);
  EXPECT_NEAR(-roof.linear_answer(roof.node(1, 1), 2), 0.3024, 0.01 * 0.3024);
}

TEST(ShellObstacleCourse, the_pinched_cylinder_gives_way_as_published) {
  ShellProblem cylinder = quarter_cylinder(16, 300, 300, pi / 2, elastic_shell(3e6, 0.3, 3));
  cylinder.hold(cylinder.side(0, 1), {2, 3, 4});
  cylinder.number();
  cylinder.load(cylinder.node(0, 1), 2, -0.25);
  EXPECT_NEAR(-cylinder.linear_answer(cylinder.node(0, 1), 2), 1.82488e-5, 0.01 * 1.82488e-5);
}

TEST(ShellObstacleCourse, the_hemisphere_opens_as_published) {
  ShellProblem hemisphere = test::hemisphere(16);
  hemisphere.load(hemisphere.node(0, 0), 0, 1);
  hemisphere.load(hemisphere.node(1, 0), 1, -1);
  EXPECT_NEAR(hemisphere.linear_answer(hemisphere.node(0, 0), 0), 0.093, 0.01 * 0.093);
}

/// Deflection in the middle of a square plate of side 1 under an even load q, times D/q; nu = 0.3.
double plate_deflection(int n, double slenderness, bool clamped, double skew) {
  const double H = 1 / slenderness, E = 1, nu = 0.3;
  ShellProblem plate(
      n, n,
      [=](double u, double v) { // a quarter, its sides on the axes
        return Eigen::Vector3d(0.5 * (u + skew * u * (1 - u) * v), 0.5 * (v - skew * v * (1 - v) * u), 0);
      },
      elastic_shell(E, nu, H));
  using Components = std::vector<int>;
  plate.hold(plate.side(0, 0), clamped ? Components{0, 1, 2, 3, 4, 5} : Components{2, 3});
  plate.hold(plate.side(1, 0), clamped ? Components{0, 1, 2, 3, 4, 5} : Components{2, 4});
  plate.hold(plate.side(0, 1), {0, 4, 5});
  plate.hold(plate.side(1, 1), {1, 3, 5});
  plate.number();
  plate.load_surface(1);
  return plate.linear_answer(plate.node(1, 1), 2) * E * H * H * H / (12 * (1 - nu * nu));
}

// Timoshenko & Woinowsky-Krieger 1959, tables 8 and 35.
TEST(SquarePlate, of_any_slenderness_does_not_lock) {
  for (const double skew : {0.0, 0.5})
    for (const bool clamped : {false, true}) {
      const double kirchhoff = clamped ? 0.00126532 : 0.00406235;
      for (const double slenderness : {1e3, 1e4, 1e5}) {
        const double coarse = std::abs(plate_deflection(8, slenderness, clamped, skew) / kirchhoff - 1),
                     fine = std::abs(plate_deflection(16, slenderness, clamped, skew) / kirchhoff - 1);
        EXPECT_LT(fine, 0.005) << skew << clamped << slenderness;
        EXPECT_GT(std::log2(coarse / fine), 1.9) << skew << clamped << slenderness;
      }
      for (const double slenderness : {10.0, 100.0}) // it shears: against a finer mesh
        EXPECT_NEAR(plate_deflection(8, slenderness, clamped, skew) /
                        plate_deflection(16, slenderness, clamped, skew),
                    1, 2e-4);
    }
}

const materials::Dielectric acrylic{.permittivity = 4e-11, .breakdown_field = 1e9};

TEST(ThinShell, deflects_like_a_membrane) {
  constexpr double stiffness = 40; // mu H, N/m
  const auto rise = [](const ShellProblem::Blocks& blocks) {
    ShellProblem film(
        6, 6, [](double u, double v) { return Eigen::Vector3d(0.1 * u, 0.1 * v, 0); }, blocks);
    for (const int parameter : {0, 1}) {
      film.hold(film.side(parameter, 0), {0, 1, 2});
      film.hold(film.side(parameter, 1), {0, 1, 2});
    }
    film.number();
    film.load_surface(300);
    EXPECT_EQ(film.raise(1, 4).end, RampEnd::complete);
    return film.displacement(film.node(0.5, 0.5)).z();
  };
  const auto material = [](double H) {
    return materials::Material{materials::Gent{stiffness / H, 60}, acrylic, 960, {}};
  };
  const double membrane = rise([&](const meshing::Mesh& mesh) {
    return make_membrane_block(
        mesh, mesh.blocks[0], {.material = material(1e-4), .thickness = 1e-4, .prestretch = {1.5, 1.2}},
        std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), passive), Dimension::spatial, 3);
  });
  std::vector<double> errors;
  for (const double H : {1e-3, 1e-4, 1e-5}) {
    const double shell = rise([&](const meshing::Mesh& mesh) {
      const std::vector<int> none(static_cast<std::size_t>(mesh.blocks[0].size()), passive);
      return make_shell_block(mesh, mesh.blocks[0], {{{material(H), H}}, {1.5, 1.2}}, {none});
    });
    errors.push_back(std::abs(shell / membrane - 1));
  }
  EXPECT_LT(errors[1], errors[0]);
  EXPECT_LT(errors[2], 2e-3); // what the membrane strains of this mesh differ by
}

struct Bent {
  double field, angle, x, z; // Phi/H sqrt(eps/mu); of the tip, rad; its place, mm
};

/// A strip of two layers of a Gent film, clamped at one end, that bends in plane strain; `offset` as in
/// ShellSection, m.
ShellProblem bilayer(double offset) {
  const materials::Material gent{materials::Gent{1e5, 7}, acrylic, 960, {}};
  ShellProblem strip(
      10, 1, [](double u, double v) { return Eigen::Vector3d(20e-3 * u, 2e-3 * v, 0); },
      ShellSection{.layers = {{gent, 1e-3}, {gent, 1e-3}}, .offset = offset}, 1);
  strip.hold(strip.side(0, 0), {0, 4, 5});
  strip.hold(strip.side(1, 0), {1, 3, 5});
  strip.hold(strip.side(1, 1), {1, 3, 5});
  strip.hold({strip.node(0, 0)}, {2});
  strip.number();
  return strip;
}

// Exact finite flexure of two layers of a Gent film in plane strain, the lower one passive, the upper one a
// cylindrical capacitor; the tip's x and z are those of the interface.
TEST(Bilayer, bends_as_exact_finite_flexure) {
  constexpr Bent table[] = {{0.05, 0.009389695233999911, 20.005965312299058, 0.09392564866353768},
                            {0.1, 0.0377357556639739, 20.020397052553818, 0.3777872371503829},
                            {0.2, 0.15383996434054878, 20.02323218540957, 1.543231468041405}};
  for (const Bent& exact : table) {
    ShellProblem strip = bilayer(0);
    const double voltage = exact.field * 1e-3 * std::sqrt(1e5 / acrylic.permittivity);
    ASSERT_EQ(strip.raise(1, 2, voltage).end, RampEnd::complete);
    const int tip = strip.node(1, 0);
    EXPECT_NEAR(spin_of(strip.state().rotation[static_cast<std::size_t>(tip)]).y(), exact.angle,
                5e-4 * exact.angle);
    EXPECT_NEAR(-1e3 * strip.displacement(tip).z(), exact.z, 5e-4 * exact.z);
    EXPECT_NEAR(20 + 1e3 * strip.displacement(tip).x(), exact.x, 1e-5 * exact.x);
  }
}

// The offset moves the drawn surface out of the middle; a neutral load along the middle would not bend it.
TEST(Bilayer, does_not_care_which_of_its_surfaces_is_drawn) {
  std::vector<double> angles;
  for (const double offset : {-1e-3, 0.0, 1e-3}) {
    ShellProblem strip = bilayer(offset);
    ASSERT_EQ(strip.raise(1, 2, 5000 / std::sqrt(2.0)).end, RampEnd::complete);
    angles.push_back(spin_of(strip.state().rotation[static_cast<std::size_t>(strip.node(1, 0))]).y());
  }
  for (const double angle : angles) EXPECT_NEAR(angle, angles[1], 0.01 * angles[1]);
}

/// The largest factor on `raise` at which the flat state is stable, by bisection of the tangent's inertia.
double critical_factor(ShellProblem& shell, const std::function<void(State&, double)>& raise) {
  Equilibrium equilibrium(shell.model(), 1);
  double low = 0.5, high = 1.5;
  while (high - low > 1e-5) {
    const double middle = (low + high) / 2;
    State state = shell.model().initial_state();
    raise(state, middle);
    const NewtonResult result = equilibrium.solve(state, {});
    EXPECT_EQ(result.outcome, Outcome::converged);
    (result.negative_pivots == 0 ? low : high) = middle;
  }
  return low;
}

// eps (Phi/H)^2 H = 14.68 D/a^2 with D = mu H^3/3 (Timoshenko & Gere 1961, sec. 9.3: the clamped plate).
TEST(ClampedDisc, buckles_at_the_critical_voltage) {
  const double a = 0.1, mu = 1e5;
  for (const double slenderness : {100.0, 300.0}) {
    const double H = a / slenderness;
    ShellProblem disc(
        8, 8,
        [a](double u, double v) { // a quarter of the disc, from a square
          const double edge = std::max(u, v);
          if (edge == 0) return Eigen::Vector3d(0, 0, 0);
          const double shrink = 1 - edge + edge * edge / std::hypot(u, v);
          return Eigen::Vector3d(a * u * shrink, a * v * shrink, 0);
        },
        ShellSection{.layers = {{{materials::NeoHookean{mu}, acrylic, 960, {}}, H}}}, 0);
    disc.hold(disc.side(0, 1), {0, 1, 2, 3, 4, 5});
    disc.hold(disc.side(1, 1), {0, 1, 2, 3, 4, 5});
    disc.hold(disc.side(0, 0), {0, 4, 5});
    disc.hold(disc.side(1, 0), {1, 3, 5});
    disc.number();
    const double expected = H * std::sqrt(14.68 * mu * H * H / 3 / (a * a) / acrylic.permittivity);
    const double factor =
        critical_factor(disc, [&](State& state, double f) { state.voltage = {f * expected}; });
    EXPECT_NEAR(factor, 1, 0.0025); // 0.5 % of the voltage's square
  }
}

// A cantilever of length L: P = pi^2 E I/(4 L^2).
TEST(EulerColumn, buckles_at_the_critical_load) {
  const double E = 1e6, L = 1, b = 0.1, H = 0.01;
  ShellProblem column(
      8, 1, [=](double u, double v) { return Eigen::Vector3d(L * u, b * v, 0); }, elastic_shell(E, 0, H));
  column.hold(column.side(0, 0), {0, 1, 2, 3, 4, 5});
  column.number();
  column.load_side(column.side(0, 1), 0, -pi * pi * E * b * H * H * H / 12 / (4 * L * L));
  EXPECT_NEAR(critical_factor(column, [&](State& state, double f) { state.dead_force = f * column.load(); }),
              1, 0.005);
}

/// Tip of a clamped plate that a load across bends by a third of its length and one in its plane shears.
Eigen::Vector3d tip(double drilling, const std::function<bool(int node)>& keeps_spins) {
  ShellSection section = elastic_shell(1e6, 0.3, 0.05);
  section.drilling = drilling;
  ShellProblem plate(
      4, 3, [](double u, double v) { return Eigen::Vector3d(u, 0.8 * v, 0); }, section);
  plate.hold(plate.side(0, 0), {0, 1, 2, 3, 4, 5});
  for (int n = 0; n < plate.model().dofs.node_count(); ++n)
    if (keeps_spins(n)) plate.model().dofs.keep_spins(n);
  plate.number();
  plate.load_side(plate.side(0, 1), 2, 10);
  plate.load_side(plate.side(0, 1), 1, 300);
  EXPECT_EQ(plate.raise(1, 5, 0, 1e-12).end, RampEnd::complete);
  return plate.displacement(plate.node(1, 1));
}

// What holds spins about directors to the film costs a little energy where its rotation jumps from one
// element to the next: three spins give what tilts give as that goes to nothing.
TEST(Tilts, give_what_three_spins_give) {
  const auto none = [](int) { return false; };
  const auto all = [](int) { return true; };
  const auto some = [](int node) { return node % 3 == 0; };
  const Eigen::Vector3d tilts = tip(1e-3, none);
  EXPECT_GT(tilts.z(), 0.25);
  EXPECT_GT(std::abs(tilts.y()), 1e-3);
  EXPECT_EQ(tilts, tip(1, none)) << "nothing drills";
  EXPECT_LT((tip(1e-9, all) - tilts).norm(), 1e-9 * tilts.norm());
  EXPECT_LT((tip(1e-9, some) - tilts).norm(), 1e-9 * tilts.norm());
  const double apart = (tip(1e-3, all) - tilts).norm();
  EXPECT_GT(apart, 1e-9 * tilts.norm());
  EXPECT_LT(apart, 1e-4 * tilts.norm());
  EXPECT_NEAR((tip(1e-4, all) - tilts).norm(), apart / 10, 0.02 * apart);
}

} // namespace
} // namespace dielast::fem::shells_test
