// SPDX-License-Identifier: GPL-3.0-or-later
// What the whole run tells: energies, courses of other quantities, margins to limits.
#include "cases/quantities/probing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dielast::cases {
namespace {

/// A part of the energy balance.
struct EnergyPart {
  const char* word;
  const char* meaning;
  double (*value)(const fem::EnergyBalance& balance);
  bool exchanged = false; ///< a work or heat, not what a state stores
};
using Balance = const fem::EnergyBalance&;
constexpr std::array energy_parts{
    EnergyPart{"electrical_work", "done on the film's electrodes: sum of int Phi dQ",
               [](Balance b) { return b.work().electrical; }, true},
    EnergyPart{
        "mechanical_work",
        "done by loads, moved supports and the pressure in a chamber (on its walls: int p dV of its own "
        "volume, without what it takes to compress the filling); where several loads jump at once they do "
        "so along a straight line",
        [](Balance b) { return b.work().mechanical; }, true},
    EnergyPart{"stored", "elastic, branches, electric and kinetic together",
               [](Balance b) { return b.stored(); }},
    EnergyPart{"elastic",
               "stored by the equilibrium law, walls, springs, contact and what sticks by friction",
               [](Balance b) { return b.parts().elastic; }},
    EnergyPart{"branches", "stored by the springs of the branches",
               [](Balance b) { return b.parts().branches; }},
    EnergyPart{"electric", "stored by the field", [](Balance b) { return b.parts().electric; }},
    EnergyPart{"kinetic", "of everything that has a mass", [](Balance b) { return b.parts().kinetic; }},
    EnergyPart{"dissipated", "turned into heat by dashpots, dampers, resistive electrodes and friction",
               [](Balance b) { return b.work().dissipated; }, true},
    EnergyPart{"source_work", "given by the sources: electrical_work, resistance_heat and leak_heat",
               [](Balance b) { return b.work().source(); }, true},
    EnergyPart{"resistance_heat", "turned into heat by the resistances and limits of current of circuits",
               [](Balance b) { return b.work().resistance; }, true},
    EnergyPart{"leak_heat", "turned into heat by the current that leaks through the film",
               [](Balance b) { return b.work().leak; }, true},
    EnergyPart{"released",
               "set free when the device is cut free, jumps to another state, comes to rest where a step "
               "without inertia follows one with it, or is caught by a support while it moves",
               [](Balance b) { return b.work().released; }, true},
    EnergyPart{"wrinkle_regularisation",
               "part of `elastic` that only keeps wrinkled film from being singular",
               [](Balance b) { return b.parts().regularised; }},
    EnergyPart{"error",
               "estimate of the error of works and heat, without that of friction's heat, which only more "
               "increments tell; beyond 1 % of them the run ends with exit code 5",
               [](Balance b) { return b.error(); }}};

std::vector<Key> energy_keys() {
  std::vector<Choice> parts;
  for (const EnergyPart& part : energy_parts) parts.emplace_back(part.word, part.meaning);
  return {word("of", parts, to(&Quantity::of), "the part")};
}

const EnergyPart& part_of(const Quantity& quantity) {
  return *std::ranges::find(energy_parts, quantity.of,
                            [](const EnergyPart& each) { return std::string(each.word); });
}

Probe energy(const Probing& probing) {
  return
      [value = part_of(probing.quantity).value](const Measured& measured) { return value(measured.energy); };
}

// --- courses: a mean over time is that of straight lines between the states where the subject has a value at
// both, and the value itself where they take no time

void begin_mean(KeptNumbers& kept, double time) {
  for (const char* sum : {"value", "known", "bulge", "error"}) kept[sum] = 0;
  for (const char* of_last : {"last", "slope", "dt"}) kept.erase(of_last);
  kept["last time"] = time;
}

/// Integral of what may lie between the straight lines and the course. Of a parabola it is f'' dt^3/12 in
/// every interval, a sixth of the rise times dt where it sets out level. Taken here is at most a quarter of
/// the rise times dt, and three times what the lines turn by at the state before tells of f'': beside a
/// corner half is seen. `known`: the time of all intervals before, s.
double bulge(KeptNumbers& kept, double known, double slope, double dt) {
  const auto most = [](double any_slope, double any_dt) { return std::abs(any_slope) * any_dt * any_dt / 4; };
  double& sum = kept["bulge"];
  const auto last = kept.find("slope");
  if (last == kept.end()) {
    sum = most(slope, dt);
  } else {
    const double last_slope = last->second, last_dt = kept.at("dt");
    const double turn = std::abs(slope - last_slope) / (last_dt + dt) / 2;
    if (known == last_dt) // the first, of which nothing else was known
      sum = std::min(sum, turn * last_dt * last_dt * last_dt);
    sum += std::min(turn * dt * dt * dt, most(slope, dt));
  }
  kept["slope"] = slope;
  kept["dt"] = dt;
  return sum;
}

double peak(KeptNumbers& kept, const Quantity& quantity, double now, double) {
  double& peak = kept.try_emplace("value", now).first->second;
  const bool beyond = quantity.extreme == post::Extreme::minimum ? now < peak : now > peak;
  if (beyond || std::isnan(peak)) peak = now;
  return peak;
}

void begin_peak(KeptNumbers& kept, double) { kept.erase("value"); }

double mean(KeptNumbers& kept, const Quantity& quantity, double now, double time) {
  if (!kept.contains("value")) {
    if (!quantity.since.empty()) return std::numeric_limits<double>::quiet_NaN();
    begin_mean(kept, time);
  }
  double& integral = kept.at("value");
  double& last = kept.try_emplace("last", now).first->second;
  double& last_time = kept.at("last time");
  double& known = kept.at("known"); // s
  if (const double dt = time - last_time; dt > 0 && !std::isnan(last) && !std::isnan(now)) {
    const double off = bulge(kept, known, (now - last) / dt, dt);
    integral += (last + now) / 2 * dt;
    known += dt;
    kept["error"] = off / known;
  }
  last = now;
  last_time = time;
  return known > 0 ? integral / known : now;
}

/// Where all of the time of a run is before the mean begins it is no mean, but the value at the end.
std::string idle_mean(const Case& one, const Quantity& quantity) {
  bool begun = quantity.since.empty(), timed = false;
  for (const Step& step : one.steps) {
    timed = timed || (begun && step.duration);
    begun = begun || step.name == quantity.since;
  }
  if (timed) return "";
  return fmt::format("no time passes{}: it is the value of {} at the end; give steps a duration",
                     quantity.since.empty() ? "" : fmt::format(" behind step \"{}\"", quantity.since),
                     quantity.of);
}

Key subject_key() { return of_key("the quantity").refers_to(Reference::quantity); }

std::string unit_of_subject(const Quantity& quantity, const std::vector<Quantity>& all) {
  for (const Quantity& other : all)
    if (other.name == quantity.of && !other.kind->so_far) return unit_of(other, all);
  return "1";
}

std::vector<Key> margin_keys() {
  return {word(
      "of",
      {{"breakdown", "somewhere the field is the breakdown field"},
       {"loss of tension", "somewhere the film has lost its tension; shells and solids bear compression"},
       {"pull-in", "a limit point, beyond which no voltage is larger"},
       {"buckling", "a bifurcation, from which the device leaves its way"},
       {"wall yield", "somewhere a wall yields"}},
      to(&Quantity::of), "the limit")};
}

} // namespace

std::vector<QuantityKind> run_kinds() {
  return {
      {.word = "energy",
       .meaning = "part of the energy balance (J)",
       .unit = "J",
       .keys = energy_keys,
       .in_words =
           [](const Quantity& q) { return fmt::format("energy balance: {}{}", field_words(q), at_words(q)); },
       .probe = energy,
       .of_balance = [](const Quantity& q) { return part_of(q).exchanged; },
       .without_error =
           [](const Quantity& q) { return std::string(q.of == "error" ? "an error itself" : ""); }},
      {.word = "peak",
       .meaning = "smallest or largest value of another quantity so far, from where the first of the case's "
                  "steps sets out",
       .keys =
           [] {
             return std::vector<Key>{subject_key(), extreme_key()};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("{} {} so far{}", extreme_word(q), q.of, at_words(q));
           },
       .so_far = peak,
       .unit_by = unit_of_subject,
       .begin = begin_peak,
       .orders = {{1, 1}}}, // read at some times only
      {.word = "mean",
       .meaning = "mean of another quantity so far, over the time in which it has a value, of straight lines "
                  "between the states; the error estimate covers how they turn, more `increments` lessen it",
       .keys =
           [] {
             return std::vector<Key>{subject_key(),
                                     since_key("step at whose end it begins; without it the whole run")};
           },
       .in_words =
           [](const Quantity& q) {
             return fmt::format("mean of {} over time{}{}", q.of,
                                q.since.empty() ? "" : ", since \"" + q.since + "\"", at_words(q));
           },
       .so_far = mean,
       .unit_by = unit_of_subject,
       .begin = begin_mean,
       .idle = idle_mean},
      {.word = "margin",
       .meaning = "factor on all voltages at the end of the run that leads to a limit, below 1 where it was "
                  "passed; none where the run does not tell (-)",
       .unit = "1",
       .keys = margin_keys,
       .in_words =
           [](const Quantity& q) {
             return fmt::format("factor on the voltages at the end that leads to {}", q.of);
           },
       .probe = [](const Probing&) -> Probe { return [](const Measured&) { return no_value; }; },
       .of_run = true},
  };
}

} // namespace dielast::cases
