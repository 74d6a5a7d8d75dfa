// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/readers/reader.hpp"
#include "cases/runs/recorder.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>

#include <map>
#include <random>
#include <set>

namespace dielast::cases {

/// Film with one branch, to be driven.
inline const std::string branched_patch = R"(
[film]
thickness = "1 mm"
[film.material]
shear_modulus = "40 kPa"
permittivity = "4e-11 F/m"
[[film.material.branch]]
shear_modulus = "40 kPa"
relaxation_time = "1 s"
[patch]
mode = "equal-biaxial"
)";

/// Cases written by a test and run in its own process.
class FilmCases : public test::ScratchTest {
 protected:
  struct Ran {
    Outcome outcome;
    std::vector<double> time;                          ///< s, per recorded state
    std::vector<std::vector<double>> voltages;         ///< V, likewise, per electrode
    std::map<std::string, std::vector<double>> values; ///< per quantity likewise
    std::multiset<std::string> events;                 ///< kinds
    std::vector<Analysis> analyses;                    ///< of the steps of kind "modes" and "harmonic"
    double last(const std::string& name) const { return values.at(name).back(); }
  };

  Ran run(const std::string& text) {
    write("film.toml", text);
    const Case one = read_case(directory / "film.toml");
    Ran ran;
    Simulation simulation(one, 1);
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      ran.time.push_back(frame.record.time);
      ran.voltages.push_back(frame.record.voltages);
      for (std::size_t q = 0; q < one.quantities.size(); ++q)
        ran.values[one.quantities[q].name].push_back(frame.values[q]);
      for (const post::Event& event : frame.record.events) ran.events.insert(event.kind);
      return true;
    };
    observer.on_analysis = [&](const Analysis& analysis, const fem::State&) {
      ran.analyses.push_back(analysis);
    };
    ran.outcome = simulation.run(observer);
    EXPECT_EQ(ran.outcome.ending, Ending::complete) << ran.outcome.message << "\n" << text;
    return ran;
  }

  /// How a run ends, whatever comes of it.
  Outcome outcome_of(const std::string& text) {
    write("film.toml", text);
    const Case one = read_case(directory / "film.toml");
    return Simulation(one, 1).run({});
  }

  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }
  int below(int end) { return std::uniform_int_distribution(0, end - 1)(random_); }

  /// Keys of each of the laws, a soft elastomer's, of about the shear modulus `kPa`.
  static std::vector<std::string> laws(double kPa) {
    return {
        fmt::format("law = \"neo-hookean\"\nshear_modulus = \"{} kPa\"\n", kPa),
        fmt::format("law = \"gent\"\nshear_modulus = \"{} kPa\"\nstretch_limit = 60\n", kPa),
        fmt::format("law = \"yeoh\"\nc1 = \"{} kPa\"\nc2 = \"{} kPa\"\nc3 = \"{} kPa\"\n", kPa / 2, kPa / 200,
                    kPa / 5000),
        fmt::format("law = \"mooney-rivlin\"\nc1 = \"{} kPa\"\nc2 = \"{} kPa\"\n", 0.45 * kPa, 0.05 * kPa),
        fmt::format("law = \"ogden\"\nmoduli = [\"{} kPa\"]\nexponents = [2.5]\n", 0.8 * kPa)};
  }

 private:
  std::mt19937 random_{2026};
};

} // namespace dielast::cases
