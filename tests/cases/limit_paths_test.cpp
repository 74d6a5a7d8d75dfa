// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/loads/step_loads.hpp"
#include "fem/paths/instability.hpp"
#include "tests/campaign.hpp"
#include "tests/cases/limit_cases.hpp"

#include <memory>
#include <optional>

// Discs, balloons and diaphragms under random loads, with random increments: they end where the path does.
// The truth is the path by arclength from the beginning of the last step; where a chamber is closed, of which
// arclength knows nothing, many more increments.

namespace dielast::cases::limit_paths_test {
namespace {

/// A device and its loads; the last step is what is looked at.
struct Draw {
  std::string device;
  std::vector<std::string> steps; ///< their kinds, in order
  double voltage = 0;             ///< V
  bool instantaneous = false;     ///< the last step, as to the dashpots
  bool closed = false;            ///< a chamber is

  /// The case file, with the last step in time where that is wanted.
  std::string text(int increments, bool timed) const {
    std::string all = device;
    if (timed)
      all += fmt::format(
          "[drive]\nvoltage = {{ wave = \"trapezoid\", to = \"{} V\", rise = \"1 s\", hold = \"1 s\", "
          "fall = \"1 s\" }}\n",
          voltage);
    else if (voltage > 0)
      all += fmt::format("[drive]\nvoltage = \"{} V\"\n", voltage);
    for (std::size_t i = 0; i < steps.size(); ++i)
      all += timed && i + 1 == steps.size()
                 ? "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\ninertia = false\n"
                 : fmt::format("[[step]]\nkind = \"{}\"\n", steps[i]);
    if (instantaneous) all += "response = \"instantaneous\"\n";
    return all + fmt::format("increments = {}\n", increments);
  }
};

Draw draw(Dice& dice) {
  Draw drawn;
  std::string law = random_law(dice) + "permittivity = \"4e-11 F/m\"\n";
  const double mu = dice.between(20, 100), prestretch = dice.between(1.1, 2.5),
               voltage = dice.by_ratio(3e3, 6e4);
  drawn.instantaneous = dice.below(4) == 0;
  if (drawn.instantaneous)
    law += fmt::format("[[film.material.branch]]\nshear_modulus = \"{} kPa\"\nrelaxation_time = \"1 s\"\n",
                       mu / 2);
  const auto film = [&](double stretch, const std::string& rest) {
    drawn.device =
        fmt::format("model = \"axisymmetric\"\n[film]\nthickness = \"1 mm\"\nprestretch = {}\n"
                    "[film.material]\n{}[mesh]\nrings = 6\n[output]\nfields = false\nerror_estimate = "
                    "false\n{}",
                    stretch, law, rest);
  };
  const auto either_first = [&](const char* one, const char* other) -> std::vector<std::string> {
    if (dice.below(2)) return {one, other};
    return {other, one};
  };
  /// With the volume (ml); half of them filled with something that gives way.
  const auto filled = [&](double volume) {
    drawn.closed = true;
    return fmt::format("[chamber]\nvolume = \"{} ml\"\n{}", volume,
                       dice.below(2) ? fmt::format("bulk_modulus = \"{} kPa\"\n", dice.by_ratio(10, 1e5))
                                     : "");
  };
  const auto pressed = [&](double pressure) {
    return fmt::format("[chamber]\npressure = \"{} kPa\"\n", pressure);
  };
  const std::string disc = "[disc]\nradius = \"40 mm\"\nelectrode_radius = \"25 mm\"\n",
                    balloon = "[balloon]\nradius = \"20 mm\"\n",
                    electrode = "[[electrode]]\nname = \"film\"\nplace = \"film\"\n";
  switch (dice.below(7)) {
  case 0:
    film(prestretch, disc);
    drawn.voltage = voltage;
    drawn.steps = {"voltage"};
    break;
  case 1:
    film(1, balloon + electrode + pressed(mu * dice.between(0.02, 0.12)));
    drawn.voltage = 0.3 * voltage;
    drawn.steps = either_first("pressure", "voltage");
    break;
  case 2:
    film(1, balloon + filled(dice.by_ratio(40, 2000)));
    drawn.steps = {"inflate"};
    break;
  case 3:
    film(prestretch,
         fmt::format("[annulus]\ninner_radius = \"12 mm\"\nouter_radius = \"50 mm\"\n[plate]\nmass = "
                     "\"{} g\"\n",
                     dice.between(20, 200)));
    drawn.voltage = voltage;
    drawn.steps = {"weight", "voltage"};
    break;
  case 4:
    film(prestretch, disc + pressed(mu * dice.between(0.005, 0.04)));
    drawn.voltage = voltage;
    drawn.steps = either_first("pressure", "voltage");
    break;
  case 5:
    film(prestretch, disc + filled(dice.between(5, 100)));
    drawn.voltage = voltage;
    drawn.steps = {"inflate", "voltage"};
    break;
  default:
    film(1, balloon + electrode + filled(dice.by_ratio(40, 400)));
    drawn.voltage = 0.3 * voltage;
    drawn.steps = either_first("inflate", "voltage");
  }
  return drawn;
}

class LimitPaths : public test::ScratchTest {
 protected:
  struct Run {
    Outcome outcome;
    double load_factor = 0;
    std::vector<Eigen::Vector3d> displacement;
  };
  Case read(const std::string& text) const {
    write("path.toml", text);
    return read_case(directory / "path.toml");
  }
  std::optional<Run> run(const std::string& text) const {
    const Case one = read(text);
    Simulation simulation(one, 1);
    Run result;
    SimulationObserver observer;
    int step = 0;
    observer.on_step = [&](const Step&) { ++step; };
    observer.on_accept = [&](const Frame& frame) {
      result.load_factor = step - std::ssize(one.steps) + frame.record.load_factor;
      return true;
    };
    result.outcome = simulation.run(observer);
    result.displacement = simulation.state().displacement;
    return result;
  }
  /// The case without its last step, run; nothing where that has its limit already.
  std::unique_ptr<Simulation> before_the_last_step(const Case& one) const {
    before_ = one;
    before_.steps.pop_back();
    auto simulation = std::make_unique<Simulation>(before_, 1);
    if (simulation->run({}).ending != Ending::complete) return nullptr;
    return simulation;
  }
  /// By arclength through the last step; nothing where that does not end.
  std::optional<Run> along_the_path(const Case& one, Simulation& simulation) const {
    fem::Equilibrium& equilibrium = simulation.equilibrium();
    const fem::DofMap& dofs = simulation.device().model.dofs;
    const int last = static_cast<int>(one.steps.size()) - 1;
    const Signals signals = signals_of(one);
    const StepLoads loads(one, simulation.device(), one.steps, signals, Eigen::VectorXd::Zero(dofs.count()));
    fem::State state = simulation.state();
    loads.begin(last, state);
    const fem::LoadPath path = loads.path(last, fem::Loads::of(state, dofs));
    path.apply(state, 0);
    state.scheme = one.steps.back().response == Response::instantaneous ? materials::TimeScheme::frozen()
                                                                        : materials::TimeScheme::relaxed();
    const fem::ContinuationOptions arcs{.first_arc = 1e-3, .largest_arc = 1e-2, .most_steps = 5000};
    auto progress = fem::begin_continuation(equilibrium, path, state, 0, arcs);
    if (!progress) return std::nullopt;
    fem::ContinuationProgress former = *progress;
    std::optional<fem::CriticalPoint> critical;
    fem::ContinuationObserver observer;
    observer.on_accept = [&](const fem::ContinuationProgress& now) {
      if (now.newton.unstable_modes > former.newton.unstable_modes)
        critical = fem::locate(equilibrium, path, former, now, {});
      const bool lost = now.newton.unstable_modes > former.newton.unstable_modes;
      former = now;
      return !lost;
    };
    const fem::ContinuationEnd end = fem::continuation(equilibrium, path, arcs, *progress, observer);
    if (critical) return Run{{Ending::gave_up}, critical->load_factor, critical->state.displacement};
    if (end != fem::ContinuationEnd::reached_load || progress->load_factor < 1) return std::nullopt;
    return Run{{}, 1, progress->state.displacement};
  }
  mutable Case before_; ///< of the simulation that was made last

  static double distance(const Run& one, const Run& other) {
    double difference = 0, size = 0;
    for (std::size_t n = 0; n < one.displacement.size(); ++n) {
      difference += (one.displacement[n] - other.displacement[n]).squaredNorm();
      size += other.displacement[n].squaredNorm();
    }
    return std::sqrt(difference / size);
  }
};

TEST_F(LimitPaths, of_devices_end_where_they_end_whatever_the_increments) {
  const int drawn = test::drawn_cases("DIELAST_LIMIT_PATHS", 60);
  Dice dice(20261122);
  int limits = 0, found = 0, unknown = 0, earlier = 0;
  for (int number = 0; found < drawn; ++number) {
    const Draw device = draw(dice);
    const int increments = static_cast<int>(dice.by_ratio(1, 401));
    const bool timed = !device.instantaneous && device.steps.back() == "voltage" && dice.below(4) == 0;
    const std::string text = device.text(increments, timed);
    SCOPED_TRACE(fmt::format("draw {}:\n{}", number, text));
    std::optional<Run> truth;
    try {
      if (device.closed) {
        truth = run(device.text(700, false));
      } else {
        const Case one = read(device.text(1, false));
        const std::unique_ptr<Simulation> simulation = before_the_last_step(one);
        if (!simulation) {
          ++earlier;
          continue;
        }
        truth = along_the_path(one, *simulation);
      }
    } catch (const CaseError&) { // a law that cannot be stretched so far
      continue;
    }
    if (!truth) {
      ++unknown;
      continue;
    }
    ++found;
    const Run ended = *run(text);
    const bool limit = truth->load_factor < 1;
    limits += limit;
    EXPECT_EQ(ended.outcome.ending == Ending::gave_up, limit) << ended.outcome.message;
    EXPECT_NEAR(ended.load_factor, truth->load_factor, timed ? 1e-5 : 2e-6);
    EXPECT_LT(distance(ended, *truth), limit ? 5e-3 : 1e-6);
  }
  EXPECT_GT(limits, drawn / 6);
  EXPECT_LE(unknown, drawn / 20);
  EXPECT_LE(earlier, drawn / 10);
  RecordProperty("limits", limits);
}

} // namespace
} // namespace dielast::cases::limit_paths_test
