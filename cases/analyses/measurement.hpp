// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/analyses/course.hpp"
#include "cases/analyses/film_values.hpp"
#include "cases/devices/device.hpp"
#include "fem/paths/energy_balance.hpp"

#include <map>
#include <string>
#include <vector>

namespace dielast::cases {

/// A state, with what is needed to measure it.
struct Measured {
  /// Without fields, samples and extremes are empty.
  Measured(const Device& device, fem::Equilibrium& equilibrium, const fem::State& state,
           const fem::EnergyBalance& energy, bool with_fields = true);

  fem::Equilibrium& equilibrium;
  bool may_rest = true; ///< asked for stiffness and vibrations, where it is at rest; not on the way in time

  const fem::State& state;
  fem::Samples samples;
  post::Extremes extremes;  ///< of these samples
  Eigen::VectorXd reaction; ///< of supports on the device at held equations (see DofMap), N and N m
  fem::Charges charges;
  const fem::EnergyBalance& energy;
};

/// Evaluates the quantities of a case on the states of a device.
class Measurement {
 public:
  /// Throws CaseError where a quantity is of a point beside the film.
  Measurement(const Case& one, const Device& device);

  /// All quantities, in the case's order and in SI; NaN where one has no meaning yet (an elongation since a
  /// step that has not ended).
  std::vector<double> all(const Measured& measured);

  /// Sees a state that is not recorded: for what depends on the course (see is_of_course).
  void pass(const Measured& measured);
  bool follows_course() const;
  /// Whether that is of quantities that are measured on fields.
  bool follows_fields() const;

  /// Says that a step ended in this state: elongations and displacements since it start here.
  void step_ended(const std::string& step, const Measured& measured);

  /// Lengths and displacements that quantities are relative to, and courses so far; stored with a checkpoint.
  References references;

 private:
  /// Whose course a quantity follows.
  const Quantity& subject(const Quantity& quantity) const;
  double evaluate(const Quantity& quantity, const Measured& measured) const;
  double length(const Quantity& quantity, const fem::State& state) const;
  double displacement(const Quantity& quantity, const fem::State& state) const;
  /// What a unit force along an axis, spread evenly over a place, moves: per free unknown, and its mean over
  /// the place, m/N.
  struct Flexibility {
    Eigen::VectorXd displacement;
    double own;
  };
  Flexibility flexibility(const std::string& place, int along, const Measured& measured) const;
  double coupling(const Quantity& quantity, const Measured& measured) const;
  double modal_stiffness(const Quantity& quantity, const Measured& measured) const;
  /// Where a value of a field is read; `key`: the quantity's path.
  std::vector<FilmReading> readings_of(const Quantity& quantity, const std::string& key,
                                       const fem::Samples& drawn) const;
  FinLoad fin_load(const Quantity& quantity, const fem::State& state) const;
  std::size_t electrode(const std::string& name) const;
  /// Which triangles belong to a place: its own, or those with a node there.
  const std::vector<char>& film_at(const std::string& place) const;

  const Case& case_;
  const Device& device_;
  std::map<std::string, std::vector<FilmReading>> readings_; ///< by quantity
  std::map<std::string, ElementPoint> points_;               ///< likewise, of displacements
  std::map<std::string, double> prestretch_;                 ///< by quantity of kind stretch, along its axis
  mutable std::map<std::string, std::vector<char>> film_at_;
};

} // namespace dielast::cases
