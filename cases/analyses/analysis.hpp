// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/device.hpp"
#include "fem/linear/harmonic.hpp"

#include <complex>
#include <string_view>

namespace dielast::cases {

/// What a step of kind "modes" or "harmonic" has found: a table, and shapes to look at.
struct Analysis {
  StepKind kind{};
  std::string step;                ///< its name
  std::string of;                  ///< harmonic: the quantity that responds
  std::vector<std::string> driven; ///< harmonic: the electrodes whose sources swing
  /// With units, as in history.csv; harmonic: about a bias U, the same for all sources, the last one is the
  /// response per U^2, its slope over 2 |U|.
  std::vector<std::string> columns;
  double bias = 0; ///< U, V; 0 where there is none
  std::vector<std::vector<double>> rows;
  /// A shape and its name, a vector per mesh node: displacement of a mode, scaled to one, or of a sine of 1 V
  /// in phase and a quarter period behind (m/V).
  struct Shape {
    std::string name;
    std::vector<Eigen::Vector3d> displacement, spin; ///< spins about the state, of bars
  };
  std::vector<Shape> shapes{}; ///< not kept in a checkpoint

  std::vector<double> column(std::size_t number) const;
  /// Complex values of harmonic's columns `magnitude` and the phase behind it.
  std::vector<std::complex<double>> values(std::size_t magnitude) const;
};

/// What is said of responses of a quantity that are zero, though the device may move; `key` names it.
std::string no_response(const std::string& quantity, std::string_view key, bool device_moves);

/// Equal ratios from the lowest to the highest frequency, Hz.
std::vector<double> frequencies(const Sweep& sweep);

/// The state that small vibrations go about: sources behind their circuits. Electrodes that are isolated stay
/// so and leak, but for those whose sources are `driven`: these take up at the electrode's voltage.
fem::State operating_point(const Device& device, fem::State state, const std::vector<std::size_t>& driven);

/// Throws AnalysisError where the state is not at rest.
void require_rest(fem::Equilibrium& equilibrium, const fem::State& state);

/// Throws AnalysisError about an unstable state: there what is disturbed grows, and no sine answers a sine,
/// whatever the linear equations give. A tangent that cannot be factored is that of what nothing holds but
/// its inertia.
void require_stable(fem::Equilibrium& equilibrium, const fem::State& state);

/// Numbers of the electrodes whose sources swing together: the named ones, without names all whose [drive]
/// has a voltage, without any such all.
std::vector<std::size_t> driven_ports(const Case& one, const std::vector<std::string>& names);

/// Their sources swing by 1 V each. Throws AnalysisError where one is isolated: it has no source.
fem::HarmonicDrive common_drive(const Device& device, const fem::State& at,
                                const std::vector<std::size_t>& ports);

/// Small vibrations about a state. Throws AnalysisError where there are none to be found.
Analysis analyse(const Case& one, const Device& device, fem::Equilibrium& equilibrium,
                 const fem::State& state, const Step& step);

/// An analysis that the state does not admit; says why.
struct AnalysisError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace dielast::cases
