// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/results/further_way.hpp"

#include "cases/console/terminal.hpp"
#include "cases/runs/phases.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace dielast::cases {

std::optional<double> factor_of(const std::vector<double>& voltages, const post::StepRecord& end) {
  const double largest = end.largest_voltage();
  const auto lead = static_cast<std::size_t>(std::ranges::find(end.voltages, largest) - end.voltages.begin());
  const double factor = voltages[lead] / largest;
  for (std::size_t e = 0; e < end.voltages.size(); ++e)
    if (std::abs(voltages[e] - factor * end.voltages[e]) > 1e-6 * std::abs(largest)) return std::nullopt;
  return factor;
}

FurtherWay::FurtherWay(const Case& one, const Simulation& own, const post::StepRecord& end, int threads)
    : one_(one), further_(one), steps_(own.steps()), end_(end), threads_(threads) {
  begin(own.progress(), 1);
}

bool FurtherWay::begin_at(const Passed& state) {
  if (state.record < 0) return false;
  Simulation simulation(one_, threads_);
  SimulationObserver observer;
  bool reached = false;
  observer.on_accept = [&](const Frame& frame) {
    reached = frame.record.index >= state.record;
    return !reached && !interrupted();
  };
  observer.goes_on = [] { return !interrupted(); };
  simulation.run(observer);
  if (!reached) return false;
  begin(simulation.progress(), state.factor);
  return true;
}

std::vector<Passed> FurtherWay::to(double factor, std::string& stopped) {
  located_.clear();
  constexpr int increments_per_voltage = 20;
  const Place& from =
      *std::ranges::min_element(places_, {}, [&](const Place& p) { return std::abs(p.factor - factor); });
  std::vector<double> voltages = end_.voltages;
  for (double& voltage : voltages) voltage *= factor;
  std::vector<Passed> way;
  try {
    if (!simulation_) {
      simulation_.emplace(further_, threads_);
      simulation_->enter(from.progress.step);
    }
    Simulation& simulation = *simulation_;
    simulation.resume(from.progress);
    simulation.lead_to(voltages, std::max(1, static_cast<int>(std::ceil(increments_per_voltage *
                                                                        std::abs(factor - from.factor)))));
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      way.push_back(state_of(frame));
      return !interrupted();
    };
    observer.goes_on = [] { return !interrupted(); };
    observer.on_critical = [&](const fem::CriticalPoint& critical, const post::Event&) {
      if (const auto at = factor_of(critical.state.voltage, end_); at && !critical.beyond)
        located_.push_back({critical.kind == fem::Instability::bifurcation, *at});
    };
    const Outcome outcome = simulation.run(observer);
    if (outcome.ending == Ending::gave_up) stopped = outcome.kind;
    if (outcome.ending == Ending::interrupted) stopped = "interrupted";
    if (outcome.ending == Ending::complete && !way.empty() && stopped.empty()) {
      SimulationProgress progress = simulation.progress();
      progress.step = places_.front().progress.step; // the same step leads on
      places_.push_back({way.back().factor, std::move(progress)});
    }
  } catch (const std::exception& error) {
    stopped = error.what();
  }
  return way;
}

std::optional<Passed> FurtherWay::at(double factor) {
  std::string stopped;
  std::vector<Passed> way = to(factor, stopped);
  if (way.empty() || !stopped.empty() || std::abs(way.back().factor - factor) > 1e-9) return std::nullopt;
  return way.back();
}

Passed FurtherWay::state_of(const Frame& frame) const {
  const auto value = [&](const char* field, post::Extreme which) {
    const auto found = frame.measured.extremes.find(field, which);
    return found ? found->value : Passed::unknown;
  };
  return {.factor = factor_of(frame.record.voltages, end_).value_or(Passed::unknown),
          .breakdown = value("breakdown_ratio", post::Extreme::maximum),
          .least_stress = value("min_principal_stress", post::Extreme::minimum),
          .yield = value("yield_ratio", post::Extreme::maximum),
          .slack = value("tension_state", post::Extreme::maximum)};
}

void FurtherWay::begin(SimulationProgress progress, double factor) {
  further_.steps = steps_;
  progress.step = std::min(progress.step, static_cast<int>(steps_.size()) - 1);
  const std::vector<char> holding = holding_in(one_, steps_, progress.step).supports;
  for (std::size_t i = 0; i < holding.size(); ++i) // goes on holding
    further_.supports[i].until = holding[i] ? "" : one_.supports[i].until;
  further_.steps.resize(static_cast<std::size_t>(progress.step) + 1);
  progress.in_step.followed.reset();
  progress.in_step.ramp.load_factor = 1; // the way goes on from its state, wherever the step has ended
  Step step{.kind = StepKind::voltage, .name = "margins"};
  for (const Step& before : further_.steps)
    if (!before.is_analysis()) step.response = before.response;
  further_.steps.push_back(step);
  places_ = {{factor, std::move(progress)}};
  simulation_.reset();
}

} // namespace dielast::cases
