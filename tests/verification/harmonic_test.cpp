// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/harmonic.hpp"

#include "tests/fem/diaphragm.hpp"

#include <numbers>

namespace dielast::fem::harmonic_test {
namespace {

using Complex = Linearisation::Complex;

/// Amplitudes A of the part Im(A exp(i omega t)) of the plate's height and of the electrode's voltage.
struct Fundamental {
  Complex height, voltage;
};

/// Integrates the sine 1 V about `bias` in time until the start has died out, then takes the last period.
Fundamental steady_oscillation(const test::Diaphragm& diaphragm, Equilibrium& equilibrium, const State& rest,
                               double hertz) {
  constexpr int per_period = 400;
  constexpr double dies_out = 1.6; // s
  const int periods = static_cast<int>(std::ceil(dies_out * hertz)) + 1;
  const double bias = rest.source[0];
  const auto node = static_cast<std::size_t>(diaphragm.mesh.node_sets.at("inner").front());
  const RampOptions options{.newton = {.tolerance = 1e-11},
                            .increments = periods * per_period,
                            .duration = periods / hertz,
                            .time_tolerance = 1e9, // equal steps
                            .inertia = true};
  LoadPath path;
  path.apply = [&](State& state, double s) {
    state.source[0] = bias + std::sin(2 * std::numbers::pi * periods * s);
  };
  Fundamental sum{};
  RampObserver observer;
  observer.on_accept = [&](const RampProgress& progress, const Increment& increment) {
    if (increment.load_factor * periods > periods - 1 + 1e-9) {
      const State& at = progress.points.back().state;
      const double angle = 2 * std::numbers::pi * periods * increment.load_factor;
      const Complex turn = Complex(0, 2.0 / per_period) * std::polar(1.0, -angle);
      sum.height += turn * (at.displacement[node].z() - rest.displacement[node].z());
      sum.voltage += turn * (at.voltage[0] - rest.voltage[0]);
    }
    return true;
  };
  RampProgress progress = RampProgress::begin(rest, diaphragm.model.dofs, options);
  EXPECT_EQ(ramp(equilibrium, path, options, progress, observer).end, RampEnd::complete);
  return sum;
}

// 40 kPa and a branch of 15 kPa, 0.05 s; 100 g, damped; 1.87 MOhm, so that RC = 4.5 ms; 2.5 kV.
TEST(Harmonic, equals_the_steady_state_of_the_transient) {
  const test::Diaphragm diaphragm(
      {.damping = 1.596,
       .branches = {{materials::NeoHookean{15e3}, materials::Dashpot::log, 15e3 * 0.05}},
       .circuit = {{.resistance = 1.87e6, .leakage = 1e-9, .charge_scale = 6e-6}},
       .elements = 6});
  Equilibrium equilibrium(diaphragm.model, 1);
  const State rest = diaphragm.settled(equilibrium, 2500);
  const Linearisation linear(equilibrium, rest);
  const auto same = [](Complex transient, Complex harmonic, double hertz) {
    const Complex ratio = transient / harmonic;
    EXPECT_NEAR(std::abs(ratio), 1, 1e-3) << hertz << " Hz";
    EXPECT_NEAR(std::arg(ratio) * 180 / std::numbers::pi, 0, 0.1) << hertz << " Hz";
  };
  for (const double hertz : {0.1, 5.0, 6.0, 10.0, 50.0}) {
    const double omega[] = {2 * std::numbers::pi * hertz};
    const auto harmonic =
        harmonic_response(linear, HarmonicDrive::at_port(diaphragm.model, 0), omega).front();
    const Fundamental transient = steady_oscillation(diaphragm, equilibrium, rest, hertz);
    same(transient.height, harmonic.displacement[diaphragm.plate], hertz);
    same(transient.voltage, harmonic.voltage[0], hertz);
    // The current through the resistance is what the electrode takes up and what leaks.
    const Complex current = (1.0 - harmonic.voltage[0]) / 1.87e6;
    EXPECT_LT(std::abs(harmonic.current[0] - current), 1e-9 * std::abs(current));
  }
}

} // namespace
} // namespace dielast::fem::harmonic_test
