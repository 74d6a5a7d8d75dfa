// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/fitting/fit_misfit.hpp"

#include <map>

namespace dielast::cases {

/// Where an attempt starts: coordinates, and those that the solver shall see as logarithms, with their sign.
struct FitStart {
  Eigen::VectorXd q;
  std::map<std::size_t, double> signs{};
};

/// Of any sign, and not a modulus.
bool is_exponent(const FitParameter& parameter);

/// Whether a parameter is a limit of its law, and has gone so far beyond `start` that it limits nothing.
bool has_run_away(const FitParameter& parameter, const Coordinate& coordinate, double q, double start);

/// Starts other than `q`: relaxation times spread evenly, in their logarithms, from the shortest time between
/// rows to the duration of the tests, moduli and viscosities scaled to the measured stresses. Curves have the
/// shape of that of `q`, and others where the law has exponents, which follow one another as in rubber, or
/// where a limit has run away at `ended`: the limit comes near the largest stretch.
std::vector<FitStart> other_starts(const FitTask& task, const std::vector<Coordinate>& coordinates,
                                   const std::vector<int>& steps, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& ended);

} // namespace dielast::cases
