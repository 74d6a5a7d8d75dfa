// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/resolved.hpp"
#include "tests/cases/case_test.hpp"

namespace dielast::cases::overridden_devices_test {
namespace {

/// What a device brings (supports, steps, electrodes, bodies) is that of the device as overrides make it: the
/// case is the one with these keys in its file.
class OverriddenDevices : public test::CaseTest {
 protected:
  void expect_same(const std::string& text, const std::vector<std::string>& overrides,
                   const std::string& written) {
    EXPECT_EQ(resolved_text(read(text, overrides)), resolved_text(read(written))) << overrides.front();
  }
  const std::string film = "[film]\nthickness = \"0.2 mm\"\nprestretch = 1.5\n[film.material]\n"
                           "shear_modulus = \"40 kPa\"\nrelative_permittivity = 4\n";
  const std::string unstretched =
      "[film]\nthickness = \"0.2 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\n"
      "relative_permittivity = 4\n";
  const std::string annulus = "[annulus]\nouter_radius = \"20 mm\"\ninner_radius = \"5 mm\"\n",
                    plate = "[plate]\nmass = \"50 g\"\n", pivot = "[pivot]\nheight = \"5 mm\"\n";
};

TEST_F(OverriddenDevices, BringAPlatesBodyAndSteps) {
  expect_same(film + annulus, {"plate.mass=50 g"}, film + annulus + plate);
  expect_same(film + annulus + plate, {"plate="}, film + annulus);
}

TEST_F(OverriddenDevices, BringAPivotsBodyAndSteps) {
  expect_same(film + annulus + "[sectors]\n", {"pivot.height=5 mm"}, film + annulus + "[sectors]\n" + pivot);
  expect_same(film + annulus + "[sectors]\n" + pivot, {"pivot="}, film + annulus + "[sectors]\n");
}

TEST_F(OverriddenDevices, ClampTheRimsOfShells) {
  const std::string disc = "[disc]\nradius = \"20 mm\"\n", space = "model = \"3d\"\n";
  const auto shell = [&] {
    std::string text = unstretched;
    return text.insert(text.find("[film.material]"), "section = \"shell\"\n");
  }();
  expect_same(space + unstretched + disc, {"film.section=shell"}, space + shell + disc);
  expect_same(space + shell + disc, {"film.section=membrane"}, space + unstretched + disc);
}

TEST_F(OverriddenDevices, TakeTheStepsOfAPatch) {
  const std::string patch = "[patch]\nmode = \"biaxial\"\n", drive = "[drive]\nvoltage = \"2 kV\"\n";
  expect_same(unstretched + patch + drive, {"patch.stretch_x=1.5"},
              unstretched + patch + "stretch_x = 1.5\n" + drive);
  expect_same(unstretched + patch + "stretch_x = 1.5\n", {"patch.stretch_x=", "patch.stress_x=1 kPa"},
              unstretched + patch + "stress_x = \"1 kPa\"\n");
}

TEST_F(OverriddenDevices, KeepWhatIsOverriddenOfWhatTheyBring) {
  const std::string patch = "[patch]\nmode = \"biaxial\"\n";
  const Case one = read(unstretched + patch + "stretch_x = 1.5\n",
                        {"step.move.increments=7", "drive.voltage=2 kV", "step.voltage.increments=3"});
  ASSERT_EQ(one.steps.size(), 2U);
  EXPECT_EQ(one.steps[0].increments, 7);
  EXPECT_EQ(one.steps[1].increments, 3);
  EXPECT_EQ(one.steps[1].kind, StepKind::voltage);
  const Case sectors = read(film + annulus + "[sectors]\n",
                            {"electrode.b.stray_capacitance=1 nF", "sectors.count=3", "pivot.height=5 mm"});
  ASSERT_EQ(sectors.electrodes.size(), 3U);
  EXPECT_EQ(sectors.electrodes[1].stray_capacitance, 1e-9);
}

TEST_F(OverriddenDevices, MeasureTurnedPartsAlikeWhateverTheUnitOfTheAngle) {
  const auto names = [&](const std::string& turned) {
    std::string all;
    for (const Quantity& quantity :
         read("[part.a]\nturned = " + turned +
              "\n[part.a.film]\nmaterial = \"VHB 4910 (honeycomb)\"\nthickness = \"1 mm\"\nprestretch = 2\n"
              "[part.a.honeycomb]\nangle = \"150 deg\"\nwall_length = \"8 mm\"\nwall_width = \"0.8 mm\"\n"
              "wall_height = \"2 mm\"\nwall_material = \"TPU 78 MPa\"\n")
             .quantities)
      all += fmt::format("{} {} ", quantity.name, quantity.along.value_or(-1));
    return all;
  };
  EXPECT_EQ(names("1.5707963267948966"), names("\"90 deg\""));
  EXPECT_NE(names("1.5707963267948966"), names("0"));
}

// What an item goes by may be what is changed of it.
TEST_F(OverriddenDevices, AreChangedWhereTheyAreMeant) {
  const std::string drive = "[drive]\nvoltage = \"2 kV\"\ncharge = \"10 nC\"\n";
  const Case charged = read(film + annulus + plate + drive, {"step.voltage.kind=charge"});
  ASSERT_EQ(charged.steps.size(), 2U);
  EXPECT_EQ(charged.steps[0].kind, StepKind::weight);
  EXPECT_EQ(charged.steps[1].kind, StepKind::charge);
  const Case moved = read(film + annulus, {"support.outer.place=film"});
  ASSERT_EQ(moved.supports.size(), 2U);
  EXPECT_EQ(moved.supports[0].place, "inner");
  EXPECT_EQ(moved.supports[1].place, "film");
}

} // namespace
} // namespace dielast::cases::overridden_devices_test
