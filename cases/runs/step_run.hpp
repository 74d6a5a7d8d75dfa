// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/loads/step_loads.hpp"
#include "fem/paths/instability.hpp"
#include "post/step_record.hpp"

namespace dielast::cases {

/// Where a step stands between two accepted states: with it, it goes on bit for bit.
struct StepProgress {
  fem::RampProgress ramp;
  std::optional<fem::ContinuationProgress> followed; ///< a path past a critical point, while it is followed
  std::vector<fem::PathPoint> folds;                 ///< limit points of paths that were followed
  int jumps = 0;
};

/// How an accepted state was reached.
enum class Reached {
  along_path,
  to_its_end, ///< along the path to a critical point from which the device goes elsewhere, or nowhere
  by_jump,
};

/// Whether events of this kind are critical points: "limit point" or "bifurcation".
bool is_critical(const std::string& kind);

/// What a step tells of itself; every member may be left out.
struct StepObserver {
  std::function<void(double load_factor)> on_try;
  std::function<void(const fem::Iteration&)> on_iteration;
  std::function<void(double load_factor, const fem::NewtonResult&)> on_cutback;
  /// A critical point has been located; the event says what it is.
  std::function<void(const fem::CriticalPoint&, const post::Event&)> on_critical;
  /// Whether physics allows a state under load control; a step that gets to no other one gives up.
  std::function<bool(double load_factor, const fem::State&)> admits;
  /// Says where the film cannot stretch any more in the state at which load control ends; empty: nowhere.
  std::function<std::string(const fem::State&)> law_limit;
  /// Returns false to stop here (interrupt). Dashpots of the state are frozen.
  std::function<bool(const fem::State&, const fem::Increment&, Reached)> on_accept;
  /// In a jump and in the search for a critical point, where no state is accepted: false to stop here
  /// (interrupt).
  std::function<bool()> goes_on;
};

enum class Ending { complete, gave_up, interrupted };

/// Kind of an interrupt in a jump or in the search for a critical point, where no run begins.
inline constexpr const char* between_states = "between states";

struct Outcome {
  Ending ending = Ending::complete;
  /// gave_up: "limit point", "instability", "singular tangent", "no equilibrium", ...; interrupted:
  /// empty or between_states
  std::string kind{};
  std::string message{}; ///< gave_up: what happened and what to do
};

/// Complete, unless something meets no stiffness in the last state of a run: where it is found is of
/// rounding.
Outcome end_at_rest(fem::Equilibrium& equilibrium, const fem::State& last);

/// What on_instability of a step that stops may be instead.
struct WaysOn {
  bool follow = false, jump = false;
  /// Empty: nothing.
  std::string words() const;
};

/// Takes a device through one step: under load control and, where that ends, along the path by arclength or
/// to the next stable state, as the step wants it.
class StepRun {
 public:
  StepRun(fem::Equilibrium& equilibrium, const Step& step, const fem::LoadPath& path,
          const fem::RampOptions& options, StepProgress& progress, const StepObserver& observer,
          WaysOn ways_on)
      : equilibrium_(equilibrium), step_(step), path_(path), options_(options), progress_(progress),
        observer_(observer), ways_on_(ways_on), accepted_{progress.ramp.load_factor, last()} {}

  Outcome run();

 private:
  struct Trouble {
    fem::RampResult ramp;                       ///< how load control ended
    std::optional<fem::CriticalPoint> critical; ///< where, if it could be located
    int unstable_modes = 0;                     ///< of a state that was reached and is not accepted
  };
  bool timed() const { return options_.duration > 0; }
  bool goes_on() {
    interrupted_ = interrupted_ || (observer_.goes_on && !observer_.goes_on());
    return !interrupted_;
  }
  const fem::Model& model() const { return equilibrium_.model(); }
  const fem::State& last() const { return progress_.ramp.points.back().state; }
  fem::State loaded(fem::State state, double s) const;
  bool accept(const fem::State& state, const fem::Increment& increment, Reached reached);
  bool on_ramp(const fem::RampProgress& now, const fem::Increment& increment);
  bool stops() const { return step_.on_instability == OnInstability::stop && !options_.inertia; }
  bool finds_by_arclength(fem::Instability kind) const;
  bool comes_back(const fem::ContinuationProgress& now, const fem::CriticalPoint& critical);
  std::optional<fem::CriticalPoint> locate(double s, bool another);
  std::optional<fem::CriticalPoint> limit_in_time() const;
  void announce(const fem::CriticalPoint& critical, bool ends);
  bool pass(fem::CriticalPoint critical);
  void accept_critical(const fem::CriticalPoint& critical);
  std::optional<Outcome> leave(const Trouble& trouble);
  fem::ContinuationOptions arcs() const;
  std::optional<Outcome> follow();
  std::optional<Outcome> end_of_branch(int unstable_modes);
  /// Loads and a state from which to jump, along a direction in the free equations.
  struct Departure {
    double load_factor;
    fem::State state;
    Eigen::VectorXd direction;
  };
  std::vector<Departure> departures(const Trouble& trouble);
  std::optional<Outcome> jump(const Trouble& trouble);
  std::string load_text(const fem::State& at, double s) const;
  std::string load_text(double s) const;
  std::vector<std::size_t> lost_film(double s) const;
  bool moves_freely() const;
  /// Whether all that moves is slack film, or what carries it.
  bool is_slack() const { return equilibrium_.is_slack(last()) && equilibrium_.film_moves_all(); }
  Outcome failure(const Trouble& trouble) const;
  Outcome singular() const;
  Outcome cause(const Trouble& trouble, WaysOn ways_on) const;

  fem::Equilibrium& equilibrium_;
  const Step& step_;
  const fem::LoadPath& path_;
  const fem::RampOptions& options_;
  StepProgress& progress_;
  const StepObserver& observer_;
  const WaysOn ways_on_;           ///< for messages
  fem::PathPoint accepted_;        ///< the last accepted state and its load factor
  std::optional<Trouble> leaving_; ///< the step leaves its path
  bool interrupted_ = false;       ///< between states, see StepObserver::goes_on
};

} // namespace dielast::cases
