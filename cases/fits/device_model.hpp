// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/identify_spec.hpp"

#include <complex>
#include <map>

namespace dielast::cases {

/// What the case gives for every row of every test, runs of tests with the same settings made once.
class DeviceModel {
 public:
  explicit DeviceModel(const Identification& asked);

  /// Groups of tests with the same settings; each takes one run.
  std::size_t run_count() const { return groups_.size(); }
  const std::vector<std::size_t>& tests_of(std::size_t run) const { return groups_[run]; }

  /// Model values of the tests of a run, one test after another; of a response real and imaginary parts in
  /// turn. `values`: of the unknowns, in their own units. Throws CaseError and other exceptions that say why
  /// there is none.
  std::vector<double> run(std::size_t run, const std::vector<double>& values) const;

 private:
  const Identification& asked_;
  std::vector<std::vector<std::size_t>> groups_;
};

} // namespace dielast::cases
