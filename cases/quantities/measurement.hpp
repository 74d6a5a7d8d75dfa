// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/quantities/probing.hpp"
#include "post/step_record.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dielast::cases {

/// What an extreme of a field was where it has been farthest in a run, and how steep there, see
/// post::rise_at().
struct Farthest {
  double value = std::numeric_limits<double>::quiet_NaN(); ///< NaN: it has had none
  double rise = 0;
};

/// Evaluates the quantities of a case on the states of a device.
class Measurement {
 public:
  /// Throws CaseError where the device does not have what a quantity is of, such as film at a point.
  Measurement(const Case& one, const Device& device);

  /// Makes what is measured ready again: the device was made again, in its place.
  void prepare();

  /// Scalars of which quantities need the extremes.
  std::vector<std::string> scalars() const;

  /// All quantities of the next accepted state, in the case's order and in SI; NaN where one has no meaning
  /// yet (an elongation since a step that has not ended).
  std::vector<double> all(const Measured& measured);

  /// One of them, by its number in the case; NaN of those of another's course, too.
  double value(std::size_t number, const Measured& measured) const;

  /// How steep an extreme of a field is where it lies, see post::rise_at(), and one whose course is followed
  /// where it had its peak, or in the mean; of other quantities 0.
  double rise(std::size_t number, const Measured& measured) const;

  /// Of every extreme that is not read at one step's end; of other quantities nothing.
  std::vector<Farthest> farthest() const;

  /// Of a mean over time, how far it may be off for what lies between the states; of other quantities 0.
  double error_of_course(const Quantity& quantity) const { return kept_of(quantity, "error").value_or(0); }

  /// Says that a step ended in this state: elongations and displacements since it start here.
  void step_ended(const std::string& step, const Measured& measured);

  /// Lengths and displacements that quantities are relative to, and courses so far; stored with a checkpoint.
  std::map<std::string, KeptNumbers> kept; ///< by the quantity's name
  /// Of every quantity, from where the first of the case's own steps sets out; NaN where it has had no value.
  /// Stored with a checkpoint.
  std::vector<post::Peak> peaks;

 private:
  void begin_peaks();
  void begin(const Quantity& course, double time);
  void note_farthest(const Quantity& quantity, double now, const Measured& measured);
  void note_rise_of_course(const Quantity& quantity, double now, double value, const Measured& measured);
  double rise_of(const Quantity& quantity, const Measured& measured) const;
  std::optional<double> kept_of(const Quantity& quantity, const std::string& name) const;
  /// The number of the quantity whose course one follows.
  std::size_t subject(const Quantity& quantity) const;

  const Case& case_;
  const Device& device_;
  std::vector<Shape> shapes_; ///< by quantity; empty: it has a probe, or is a course
  std::vector<Probe> probes_;
  std::vector<double> drawn_; ///< of shapes that count since some step: their value as drawn
  /// The components of a displacement since some step whose magnitude is asked for, and their shapes.
  struct Components {
    std::array<Quantity, 3> quantities;
    std::array<Shape, 3> shapes;
  };
  std::map<std::size_t, Components> magnitudes_; ///< by quantity
};

/// A quantity with a gradient as a row over the free equations.
Eigen::VectorXd response_row(const Case& one, const Device& device, const fem::State& state,
                             const Quantity& quantity);

} // namespace dielast::cases
