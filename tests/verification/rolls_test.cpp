// SPDX-License-Identifier: GPL-3.0-or-later
// The antagonistic rolls of the gallery against their reduced model: one unknown, the tip's angle; the hinge
// an arc of a circle, rigid ribbons that turn freely at their ends (Nagai & Shintake's Eqs. 2-27, with the
// kinematics of each side instead of Eq. 18, and the hinge's length in Eq. 7). And against the same rolls
// with leaves that bend as they must.
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/values_at_end.hpp"

#include <Eigen/LU>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace dielast::cases::rolls_test {
namespace {

/// Of the gallery's rolls with these keys, rad.
double tip_angle(const std::vector<std::string>& overrides) {
  const Case one = read_case(
      std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/antagonistic_rolls/case.toml", overrides);
  Simulation simulation(one, 1);
  EXPECT_EQ(simulation.run({}).ending, Ending::complete);
  for (std::size_t q = 0; q < one.quantities.size(); ++q)
    if (one.quantities[q].name == "tip_angle") return simulation.results()[q];
  return NAN;
}

struct Rolls {
  double voltage = 2000;
  double lower_voltage = 0;
  double hinge_length = 1e-3, hinge_thickness = 50e-6, film_thickness = 100e-6, prestretch = 1.05;

  static constexpr double arm = 0.4e-3, ribbon = 2e-3, length = 21e-3;
  /// How far the end of a roll has moved along the backbone, on the outer side (1) or the inner one (-1).
  double elongation(double side, double angle) const {
    const double turn = side * angle, out = hinge_thickness / 2 + arm;
    const double radius = hinge_length / turn;
    const double across = -radius * (1 - std::cos(turn)) + out * std::cos(turn);
    const auto reach = [](double gap) { return std::sqrt(ribbon * ribbon - gap * gap); };
    return (radius + out) * std::sin(turn) - reach(out + arm - across) - (hinge_length - reach(arm));
  }
  /// Stretches of the upper and the lower roll.
  std::array<double, 2> stretches(double angle) const {
    return {prestretch + elongation(1, angle) / length, prestretch + elongation(-1, angle) / length};
  }
  /// What the film of a roll stores at a stretch, less what its source gives, J.
  double roll_energy(double stretch, double volts) const {
    const double excess = stretch * stretch + 2 / stretch - 3;
    const double capacitance = 2.8 * 8.8541878128e-12 * 2 * 125.83e-3 * 15e-3 / film_thickness;
    return (17e3 + (3.86e3 - 68.9 * excess) * excess) * excess * length * 141e-3 * 2 * film_thickness -
           capacitance * stretch * volts * volts / 2;
  }
  /// E I of a leaf, N m^2.
  static double stiffness(double modulus, double thickness) {
    return modulus * 5e-3 * std::pow(thickness, 3) / 12;
  }
  double hinge() const { return stiffness(3.3e9, hinge_thickness); }
  static double one_ribbon() { return stiffness(2.675e9, 25e-6); }
  /// Energy at the tip's angle (rad, positive where the upper roll is the longer), J.
  double energy(double angle) const {
    const auto [upper, lower] = stretches(angle);
    const double bending = hinge() / hinge_length + 2 * one_ribbon() / ribbon;
    return roll_energy(upper, voltage) + roll_energy(lower, lower_voltage) + bending * angle * angle / 2;
  }
  /// Minimum by bisection of the torque.
  double angle() const {
    constexpr double d = 1e-5;
    double low = 2 * d, high = 0.7;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (energy(middle + d) > energy(middle - d) ? high : low) = middle;
    }
    return low;
  }
  /// Of the finite elements.
  double solved(const char* ribbons = "links") const {
    return tip_angle(
        {fmt::format("drive.upper.voltage={} V", voltage), fmt::format("hinge.length={} m", hinge_length),
         fmt::format("hinge.thickness={} m", hinge_thickness),
         fmt::format("film.thickness={} m", film_thickness), fmt::format("film.prestretch={}", prestretch),
         fmt::format("antagonistic_rolls.ribbons='{}'", ribbons)});
  }
};

constexpr double degree = 0.017453292519943295;

TEST(AntagonisticRolls, TheReducedModelHasItsPublishedNumbers) {
  EXPECT_NEAR(Rolls{.voltage = 1200}.angle(), 4.1817 * degree, 5e-4 * degree);
  EXPECT_NEAR(Rolls{}.angle(), 11.2578 * degree, 5e-4 * degree);
}

/// The hinge under the rolls' pull bends more easily than to an arc: by 1.2 % where it is straight.
TEST(AntagonisticRolls, TurnTheTipAsTheReducedModelSays) {
  for (const double voltage : {400.0, 800.0, 1200.0, 2000.0}) {
    const Rolls rolls{.voltage = voltage};
    EXPECT_NEAR(rolls.solved(), rolls.angle(), (voltage < 1000 ? 0.012 : 0.01) * rolls.angle()) << voltage;
  }
}

/// Thinner and thinner ribbons that are as hard to stretch turn as links: what clamps them reaches as far as
/// they are thick. Links need no elements for that (they were clamped with a trace of stiffness: 2e-4).
TEST(AntagonisticRolls, ThinRibbonsTurnAsLinks) {
  const auto angle = [](double thickness, const char* ribbons, int elements) {
    return tip_angle({"drive.upper.voltage=2 kV", fmt::format("ribbon.thickness={} um", thickness),
                      fmt::format("ribbon.material.youngs_modulus={} GPa", 2.675 * 25 / thickness),
                      fmt::format("antagonistic_rolls.ribbons='{}'", ribbons),
                      fmt::format("mesh.wall_elements={}", elements)});
  };
  const double links = angle(1, "links", 8);
  EXPECT_NEAR(angle(1, "links", 32), links, 1e-6 * links);
  EXPECT_NEAR(2 * angle(1, "beams", 200) - angle(2, "beams", 200), links, 2e-4 * links);
}

/// Where the hinge is far from buckling under the rolls' pull.
TEST(AntagonisticRolls, AndSoInTheSweepsOfThePaper) {
  std::vector<Rolls> sweep;
  for (const double length : {0.25e-3, 0.5e-3, 2e-3}) sweep.push_back({.hinge_length = length});
  for (const double thickness : {75e-6, 100e-6}) sweep.push_back({.hinge_thickness = thickness});
  for (const double thickness : {80e-6, 150e-6, 200e-6}) sweep.push_back({.film_thickness = thickness});
  for (const Rolls& rolls : sweep)
    EXPECT_NEAR(rolls.solved(), rolls.angle(), 0.03 * rolls.angle())
        << rolls.hinge_length << " " << rolls.hinge_thickness << " " << rolls.film_thickness;
}

/// The rolls with leaves that bend as elasticas do, without extension: the slope of the hinge along its
/// length, and where ribbons are `beams` those of both ribbons, are polynomials that make the energy
/// stationary; multipliers keep the ribbons' ends on the rolls' axes. Links take their bending with the
/// hinge, and their ends turn freely.
struct Elasticas {
  Rolls rolls;
  bool beams = false;

  static constexpr int hinge_terms = 4, ribbon_terms = 6;
  int terms() const { return beams ? hinge_terms + 2 * ribbon_terms : hinge_terms; }
  int unknowns() const { return beams ? terms() + 2 : terms(); }

  /// Ends of a leaf from the origin along x, turned by its slope (`first` at its beginning), and int
  /// slope'^2.
  struct Leaf {
    double along = 0, across = 0, curvature = 0;
  };
  static Leaf leaf(double length, double first, const Eigen::VectorXd& slope) {
    static constexpr std::array nodes{0.1252334085114689, 0.3678314989981802, 0.5873179542866175,
                                      0.7699026741943047, 0.9041172563704749, 0.9815606342467192},
        weights{0.2491470458134028, 0.2334925365383548, 0.2031674267230659,
                0.1600783285433462, 0.1069393259953184, 0.0471753363865118};
    Leaf end;
    for (std::size_t g = 0; g < 12; ++g) {
      const double x = (1 + (g < 6 ? -1 : 1) * nodes[g % 6]) / 2, w = weights[g % 6] / 2;
      double angle = first, bend = 0, power = 1;
      for (Eigen::Index k = 0; k < slope.size(); ++k, power *= x) {
        bend += static_cast<double>(k + 1) * slope[k] * power / length;
        angle += slope[k] * power * x;
      }
      end.along += w * length * std::cos(angle);
      end.across += w * length * std::sin(angle);
      end.curvature += w * length * bend * bend;
    }
    return end;
  }

  /// Energy over 1 uJ, with the multipliers' constraints.
  double lagrangian(const Eigen::VectorXd& q) const {
    const double drawn = std::asin(Rolls::arm / Rolls::ribbon), out = rolls.hinge_thickness / 2 + Rolls::arm;
    const Leaf hinge = leaf(rolls.hinge_length, 0, q.head(hinge_terms));
    const double turn = q.head(hinge_terms).sum();
    const double with_links = beams ? 0 : 2 * Rolls::one_ribbon() * rolls.hinge_length / Rolls::ribbon;
    double energy = (rolls.hinge() + with_links) * hinge.curvature / 2;
    for (const int side : {1, -1}) {
      double along = hinge.along + side * out * std::sin(turn);
      const double gap =
          out + Rolls::arm - (out * std::cos(turn) - side * hinge.across); // to the roll's axis
      if (beams) {
        const Leaf ribbon =
            leaf(Rolls::ribbon, drawn + side * turn,
                 q.segment(side > 0 ? hinge_terms : hinge_terms + ribbon_terms, ribbon_terms));
        energy += Rolls::one_ribbon() * ribbon.curvature / 2 +
                  0.1 * q[terms() + (side < 0)] * (ribbon.across - gap);
        along -= ribbon.along;
      } else {
        along -= std::sqrt(Rolls::ribbon * Rolls::ribbon - gap * gap);
      }
      const double moved = along - rolls.hinge_length + Rolls::ribbon * std::cos(drawn);
      energy += rolls.roll_energy(rolls.prestretch + moved / Rolls::length,
                                  side > 0 ? rolls.voltage : rolls.lower_voltage);
    }
    return 1e6 * energy;
  }

  /// The tip's angle, by Newton's method with differences.
  double angle() const {
    constexpr double d = 1e-4, longest = 0.3;
    const int n = unknowns();
    Eigen::VectorXd q = Eigen::VectorXd::Zero(n);
    for (int iteration = 0; iteration < 60; ++iteration) {
      const auto at = [&](int i, double by, int j = 0, double other = 0) {
        Eigen::VectorXd there = q;
        there[i] += by;
        there[j] += other;
        return lagrangian(there);
      };
      Eigen::VectorXd gradient(n);
      Eigen::MatrixXd hessian(n, n);
      for (int i = 0; i < n; ++i) {
        gradient[i] = (at(i, d) - at(i, -d)) / (2 * d);
        for (int j = 0; j <= i; ++j)
          hessian(i, j) = hessian(j, i) =
              (at(i, d, j, d) - at(i, d, j, -d) - at(i, -d, j, d) + at(i, -d, j, -d)) / (4 * d * d);
      }
      Eigen::VectorXd step = -hessian.fullPivLu().solve(gradient);
      const double size = step.head(terms()).cwiseAbs().maxCoeff();
      q += std::min(1.0, longest / size) * step;
      if (size < 1e-6) break;
    }
    return q.head(hinge_terms).sum();
  }
};

/// What the reduced model misses is the shape of its leaves: a hinge that the rolls press is no arc, and a
/// ribbon that is clamped to the tip and pulled bends near its end.
TEST(AntagonisticRolls, BendTheirLeavesAsElasticas) {
  EXPECT_NEAR((Elasticas{{.voltage = 1200}}.angle()), 4.2206 * degree, 1e-3 * degree);
  std::vector<Rolls> all{{.voltage = 1200}, {}};
  for (const double prestretch : {1.1, 1.2}) all.push_back({.prestretch = prestretch});
  for (const double length : {0.25e-3, 2e-3}) all.push_back({.hinge_length = length});
  for (const double thickness : {25e-6, 100e-6}) all.push_back({.hinge_thickness = thickness});
  for (const double thickness : {80e-6, 200e-6}) all.push_back({.film_thickness = thickness});
  for (const Rolls& rolls : all) {
    const double angle = Elasticas{rolls}.angle();
    EXPECT_NEAR(rolls.solved(), angle, (rolls.prestretch > 1.15 ? 0.01 : 0.003) * angle)
        << rolls.voltage << " " << rolls.prestretch << " " << rolls.hinge_length << " "
        << rolls.hinge_thickness << " " << rolls.film_thickness;
  }
  for (const double voltage : {1200.0, 2000.0}) {
    const Rolls rolls{.voltage = voltage};
    const double angle = Elasticas{rolls, true}.angle();
    EXPECT_NEAR(rolls.solved("beams"), angle, 0.003 * angle) << voltage;
  }
}

/// The robot's tail with the tip's angle alone: a fin that turns about the middle of the hinge, in
/// Runge-Kutta steps. Means of thrust and power over the cycles behind the first ones.
struct Tail {
  double frequency;
  static constexpr double pi = 3.14159265358979323846;

  /// Angular acceleration, thrust and power.
  std::array<double, 3> at(double time, double angle, double rate) const {
    const double swing = 500 * std::sin(2 * pi * frequency * time);
    const Rolls rolls{.voltage = 500 + swing, .lower_voltage = 500 - swing};
    constexpr double d = 1e-6;
    const double off = std::abs(angle) < 3e-5 ? 3e-5 : 0; // the arc has no radius where it is straight
    const double turn = angle + off;
    double torque = -(rolls.energy(turn + d) - rolls.energy(turn - d)) / (2 * d);
    if (off > 0) { // from both sides
      const double other = angle - off;
      torque = torque / 2 - (rolls.energy(other + d) - rolls.energy(other - d)) / (4 * d);
    }
    // eta beside the law, E:  3 eta dlambda/dt / lambda^2 over the drawn section
    const auto more = rolls.stretches(turn + d), less = rolls.stretches(turn - d),
               now = rolls.stretches(turn);
    for (const std::size_t roll : {0, 1}) {
      const double slope = (more[roll] - less[roll]) / (2 * d);
      torque -= 3 * 50 * slope * slope * rate / (now[roll] * now[roll]) * Rolls::length * 141e-3 * 200e-6;
    }
    // Fin from 0.5 to 15.5 mm behind the middle of the hinge; 0.01 m high, in water.
    const double front = 0.5e-3, back = 15.5e-3;
    const double mass = 1000 * pi / 4 * 1e-4, drag = 1000 * 2 * 0.01 / 2; // per length
    const double second = mass * (std::pow(back, 3) - std::pow(front, 3)) / 3;
    const double own = 6e-10 + 30e-6 * std::pow(7.5e-3, 2);
    const double resistance = drag * std::abs(rate) * rate * (std::pow(back, 4) - std::pow(front, 4)) / 4;
    const double acceleration = (torque - resistance) / (own + second);
    const double force = mass * acceleration * (back * back - front * front) / 2 +
                         drag * std::abs(rate) * rate * (std::pow(back, 3) - std::pow(front, 3)) / 3;
    return {acceleration, -force * std::sin(angle), (second * acceleration + resistance) * rate};
  }

  std::array<double, 2> means(int before, int cycles) const {
    constexpr int steps = 400; // per cycle
    const double h = 1 / (frequency * steps);
    double angle = 0, rate = 0, thrust = 0, power = 0;
    for (int n = 0; n < (before + cycles) * steps; ++n) {
      const double t = n * h;
      const auto a = at(t, angle, rate);
      const auto b = at(t + h / 2, angle + h / 2 * rate, rate + h / 2 * a[0]);
      const double rate_b = rate + h / 2 * a[0], rate_c = rate + h / 2 * b[0];
      const auto c = at(t + h / 2, angle + h / 2 * rate_b, rate_c);
      const double rate_d = rate + h * c[0];
      const auto d = at(t + h, angle + h * rate_c, rate_d);
      if (n >= before * steps) thrust += a[1], power += a[2];
      angle += h / 6 * (rate + 2 * rate_b + 2 * rate_c + rate_d);
      rate += h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]);
    }
    return {thrust / (cycles * steps), power / (cycles * steps)};
  }
};

/// The hinge under the rolls' pull lets the tip swing 1.6 % further, 0.0527 rad at 1 Hz; power goes with its
/// cube and with the fourth power of the distance from where it turns.
TEST(AntagonisticRolls, BeatTheirFinAsATailThatOnlyTurnsDoes) {
  for (const double frequency : {1.0, 5.0}) {
    const Case one =
        read_case(std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/antagonistic_rolls/robot.toml",
                  {fmt::format("drive.upper.voltage.frequency={} Hz", frequency),
                   fmt::format("drive.lower.voltage.frequency={} Hz", frequency),
                   fmt::format("step.start.duration={} s", 4 / frequency),
                   fmt::format("step.swim.duration={} s", 4 / frequency)});
    const auto values = test::values_at_end(one);
    const auto [thrust, power] = Tail{frequency}.means(4, 4);
    EXPECT_NEAR(values.at("mean_thrust"), thrust, 0.05 * thrust) << frequency;
    EXPECT_NEAR(values.at("mean_power"), power, 0.09 * power) << frequency;
    EXPECT_LT(values.at("energy_error"), 1e-6 * values.at("stored_energy"));
  }
}

} // namespace
} // namespace dielast::cases::rolls_test
