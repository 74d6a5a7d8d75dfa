// SPDX-License-Identifier: GPL-3.0-or-later
// What is stable, and where a device goes that is not, whatever the increments.
#include "tests/cases/margins_at_end.hpp"
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace dielast::cases::stability_test {
namespace {

class Stability : public Paths {
 protected:
  static Case gallery_bow(std::vector<std::string> overrides) {
    overrides.insert(overrides.end(), {"check=", "output.error_estimate=false", "output.fields=false"});
    return read_case(std::filesystem::path(DIELAST_SOURCE_DIR) /
                         "cases/gallery/minimum_energy_structure/case.toml",
                     overrides);
  }

  /// Hinged, 80 mm long, pressed by a force (N), and film of 10 mm beside it.
  static std::string column(double prestretch, double force, int increments) {
    return fmt::format(R"toml(
model = "3d"
[film]
thickness = "0.1 mm"
prestretch = {}
[film.material]
shear_modulus = "40 kPa"
relative_permittivity = 3
[rectangle]
length = "10 mm"
[mesh]
across = 2
[part.bar]
at = [0, "50 mm", 0]
[part.bar.line]
to = ["80 mm", 0, 0]
[part.bar.mesh]
wall_elements = 24
[part.bar.beam]
width = "8 mm"
height = "0.4 mm"
material = {{ youngs_modulus = "3 GPa", poisson_ratio = 0.38 }}
[[support]]
place = "frame"
fix = ["x", "y", "z"]
[[support]]
place = "film"
fix = ["z"]
[[support]]
place = "bar.start"
fix = ["x", "y", "z", "turn_x", "turn_z"]
[[support]]
place = "bar.end"
fix = ["y", "z", "turn_x", "turn_z"]
[[load]]
place = "bar.end"
force = ["-{} N", 0, 0]
[[step]]
kind = "force"
increments = {}
)toml",
                       prestretch, force, increments);
  }
};

/// A hinged column of 80 mm buckles at pi^2 EI/L^2 = 0.1973921 N, a little before the end of its step:
/// however many increments lead there. (The state at the end was found from the one before by one step, whose
/// tangent was taken for that of the end.) Film beside it without a stress does not make it stable, where it
/// is slender and its stiffness is little beside the film's.
TEST_F(Stability, ColumnsBuckleAtEulersForce) {
  for (const double prestretch : {1.5, 1.0})
    for (const double force : {0.1982, 0.1976, 0.3})
      for (const int increments : {1, 4, 10}) {
        const Case one = read(column(prestretch, force, increments));
        SimulationObserver observer;
        std::vector<double> critical;
        observer.on_critical = [&](const fem::CriticalPoint& at, const post::Event&) {
          critical.push_back(at.load_factor * force);
        };
        EXPECT_EQ(Simulation(one, 1).run(observer).ending, Ending::gave_up) << force << " " << increments;
        ASSERT_EQ(critical.size(), 1u) << prestretch << " " << force << " " << increments;
        EXPECT_NEAR(critical[0], 0.1973921, 1e-4 * 0.1973921)
            << prestretch << " " << force << " " << increments;
      }
}

// The film of a honeycomb gives way in single cells, along a mode that is a thousand times stiffer,
// over the stiffness as drawn, than those of the whole. The load turns there: no bifurcation is told, and
// none that a bracket with other modes close to zero does not show.
TEST_F(Stability, FilmInCellsOfALatticeReachesALimitPoint) {
  const Case one = read_case(std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/honeycomb/case.toml",
                             {"check=", "output.error_estimate=false", "output.fields=false",
                              "honeycomb.columns=[2,3,2]", "mesh.wall_elements=4", "drive.voltage=10 kV"});
  SimulationObserver observer;
  int turns = 0;
  observer.on_critical = [&](const fem::CriticalPoint& critical, const post::Event& event) {
    turns += critical.kind == fem::Instability::limit_point && !event.branches_off;
    EXPECT_NEAR(critical.load_factor, 0.86374, 1e-5);
    EXPECT_GT(critical.mode.eigenvalue, 0);
  };
  EXPECT_EQ(Simulation(one, 1).run(observer).kind, "limit point");
  EXPECT_EQ(turns, 1);
}

// Its states are no states of the run, and what it would have found is not told: the run goes on from the
// last state before it, where it is sought anew.
TEST_F(Stability, TheSearchForACriticalPointCanBeInterrupted) {
  for (const bool pulls_in : {false, true}) {
    const Case one = pulls_in ? read(column(1.2, 0.1, 2) + "[[step]]\nkind = \"voltage\"\nincrements = 4\n"
                                                           "[drive]\nvoltage = \"20 kV\"\n")
                              : read(column(1.5, 0.3, 4));
    std::vector<std::vector<double>> rows;
    std::string critical;
    SimulationObserver observer;
    observer.on_accept = [&](const Frame& frame) {
      rows.push_back(frame.values);
      return true;
    };
    observer.on_critical = [&](const fem::CriticalPoint&, const post::Event& event) {
      critical = event.message;
    };
    const Outcome whole = Simulation(one, 1).run(observer);
    ASSERT_EQ(whole.ending, Ending::gave_up);
    ASSERT_NE(critical, "");
    for (const int asked : {1, 4}) {
      std::vector<std::vector<double>> before = std::exchange(rows, {});
      const std::string found = std::exchange(critical, "");
      std::optional<SimulationProgress> kept;
      Simulation stopped(one, 1);
      observer.on_accept = [&](const Frame& frame) {
        rows.push_back(frame.values);
        kept = stopped.progress();
        return true;
      };
      int times = 0;
      observer.goes_on = [&] { return ++times < asked; };
      const Outcome outcome = stopped.run(observer);
      EXPECT_EQ(outcome.ending, Ending::interrupted);
      EXPECT_EQ(outcome.kind, between_states);
      EXPECT_EQ(critical, "");
      Simulation resumed(one, 1);
      ASSERT_TRUE(kept);
      resumed.enter(kept->step);
      resumed.resume(*kept);
      observer.goes_on = {};
      EXPECT_EQ(resumed.run(observer).message, whole.message);
      EXPECT_EQ(critical, found);
      EXPECT_EQ(rows, before);
    }
  }
}

/// A jump does not lead through a stretch of 0 to film that is inside out, where the energy is lower, too.
TEST_F(Stability, JumpsDoNotTurnFilmInsideOut) {
  for (const int increments : {2, 3, 5, 40}) {
    const auto found = values(fmt::format(R"toml(
[film]
thickness = "1 mm"
[film.material]
law = "gent"
shear_modulus = "45 kPa"
stretch_limit = 100
permittivity = "4e-11 F/m"
[patch]
mode = "biaxial"
[drive]
voltage = "24 kV"
[output]
error_estimate = false
[[step]]
kind = "voltage"
name = "up"
increments = 3
on_instability = "jump"
[[step]]
kind = "voltage"
name = "down"
to = "0 V"
increments = {}
on_instability = "jump"
)toml",
                                          increments));
    EXPECT_NEAR(found.at("stretch_x"), 1, 1e-6) << increments;
  }
}

/// A bow whose bar has stayed straight as it was released is unstable: a step that may jump bends it, as
/// a release that jumps does.
TEST_F(Stability, AStepThatBeginsUnstableJumps) {
  const auto chord = [](std::vector<std::string> overrides) {
    overrides.insert(overrides.end(), {"drive.voltage=1 kV", "step.release.on_instability=follow",
                                       "step.voltage.on_instability=jump"});
    const Case one = gallery_bow(overrides);
    EXPECT_GT(test::values_at_end(one).at("rise"), 0.02);
    return test::values_at_end(one).at("chord");
  };
  const double bent = chord({});
  EXPECT_NEAR(chord({"step.release.on_bifurcation=follow"}), bent, 1e-6 * bent);
}

/// A bow opens under voltage until its bar is straight, at 2.0916 kV (closed form), and stays straight
/// beyond: where the branches meet there is neither a limit point nor an end, and no pull-in to be told of
/// below.
TEST_F(Stability, ABranchThatComesBackGoesOn) {
  for (const char* way : {"stop", "follow"})
    for (const int increments : {1, 5, 9, 12}) {
      const Case one =
          gallery_bow({"drive.voltage=2.5 kV", fmt::format("step.voltage.increments={}", increments),
                       fmt::format("step.voltage.on_instability={}", way)});
      EXPECT_NEAR(test::values_at_end(one).at("chord"), 0.08, 5e-6) << way << " " << increments;
    }
  const auto margins = test::margins_at_end(gallery_bow({"output.margins_up_to=2"}));
  EXPECT_FALSE(margins.at("pull-in").factor.has_value());
  // 2778 V, where the film between the hinges is as drawn
  EXPECT_NEAR(margins.at("breakdown").factor.value_or(0), 2778 / 1800.0, 1e-3);
}

/// Two modes of a sheared sheet lose their stability next to one another.
class ShearedSheet : public Stability {
 protected:
  Run sheared(int across, const std::string& on_instability) {
    return run(
        "model = \"3d\"\n[film]\nthickness = \"0.4 mm\"\nprestretch = [1.02, 1.05]\nsection = \"shell\"\n"
        "[film.material]\nshear_modulus = \"45 kPa\"\nrelative_permittivity = 4.7\n[strip]\n"
        "length = \"40 mm\"\nwidth = \"80 mm\"\n[mesh]\nacross = " +
            std::to_string(across) +
            "\n[[body]]\nname = \"bar\"\n"
            "places = [\"lower_end\"]\nfix = [\"x\", \"y\", \"z\", \"turn_x\", \"turn_y\", \"turn_z\"]\n"
            "[[support]]\nplace = \"upper_end\"\nfix = [\"x\", \"y\", \"z\", \"turn_x\", \"turn_y\", "
            "\"turn_z\"]\n"
            "displacement = { x = \"6 mm\" }\n[[step]]\nkind = \"move\"\nincrements = 6\n"
            "on_bifurcation = \"switch\"\non_instability = \"" +
            on_instability +
            "\"\n[[quantity]]\n"
            "name = \"lowest\"\nkind = \"modal stiffness\"\n[output]\nerror_estimate = false\nfields = "
            "false\n",
        "lowest");
  }
};

TEST_F(ShearedSheet, BranchThatIsUnstableAtItsEndIsNoResult) {
  const Run stopped = sheared(8, "stop");
  EXPECT_EQ(stopped.outcome.ending, Ending::gave_up);
  EXPECT_EQ(stopped.outcome.kind, "instability");
  EXPECT_LT(stopped.rows.back().value, 0);
  const Run jumped = sheared(8, "jump");
  EXPECT_EQ(jumped.outcome.ending, Ending::complete) << jumped.outcome.message;
  EXPECT_GT(jumped.rows.back().value, 0);
  EXPECT_EQ(jumped.rows.back().load_factor, 1);
}

// This mesh is not symmetric and leaves a gap where the branch of the first mode would lose its stability to
// the second: the path turns a sharp corner there and stays stable. A step across the gap led to the part
// beyond, which is unstable, and from which the sheet jumped to where the path ends.
TEST_F(ShearedSheet, BranchIsFollowedRoundACorner) {
  const Run followed = sheared(6, "stop");
  EXPECT_EQ(followed.outcome.ending, Ending::complete) << followed.outcome.message;
  EXPECT_NEAR(followed.rows.back().value, 30924, 10); // of the jump's end
}

// Where a buckled beam is pushed through, the branch along which it turns is unstable from its beginning: a
// step that may jump does so from there, as without a switch.
TEST_F(Stability, ABranchThatIsUnstableFromItsBeginningIsJumpedFrom) {
  const auto beam = [](const char* name, double from, double to) {
    return fmt::format(
        "[part.{0}.line]\nfrom = [\"{1} mm\", 0, 0]\nto = [\"{2} mm\", 0, 0]\n[part.{0}.beam]\n"
        "width = \"0.5 mm\"\nheight = \"5 mm\"\nmaterial = {{ youngs_modulus = \"2 GPa\", "
        "poisson_ratio = 0.3 }}\n",
        name, from, to);
  };
  const auto end = [&](const char* on_bifurcation) {
    const Run ran = run(
        beam("l", -20, 0) + beam("r", 0, 20) +
            "[part.f.film]\nthickness = \"0.5 mm\"\nprestretch = 2\n[part.f.film.material]\nshear_modulus = "
            "\"50 "
            "kPa\"\nrelative_permittivity = 4.7\n[part.f.rod]\nwidth = \"10 mm\"\n[part.f.line]\nto = [0, "
            "\"30 "
            "mm\", 0]\n[[tie]]\nbetween = [\"l.end\", \"r.start\"]\n[[tie]]\nbetween = [\"l.end\", "
            "\"f.start\"]\n"
            "[[support]]\nplace = \"l.start\"\nfix = [\"y\", \"turn_z\"]\ndisplacement = { x = \"0.5 mm\" }\n"
            "[[support]]\nplace = \"r.end\"\nfix = [\"y\", \"turn_z\"]\ndisplacement = { x = \"-0.5 mm\" }\n"
            "[[support]]\nplace = \"f.end\"\nfix = [\"x\", \"y\"]\n[[load]]\nplace = \"l.end\"\nforce = [0, "
            "\"-5 "
            "N\", 0]\n[drive]\nvoltage = \"1 kV\"\n[output]\nerror_estimate = false\n[[quantity]]\nname = "
            "\"y\"\n"
            "kind = \"displacement\"\nof = \"l.end\"\nalong = \"y\"\n[[step]]\nkind = "
            "\"release\"\n[[step]]\nkind "
            "= \"move\"\n[[step]]\nkind = \"force\"\nincrements = 20\non_instability = "
            "\"jump\"\non_bifurcation = \"" +
            std::string(on_bifurcation) + "\"\n",
        "y");
    EXPECT_EQ(ran.outcome.ending, Ending::complete) << ran.outcome.message;
    return ran.rows.back().value;
  };
  const double y = end("switch");
  EXPECT_NEAR(y, -4.24692e-3, 1e-6); // by a chain of 80 hinged bars with springs between them
  EXPECT_NEAR(y, end("follow"), 1e-9);
}

// Thickness that changes as film bends tilted the middle of film that was drawn at a face: elements of its
// thickness buckled under tension, and a disc that is clamped bent without a word.
TEST_F(Stability, FilmIsTheSameWhereverItIsDrawn) {
  for (const double prestretch : {1.2, 3.0}) {
    const auto frequency = [&](const char* section) {
      const Run ran = run(fmt::format("model = \"3d\"\n[film]\nsection = \"shell\"\nprestretch = {}\n{}"
                                      "[film.material]\nshear_modulus = \"50 kPa\"\n"
                                      "relative_permittivity = 4\n[rectangle]\nlength = \"20 mm\"\n"
                                      "width = \"10 mm\"\n[mesh]\nacross = 4\n[[step]]\n"
                                      "kind = \"voltage\"\nto = \"1 V\"\nincrements = 1\n[[quantity]]\n"
                                      "name = \"w\"\nkind = \"natural frequency\"\n"
                                      "[output]\nerror_estimate = false\nfields = false\n",
                                      prestretch, section),
                          "w");
      EXPECT_EQ(ran.outcome.ending, Ending::complete) << ran.outcome.message;
      return ran.rows.back().value;
    };
    const double at_middle = frequency("thickness = \"1 mm\"\n");
    EXPECT_NEAR(frequency("thickness = \"1 mm\"\noffset = \"0.5 mm\"\n"), at_middle, 1e-8 * at_middle);
    const std::string layered =
        fmt::format("thickness = \"0.1 mm\"\nlayer = [{{ thickness = \"0.9 mm\", prestretch = {}, "
                    "material = {{ shear_modulus = \"50 kPa\" }} }}]\n",
                    prestretch);
    EXPECT_NEAR(frequency(layered.c_str()), at_middle, 1e-6 * at_middle);
  }
  const auto bifurcation = [&](const char* offset) {
    const Run ran = run(
        fmt::format("model = \"3d\"\n[film]\nsection = \"shell\"\nthickness = \"0.5 mm\"\noffset = \"{}\"\n"
                    "[film.material]\nshear_modulus = \"40 kPa\"\nrelative_permittivity = 4.7\n[disc]\n"
                    "radius = \"50 mm\"\n[mesh]\nrings = 4\n[drive]\nvoltage = \"450 V\"\n[[step]]\n"
                    "kind = \"voltage\"\nincrements = 4\non_bifurcation = \"switch\"\n[[quantity]]\n"
                    "name = \"dz\"\nkind = \"displacement\"\nof = \"centre\"\nalong = \"z\"\n"
                    "[output]\nerror_estimate = false\nfields = false\n",
                    offset),
        "dz");
    EXPECT_EQ(ran.outcome.ending, Ending::complete) << ran.outcome.message;
    const auto event = std::ranges::find(ran.events, "bifurcation", &post::Event::kind);
    return event == ran.events.end() ? std::string("none") : event->message;
  };
  EXPECT_EQ(bifurcation("0.25 mm"), bifurcation("0 mm"));
  EXPECT_NE(bifurcation("0.25 mm"), "none");
}

// Ribbons that turn freely at their ends pull only: they pushed the tip to twice its angle, with exit code 0.
TEST_F(Stability, RibbonsThatWouldBePushedAreTold) {
  for (const auto& [way, elements] : {std::pair{"stop", 1}, {"follow", 1}, {"follow", 8}}) {
    const Case one =
        read_case(std::filesystem::path(DIELAST_SOURCE_DIR) / "cases/gallery/antagonistic_rolls/case.toml",
                  {"check=", "output.error_estimate=false", "output.fields=false", "drive.upper.voltage=4 kV",
                   "mesh.order=1", fmt::format("mesh.wall_elements={}", elements),
                   fmt::format("step.voltage.on_instability={}", way)});
    const Outcome outcome = Simulation(one, 1).run({});
    EXPECT_EQ(outcome.kind, "slack ribbon") << way << " " << elements << ": " << outcome.message;
    EXPECT_NE(outcome.message.find("the upper ribbon"), std::string::npos) << outcome.message;
  }
}

} // namespace
} // namespace dielast::cases::stability_test
