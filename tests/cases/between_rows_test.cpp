// SPDX-License-Identifier: GPL-3.0-or-later
// What happens between the rows of a history.
#include "cases/runs/recorder.hpp"
#include "tests/cases/case_test.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

namespace dielast::cases::between_rows_test {
namespace {

class BetweenRows : public test::CaseTest {
 protected:
  /// Free, of 50 kPa.
  static constexpr const char* film =
      "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"50 kPa\"\npermittivity = "
      "\"4e-11 F/m\"\nbreakdown_field = \"7.8 MV/m\"\n[patch]\nmode = \"equal-biaxial\"\n";
  /// V.
  static double breakdown_voltage() {
    const double moved = 4e-11 / 50e3 * 7.8e6 * 7.8e6;
    double square = 1; // of the stretch
    for (int i = 0; i < 100; ++i) square = 1 / std::sqrt(square - moved);
    return 7.8e6 * 1e-3 / square;
  }
  /// That film under 5 kV and a sine of 3 kV, 1 Hz, in steps of 10 ms.
  Case wave(const std::string& record) const {
    return read(std::string(film) +
                "[drive]\nvoltage = { wave = \"sine\", mean = \"5 kV\", amplitude = \"3 kV\", frequency = "
                "\"1 Hz\" }\n"
                "[[step]]\nkind = \"transient\"\nduration = \"2.1 s\"\nincrements = 210\n" +
                (record.empty() ? "" : "record = \"" + record + "\"\n"));
  }
  struct Told {
    double time, voltage, load_factor;
  };
  /// Breakdowns and the peak of the field.
  struct Course {
    std::vector<Told> breakdowns;
    post::Peak field;
  };
  void note(const post::StepRecord& record, Course& course) const {
    for (const post::Event& event : record.events) {
      EXPECT_EQ(event.kind, "breakdown");
      const post::Moment at =
          event.before.value_or(post::Moment{record.load_factor, record.time, record.voltages});
      course.breakdowns.push_back({at.time, at.voltages.at(0), at.load_factor});
    }
  }
  static std::size_t number_of(const Case& one, const std::string& quantity) {
    return static_cast<std::size_t>(std::ranges::find(one.quantities, quantity, &Quantity::name) -
                                    one.quantities.begin());
  }
  Course course(const Case& one) const {
    Course course;
    Simulation simulation(one, 1);
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      note(frame.record, course);
      return true;
    };
    EXPECT_EQ(simulation.run(observer).ending, Ending::complete);
    course.field = simulation.peaks()[number_of(one, "max_field")];
    return course;
  }
};

// The largest field is that at 8 kV: mu (l^2 - l^-4) = eps E^2, E = l^2 V / H. At breakdown the field is
// given.
TEST_F(BetweenRows, EventsAndPeaksAreThoseOfAllTimeSteps) {
  double stretch = 1;
  for (int i = 0; i < 100; ++i) stretch = std::pow(1 - 4e-11 / 50e3 * std::pow(8e6 * stretch, 2), -1.0 / 6);
  const double largest = 8e6 * stretch * stretch;
  const double breaks = std::asin((breakdown_voltage() - 5e3) / 3e3) / (2 * std::numbers::pi); // s
  for (const auto& [record, told] : {std::pair{"", 2u}, {"0.35 s", 2u}, {"2.1 s", 1u}}) {
    const Course found = course(wave(record));
    EXPECT_NEAR(found.field.value / largest, 1, 1e-9) << record;
    EXPECT_NEAR(found.field.time, 0.25, 1e-9) << record;
    ASSERT_EQ(found.breakdowns.size(), told) << record; // between two rows one of a kind
    for (unsigned i = 0; i < told; ++i) {
      const Told& at = found.breakdowns[i];
      EXPECT_NEAR(at.time, i + breaks, 1e-6) << record;
      EXPECT_NEAR(at.load_factor, at.time / 2.1, 1e-9) << record;
      EXPECT_NEAR(at.voltage, 5e3 + 3e3 * std::sin(2 * std::numbers::pi * at.time), 1e-6) << record;
    }
  }
}

// Not at the state that tells of it, up to 3 kV farther, whether time passes or not.
TEST_F(BetweenRows, BreakdownIsLocatedBetweenIncrements) {
  for (const char* duration : {"", "duration = \"1 s\"\n"})
    for (const auto& [increments, accuracy] : {std::pair{3, 1e-2}, {12, 1e-5}}) {
      const Course found = course(
          read(fmt::format("{}[drive]\nvoltage = \"8 kV\"\n[[step]]\nkind = \"voltage\"\nincrements = {}\n{}",
                           film, increments, duration)));
      ASSERT_EQ(found.breakdowns.size(), 1u);
      EXPECT_NEAR(found.breakdowns[0].voltage / breakdown_voltage(), 1, accuracy) << increments << duration;
      EXPECT_NEAR(found.breakdowns[0].voltage, 8e3 * found.breakdowns[0].load_factor, 1e-6);
    }
}

// Nothing makes steps shorter where nothing flows: what a sine does between them nobody sees.
TEST_F(BetweenRows, WavesThatStepsResolvePoorlyAreWarnedOf) {
  const auto warnings = [](const Case& one) {
    return std::ranges::count_if(one.warnings, [](const Diagnostic& warning) {
      return warning.text().find("peaks, means and events between them may be missed") != std::string::npos;
    });
  };
  const Case fine = wave("");
  EXPECT_EQ(warnings(fine), 0);
  EXPECT_EQ(warnings(read_case(directory / "case.toml", {"step[1].increments=21"})), 1);
  EXPECT_EQ(warnings(read_case(directory / "case.toml", {"step[1].increments=42"})), 0);
  EXPECT_EQ(warnings(read_case(directory / "case.toml",
                               {"step[1].increments=21", "film.material.branch=[{shear_modulus='10 kPa', "
                                                         "relaxation_time='1 s'}]"})),
            0);
}

// Stopped behind what is told in the row to come.
TEST_F(BetweenRows, AResumedRunTellsWhatWasBeforeIt) {
  const Case one = wave("2.1 s");
  for (const int states : {10, 22, 30}) {
    Course found;
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      note(frame.record, found);
      return true;
    };
    int passed = 0;
    observer.goes_on = [&] { return ++passed != states; };
    Simulation stopped(one, 1);
    ASSERT_EQ(stopped.run(observer).ending, Ending::interrupted);
    const nlohmann::json kept =
        nlohmann::json::from_cbor(nlohmann::json::to_cbor(archive(stopped.progress())));
    Simulation resumed(one, 1);
    resumed.resume(restore_progress(kept, post::StateSizes::of(resumed.device().model)));
    ASSERT_EQ(resumed.run(observer).ending, Ending::complete);
    const Course straight = course(one);
    EXPECT_EQ(resumed.peaks()[number_of(one, "max_field")].value, straight.field.value) << states;
    EXPECT_EQ(resumed.peaks()[number_of(one, "max_field")].time, straight.field.time) << states;
    ASSERT_EQ(found.breakdowns.size(), 1u) << states;
    EXPECT_EQ(found.breakdowns[0].time, straight.breakdowns[0].time) << states;
  }
}

// Stopped at its last state, with no row since the step before: the row with which it gives up is written.
TEST_F(BetweenRows, AResumedRunThatGivesUpWritesItsLastRow) {
  const Case one = read(std::string(film) + "[drive]\nvoltage = \"60 kV\"\n[[step]]\nkind = \"voltage\"\n"
                                            "duration = \"1 s\"\nrecord = \"1 s\"\n");
  std::vector<double> times;
  int states = 0;
  SimulationObserver observer;
  observer.on_accept = [&](const Frame& frame) {
    times.push_back(frame.record.time);
    return true;
  };
  observer.goes_on = [&] { return ++states > 0; };
  const Outcome straight = Simulation(one, 1).run(observer);
  ASSERT_EQ(straight.kind, "limit point") << straight.message;
  const std::vector<double> all = std::exchange(times, {});
  int left = std::exchange(states, 0);
  observer.goes_on = [&] { return --left != 0; };
  Simulation stopped(one, 1);
  EXPECT_EQ(stopped.run(observer).ending, Ending::interrupted);
  const nlohmann::json kept = archive(stopped.progress());
  Simulation resumed(one, 1);
  resumed.resume(restore_progress(kept, post::StateSizes::of(resumed.device().model)));
  EXPECT_EQ(resumed.run(observer).kind, "limit point");
  EXPECT_EQ(times, all);
}

} // namespace
} // namespace dielast::cases::between_rows_test
