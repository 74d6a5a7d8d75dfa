// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/devices/device.hpp"
#include "cases/loads/signals.hpp"
#include "fem/paths/ramp.hpp"

namespace dielast::cases {

/// What the steps of a case do to the loads of its device.
class StepLoads {
 public:
  /// `signals`: what loads follow in transients instead of what the case says of them. `frame_force`: dead
  /// forces by which a frame holds the free nodes as drawn, until a step releases them.
  StepLoads(const Case& one, const Device& device, const std::vector<Step>& steps, const Signals& signals,
            Eigen::VectorXd frame_force);

  /// Connects and isolates electrodes as the step wants; what becomes isolated keeps its charge.
  void begin(int step, fem::State& state) const;
  /// From the loads `start` on: straight to the goals of a ramp, along the waves of a transient.
  fem::LoadPath path(int step, const fem::Loads& start) const;
  fem::RampOptions options(int step) const;
  /// Of the dead forces of a state on the way of a release from the loads `start` those that are gone at its
  /// end: the frame's, and those of supports that let go.
  Eigen::VectorXd cut(int step, const fem::Loads& start, const fem::State& state) const;

  /// Forces of supports that the step lets go, dead when it begins and zero when it ends; empty: none.
  Eigen::VectorXd let_go{};

 private:
  fem::Supply isolated(const Step& step, std::size_t electrode) const;
  fem::Supply supply(const Step& step, std::size_t electrode) const;
  /// What a ramp leads to, or a transient has at t; nothing where the step is not about it.
  static std::optional<double> goal_of(const Step& step, const std::optional<Waveform>& wave, Instant t);
  std::optional<double> goal_of(const Step& step, std::size_t electrode, std::optional<Waveform> Drive::*part,
                                Instant t) const;
  /// What a load follows in a transient; null: what the case says of it.
  const Signal* signal_of(const Step& step, const DrivenLoad& load) const;
  void connect_chamber(const Step& step, const fem::Charges& held, fem::State& state) const;
  const Drive* drive(std::size_t electrode) const;
  /// Kinds of the steps up to this one.
  bool happened(int step, StepKind kind) const;
  Eigen::VectorXd dead_force(int number, Instant t) const;
  void move(const Step& step, Eigen::VectorXd& held, Instant t) const;
  fem::Loads at(int step, const fem::Loads& start, Instant t) const;
  /// Has electrodes stand still on the way of a ramp while as much leaks as their sources give.
  void limit_sources(fem::LoadPath& path, const fem::Loads& from, const fem::Loads& to) const;
  /// What is left of `let_go`: ramps lead to nothing.
  double left(const Step& step, Instant t) const;
  /// Kinks of waves that are as good as one, s.
  struct Break {
    double first = 0, last = 0;
  };
  /// All of them in a step that takes time, in order; the first begins with it, the last ends with it.
  std::vector<Break> breaks(const Step& step) const;

  const Case& case_;
  const Device& device_;
  const std::vector<Step>& steps_;
  const Signals& signals_;
  Eigen::VectorXd frame_force_;
};

} // namespace dielast::cases
