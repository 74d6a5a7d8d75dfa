// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"
#include "cases/fitting/fit_solver.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace dielast::cases {

/// [[test]]: a measured table, and how it was measured
struct FitTest {
  std::filesystem::path file; ///< as written
  materials::Mode kind{};
  std::string stretch_column, stress_column, time_column; ///< empty: the usual ones
  std::string strain_column, displacement_column;         ///< instead of the stretch; empty: not these
  std::string force_column;                               ///< instead of the stress; empty: not this
  std::optional<double> length;                           ///< m, of the specimen, for the displacement
  std::optional<double> area;                             ///< m^2, undeformed cross-section, for the force
  std::optional<double> rate;                             ///< 1/s, of the stretch, where there is no time
  bool equilibrium = false;                               ///< infinitely slow
  bool zero = false;                                      ///< the first row is the origin
  bool predict = false;
  double weight = 1;
  MeasuredTest measured;  ///< of the file
  std::string doubt;      ///< what may be meant otherwise in its file; empty: nothing
  std::vector<int> lines; ///< of the file, one for each row

  /// What tables and plots call it.
  std::string name() const { return file.stem().string(); }
};

/// A fit file: [fit], [[test]] and the [film.material] that it starts from
struct Fit {
  std::string title;
  std::filesystem::path source;
  Film film;                           ///< only its material is read
  std::vector<std::string> parameters; ///< names, see fit_parameters.hpp
  std::vector<bool> keeps_viscosity;   ///< of every branch: given by it, or it is a parameter
  double range = 0;
  int max_iterations = 0;
  std::vector<FitTest> tests;
};

} // namespace dielast::cases
