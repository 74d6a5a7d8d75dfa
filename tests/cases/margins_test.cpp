// SPDX-License-Identifier: GPL-3.0-or-later
// How far limits are from the end of a run, against closed forms of homogeneous film.
#include "cases/readers/reader.hpp"
#include "tests/cases/margins_at_end.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::cases::margins_test {
namespace {

class Margins : public test::ScratchTest {
 protected:
  std::map<std::string, Margin> margins(const std::string& text,
                                        const std::vector<std::string>& overrides = {}) {
    write("case.toml", text);
    return test::margins_at_end(read_case(directory / "case.toml", overrides));
  }
};

// Neo-Hookean film without loads, stretched l in all directions by a voltage: the field E_0 = V / H obeys
// eps E_0^2 = mu (l^-2 - l^-8), largest at l = 4^(1/6); the true field is l^2 E_0.
constexpr double modulus = 40e3, permittivity = 4e-11, thickness = 1e-3;
double voltage_at(double stretch) {
  return thickness * std::sqrt(modulus / permittivity * (std::pow(stretch, -2) - std::pow(stretch, -8)));
}
const double pull_in = voltage_at(std::pow(4, 1.0 / 6));

std::string patch(double voltage, double breakdown, const char* more = "") {
  return fmt::format(
      "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\npermittivity = "
      "\"4e-11 F/m\"\nbreakdown_field = \"{} V/m\"\n[patch]\nmode = \"equal-biaxial\"\n"
      "[drive]\nvoltage = \"{} V\"\n[[step]]\nkind = \"voltage\"\nincrements = 40\n{}",
      breakdown, voltage, more);
}

TEST_F(Margins, BreakdownThatWasPassedIsWhereTheFieldWasReached) {
  const double stretch = 1.1, field = stretch * stretch * voltage_at(stretch) / thickness;
  const double end = 0.98 * pull_in;
  const Margin found = margins(patch(end, field)).at("breakdown");
  ASSERT_TRUE(found.factor);
  EXPECT_NEAR(*found.factor, voltage_at(stretch) / end, 1e-5);
}

// The rows of few increments are far apart where the path turns; what was passed is solved for between them.
TEST_F(Margins, DoNotDependOnTheIncrements) {
  const double stretch = 1.15, field = stretch * stretch * voltage_at(stretch) / thickness;
  for (const char* increments : {"step.voltage.increments=3", "step.voltage.increments=10"}) {
    const double end = 0.999 * pull_in;
    const Margin found = margins(patch(end, field), {increments}).at("breakdown");
    ASSERT_TRUE(found.factor);
    EXPECT_NEAR(*found.factor, voltage_at(stretch) / end, 1e-5) << increments;
    EXPECT_EQ(found.remark, "");
    const Margin stopped = margins(patch(1.1 * pull_in, field), {increments}).at("breakdown");
    ASSERT_TRUE(stopped.factor);
    EXPECT_NEAR(*stopped.factor, voltage_at(stretch) / pull_in, 2e-5) << increments;
    EXPECT_EQ(stopped.remark, "");
  }
}

// A film that stiffens jumps at its limit point; from behind no way leads back to what was passed before.
TEST_F(Margins, WhatWasPassedBeforeAJumpIsSolvedForThere) {
  const auto gent = [this](const char* end) {
    std::string text = patch(1, 20e6, "on_instability = \"jump\"\n");
    text.replace(text.find("shear_modulus"), 0, "law = \"gent\"\nstretch_limit = 20\n");
    return margins(text, {fmt::format("drive.voltage={}", end), "step.voltage.increments=10"});
  };
  const auto whole = gent("26 kV"), part = gent("20 kV");
  ASSERT_TRUE(whole.at("breakdown").factor && part.at("breakdown").factor);
  EXPECT_NEAR(*whole.at("breakdown").factor * 26, *part.at("breakdown").factor * 20, 1e-4);
  EXPECT_EQ(whole.at("breakdown").remark, "");
}

TEST_F(Margins, WhatWasNotReachedIsNotGuessed) {
  const auto found = margins(patch(0.5 * pull_in, 1e9));
  for (const char* limit : {"breakdown", "pull-in"}) {
    EXPECT_FALSE(found.at(limit).factor) << limit;
    EXPECT_EQ(found.at(limit).remark, "not reached up to 1 times the voltage of the end") << limit;
  }
  EXPECT_EQ(found.at("wall yield").remark, "not known: there are no walls");
  EXPECT_EQ(found.at("buckling").remark,
            "not known: film does not leave its plane, or its meridian's, in this model");
}

TEST_F(Margins, LookingFurtherFindsPullInAndBreakdown) {
  const double stretch = 1.15, field = stretch * stretch * voltage_at(stretch) / thickness;
  const double end = 0.6 * pull_in;
  const auto found = margins(patch(end, field), {"output.margins_up_to=3"});
  ASSERT_TRUE(found.at("breakdown").factor);
  EXPECT_NEAR(*found.at("breakdown").factor, voltage_at(stretch) / end, 1e-5);
  ASSERT_TRUE(found.at("pull-in").factor);
  EXPECT_NEAR(*found.at("pull-in").factor, pull_in / end, 1e-3);
}

TEST_F(Margins, ARunThatEndsAtItsLimitPointIsThere) {
  const Margin found = margins(patch(1.2 * pull_in, 1e9)).at("pull-in");
  ASSERT_TRUE(found.factor);
  EXPECT_NEAR(*found.factor, 1, 1e-12);
}

// Film held at the stretch l loses its tension where eps E_0^2 l^4 = mu (l^2 - l^-4) ... of true stresses.
TEST_F(Margins, HeldFilmLosesItsTensionWhereTheFieldBalancesIt) {
  const double stretch = 1.5;
  const double lost = thickness / (stretch * stretch) *
                      std::sqrt(modulus / permittivity * (stretch * stretch - std::pow(stretch, -4)));
  const std::string held = "[film]\nthickness = \"1 mm\"\nprestretch = 1.5\n[film.material]\nshear_modulus = "
                           "\"40 kPa\"\npermittivity "
                           "= \"4e-11 F/m\"\n[patch]\nstretch_x = 1.5\nstretch_y = 1.5\n[[step]]\nkind = "
                           "\"move\"\n[[step]]\nkind = "
                           "\"voltage\"\nincrements = 20\n";
  const auto passed = margins(held, {fmt::format("drive.voltage={} V", 1.2 * lost)});
  ASSERT_TRUE(passed.at("loss of tension").factor);
  EXPECT_NEAR(*passed.at("loss of tension").factor, 1 / 1.2, 1e-4);
  const auto ahead = margins(held, {fmt::format("drive.voltage={} V", 0.5 * lost), "output.margins_up_to=3"});
  ASSERT_TRUE(ahead.at("loss of tension").factor);
  EXPECT_NEAR(*ahead.at("loss of tension").factor, 2, 1e-4);
}

// The least principal stress of film held along x, with free sides, is theirs, 0, until its own is none: it
// is stretched equally then, and eps E^2 = mu (a^2 - a^-4).
TEST_F(Margins, FilmWithFreeSidesLosesItsTensionWhereItsForceIsNone) {
  const double stretch = 1.3;
  const double lost = thickness / (stretch * stretch) *
                      std::sqrt(modulus / permittivity * (stretch * stretch - std::pow(stretch, -4)));
  const std::string held = "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\n"
                           "permittivity = \"4e-11 F/m\"\n[patch]\nstretch_x = 1.3\n[[step]]\nkind = "
                           "\"move\"\n[[step]]\nkind = \"voltage\"\nincrements = 7\n";
  const auto passed = margins(held, {fmt::format("drive.voltage={} V", 1.05 * lost)});
  ASSERT_TRUE(passed.at("loss of tension").factor) << passed.at("loss of tension").remark;
  EXPECT_NEAR(*passed.at("loss of tension").factor, 1 / 1.05, 1e-6);
  const auto ahead = margins(held, {fmt::format("drive.voltage={} V", 0.7 * lost), "output.margins_up_to=3"});
  ASSERT_TRUE(ahead.at("loss of tension").factor) << ahead.at("loss of tension").remark;
  EXPECT_NEAR(*ahead.at("loss of tension").factor, 1 / 0.7, 1e-6);
}

// A force that comes last stretches the film l times under 3 kV and the stress 60 kPa: at the factor f on the
// voltage the true field l^2 f V / H is the breakdown field where 60 kPa l = mu (l^2 - l^-4) - eps E^2.
TEST_F(Margins, WhatAForcePassesIsTheFactorOnTheVoltage) {
  const std::string pulled = "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"50 "
                             "kPa\"\npermittivity = \"4e-11 F/m\"\n"
                             "breakdown_field = \"5 MV/m\"\n[patch]\nmode = \"equal-biaxial\"\nstress_x = "
                             "\"60 kPa\"\n[[step]]\nkind = "
                             "\"voltage\"\nto = \"3 kV\"\n[[step]]\nkind = \"force\"\n";
  double low = 1, high = 3;
  for (int i = 0; i < 60; ++i) {
    const double l = (low + high) / 2;
    (50e3 * (l * l - std::pow(l, -4)) - 4e-11 * 25e12 > 60e3 * l ? high : low) = l;
  }
  const double factor = 5e6 * 1e-3 / (low * low) / 3e3;
  const Margin found = margins(pulled).at("breakdown");
  ASSERT_TRUE(found.factor) << found.remark;
  EXPECT_NEAR(*found.factor, factor, 1e-5);
  EXPECT_NEAR(factor, 0.850, 5e-4);
  EXPECT_EQ(found.remark, "on the way back to 0 V, with all other loads of the end");
  // the other way round the run itself tells
  const Margin told = margins(pulled.substr(0, pulled.find("[[step]]")) +
                              "[[step]]\nkind = \"force\"\n[[step]]\nkind = \"voltage\"\nto = \"3 kV\"\n")
                          .at("breakdown");
  ASSERT_TRUE(told.factor);
  EXPECT_NEAR(*told.factor, factor, 1e-5);
  EXPECT_EQ(told.remark, "");
  // pressed together, with a voltage or without
  const auto held =
      margins("[film]\nthickness = \"1 mm\"\nprestretch = 1.2\n[film.material]\nshear_modulus = \"50 "
              "kPa\"\npermittivity = \"4e-11 F/m\"\n[patch]\nstretch_x = 0.9\nstretch_y = 0.9\n"
              "[[step]]\nkind = \"voltage\"\nto = \"1 kV\"\n[[step]]\nkind = \"move\"\n");
  ASSERT_TRUE(held.at("loss of tension").factor);
  EXPECT_EQ(*held.at("loss of tension").factor, 0);
  EXPECT_EQ(held.at("loss of tension").remark, "passed without voltage");
}

// Any voltage compresses a slab: that is no limit of what bears compression.
TEST_F(Margins, SolidsAndShellsLoseNoTension) {
  const auto found =
      margins("[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"50 kPa\"\npermittivity = "
              "\"4e-11 F/m\"\n[slab]\nlength = \"4 mm\"\nheight = \"1 mm\"\n[[support]]\nplace = "
              "\"bottom\"\nfix = [\"x\", \"y\"]\n[[step]]\nkind = \"voltage\"\nto = \"1 kV\"\n");
  EXPECT_FALSE(found.at("loss of tension").factor);
  EXPECT_EQ(found.at("loss of tension").remark, "not known: shells and solids bear compression");
}

// A support that holds until the end of the run held no longer behind it.
TEST_F(Margins, WhatHoldsAtTheEndGoesOnHolding) {
  const double lost = thickness / 4 * std::sqrt(modulus / permittivity * (4 - 1.0 / 16));
  const std::string held =
      "model = \"planar\"\n[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\nshear_modulus = "
      "\"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[disc]\nradius = \"20 mm\"\nelectrode_radius = \"8 mm\"\n"
      "[mesh]\nrings = 5\n[[support]]\nplace = \"rim\"\nfix = [\"x\", \"y\"]\n[[support]]\nplace = "
      "\"electrode_edge\"\nfix = [\"x\", \"y\"]\nuntil = \"charge\"\n[[step]]\nkind = \"voltage\"\nname = "
      "\"charge\"\n";
  const Margin found = margins(held, {fmt::format("drive.voltage={} V", lost / 2), "output.margins_up_to=3"})
                           .at("loss of tension");
  ASSERT_TRUE(found.factor) << found.remark;
  EXPECT_NEAR(*found.factor, 2, 1e-4);
}

// A leak behind a resistance takes a fifth of the source's voltage, there as here: margins were looked for up
// to four fifths of what was asked for, and no state between was found again.
TEST_F(Margins, ALeakTakesItsPartBehindTheEndToo) {
  const double stretch = 1.15, field = stretch * stretch * voltage_at(stretch) / thickness;
  const double end = 0.5 * pull_in; // of the source
  const auto found = margins(patch(end, field, "[circuit]\nresistance = 1e9\nleakage_resistance = 4e9\n"),
                             {"output.margins_up_to=2.6"});
  ASSERT_TRUE(found.at("breakdown").factor && found.at("pull-in").factor);
  EXPECT_NEAR(*found.at("breakdown").factor, voltage_at(stretch) / (0.8 * end), 1e-5);
  EXPECT_EQ(found.at("breakdown").remark, "");
  EXPECT_NEAR(*found.at("pull-in").factor, 2.5, 1e-3);
}

TEST_F(Margins, WithoutAVoltageOrInTimeNothingIsKnown) {
  EXPECT_EQ(margins(patch(0, 1e9)).at("pull-in").remark, "not known: no voltage is applied at the end");
  const auto timed = margins(patch(500, 1e9, "duration = \"1 s\"\n"));
  EXPECT_EQ(timed.at("pull-in").remark,
            "not known: time passes: a run tells of its own course of the voltage only");
}

// A clamped plate of film buckles under its own widening at 14.68 D / a^2 of compression (Timoshenko, Gere,
// Theory of Elastic Stability, art. 9.2), D of the incompressible film: eps V^2 / H = 14.68 D / a^2. Nobody
// pulls in there, and what follows does not move the point: the margin was that of the next state, and
// pull-in.
TEST_F(Margins, BucklingIsWhereThePathsPart) {
  const std::string plate =
      "model = \"3d\"\n[film]\nthickness = \"0.1 mm\"\nsection = \"shell\"\n[film.material]\nshear_modulus = "
      "\"300 kPa\"\nrelative_permittivity = 3\n[disc]\nradius = \"10 mm\"\n[mesh]\nrings = 4\n"
      "[[step]]\nkind = \"voltage\"\n";
  const auto buckling = [&](double volt, const std::string& more, const std::vector<std::string>& overrides) {
    std::vector<std::string> all = overrides;
    all.push_back(fmt::format("drive.voltage={} V", volt));
    const auto found = margins(plate + more, all);
    EXPECT_FALSE(found.at("pull-in").factor) << more << *found.at("pull-in").factor;
    EXPECT_NE(found.at("pull-in").remark.find("not reached"), std::string::npos);
    return found.at("buckling").factor.value_or(0) * volt;
  };
  const double closed = 235.09;
  const double jumps = buckling(250, "on_instability = \"jump\"\n", {});
  EXPECT_NEAR(jumps, closed, 0.01 * closed);
  EXPECT_NEAR(buckling(250, "on_bifurcation = \"switch\"\n", {"step.voltage.increments=4"}), jumps,
              1e-4 * jumps);
  EXPECT_NEAR(buckling(250, "", {}), 250, 1e-9 * jumps); // ends there
  EXPECT_NEAR(buckling(200, "", {"output.margins_up_to=3"}), jumps, 1e-4 * jumps);
}

// Film that is held all around keeps its shape until eps E^2 = mu (l^2 - l^-4), and there it leaves its
// plane.
TEST_F(Margins, TensionEndsWhereFilmLeavesItsPlane) {
  const double stretch = 1.4, tension = modulus * (std::pow(stretch, 2) - std::pow(stretch, -4));
  const double end = thickness / std::pow(stretch, 2) * std::sqrt(tension / permittivity);
  const auto held = [&](const char* model, double voltage) {
    return fmt::format("model = \"{}\"\n[film]\nthickness = \"1 mm\"\nprestretch = {}\n[film.material]\n"
                       "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[disc]\nradius = "
                       "\"20 mm\"\n[mesh]\nrings = 4\n[drive]\nvoltage = \"{} V\"\n[output]\n"
                       "margins_up_to = 2\n",
                       model, stretch, voltage);
  };
  for (const char* model : {"axisymmetric", "3d"}) {
    const Margin beyond = margins(held(model, 0.8 * end)).at("loss of tension");
    EXPECT_NEAR(beyond.factor.value_or(0), 1 / 0.8, 1e-5) << model << ": " << beyond.remark;
    const Margin stopped = margins(held(model, 1.1 * end)).at("loss of tension");
    EXPECT_NEAR(stopped.factor.value_or(0), 1, 1e-5) << model << ": " << stopped.remark;
  }
}

// Of film that may wrinkle, held at 2 along x and 1 along y: mu (1 - 2^-2) = eps E_0^2 2^2, before the end
// of the run, of which no quantity tells.
TEST_F(Margins, OfTensionThatAWrinklingFilmHasLost) {
  const std::string held =
      "[film]\nthickness = \"1 mm\"\nwrinkling = \"tension field\"\n[film.material]\nshear_modulus = \"40 "
      "kPa\"\n"
      "permittivity = \"4e-11 F/m\"\n[patch]\nstretch_x = 2\nstretch_y = 1\n[drive]\nvoltage = \"15 kV\"\n"
      "[output]\nerror_estimate = false\n";
  const double lost = thickness * std::sqrt(modulus * (1 - 0.25) / (permittivity * 4)) / 15e3;
  for (const char* up_to : {"1", "3"})
    EXPECT_NEAR(margins(held, {std::string("output.margins_up_to=") + up_to})
                    .at("loss of tension")
                    .factor.value_or(0),
                lost, 1e-5);
  EXPECT_NEAR(margins(held, {"drive.voltage=10 kV", "output.margins_up_to=2"})
                  .at("loss of tension")
                  .factor.value_or(0),
              1.5 * lost, 1e-5);
}

// Evenly stretched film that is charged all over leaves its plane in many short waves next to one another,
// where its tension along the shorter stretch ends: mu (l1^2 - l3^2) = eps E^2, with E = V / (H l3).
TEST_F(Margins, AreFoundAmongManyModesNextToOneAnother) {
  const double l1 = 2, l3 = 1.0 / 6;
  const double lost = thickness * l3 * std::sqrt(modulus * (l1 * l1 - l3 * l3) / permittivity) / 8e3;
  double before = 1.02 * lost;
  for (const int across : {6, 8, 12}) {
    const auto found = margins(
        fmt::format("model = \"3d\"\n[film]\nthickness = \"1 mm\"\nprestretch = [2, 3]\n[film.material]\n"
                    "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[rectangle]\nlength = \"80 "
                    "mm\"\nwidth = \"50 mm\"\n[mesh]\nacross = {}\n[drive]\nvoltage = \"8 kV\"\n[[step]]\n"
                    "kind = \"voltage\"\n[output]\nmargins_up_to = 20\n",
                    across));
    EXPECT_NEAR(found.at("loss of tension").factor.value_or(0), lost, 1e-7 * lost) << across;
    const double buckling = found.at("buckling").factor.value_or(0);
    EXPECT_GT(buckling, lost) << across;
    EXPECT_LT(buckling, before) << across; // from above, as the waves are resolved
    before = buckling;
  }
  EXPECT_LT(before, 1.005 * lost);
}

} // namespace
} // namespace dielast::cases::margins_test
