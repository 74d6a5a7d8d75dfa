#pragma once

#include "cases/measurement.hpp"
#include "cases/watch.hpp"
#include "fem/ramp.hpp"

#include <functional>

namespace dielast::cases {

/// Where a simulation stands between two increments: with it, it goes on bit for bit.
struct SimulationProgress {
  int step = 0;    ///< number of the current step, from 0
  int records = 0; ///< accepted states so far, the drawn one included
  fem::RampProgress ramp;
  std::map<std::string, double> rest_lengths;
  std::set<std::string> active_events;
};

/// An accepted state.
struct Frame {
  const post::StepRecord& record;
  const Measured& measured;
  const std::vector<double>& values; ///< of the quantities, in the case's order, SI
  bool ends_step = false;
};

/// Watches a simulation; every member may be left out.
struct SimulationObserver {
  std::function<void(const Step&)> on_step;
  std::function<void(double load_factor)> on_try;
  std::function<void(const fem::Iteration&)> on_iteration;
  std::function<void(double load_factor, const fem::NewtonResult&)> on_cutback;
  /// Returns false to stop here (interrupt).
  std::function<bool(const Frame&)> on_accept;
};

enum class Ending { complete, gave_up, interrupted };

struct Outcome {
  Ending ending = Ending::complete;
  std::string kind{};    ///< gave_up: "limit point", "singular tangent", "no equilibrium"
  std::string message{}; ///< gave_up: what happened and what to do
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
  const fem::Timings& timings() const { return equilibrium_.timings(); }
  SimulationProgress progress() const;
  void resume(const SimulationProgress& progress);
  /// Values of the quantities, each at the end of the step that it is read at; NaN where that did not happen.
  const std::vector<double>& results() const { return results_; }
  void set_results(std::vector<double> results) { results_ = std::move(results); }

 private:
  fem::RampTarget target(int step, const fem::RampTarget& start) const;
  fem::RampOptions options(const Step& step) const;
  Eigen::VectorXd frame_force();
  bool accept(const SimulationObserver& observer, const Step& step, const fem::State& state,
              double load_factor, const fem::NewtonResult& newton);
  Outcome failure(const Step& step, const fem::RampResult& result, const fem::RampTarget& target) const;

  const Case& case_;
  Device device_;
  fem::Equilibrium equilibrium_;
  Measurement measurement_;
  Watch watch_;
  std::vector<Step> steps_;
  Eigen::VectorXd
      frame_force_; ///< dead forces by which a frame holds the free nodes as drawn, until the release
  std::vector<double> results_;
  int step_ = 0, records_ = 0;
  fem::RampProgress ramp_;
};

} // namespace dielast::cases
