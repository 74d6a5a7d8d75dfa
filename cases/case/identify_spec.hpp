// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <complex>
#include <filesystem>
#include <string>
#include <vector>

namespace dielast::cases {

/// What a step of kind "harmonic" answers a small sine with; none: a quantity is measured instead.
enum class MeasuredResponse { none, displacement, impedance, admittance };
/// SI unit of what a table of that response has.
const char* unit_of(MeasuredResponse response);

/// Which state a row at an instant at which something jumps was measured in.
enum class AtJump { unsaid, before, after };

/// [[identify.test]]: what was measured on the device
struct DeviceTest {
  std::filesystem::path file;  ///< as written
  std::string quantity;        ///< of the case; empty: a response
  MeasuredResponse response{}; ///< displacement: of the step's quantity, per squared volt, m/V^2
  std::string step;            ///< of the case, in which it was measured; empty: not said
  AtJump at_jump{};
  std::vector<std::string> settings; ///< "key=value", of this test alone
  bool predict = false;              ///< kept out of the fit
  double weight = 1;
  std::string against;                        ///< column of the history, or "frequency"
  std::vector<std::string> bare;              ///< columns without a unit, with that in which they are taken
  std::vector<double> x;                      ///< SI, of a frequency Hz
  std::vector<std::complex<double>> measured; ///< SI; of a quantity real

  bool is_response() const { return response != MeasuredResponse::none; }
  /// What tables and plots call it.
  std::string name() const { return file.stem().string(); }
};

/// A key of the case whose value is looked for, in the unit in which the case gives its start.
struct Unknown {
  std::string key;
  double start = 0;
  std::string unit; ///< "": a pure number

  /// "key=value unit", as after --set.
  std::string assignment(double value) const;
};

/// [identify]: keys of a case are fitted to what was measured on the device
struct Identification {
  std::string title;
  std::filesystem::path source; ///< the file with the [identify] section
  std::filesystem::path base;   ///< the case
  std::vector<std::string> keys;
  std::vector<Unknown> unknowns; ///< of the keys
  double range = 0;
  int max_iterations = 0;
  std::vector<DeviceTest> tests;

  /// Rows that are fitted, of a response two numbers each.
  std::size_t fitted_numbers() const;
};

} // namespace dielast::cases
