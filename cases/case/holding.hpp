// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/case.hpp"

#include <initializer_list>
#include <vector>

namespace dielast::cases {

/// What holds the device in a step.
struct Holding {
  std::vector<char> supports; ///< which of the case's
  /// Where there is nothing else, pins against rigid motion. They bear nothing while all forces balance, and
  /// with inertia let go: then masses keep the device where it is.
  bool pins = false;

  bool operator==(const Holding&) const = default;
};

/// What holds in this step (its number). An analysis is about the state as the step before has left it: no
/// support lets go or takes hold in it.
Holding holding_in(const Case& one, const std::vector<Step>& steps, int step);

/// Whether a support (its number) holds in a step of one of these kinds.
bool holds_in_any(const Case& one, std::size_t support, std::initializer_list<StepKind> kinds);

/// The case with what holds then alone.
Case held_by(Case one, const Holding& holding);

/// Whether no support, body or table holds the device while these supports do.
bool is_free(const Case& one, const std::vector<char>& supports);

} // namespace dielast::cases
