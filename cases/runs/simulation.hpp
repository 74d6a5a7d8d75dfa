// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/analyses/analysis.hpp"
#include "cases/case/holding.hpp"
#include "cases/quantities/measurement.hpp"
#include "cases/runs/step_run.hpp"
#include "cases/runs/watch.hpp"
#include "fem/equilibrium/unseen_motion.hpp"
#include "fem/paths/energy_balance.hpp"

#include <functional>

namespace dielast::cases {

/// What a simulation has come through so far.
struct Taken {
  int states = 0;     ///< accepted ones, the drawn one included, recorded or not
  int iterations = 0; ///< of Newton's method that led to them
};

/// The time steps of a run.
struct TimeSteps {
  int count = 0;
  double error = 0; ///< the sum of what each of them may have added, relative
};

/// Where a simulation stands between two increments: with it, it goes on bit for bit.
struct SimulationProgress {
  int step = 0;    ///< number of the current step, from 0
  int records = 0; ///< recorded states so far, the drawn one included
  StepProgress in_step;
  fem::EnergyBalance::Record energy;
  std::map<std::string, KeptNumbers> kept; ///< see Measurement
  std::set<std::string> active_events;
  TimeSteps time_steps{};
  Eigen::VectorXd let_go{};                   ///< see StepLoads
  std::vector<std::vector<double>> signals{}; ///< what each of them keeps
  fem::UnseenMotion unseen{};                 ///< of the current step
  std::vector<post::Peak> peaks{};            ///< see Measurement
  std::vector<post::Event> news{};            ///< for the next record
  Taken taken{};
  std::optional<fem::Increment> unrecorded{}; ///< that led to the last accepted state
};

/// An accepted state.
struct Frame {
  const post::StepRecord& record;
  const Measured& measured;
  const std::vector<double>& values; ///< of the quantities, in the case's order, SI
  bool ends_step = false;
  bool ends_path = false; ///< a critical point: what the device does there comes next, and no run begins here
};

/// Watches a simulation; every member may be left out.
struct SimulationObserver {
  std::function<void(const Step&)> on_step;
  std::function<void(double load_factor)> on_try;
  std::function<void(const fem::Iteration&)> on_iteration;
  std::function<void(double load_factor, const fem::NewtonResult&)> on_cutback;
  std::function<void(const fem::CriticalPoint&, const post::Event&)> on_critical;
  /// Returns false to stop here (interrupt).
  std::function<bool(const Frame&)> on_accept;
  /// Left out where nobody wants the analyses: then they are not made.
  std::function<void(const Analysis&, const fem::State&)> on_analysis;
  /// The same as on_accept, at an accepted state that is not recorded, in a jump and in the search for a
  /// critical point.
  std::function<bool()> goes_on;
};

/// Takes a case through its steps.
class Simulation {
 public:
  /// Meshes and builds the model. `threads`: 0 uses every core. The case must outlive this. Throws as
  /// build_device().
  Simulation(const Case& one, int threads);

  /// Runs all steps, or goes on where progress() was restored to.
  Outcome run(const SimulationObserver& observer);

  const Device& device() const { return device_; }
  fem::Equilibrium& equilibrium() { return *equilibrium_; }
  /// The last accepted state.
  const fem::State& state() const { return in_step_.ramp.points.back().state; }
  const fem::Timings& timings() const { return equilibrium_->timings(); }
  SimulationProgress progress() const;
  /// Makes the device that it is in a step (by its number), with the supports that hold then.
  void enter(int step);
  /// The device must be that of the step. Whatever this has done before, it goes on from there.
  void resume(const SimulationProgress& progress);
  /// Lets the last step, one of kind "voltage", lead to other voltages (of every electrode), in so many
  /// increments. The device is the one that it will be in that step.
  void lead_to(const std::vector<double>& voltages, int increments);
  /// What the user should know before looking at results, one sentence each.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// The steps that are taken, one that nobody wrote included.
  const std::vector<Step>& steps() const { return steps_; }
  /// Values of the quantities, each at the end of the step that it is read at; NaN where that did not happen.
  const std::vector<double>& results() const { return results_; }
  /// How steep those are there that are extremes of fields, see post::rise_at(); of others 0.
  const std::vector<double>& rises() const { return rises_; }
  /// Works, heat and how well they are resolved.
  const fem::EnergyBalance& energy() const { return energy_; }
  /// Sum of the errors that the time steps may have added to internal variables and motion, relative.
  const TimeSteps& time_steps() const { return time_steps_; }
  const Taken& taken() const { return taken_; }
  /// What a mean over time may be off for the states that it is made of, in its unit; of others 0.
  double error_of_course(const Quantity& quantity) const;
  /// Of the quantities, see Measurement.
  const std::vector<post::Peak>& peaks() const { return measurement_.peaks; }
  std::vector<Farthest> farthest() const { return measurement_.farthest(); }
  void set_results(std::vector<double> results, std::vector<double> rises) {
    results_ = std::move(results);
    rises_ = std::move(rises);
  }

 private:
  Eigen::VectorXd frame_force();
  bool come_to_rest(fem::State& state);
  void change_supports(fem::State& state);
  bool pins_bear(const fem::State& given);
  void catch_what_moves(const fem::State& state, fem::EnergyBalance::Record& record);
  bool refuses(const Step& step, double load_factor, const char* kind, const std::string& why);
  bool admits(const Step& step, double load_factor, const fem::State& state);
  bool leads(const Step& step, double load_factor, const fem::State& state);
  void come_to(const fem::State& state);
  bool sample(const Step& step, double load_factor, Measured& measured);
  bool accept(const SimulationObserver& observer, const Step& step, const fem::State& state,
              const fem::Increment& increment, Reached reached);
  void account(const fem::State& state, const fem::Increment& increment, Reached reached);
  bool record(const SimulationObserver& observer, const Step& step, Measured& measured,
              const fem::Increment& increment, Reached reached = Reached::along_path);
  std::vector<post::Event> events(const Step& step, const Measured& measured, const fem::Increment& increment,
                                  Reached reached, bool ends = false);
  std::vector<double> voltages(const fem::State& state) const;

  const Case& case_;
  int threads_;
  Holding holding_; ///< what holds the device now
  Case now_;        ///< the case with that alone
  Device device_;   ///< of it
  std::optional<fem::Equilibrium> equilibrium_;
  Measurement measurement_;
  Signals signals_;
  Watch watch_;
  post::WantedScalars scalars_; ///< of which extremes are needed
  std::vector<Step> steps_;
  std::vector<std::string> warnings_;
  std::optional<Outcome> refusal_; ///< of a state that no physics allows
  Eigen::VectorXd frame_;          ///< see StepLoads
  std::optional<StepLoads> loads_;
  std::vector<double> results_, rises_;
  int step_ = 0, records_ = 0;
  Taken taken_;
  StepProgress in_step_;
  std::vector<post::Event> news_; ///< for the next record
  fem::EnergyBalance energy_;
  std::optional<fem::Increment> unrecorded_; ///< that led to the last accepted state
  TimeSteps time_steps_;
  fem::UnseenMotion unseen_; ///< of the current step
  fem::State accounted_;     ///< the last state in energy_
  fem::Holding held_;        ///< what holds it
};

} // namespace dielast::cases
