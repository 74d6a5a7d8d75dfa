// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace dielast::test {

/// A case file of tests/verification/error_estimates, with overrides.
struct EstimatedCase {
  std::string file;
  std::vector<std::string> overrides;
  int finer = 4; ///< by how much elements and time steps of the reference are smaller
};

/// A quantity with an estimate, and that of the reference.
struct EstimatedValue {
  std::string label, quantity;
  std::string kind; ///< kind of quantity, as the table of docs/verification.md names it
  double value = 0, reference = 0;
  double printed = 0; ///< estimated error as people read it: not below 1e-6 of the value

  double error() const;
  bool holds() const { return error() <= printed; }
};

/// What the estimates of some cases came to.
struct EstimateCount {
  std::vector<EstimatedValue> values;
  std::vector<std::string> without; ///< "case: quantity: why" where there is no estimate
};

/// Forty cases of all devices, element orders and kinds of steps.
std::vector<EstimatedCase> estimated_cases();

/// Eight of the kind that take seconds.
std::vector<EstimatedCase> quick_estimated_cases();

/// Runs a case and the reference, and adds what its estimates are. Quantities that have no discretisation
/// error (below 1e-9 of the value) are left out.
void add_estimates(const EstimatedCase& one, EstimateCount& count);

/// Part of the values whose error is below the printed one.
double share(const std::vector<EstimatedValue>& values);

/// Median of printed over true error.
double median_ratio(const std::vector<EstimatedValue>& values);

/// One line for every value whose error is above the printed one, and for every one without an estimate.
std::string exceptions(const EstimateCount& count);

/// Markdown table by kind: how many, the share, the median of printed over true error.
std::string table(const EstimateCount& count);

} // namespace dielast::test
