// SPDX-License-Identifier: GPL-3.0-or-later
// Strips and stacks: what layers, covers, margins and strays must do, whatever the numbers.
#include "cases/devices/device.hpp"
#include "tests/cases/case_test.hpp"

#include <fmt/format.h>

namespace dielast::cases::strips_test {
namespace {

const std::string stack = R"toml(
[film]
thickness = "50 um"
[film.material]
shear_modulus = "0.4 MPa"
relative_permittivity = 2.8
[strip]
length = "12 mm"
width = "13 mm"
layers = 10
[weight]
mass = "50 g"
[gravity]
film = false
[drive]
voltage = "1 kV"
[mesh]
across = 4
)toml";

class Strips : public test::CaseTest {
 protected:
  void expect_alike(const std::map<std::string, double>& one, const std::map<std::string, double>& other) {
    for (const char* name : {"extension", "stroke", "strain", "coupling"})
      EXPECT_NEAR(one.at(name), other.at(name), 1e-9 * std::abs(other.at(name))) << name;
  }
};

// As a [plate] or a [[body]] does: what jumps under a weight overshoots.
TEST_F(Strips, TheirWeightHasInertiaByDefault) {
  const std::string timed =
      stack + "[[step]]\nkind = \"weight\"\n[[step]]\nkind = \"transient\"\nduration = \"1 ms\"\n";
  EXPECT_TRUE(read(timed).steps.back().inertia);
  EXPECT_FALSE(read(timed, {"weight.mass=0 g"}).steps.back().inertia);
  EXPECT_FALSE(read(timed, {"step[2].inertia=false"}).steps.back().inertia);
}

TEST_F(Strips, LayersAreOneThickFilmUnderTheSameField) {
  const auto layers = values(stack);
  const auto thick = values(stack, {"strip.layers=1", "film.thickness=0.5 mm", "drive.voltage=10 kV"});
  expect_alike(layers, thick);
  EXPECT_NEAR(layers.at("capacitance"), 100 * thick.at("capacitance"), 1e-9 * layers.at("capacitance"));
  EXPECT_NEAR(layers.at("natural_frequency"), thick.at("natural_frequency"), 1e-6);
  EXPECT_GT(layers.at("stroke"), 10e-6);
}

TEST_F(Strips, CoversCarryWithoutAField) {
  const auto bare = values(stack, {"drive.voltage=0"});
  const auto covered = values(stack, {"drive.voltage=0", "strip.cover_thickness=50 um", "weight.mass=60 g"});
  EXPECT_NEAR(covered.at("extension"), bare.at("extension"), 1e-12);
  EXPECT_NEAR(covered.at("stiffness"), 1.2 * bare.at("stiffness"), 1e-6);
  EXPECT_NEAR(covered.at("capacitance"), bare.at("capacitance"), 1e-20);
  EXPECT_NEAR(covered.at("coupling"), bare.at("coupling"), 1e-9);
}

// The force per squared voltage is a property of the state, not of who keeps the charge.
TEST_F(Strips, CouplingIsThatOfTheStateHoweverItWasCharged) {
  const auto connected = values(stack);
  const auto charged = values(stack, {fmt::format("drive={{charge={}}}", 1e3 * connected.at("capacitance")),
                                      "step=[{kind='weight'}, {kind='charge'}]"});
  EXPECT_NEAR(charged.at("extension"), connected.at("extension"), 1e-9 * connected.at("extension"));
  EXPECT_NEAR(charged.at("coupling"), connected.at("coupling"), 1e-7);
  EXPECT_GT(charged.at("stiffness"), 1.01 * connected.at("stiffness")); // as its charge stays
}

// What a support holds has the stiffness that it has where its weight holds it; it had none.
TEST_F(Strips, WhatIsHeldIsAsStiffAsWhatHangsThere) {
  const auto hangs = values(stack);
  const auto held =
      values(stack, {fmt::format("support=[{{place='upper_end', fix=['x','y','z']}}, {{place='bar', "
                                 "displacement={{y={:.17g}}}}}]",
                                 -hangs.at("extension")),
                     "step=[{kind='move'}, {kind='voltage'}]"});
  EXPECT_NEAR(held.at("stiffness"), hangs.at("stiffness"), 1e-6 * hangs.at("stiffness"));
  EXPECT_NEAR(held.at("coupling"), hangs.at("coupling"), 1e-6 * hangs.at("coupling"));
}

// The motion by the voltage counts from where it sets out, whatever the step before is called.
TEST_F(Strips, StrokeCountsFromBeforeTheVoltage) {
  const auto since = [&](const std::string& steps) {
    const Case one = read(stack, {"step=" + steps});
    return std::ranges::find(one.quantities, "stroke", &Quantity::name)->since;
  };
  EXPECT_EQ(since("[{kind='weight', name='hang'}, {kind='voltage'}]"), "hang");
  EXPECT_EQ(since("[{kind='hold', name='wait', duration=1}, {kind='modes'}, {kind='voltage'}]"), "wait");
  EXPECT_EQ(since("[{kind='voltage'}, {kind='hold', duration=1}]"), "");
}

// Its own [[support]] stands instead of the clamp of a strip, which then goes along as it is.
TEST_F(Strips, WhatOneSupportCarriesAlongIsTold) {
  const auto told = [&](const std::string& supports, const std::string& step) {
    const Case one = read(stack, {"support=[" + supports + "]", "step=[{" + step + "}]"});
    return std::ranges::count_if(build_device(one).warnings, [](const std::string& warning) {
      return warning.find("nothing else holds the device along y: it is carried along with \"bar\"") !=
             std::string::npos;
    });
  };
  const std::string pulled = "{place='bar', displacement={y='-1 mm'}}",
                    clamp = "{place='upper_end', fix=['x','y']}";
  EXPECT_EQ(told(pulled, "kind='move'"), 1);
  EXPECT_EQ(told(pulled + ", " + clamp, "kind='move'"), 0);
  EXPECT_EQ(told(clamp, "kind='weight'"), 0);
  EXPECT_EQ(told(pulled, "kind='move'}, {kind='hold', duration=1, inertia=true"), 0);
}

TEST_F(Strips, AnElectrodeInTheClampsHasACapacitanceOnly) {
  const auto even = values(stack, {"strip.electrode_width=10 mm"});
  const auto longer = values(stack, {"strip.electrode_width=10 mm", "strip.electrode_length=16 mm"});
  expect_alike(longer, even);
  const double outside = 10 * 2.8 * 8.8541878128e-12 * 4e-3 * 10e-3 / 50e-6;
  EXPECT_NEAR(longer.at("capacitance") - even.at("capacitance"), outside, 1e-9 * outside);
}

// Twice the prestretch, four times the area of a quarter of the thickness.
TEST_F(Strips, WhatLiesInTheClampsIsPrestretched) {
  const std::vector<std::string> stretched{"film.prestretch=2", "drive.voltage=0", "strip.layers=1"};
  const auto even = values(stack, stretched);
  auto overrides = stretched;
  overrides.emplace_back("strip.electrode_length=16 mm");
  const double outside = 2.8 * 8.8541878128e-12 * 4e-3 * 13e-3 / (50e-6 / 4);
  EXPECT_NEAR(values(stack, overrides).at("capacitance") - even.at("capacitance"), outside, 1e-9 * outside);
}

TEST_F(Strips, AMarginHasNoField) {
  const auto covered = values(stack);
  for (const char* margin : {"strip.electrode_width=6.5 mm", "strip.electrode_length=6 mm"}) {
    const auto half = values(stack, {margin});
    EXPECT_LT(half.at("stroke"), 0.75 * covered.at("stroke")) << margin;
    EXPECT_GT(half.at("stroke"), 0.3 * covered.at("stroke")) << margin;
    EXPECT_NEAR(half.at("capacitance"), covered.at("capacitance") / 2, 0.05 * covered.at("capacitance"))
        << margin;
  }
}

// Isolated while the weight pulls: film and stray share the charge.
TEST_F(Strips, AStrayTakesItsShareOfTheCharge) {
  const std::string electrode = R"toml(
[[electrode]]
name = "film"
place = "electrode"
stray_capacitance = "0.5 nF"
[[step]]
kind = "voltage"
[[step]]
kind = "weight"
control = "charge"
[[quantity]]
name = "charge"
kind = "charge"
of = "film"
[[quantity]]
name = "charge_before"
kind = "charge"
of = "film"
at = "voltage"
[[quantity]]
name = "capacitance_before"
kind = "capacitance"
of = "film"
at = "voltage"
[[quantity]]
name = "field"
kind = "extreme"
of = "electric_field"
extreme = "minimum"
)toml";
  const auto with = values(stack + electrode);
  const auto without = values(stack + electrode, {"electrode[1].stray_capacitance=0 F"});
  EXPECT_NEAR(with.at("charge"), with.at("charge_before"), 1e-9 * with.at("charge"));
  EXPECT_NEAR(with.at("capacitance_before") - without.at("capacitance_before"), 0.5e-9, 1e-18);
  EXPECT_GT(with.at("capacitance"), 1.02 * with.at("capacitance_before"));
  EXPECT_LT(std::abs(with.at("energy_error")), 1e-9 * with.at("mechanical_work"));
  EXPECT_LT(std::abs(without.at("energy_error")), 1e-9 * without.at("mechanical_work"));
}

// What lies beside the film pulls at nothing.
TEST_F(Strips, StrayCapacitanceDoesNotCouple) {
  const std::string hung = R"toml(
[film]
thickness = "0.2 mm"
[film.material]
shear_modulus = "45 kPa"
relative_permittivity = 4.7
[strip]
length = "50 mm"
width = "20 mm"
[mesh]
across = 4
[weight]
mass = "5 g"
[drive]
voltage = "1 kV"
)toml";
  const auto alone = values(hung),
             beside = values(hung + "[[electrode]]\nname = \"film\"\nplace = \"electrode\"\n"
                                    "stray_capacitance = \"1 nF\"\n");
  EXPECT_NEAR(beside.at("coupling"), alone.at("coupling"), 1e-9 * alone.at("coupling"));
}

// Cut free before its weight hangs on it a strip has no stiffness across itself in space, but for rounding.
TEST_F(Strips, HangInSpaceAsInThePlane) {
  const std::string hung = R"toml(
[film]
thickness = "0.25 mm"
prestretch = [1, 1.3]
[film.material]
law = "yeoh"
c1 = "40 kPa"
c2 = "1 kPa"
relative_permittivity = 3
[strip]
length = "30 mm"
width = "10 mm"
[mesh]
across = 4
[weight]
mass = "30 g"
[drive]
voltage = "2 kV"
)toml";
  for (const char* prestretch : {"[1, 1.05]", "[1, 1.3]", "[1, 1.5]"}) {
    const std::vector<std::string> with{std::string("film.prestretch=") + prestretch};
    const double in_plane = values(hung, with).at("extension");
    EXPECT_NEAR(values("model = \"3d\"\n" + hung, with).at("extension"), in_plane, 1e-8 * in_plane)
        << prestretch;
  }
}

// The charge of film that wrinkles is no multiple of its voltage: what couples is what another volt adds to
// the force.
TEST_F(Strips, WrinkledFilmCouplesAsItsForceChangesWithTheVoltage) {
  const std::string sheared = R"toml(
[film]
thickness = "0.2 mm"
prestretch = [1, 1.01]
wrinkling = "tension field"
[film.material]
shear_modulus = "45 kPa"
relative_permittivity = 4.7
[strip]
length = "50 mm"
width = "100 mm"
[mesh]
across = 8
[[body]]
name = "bar"
places = ["lower_end"]
fix = ["x", "y", "turn_z"]
[[support]]
place = "upper_end"
fix = ["x", "y"]
displacement = { x = "2 mm" }
[drive]
voltage = "1 kV"
[[step]]
kind = "move"
increments = 2
[[step]]
kind = "voltage"
increments = 2
[[quantity]]
name = "pull"
kind = "force"
of = "upper_end"
along = "y"
)toml";
  const auto at = values(sheared), below = values(sheared, {"drive.voltage=990"}),
             above = values(sheared, {"drive.voltage=1010"});
  const double per_squared_voltage = (below.at("pull") - above.at("pull")) / (1010.0 * 1010 - 990.0 * 990);
  const double capacitance = 4.7 * 8.8541878128e-12 * 0.05 * 0.1 * 1.01 / 0.2e-3; // as drawn
  EXPECT_NEAR(at.at("coupling"), per_squared_voltage * 0.05 / capacitance, 1e-4 * at.at("coupling"));
}

// Stretched by the weight without a bending moment, a stack of shells is the membrane.
TEST_F(Strips, AStackOfShellsPullsLikeTheMembrane) {
  const std::vector<std::string> few{"strip.layers=3", "strip.cover_thickness=25 um", "weight.mass=15 g"};
  const auto membrane = values(stack, few);
  auto overrides = few;
  overrides.insert(overrides.end(), {"film.section=shell", "model=3d"});
  const auto shell = values(stack, overrides);
  for (const char* name : {"extension", "stroke", "capacitance", "coupling"})
    EXPECT_NEAR(shell.at(name), membrane.at(name), 0.01 * std::abs(membrane.at(name))) << name;
}

// The bar at the lower end carries the last node of the side.
TEST_F(Strips, SidesThatAreHeldAreToldOfTheNodeThatTheBarCarries) {
  const Case one = read(stack + "[[support]]\nplace = \"left\"\nfix = [\"x\"]\n");
  try {
    build_device(one);
    ADD_FAILURE() << "nothing is told";
  } catch (const CaseError& error) {
    EXPECT_NE(
        std::string(error.what()).find("\"left\" has the node drawn at (-6.5, -12, 0) mm, which a [[body]]"),
        std::string::npos)
        << error.what();
  }
}

} // namespace
} // namespace dielast::cases::strips_test
