// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/reader.hpp"
#include "cases/runs/recorder.hpp"
#include "cases/runs/simulation.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

// The patch device against closed forms and independent integrations of material points, through case files.

namespace dielast::cases::patch_validation_test {
namespace {

constexpr double mu = 45e3, permittivity = 4e-11, thickness = 1e-3;

/// Volts for the nominal field (Phi/H) sqrt(eps/mu).
double volts(double nominal_field) { return nominal_field * thickness * std::sqrt(mu / permittivity); }

struct Point {
  double time, stretch_x, stretch_y;
};

class PatchValidation : public test::ScratchTest {
 protected:
  /// The recorded states of a case.
  std::vector<Point> run(const std::string& text) {
    write("patch.toml", text);
    const Case one = read_case(directory / "patch.toml");
    std::size_t x = 0, y = 0;
    for (std::size_t q = 0; q < one.quantities.size(); ++q) {
      if (one.quantities[q].name == "stretch_x") x = q;
      if (one.quantities[q].name == "stretch_y") y = q;
    }
    std::vector<Point> points;
    Simulation simulation(one, 1);
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      points.push_back({frame.record.time, frame.values[x], frame.values[y]});
      return true;
    };
    const Outcome outcome = simulation.run(observer);
    EXPECT_EQ(outcome.ending, Ending::complete) << outcome.message;
    return points;
  }
  static std::string film(const std::string& prestretch = "1") {
    return fmt::format(
        "[film]\nthickness = \"1 mm\"\nprestretch = {}\n[film.material]\nshear_modulus = \"45 kPa\"\n"
        "permittivity = \"4e-11 F/m\"\n",
        prestretch);
  }
  static std::string drive(double nominal_field) {
    return fmt::format("[drive]\nvoltage = \"{:.17g} V\"\n", volts(nominal_field));
  }
};

TEST_F(PatchValidation, free_neo_hookean_film_spreads_as_the_closed_form_says) {
  for (const auto& [field, stretch] : {std::pair{0.1, 1.0016821},
                                       {0.3, 1.0163973},
                                       {0.5, 1.0559773},
                                       {0.65, 1.1433128},
                                       {0.68, 1.2013524}}) {
    const auto end = run(film() + "[patch]\n" + drive(field)).back();
    EXPECT_NEAR(end.stretch_x, stretch, 1e-6) << field;
    EXPECT_NEAR(end.stretch_y, stretch, 1e-6) << field;
  }
}

TEST_F(PatchValidation, dead_loads_help_the_field) {
  for (const auto& [field, stretch] :
       {std::pair{0.0, 1.285199}, {0.1, 1.2956405}, {0.2, 1.33261}, {0.3, 1.4303981}})
    EXPECT_NEAR(run(film() + "[patch]\nmode = \"equal-biaxial\"\nstress_x = \"45 kPa\"\n" + drive(field))
                    .back()
                    .stretch_x,
                stretch, 1e-6 * stretch)
        << field;
}

TEST_F(PatchValidation, pure_shear_has_no_pull_in) {
  struct Row {
    double held, stress, field, stretch;
  };
  for (const Row& row : {Row{1, 0.5, 0.3, 1.1943907},
                         {1, 1, 0.7, 2.1563427},
                         {1, 2, 0.5, 2.7320508},
                         {3, 0, 0.2, 0.64549722},
                         {3, 1, 0.2, 1.6045277},
                         {3, 2, 0.1, 2.2091276}}) {
    const auto end =
        run(film(fmt::format("[1, {}]", row.held)) +
            fmt::format("[patch]\nmode = \"pure-shear\"\nstress_x = \"{} kPa\"\n", 45 * row.stress) +
            drive(row.field))
            .back();
    EXPECT_NEAR(end.stretch_x, row.stretch, 1e-6 * row.stretch)
        << row.held << " " << row.stress << " " << row.field;
    EXPECT_NEAR(end.stretch_y, row.held, 1e-12);
  }
}

/// Spring-rolled muscle: film, spring and, with `weight`, the linkage.
std::string muscle(bool weight) {
  std::string text = R"(
[film]
material = "VHB F9473PC"
thickness = "0.254 mm"
prestretch = [1.94999, 1]
[patch]
mode = "pure-shear"
length = "40 mm"
width = "250 mm"
[[spring]]
between = ["left", "right"]
along = "x"
stiffness = "180 N/m"
free_length = "110 mm"
)";
  if (weight)
    text += R"(
[[linkage]]
between = ["left", "right"]
along = "x"
force = "0.7122 N"
arm = "110 mm"
strut = "60 mm"
offset = "47.3 mm"
)";
  return text;
}

TEST_F(PatchValidation, rolled_muscle_rests_where_the_lumped_equations_say) {
  const std::string steps = "[[step]]\nkind = \"release\"\n[[step]]\nkind = \"voltage\"\n";
  const auto loaded = run(muscle(true) + "[drive]\nvoltage = \"2828.42712474619 V\"\n" + steps);
  EXPECT_NEAR(loaded[1].stretch_x, 2.0065921, 1e-5);     // under the weight
  EXPECT_NEAR(loaded.back().stretch_x, 2.0599004, 1e-5); // and the mean of Phi^2
  EXPECT_NEAR(run(muscle(false) + "[drive]\nvoltage = \"4 kV\"\n" + steps).back().stretch_x, 2.0554957, 1e-5);
}

TEST_F(PatchValidation, rolled_muscle_creeps_as_the_lumped_equations_say) {
  const auto points = run(muscle(false) + R"([drive]
voltage = "4 kV"
[[step]]
kind = "release"
[[step]]
name = "on"
kind = "voltage"
response = "instantaneous"
[[step]]
kind = "hold"
duration = "600 s"
increments = 120
record = "10 s"
)");
  for (const auto& [time, stretch] :
       {std::pair{0.0, 1.9614701}, {10.0, 1.9689728}, {100.0, 1.9983548}, {600.0, 2.0434685}}) {
    const auto at = std::find_if(points.rbegin(), points.rend(),
                                 [t = time](const Point& p) { return p.time < t + 1e-6; });
    ASSERT_NE(at, points.rend());
    EXPECT_NEAR(at->time, time, 1e-6);
    EXPECT_NEAR(at->stretch_x, stretch, 1e-5 * stretch) << time;
  }
}

/// Strokes of the first and the last two seconds, mm.
std::array<double, 2> strokes(const std::vector<Point>& points, double end) {
  const auto stroke = [&](double from, double to) {
    double low = 10, high = 0;
    for (const Point& p : points)
      if (p.time >= from - 1e-6 && p.time <= to + 1e-6 &&
          &p != &points.front()) // the drawn one knows no weight
        low = std::min(low, p.stretch_x), high = std::max(high, p.stretch_x);
    return 40 * (high - low);
  };
  return {stroke(0, 2), stroke(end - 2, end)};
}

TEST_F(PatchValidation, rolled_muscle_is_driven_for_twenty_minutes) {
  const std::string drive = R"([drive]
voltage = { wave = "sine", amplitude = "4 kV", frequency = "0.5 Hz" }
[[step]]
kind = "release"
response = "instantaneous"
[[step]]
kind = "transient"
duration = "1200 s"
increments = 24000
)";
  const auto five = strokes(run(muscle(true) + drive), 1200);
  EXPECT_NEAR(five[0], 0.5190, 1e-4);
  EXPECT_NEAR(five[1], 0.5289, 1e-4);
  std::string two_branches = muscle(true);
  two_branches.replace(two_branches.find("material = \"VHB F9473PC\"\n"), 25, "");
  two_branches.insert(two_branches.find("[patch]"), R"([film.material]
name = "VHB F9473PC"
[[film.material.branch]]
law = "gent"
shear_modulus = "1 MPa"
stretch_limit = 200
dashpot = "nominal"
directions = ["x"]
viscosity = "1e7 Pa s"
)");
  const auto two = strokes(run(two_branches + drive), 1200);
  EXPECT_NEAR(two[0], 0.6725, 1e-4);
  EXPECT_NEAR(two[1], 0.6647, 1e-4);
}

/// Without bending stiffness, held at these stretches under a voltage in kV.
std::string wrinkling_patch(const std::string& law, double x, double y, double voltage) {
  return "[film]\nthickness = \"1 mm\"\nwrinkling = \"tension field\"\n[film.material]\n" + law +
         fmt::format("permittivity = \"4e-11 F/m\"\n[patch]\nstretch_x = {}\nstretch_y = {}\n[drive]\n"
                     "voltage = \"{} kV\"\n",
                     x, y, voltage);
}

TEST_F(PatchValidation, wrinkled_film_that_the_field_pulls_wider_without_limit_is_told_apart) {
  write("patch.toml", wrinkling_patch("shear_modulus = \"45 kPa\"\n", 1.5, 0.9, 30));
  const Case one = read_case(directory / "patch.toml");
  Simulation simulation(one, 1);
  const Outcome outcome = simulation.run({});
  EXPECT_EQ(outcome.ending, Ending::gave_up);
  EXPECT_EQ(outcome.kind, "electromechanical loss") << outcome.message;
}

// No node moves, and none of the equilibria is unstable: the charge alone would jump, by two decades.
TEST_F(PatchValidation, slack_film_that_snaps_is_a_limit_point) {
  write("patch.toml",
        wrinkling_patch("law = \"gent\"\nshear_modulus = \"40 kPa\"\nstretch_limit = 30\n", 1, 1, 24));
  const Case one = read_case(directory / "patch.toml");
  Simulation simulation(one, 1);
  double voltage = 0;
  SimulationObserver observer;
  observer.on_accept = [&](const Frame& frame) {
    voltage = frame.record.voltages.front();
    return true;
  };
  const Outcome outcome = simulation.run(observer);
  EXPECT_EQ(outcome.ending, Ending::gave_up);
  EXPECT_EQ(outcome.kind, "limit point") << outcome.message;
  // eps V^2/H^2 = mu J/(J - I1 + 3) (1 - l^-6)/l^2 has its first maximum there
  double most = 0;
  for (double l = 1; l < 1.6; l += 1e-4)
    most = std::max(most, 30 / (33 - 2 * l * l - 1 / std::pow(l, 4)) * (1 - std::pow(l, -6)) / (l * l));
  const double limit = 1e-3 * std::sqrt(40e3 * most / 4e-11);
  EXPECT_LT(voltage, limit);
  EXPECT_GT(voltage, limit - 2e-3 * 24e3); // two of the smallest increments
}

// Stopped at any record and resumed through a checkpoint's bytes, a run ends in the same bits: in time, along
// a followed path, and behind a jump.
TEST_F(PatchValidation, resumed_runs_end_in_the_same_bits) {
  const std::string gent = R"([film]
thickness = "1 mm"
[film.material]
law = "gent"
shear_modulus = "45 kPa"
stretch_limit = 100
permittivity = "4e-11 F/m"
)";
  const std::string branch = R"([[film.material.branch]]
shear_modulus = "20 kPa"
relaxation_time = "2 s"
)";
  const std::string square = "[patch]\nmode = \"equal-biaxial\"\n[drive]\nvoltage = ";
  for (const std::string& text :
       {gent + branch + square +
            "{ wave = \"square\", to = \"15 kV\", frequency = \"0.2 Hz\" }\n[[step]]\nkind = "
            "\"transient\"\nduration = "
            "\"12 s\"\nincrements = 24\n",
        gent + square + "\"25 kV\"\n[[step]]\nkind = \"voltage\"\non_instability = \"follow\"\n",
        gent + square + "\"25 kV\"\n[[step]]\nkind = \"voltage\"\non_instability = \"jump\"\n"}) {
    write("patch.toml", text);
    const Case one = read_case(directory / "patch.toml");
    Simulation straight(one, 1);
    int records = 0;
    SimulationObserver count;
    count.on_accept = [&](const Frame&) { return ++records > 0; };
    ASSERT_EQ(straight.run(count).ending, Ending::complete);
    for (int stop = 1; stop < records; stop += 5) {
      const auto out = directory / fmt::format("out{}", stop);
      {
        post::ResultsFolder folder(out, "run");
        Simulation first(one, 1);
        Recorder recorder(one, first, folder, false);
        int seen = 0;
        SimulationObserver observer;
        observer.on_critical = [&](const fem::CriticalPoint& critical, const post::Event& event) {
          recorder.record_mode(critical, event);
        };
        observer.on_accept = [&](const Frame& frame) {
          recorder.record(frame);
          return ++seen < stop; // the last state before a jump does not stop it
        };
        ASSERT_EQ(first.run(observer).ending, Ending::interrupted);
        recorder.save_checkpoint();
      }
      Simulation second(one, 1);
      post::ResultsFolder folder(out, "run");
      Recorder recorder(one, second, folder, true);
      ASSERT_EQ(second.run({}).ending, Ending::complete) << stop;
      for (std::size_t q = 0; q < one.quantities.size(); ++q)
        EXPECT_EQ(second.results()[q], straight.results()[q]) << one.quantities[q].name << " " << stop;
    }
  }
}

} // namespace
} // namespace dielast::cases::patch_validation_test
