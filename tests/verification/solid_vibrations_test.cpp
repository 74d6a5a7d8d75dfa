// SPDX-License-Identifier: GPL-3.0-or-later
// Small vibrations of incompressible solids against closed forms: charged bars along their length, a rod of
// revolution, a cantilever.
#include "cases/devices/device.hpp"
#include "fem/linear/harmonic.hpp"
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace dielast::cases::solid_vibrations_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double mu = 40e3, density = 1000, length = 20e-3, height = 1e-3, permittivity = 3e-11;

class SolidVibrations : public Paths {
 protected:
  /// A slab of the lengths above; `geometry` and `rest` are lines of the case.
  static std::string slab(const std::string& film, const std::string& geometry, int across,
                          const std::string& rest) {
    return fmt::format(
               "[film]\nthickness = \"1 mm\"\n{}\n[film.material]\nshear_modulus = \"40 kPa\"\n"
               "permittivity = \"3e-11 F/m\"\ndensity = \"1000 kg/m^3\"\n[slab]\n{}\n[mesh]\nacross = {}\n"
               "grading = 1\n[output]\nerror_estimate = false\n[[step]]\nkind = \"voltage\"\nincrements = "
               "2\n",
               film, geometry, across) +
           rest;
  }
  static std::string frequency(int mode) {
    return fmt::format("[[quantity]]\nname = \"f{0}\"\nkind = \"natural frequency\"\nmode = {0}\n", mode);
  }
};

const std::string held_at_the_left = "[[support]]\nplace = \"left\"\nfix = [\"x\"]\n"
                                     "[[support]]\nplace = \"bottom\"\nfix = [\"y\"]\n";
const std::string charged = "[drive]\nvoltage = \"10 kV\"\n";

/// In plane strain: mu (l - 1/l^3) = eps (V/H)^2 l along x.
struct ChargedBar {
  explicit ChargedBar(double voltage) : stress(permittivity * voltage * voltage / (height * height)) {
    double low = 1, high = 2;
    for (int i = 0; i < 100; ++i) {
      stretch = (low + high) / 2;
      (mu * (stretch - std::pow(stretch, -3)) < stress * stretch ? low : high) = stretch;
    }
    stiffness = mu * (1 + 3 * std::pow(stretch, -4)) - stress;
    per_volt = length * 2 * stress / voltage * stretch / stiffness;
  }
  /// Of standing waves that are free at one end, its thickness following (Love): each part of the bar also
  /// moves across by its distance from the bottom times the strain.
  double frequency(int mode) const {
    const double wave = (2 * mode - 1) * pi / (2 * length), thin = wave * height / (stretch * stretch);
    return wave * std::sqrt(stiffness / density / (1 + thin * thin / 3));
  }
  double stress, stretch = 1, stiffness = 0, per_volt = 0;
};

/// With the field of layers, and with the potential as unknown; the pressure that keeps the volume follows.
TEST_F(SolidVibrations, charged_bar_rings_as_the_closed_form_says) {
  const ChargedBar bar(10e3);
  for (const bool potential : {false, true}) {
    const auto end = values(
        slab(potential ? "field = \"potential\"" : "", "length = \"20 mm\"\nheight = \"1 mm\"", 4,
             held_at_the_left +
                 (potential ? "[[electrode]]\nname = \"film\"\nplace = \"top\"\nground = \"bottom\"\n" : "") +
                 charged + frequency(1) + frequency(2)));
    EXPECT_NEAR(end.at("f1"), bar.frequency(1), 2e-4 * bar.frequency(1)) << potential;
    EXPECT_NEAR(end.at("f2"), bar.frequency(2), 2e-3 * bar.frequency(2)) << potential;
  }
}

/// At low frequencies the derivative of the static displacement, then more by 1/(1 - (f/f1)^2).
TEST_F(SolidVibrations, charged_bar_answers_a_sine_as_the_closed_form_says) {
  const ChargedBar bar(10e3);
  const Case one = read(slab("", "length = \"20 mm\"\nheight = \"1 mm\"", 4, held_at_the_left + charged));
  Simulation simulation(one, 1);
  std::optional<fem::State> state;
  SimulationObserver observer;
  observer.on_accept = [&](const Frame& frame) {
    state = frame.measured.state;
    return true;
  };
  ASSERT_EQ(simulation.run(observer).ending, Ending::complete);
  const Device& device = simulation.device();
  fem::Equilibrium equilibrium(device.model, 1);
  const fem::Linearisation at(equilibrium, *state);
  const double low = 1e-3 * bar.frequency(1), high = 0.9 * bar.frequency(1);
  const int tip = device.model.dofs.equation(device.mesh.node_sets.at("right").front(), 0);
  const auto responses = fem::harmonic_response(at, fem::HarmonicDrive::at_port(device.model, 0),
                                                std::vector<double>{low, high});
  EXPECT_NEAR(responses[0].displacement[tip].real(), bar.per_volt, 1e-5 * bar.per_volt);
  // Voltage pulls evenly along the bar: tan(k L) / (k L) of the static one, k the wave number.
  const double phase = pi / 2 * 0.9;
  EXPECT_NEAR(responses[1].displacement[tip].real(), bar.per_volt * std::tan(phase) / phase,
              5e-3 * bar.per_volt * std::tan(phase) / phase);
}

/// A bar with a branch of 20 kPa and 0.1 s: at 1/s beside it, the branch resists with
/// 20 kPa 4/l^2 s / (s + 10): it is free of stress as it is.
TEST_F(SolidVibrations, branches_answer_a_sine_as_maxwells_element_does) {
  const ChargedBar bar(10e3);
  for (const bool potential : {false, true}) {
    std::string text =
        slab(potential ? "field = \"potential\"" : "", "length = \"20 mm\"\nheight = \"1 mm\"", 4,
             held_at_the_left +
                 (potential ? "[[electrode]]\nname = \"film\"\nplace = \"top\"\nground = \"bottom\"\n" : "") +
                 charged);
    text.insert(text.find("[slab]"),
                "[[film.material.branch]]\nshear_modulus = \"20 kPa\"\nrelaxation_time = \"0.1 s\"\n");
    const Case one = read(text);
    Simulation simulation(one, 1);
    std::optional<fem::State> state;
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      state = frame.measured.state;
      return true;
    };
    ASSERT_EQ(simulation.run(observer).ending, Ending::complete);
    const Device& device = simulation.device();
    state->scheme = materials::TimeScheme::relaxed();
    state->history = device.model.advanced_history(*state);
    fem::Equilibrium equilibrium(device.model, 1);
    const fem::Linearisation at(equilibrium, *state);
    const int tip = device.model.dofs.equation(device.mesh.node_sets.at("right").front(), 0);
    constexpr double omega = 10;
    const std::complex<double> s(0, omega);
    const double spring = 20e3 * 4 / (bar.stretch * bar.stretch);
    // of the slow bar; inertia takes (omega/omega_1)^2, some 1e-4
    const std::complex<double> expected =
        bar.per_volt * bar.stiffness / (bar.stiffness + spring * s / (s + 10.0));
    const auto responses =
        fem::harmonic_response(at, fem::HarmonicDrive::at_port(device.model, 0), std::vector<double>{omega});
    EXPECT_NEAR(std::abs(responses[0].displacement[tip] - expected), 0, 1e-3 * std::abs(expected))
        << potential;
  }
}

/// Young's modulus of the rod is 3 mu; thin as it is.
TEST_F(SolidVibrations, round_rod_rings_along_its_length) {
  const auto end = values(
      "model = \"axisymmetric\"\n" +
      slab("section = \"solid\"\nstacked_along = \"z\"", "length = \"1 mm\"\nheight = \"20 mm\"", 40,
           "[[support]]\nplace = \"bottom\"\nfix = [\"z\"]\n[drive]\nvoltage = \"1 V\"\n" + frequency(1)));
  const double wave = pi / (2 * length), thin = wave * 1e-3 / 2; // each ring moves by r/2 times the strain
  const double expected = wave * std::sqrt(3 * mu / density / (1 + thin * thin / 2));
  EXPECT_NEAR(end.at("f1"), expected, 2e-4 * expected);
}

/// A block in space, free across: likewise, between the two.
TEST_F(SolidVibrations, block_rings_along_its_length) {
  const auto end = values(
      "model = \"3d\"\n" +
      slab("", "length = \"20 mm\"\nheight = \"1 mm\"\nwidth = \"1 mm\"", 2,
           held_at_the_left + "[[support]]\nplace = \"back\"\nfix = [\"z\"]\n[drive]\nvoltage = \"1 V\"\n" +
               frequency(1)));
  const double wave = pi / (2 * length), thin = wave * height / 2; // across by half the strain, both ways
  const double expected = wave * std::sqrt(3 * mu / density / (1 + 2 * thin * thin / 3));
  EXPECT_NEAR(end.at("f1"), expected, 5e-4 * expected);
}

/// Timoshenko, E/(1 - nu^2) = 4 mu, shear coefficient 5/6; its clamped end keeps its height, too.
TEST_F(SolidVibrations, cantilever_rings_as_a_beam) {
  const auto end = values(slab(
      "", "length = \"20 mm\"\nheight = \"1 mm\"", 4,
      "[[support]]\nplace = \"left\"\nfix = [\"x\", \"y\"]\n[drive]\nvoltage = \"1 V\"\n" + frequency(1)));
  const double root = 1.8751040687;
  const double expected =
      root * root / (length * length) * std::sqrt(4 * mu * height * height / 12 / density);
  EXPECT_NEAR(end.at("f1"), expected, 5e-3 * expected);
}

} // namespace
} // namespace dielast::cases::solid_vibrations_test
