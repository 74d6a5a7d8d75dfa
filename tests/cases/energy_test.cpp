// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/sudden_motion.hpp"
#include "cases/readers/reader.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

// Works, heat and peaks of runs in which they once were wrong in silence. Works and heat of random transients
// are in works_test.cpp.

namespace dielast::cases::energy_test {
namespace {

constexpr double volume = 1e-7; ///< of the patch, m^3

class Energy : public test::ScratchTest {
 protected:
  using Row = std::map<std::string, double>;

  /// Time and quantities of every recorded state.
  std::vector<Row> run(const std::string& text) {
    write("case.toml", "[output]\nfields = false\nerror_estimate = false\n" + text);
    const Case one = read_case(directory / "case.toml");
    std::vector<Row> rows;
    Simulation simulation(one, 1);
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      Row& row = rows.emplace_back();
      row["time"] = frame.record.time;
      for (std::size_t q = 0; q < one.quantities.size(); ++q) row[one.quantities[q].name] = frame.values[q];
      return true;
    };
    const Outcome outcome = simulation.run(observer);
    EXPECT_EQ(outcome.ending, Ending::complete) << outcome.message;
    EXPECT_FALSE(simulation.energy().worst().is_poor());
    for (std::size_t q = 0; q < one.quantities.size(); ++q)
      peaks[one.quantities[q].name] = simulation.peaks()[q];
    return rows;
  }
  /// Messages of the events of a kind.
  std::vector<std::string> told(const std::string& kind, const std::string& text) const {
    write("case.toml", text);
    const Case one = read_case(directory / "case.toml");
    std::vector<std::string> messages;
    Simulation simulation(one, 1);
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      for (const post::Event& event : frame.record.events)
        if (event.kind == kind) messages.push_back(event.message);
      return true;
    };
    EXPECT_EQ(simulation.run(observer).ending, Ending::complete);
    return messages;
  }
  static std::string film(double modulus, const std::string& rest = "") {
    return fmt::format("[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = {}\npermittivity = "
                       "\"4e-11 F/m\"\n{}",
                       modulus, rest);
  }
  static std::string branch(double modulus, double time) {
    return fmt::format("[[film.material.branch]]\nshear_modulus = {}\nrelaxation_time = {}\n", modulus, time);
  }

  std::map<std::string, post::Peak> peaks; ///< of the last run
};

// The film is held at 1.5 x 1: all that its branch stores at once becomes heat; charges follow the voltage.
TEST_F(Energy, square_wave_beside_a_dashpot) {
  const auto rows =
      run(film(50e3, branch(50e3, 1)) +
          "[patch]\nmode = \"pure-shear\"\nstretch_x = 1.5\n"
          "[drive]\nvoltage = { wave = \"square\", to = \"2 kV\", frequency = \"0.2846 Hz\", duty = 0.77 }\n"
          "[[step]]\nkind = \"transient\"\nduration = \"10.832 s\"\nincrements = 50\n");
  const double strain = (1.5 * 1.5 + 1 / (1.5 * 1.5) - 2) / 2;
  const Row& end = rows.back();
  EXPECT_NEAR(end.at("dissipated_energy"), 50e3 * strain * volume, 1e-4 * 50e3 * strain * volume);
  EXPECT_NEAR(end.at("mechanical_work") + end.at("electrical_work"),
              100e3 * strain * volume + end.at("charge") * 2e3 / 2, 1e-9);
  EXPECT_NEAR(end.at("mechanical_work"), 3.47e-3, 0.01e-3);
  for (std::size_t i = 1; i < rows.size(); ++i)
    EXPECT_GE(rows[i].at("dissipated_energy"), rows[i - 1].at("dissipated_energy"));
  // before and behind each of seven jumps
  EXPECT_EQ(rows.size(), 51u + 7u);
}

// Its dashpot follows the shape within a ten-thousandth of an increment: 2 eta D : D = 12 eta
// (rate/lambda)^2.
TEST_F(Energy, a_dashpot_beside_the_law_turns_its_own_power_into_heat) {
  const auto rows =
      run("[film]\nthickness = \"0.1 mm\"\n[film.material]\nshear_modulus = \"50 kPa\"\n"
          "permittivity = \"4e-11 F/m\"\nviscosity = \"500 Pa.s\"\n[patch]\nmode = \"equal-biaxial\"\n"
          "stretch_x = { wave = \"ramp\", from = 1, to = 1.05, duration = \"1 s\" }\n"
          "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\nincrements = 50\n");
  const double rate = 0.05, end = 1.05;
  const double heat = 12 * 500 * rate * (end - 1) / end * 1e-8;
  EXPECT_NEAR(rows.back().at("dissipated_energy"), heat, 0.005 * heat);
}

// Its first increments exchange a millionth of what the run does, and know a fifth of that.
TEST_F(Energy, a_wave_that_sets_in_smoothly_behind_a_resistance_is_resolved) {
  const auto rows =
      run(film(50e3) + "[patch]\n[drive]\nvoltage = { wave = \"ramp\", to = \"4 kV\", duration = \"10 s\" }\n"
                       "[circuit]\nresistance = \"200 GOhm\"\n"
                       "[[step]]\nkind = \"transient\"\nduration = \"10 s\"\nincrements = 100\n");
  const Row& end = rows.back();
  EXPECT_LT(end.at("energy_error"), 1e-4 * end.at("stored_energy"));
}

TEST_F(Energy, a_hold_in_which_nothing_moves_does_no_work) {
  const auto rows =
      run(film(10e3, branch(20e3, 4)) +
          "[patch]\nmode = \"pure-shear\"\n[drive]\nvoltage = \"5 kV\"\n[[step]]\nkind = \"voltage\"\n"
          "increments = 8\n[[step]]\nkind = \"hold\"\nduration = \"2.5 s\"\nincrements = 5\n"
          "[solver]\ntime_tolerance = 1e-8\n");
  const double work = rows[8].at("electrical_work");
  EXPECT_NEAR(work, rows[8].at("stored_energy"), 1e-12 * work);
  for (std::size_t i = 9; i < rows.size(); ++i) EXPECT_NEAR(rows[i].at("electrical_work"), work, 1e-9 * work);
}

// Kinks beside the ends of increments, by any distance.
TEST_F(Energy, tables_beside_the_increments_do_the_work_that_is_stored) {
  for (const int decimals : {4, 8, 10, 12})
    for (const int increments : {15, 30, 60, 90}) {
      std::string table = "time_s,voltage_V\n";
      for (int row = 0; row <= 31; ++row)
        table += fmt::format("{:.{}f},{}\n", row / 30.0, decimals, 6e3 * std::sin(row / 25.0));
      write("table.csv", table);
      const auto rows = run(
          film(40e3) +
          "[patch]\nmode = \"equal-biaxial\"\n"
          "[drive]\nvoltage = { wave = \"file\", file = \"table.csv\" }\n" +
          fmt::format("[[step]]\nkind = \"transient\"\nduration = \"1 s\"\nincrements = {}\n", increments));
      EXPECT_EQ(rows.size(), static_cast<std::size_t>(increments) + 1);
      for (const Row& row : rows)
        EXPECT_NEAR(row.at("electrical_work"), row.at("stored_energy"),
                    1e-9 * rows.back().at("stored_energy"));
    }
}

TEST_F(Energy, kinks_that_are_ends_of_increments_but_for_rounding_make_no_rows) {
  constexpr double duration = 4.4879202653859736;
  std::string table = "time_s,voltage_V\n";
  for (int row = 0; row <= 120; ++row)
    table += fmt::format("{:.17g},{}\n", row * duration / 120, 4e3 * std::sin(row / 25.0));
  write("table.csv", table);
  const auto rows = run(
      film(40e3, branch(20e3, 1)) +
      "[patch]\nmode = \"equal-biaxial\"\n[drive]\nvoltage = { wave = \"file\", file = \"table.csv\" }\n" +
      fmt::format("[[step]]\nkind = \"transient\"\nduration = {:.17g}\nincrements = 120\n", duration));
  EXPECT_EQ(rows.size(), 121u);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_GT(rows[i].at("time"), rows[i - 1].at("time"));
    EXPECT_TRUE(std::isfinite(rows[i].at("electrical_work")));
  }
}

// Each work is exact from the potential, however few the increments.
TEST_F(Energy, static_works_do_not_depend_on_the_increments) {
  std::vector<Row> ends;
  for (const int increments : {1, 2, 7, 60})
    ends.push_back(run(film(40e3) +
                       "[patch]\nmode = \"biaxial\"\nstretch_y = 1.3\nstress_x = \"30 "
                       "kPa\"\n[drive]\nvoltage = \"6 kV\"\n" +
                       fmt::format("[[step]]\nkind = \"move\"\nincrements = {0}\n[[step]]\nkind = \"force\"\n"
                                   "increments = {0}\n[[step]]\nkind = \"voltage\"\nincrements = {0}\n",
                                   increments))
                       .back());
  for (const Row& end : ends)
    for (const char* work : {"electrical_work", "mechanical_work"})
      EXPECT_NEAR(end.at(work), ends.back().at(work), 1e-8 * ends.back().at("stored_energy")) << work;
}

// Branches that have been frozen flow at once in the relaxed step behind, under the loads as they are.
TEST_F(Energy, heat_of_a_relaxed_step_behind_an_instantaneous_one) {
  for (const int increments : {1, 40}) {
    const auto ramps = [&](const char* kind) {
      return fmt::format("[[step]]\nkind = \"{}\"\nincrements = {}\nresponse = \"instantaneous\"\n"
                         "[[step]]\nkind = \"voltage\"\nincrements = {}\n",
                         kind, increments, increments);
    };
    const auto pulled =
        run(film(50e3, branch(50e3, 1)) +
            "[patch]\nmode = \"equal-biaxial\"\nstress_x = \"40 kPa\"\n[drive]\nvoltage = \"1 V\"\n" +
            ramps("force"));
    // dead loads give all, the spring of the law keeps its part
    const double pull = 2 * 40e3 * volume;
    const Row &at_once = pulled[static_cast<std::size_t>(increments)], &end = pulled.back();
    EXPECT_NEAR(end.at("mechanical_work") - at_once.at("mechanical_work"),
                pull * (end.at("stretch_x") - at_once.at("stretch_x")), 1e-10);
    EXPECT_NEAR(end.at("dissipated_energy"), 393.5223e-6, 1e-10);
    EXPECT_NEAR(end.at("mechanical_work") - end.at("stored_energy"), end.at("dissipated_energy"), 1e-10);
    EXPECT_LT(end.at("energy_error"), 1e-12);

    const auto held =
        run(film(50e3, branch(50e3, 1)) +
            "[patch]\nmode = \"pure-shear\"\nstretch_x = 1.5\n[drive]\nvoltage = \"1 kV\"\n" + ramps("move"));
    const double strain = (1.5 * 1.5 + 1 / (1.5 * 1.5) - 2) / 2;
    EXPECT_NEAR(held.back().at("dissipated_energy"), 50e3 * strain * volume, 1e-10);
    EXPECT_NEAR(held.back().at("mechanical_work"), 100e3 * strain * volume, 1e-10);
  }
}

TEST_F(Energy, peaks_and_means_do_not_depend_on_what_is_recorded) {
  std::vector<Row> ends;
  for (const char* record : {"", "record = \"0.4 s\"\n"})
    ends.push_back(
        run(film(40e3) +
            "[patch]\nmode = \"equal-biaxial\"\n[drive]\nvoltage = { wave = \"trapezoid\", to = \"10 kV\", "
            "rise = "
            "\"0.1 s\", hold = \"0.1 s\", fall = \"0.1 s\" }\n[[step]]\nkind = \"transient\"\nduration = \"1 "
            "s\"\n"
            "increments = 200\n" +
            std::string(record) +
            "[[quantity]]\nname = \"widest\"\nkind = \"peak\"\nof = \"stretch_x\"\nextreme = \"maximum\"\n"
            "[[quantity]]\nname = \"strongest\"\nkind = \"peak\"\nof = \"max_field\"\nextreme = "
            "\"maximum\"\n[[quantity]]\nname = \"usual\"\nkind = \"mean\"\nof = \"max_field\"\n")
            .back());
  for (const char* peak : {"widest", "strongest"}) EXPECT_EQ(ends[0].at(peak), ends[1].at(peak)) << peak;
  EXPECT_NEAR(peaks.at("max_field").value / ends[1].at("strongest"), 1, 1e-8);
  EXPECT_NEAR(peaks.at("stretch_x").value / ends[1].at("widest"), 1, 1e-8);
  EXPECT_NEAR(ends[0].at("usual"), ends[1].at("usual"), 1e-9 * ends[1].at("usual"));
  EXPECT_NEAR(ends[1].at("usual"), 0.2 * ends[1].at("strongest"), 0.003 * ends[1].at("strongest"));
  EXPECT_NEAR(ends[1].at("widest"), 1.018417, 1e-6);
}

// A film that is drawn stretched settles first, by itself: peaks are those of the steps that were asked for.
TEST_F(Energy, peaks_do_not_count_what_settles_before_the_first_step) {
  const auto rows =
      run("[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = \"40 kPa\"\n"
          "permittivity = \"4e-11 F/m\"\n[patch]\nmode = \"equal-biaxial\"\n[drive]\nvoltage = { wave = "
          "\"trapezoid\", to = \"5 kV\", rise = \"0.1 s\", hold = \"0.1 s\", fall = \"0.1 s\" }\n"
          "[[step]]\nkind = \"transient\"\nduration = \"1 s\"\n"
          "[[quantity]]\nname = \"widest\"\nkind = \"peak\"\nof = \"stretch_x\"\nextreme = \"maximum\"\n");
  ASSERT_GT(rows.front().at("stretch_x"), 1.4);
  ASSERT_LT(rows.back().at("stretch_x"), 1.1);
  double widest = 0;
  for (const Row& row : rows)
    if (row.at("time") > 0) widest = std::max(widest, row.at("stretch_x"));
  EXPECT_GT(widest, 1.002);
  EXPECT_EQ(rows.back().at("widest"), widest);
  EXPECT_NEAR(peaks.at("stretch_x").value, widest, 1e-8);
}

// Rounding moves the film by 1e-12 of its length in the hold: no motion to have a kinetic energy.
TEST_F(Energy, rounding_is_no_motion) {
  const std::string held =
      film(50e3, "density = \"1000 kg/m^3\"\n") +
      "[patch]\nlength = \"50 mm\"\n[circuit]\nresistance = \"1 MOhm\"\nleakage_resistance = \"10 "
      "GOhm\"\ncurrent_limit = \"1e-7 A\"\n[drive]\nvoltage = \"3 kV\"\n[[step]]\nkind = "
      "\"voltage\"\nduration = "
      "\"20 s\"\n[[step]]\nkind = \"hold\"\nduration = \"20 s\"\n";
  EXPECT_TRUE(told("inertia left out", held).empty());
}

// What a jump covers in a time step is no speed, nor is what the way to the limit does, where stiffness
// vanishes.
TEST_F(Energy, a_jump_is_no_speed) {
  for (const char* record : {"0.1 s", "0.35 s", "2 s", "10 s"}) {
    const std::string ramp =
        fmt::format("[film]\nthickness = \"1 mm\"\n[film.material]\nlaw = \"gent\"\nshear_modulus = \"50 "
                    "kPa\"\nstretch_limit = "
                    "20\npermittivity = \"4e-11 F/m\"\ndensity = \"1000 kg/m^3\"\n[patch]\nmode = "
                    "\"equal-biaxial\"\nlength = \"50 mm\"\n[drive]\nvoltage = {{ wave = \"ramp\", to = \"30 "
                    "kV\", duration = "
                    "\"10 s\" }}\n[[step]]\nkind = \"transient\"\nduration = \"10 s\"\non_instability = "
                    "\"jump\"\nrecord = "
                    "\"{}\"\n",
                    record);
    const auto jumps = told("jump", ramp);
    ASSERT_EQ(jumps.size(), 1u) << record;
    EXPECT_NE(jumps[0].find("whether inertia would have counted before that in this step is not known"),
              std::string::npos)
        << jumps[0];
    EXPECT_TRUE(told("inertia left out", ramp).empty()) << record;
  }
}

// A support that sets out with a finite speed pushes masses the harder the shorter the time steps are; what
// that takes is known.
TEST_F(Energy, a_support_that_sets_out_at_once_is_told_and_its_work_is_known) {
  const auto shaken = [this](const std::string& wave, const std::string& before = "", int increments = 400,
                             const char* event = "sudden motion") {
    return told(
        event,
        film(50e3) +
            "[patch]\nmode = \"pure-shear\"\nlength = \"50 mm\"\n[[support]]\nplace = \"right\"\nfix = "
            "[\"x\"]\ndisplacement.x = { " +
            wave + " }\n[[point_mass]]\nplace = \"right\"\nmass = \"20 g\"\ndamping = \"0.05 N.s/m\"\n" +
            before +
            fmt::format("[[step]]\nkind = \"transient\"\nduration = \"0.4 s\"\nincrements = {}\ninertia = "
                        "true\n",
                        increments));
  };
  const std::string sine = "wave = \"sine\", amplitude = \"1 mm\", frequency = \"5 Hz\"";
  const std::string move = "[[step]]\nkind = \"move\"\n";
  const auto at_once = shaken(sine);
  ASSERT_EQ(at_once.size(), 1u);
  EXPECT_NE(
      at_once[0].find("support \"right\" is to set out with 31.42 mm/s along x at once: masses are struck"),
      std::string::npos)
      << at_once[0];
  EXPECT_TRUE(shaken(sine, "", 400, "unresolved energy").empty());
  shaken("wave = \"ramp\", to = \"1 mm\", at = \"0.1 s\", duration = \"0.1 s\"");
  const Case corner = read_case(directory / "case.toml");
  EXPECT_EQ(sudden_motion(corner, corner.steps),
            "support \"right\" is to change its speed by 10.00 mm/s along x at once, at 100.0 ms");
  EXPECT_TRUE(shaken(sine + ", phase = \"90 deg\"", move).empty());
  EXPECT_TRUE(shaken("wave = \"unipolar sine\", amplitude = \"1 mm\", frequency = \"5 Hz\"").empty());
}

// Masses do not move at once: what a charge that jumps costs is stored by the film as it is.
TEST_F(Energy, a_charge_that_jumps_while_masses_stand_does_its_work) {
  const auto rows = run(film(50e3, "density = 1000\n") +
                        "[patch]\nlength = \"20 mm\"\nmode = \"equal-biaxial\"\n"
                        "[drive]\ncharge = { wave = \"step\", to = \"0.1 uC\", at = \"10 ms\" }\n"
                        "[[step]]\nkind = \"transient\"\nduration = \"30 ms\"\ncontrol = \"charge\"\n"
                        "inertia = true\n");
  const double capacitance = rows.front().at("capacitance"), work = 1e-7 * 1e-7 / (2 * capacitance);
  EXPECT_NEAR(rows.back().at("electrical_work"), work, 1e-6 * work);
  EXPECT_LT(peaks.at("energy_error").value, 1e-6 * work);
  EXPECT_NEAR(peaks.at("max_field").value, 1e-7 / capacitance / 1e-3, 1); // at the jump
}

// Nor does the potential within a solid, which has no mass, stay as it was.
TEST_F(Energy, the_field_of_a_solid_follows_a_voltage_that_jumps_while_masses_stand) {
  const auto rows = run(film(40e3, "density = 1000\n") +
                        "[hollow_sphere]\ninner_radius = \"10 mm\"\nouter_radius = \"12 mm\"\n"
                        "[drive]\nvoltage = { wave = \"step\", to = \"20 kV\", at = \"0.1 ms\" }\n"
                        "[[step]]\nkind = \"transient\"\nduration = \"0.3 ms\"\nrecord = \"0.1 ms\"\n"
                        "inertia = true\n");
  const double work = rows.front().at("capacitance") * 20e3 * 20e3 / 2;
  EXPECT_NEAR(rows[2].at("electrical_work"), work, 1e-6 * work); // behind the jump
  EXPECT_LT(peaks.at("energy_error").value, 1e-5 * work);
}

// The pressure follows at once, the film later: what it does on it is int p dV, whatever the pump needed.
TEST_F(Energy, a_gas_does_work_on_the_walls_of_its_chamber_only) {
  const auto rows =
      run("[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = \"50 kPa\"\n"
          "permittivity = \"4e-11 F/m\"\ndensity = 1000\n[annulus]\ninner_radius = \"10 mm\"\n"
          "outer_radius = \"30 mm\"\n[mesh]\nrings = 3\n[plate]\nmass = \"20 g\"\n[drive]\nvoltage = 0\n"
          "[chamber]\nbulk_modulus = \"100 kPa\"\n"
          "volume = { wave = \"step\", from = \"5 ml\", to = \"4 ml\", at = \"1 ms\" }\n"
          "[[step]]\nkind = \"inflate\"\nto = \"5 ml\"\n"
          "[[step]]\nkind = \"transient\"\nduration = \"3 ms\"\nrecord = \"0.5 ms\"\n");
  const auto behind = std::ranges::find_if(
      rows, [](const Row& row) { return row.at("time") > 0.9e-3 && row.at("pressure") < 0; });
  ASSERT_NE(behind, rows.end());
  const double volume = behind->at("volume");
  EXPECT_NEAR(behind->at("time"), 1e-3, 1e-9);
  EXPECT_NEAR(behind->at("pressure"), 1e5 * (4e-6 / volume - 1), 1);
  EXPECT_NEAR(behind->at("mechanical_work"), std::prev(behind)->at("mechanical_work"), 1e-12);
  EXPECT_LT(peaks.at("energy_error").value, 1e-3 * peaks.at("mechanical_work").value);
}

TEST_F(Energy, a_mean_begins_where_its_step_ends) {
  const auto rows =
      run(film(40e3) +
          "[patch]\nmode = \"equal-biaxial\"\n[drive]\nvoltage = { wave = \"ramp\", to = \"10 kV\", "
          "duration = \"1 s\" }\n[[step]]\nname = \"rise\"\nkind = \"transient\"\nduration = \"1 s\"\n"
          "[[step]]\nkind = \"hold\"\nduration = \"3 s\"\n"
          "[[quantity]]\nname = \"held\"\nkind = \"mean\"\nof = \"max_field\"\nsince = \"rise\"\n"
          "[[quantity]]\nname = \"all\"\nkind = \"mean\"\nof = \"max_field\"\n");
  EXPECT_TRUE(std::isnan(rows[1].at("held")));
  EXPECT_NEAR(rows.back().at("held"), rows.back().at("max_field"), 1e-9 * rows.back().at("max_field"));
  EXPECT_NEAR(rows.back().at("all"), 3.5 / 4 * rows.back().at("max_field"),
              0.005 * rows.back().at("max_field"));
}

// What the source has given is what the electrode holds; where its charge is given nothing is known.
TEST_F(Energy, the_mean_of_a_current_is_the_charge_over_the_time_in_which_it_is_known) {
  const auto rows = run(
      film(40e3) +
      "[patch]\n[circuit]\nresistance = \"10 MOhm\"\n[drive]\nvoltage = { wave = \"ramp\", to = \"4 kV\", "
      "duration = \"2 s\" }\n[[step]]\nname = \"rise\"\nkind = \"transient\"\nduration = \"2 s\"\n"
      "[[step]]\nkind = \"hold\"\nduration = \"3 s\"\ncontrol = \"charge\"\n"
      "[[quantity]]\nname = \"i\"\nkind = \"current\"\nof = \"film\"\n"
      "[[quantity]]\nname = \"mean\"\nkind = \"mean\"\nof = \"i\"\n"
      "[[quantity]]\nname = \"later\"\nkind = \"mean\"\nof = \"i\"\nsince = \"rise\"\n");
  const double charge = rows.back().at("charge");
  EXPECT_NEAR(2 * rows.back().at("mean"), charge, 1e-3 * charge);
  EXPECT_TRUE(std::isnan(rows.back().at("i")));
  EXPECT_TRUE(std::isnan(rows.back().at("later")));
}

TEST_F(Energy, without_time_the_source_gives_what_leaks) {
  const auto rows =
      run(film(40e3) + "[patch]\n[circuit]\nresistance = \"1 GOhm\"\nleakage_resistance = \"4 GOhm\"\n"
                       "[drive]\nvoltage = \"5 kV\"\n[[step]]\nkind = \"voltage\"\n"
                       "[[quantity]]\nname = \"i\"\nkind = \"current\"\nof = \"film\"\n");
  EXPECT_NEAR(rows.back().at("i"), 1e-6, 1e-15);
}

} // namespace
} // namespace dielast::cases::energy_test
