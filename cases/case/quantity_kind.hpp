// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/state.hpp"

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dielast::cases {

struct Case;
struct Quantity;
struct Device;
struct Key;
struct Measured;
struct Probing;

/// A quantity on a device, ready to be read from any state of it; in SI, NaN where it has no meaning.
using Probe = std::function<double(const Measured&)>;
/// One that the shape alone tells.
using Shape = std::function<double(const fem::State&)>;

/// Numbers that a measurement keeps of a quantity between states.
using KeptNumbers = std::map<std::string, double>;

/// All that is known of a kind of quantity, once: what a case file may say of it, what it is in words, its
/// value. Of `shape`, `probe` and `so_far` each kind has one; what few have is null by default.
struct QuantityKind {
  std::string word;
  std::string meaning;
  std::string unit{};                                          ///< SI, "1" for a pure number
  std::vector<Key> (*keys)() = nullptr;                        ///< besides its name and when it is read
  std::string (*in_words)(const Quantity& quantity) = nullptr; ///< for a person who did not write the case

  Shape (*shape)(const Probing& probing) = nullptr;
  Probe (*probe)(const Probing& probing) = nullptr;
  /// Of another quantity's course, which has the value `now`; `time`: s.
  double (*so_far)(KeptNumbers& kept, const Quantity& quantity, double now, double time) = nullptr;

  /// Its unit where what it is of tells; `all`: the quantities of the case.
  std::string (*unit_by)(const Quantity& quantity, const std::vector<Quantity>& all) = nullptr;
  /// Its value by that of its shape now and at the end of the step since which it counts, or as drawn.
  double (*since)(double now, double then) = nullptr;
  /// What begins at the end of the step since which it counts, of a course; `time`: s.
  void (*begin)(KeptNumbers& kept, double time) = nullptr;
  /// A shape's derivative, over all equations.
  Eigen::VectorXd (*gradient)(const Probing& probing, const fem::State& state) = nullptr;
  /// What is wrong with it in a case; what leaves it without a value there, or with one to be warned of.
  /// Empty: nothing.
  std::string (*refusal)(const Case& one, const Quantity& quantity) = nullptr;
  std::string (*idle)(const Case& one, const Quantity& quantity) = nullptr;
  /// Whether it is a work or heat, known no better than the balance of energies.
  bool (*of_balance)(const Quantity& quantity) = nullptr;
  /// What is said of it instead of an estimate of its error. Empty: there is one.
  std::string (*without_error)(const Quantity& quantity) = nullptr;

  bool shares = false;                     ///< a mean over its place, by the shares of the nodes
  bool directed = false;                   ///< its gradient is that along an axis
  bool fields = false;                     ///< read from the samples of a state
  bool extreme = false;                    ///< the smallest or largest value of a field
  bool of_run = false;                     ///< told at the end of a run, by the margins to its limits
  bool relative = false;                   ///< a change that is shown in %
  bool vibrates = false;                   ///< about small vibrations
  bool of_shells = true, of_solids = true; ///< such have it, as membranes do
  std::optional<std::array<double, 2>> orders = {}; ///< smallest and largest order with which its error goes
                                                    ///< with the elements' size; absent: the unknowns' own
};

/// All kinds. Those with a gradient stand in the order in which the first quantity is taken for a response.
std::span<const QuantityKind> quantity_kinds();

} // namespace dielast::cases
