// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/fitting/fit_solver.hpp"

#include <array>
#include <complex>
#include <string>
#include <vector>

namespace dielast::cases {

/// A measured frequency response: values at frequencies, Hz.
struct FrequencyTable {
  std::vector<double> hertz;
  std::vector<std::complex<double>> value;
};

/// What is to be found: (b_m s^m + ... + b_0) / (s^n + a_(n-1) s^(n-1) + ... + a_0), s = i 2 pi f.
struct RationalOrder {
  int poles = 0, zeros = 0; ///< n, m
};

/// Elements of the circuit of an electrode, in the order of `elements` below: the impedance
/// resistance + 1 / (1 / leakage_resistance + s capacitance).
struct FilmCircuit {
  std::array<bool, 3> elements{}; ///< which there are; without a resistance 0, without a leakage none
  bool admittance = false;        ///< the table has 1 over the impedance
};
enum class CircuitElement { resistance, leakage_resistance, capacitance };

/// A number of a fit, with its 95 % interval.
struct FittedNumber {
  std::string name, unit;
  FittedParameter number; ///< SI; its start is of no interest
};

struct RationalOutcome {
  FitEnding ending{};
  int iterations = 0;
  std::vector<FittedNumber> numbers; ///< of a circuit its elements; otherwise the value at rest, frequencies
                                     ///< and damping ratios of poles and zeros
  std::vector<double> numerator, denominator; ///< in powers of s, the highest first; of a circuit those of
                                              ///< what the table has
  std::vector<std::complex<double>> model;    ///< for each row
  double deviation = 0;                       ///< s of the relative errors
  double error = 0;                           ///< their rms
  bool stable = true;                         ///< all poles are in the left half plane
};

/// Least squares of (model - measured) / |measured|, by Levenberg-Marquardt (Ceres), from the start that the
/// iteration of Sanathanan & Koerner 1963 (IEEE Trans. Autom. Control 8, 56) gives. Intervals: see
/// fit_statistics.hpp; those of poles and zeros to first order. More numbers than unknowns are needed.
RationalOutcome fit_rational(const FrequencyTable& measured, const RationalOrder& order, int max_iterations);

/// Likewise, in the logarithms of the elements.
RationalOutcome fit_circuit(const FrequencyTable& measured, const FilmCircuit& circuit, int max_iterations);

} // namespace dielast::cases
