// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/identify_spec.hpp"
#include "cases/fitting/rational.hpp"

#include <algorithm>

namespace dielast::cases {

/// [[rational]]: a rational function of s = i omega, or a circuit, is fitted to a measured response
struct RationalFit {
  std::filesystem::path file; ///< as written
  MeasuredResponse response{};
  RationalOrder order;
  std::array<bool, 3> elements{}; ///< of a FilmCircuit, instead of an order
  FrequencyTable measured;

  int element_count() const { return static_cast<int>(std::ranges::count(elements, true)); }
  bool is_circuit() const { return element_count() > 0; }
  int unknowns() const { return is_circuit() ? element_count() : order.poles + order.zeros + 1; }
  /// What tables and plots call it.
  std::string name() const { return file.stem().string(); }
};

/// A file of such fits.
struct RationalFits {
  std::string title;
  std::filesystem::path source;
  std::vector<RationalFit> fits;
};

} // namespace dielast::cases
