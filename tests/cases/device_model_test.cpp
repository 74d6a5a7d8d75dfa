// SPDX-License-Identifier: GPL-3.0-or-later
// What a case answers to the tests of an [identify], in relations that need no number of it.
#include "cases/fits/device_model.hpp"
#include "cases/readers/identify_reader.hpp"
#include "tests/cases/scratch.hpp"

#include <fmt/format.h>

#include <cmath>

namespace dielast::cases::device_model_test {
namespace {

class DeviceModels : public test::ScratchTest {
 protected:
  std::vector<double> answers(const std::string& text, const std::string& test, double modulus) {
    write("case.toml", text);
    write("identify.toml", "case = \"case.toml\"\n[identify]\nunknowns = "
                           "[\"film.material.shear_modulus\"]\n[[identify.test]]\n" +
                               test);
    return DeviceModel(read_identification(directory / "identify.toml")).run(0, {modulus});
  }
};

// Film feels the square of its voltage.
TEST_F(DeviceModels, MoveByTheSquaredVoltageAlikeAboutEitherSign) {
  write("g.csv", "frequency[Hz],real[m/V^2],imaginary[m/V^2]\n1,1,0\n10,1,0\n");
  const auto at = [&](const char* voltage) {
    return answers(
        fmt::format("[film]\nthickness = \"40 um\"\n[film.material]\nshear_modulus = \"0.4 MPa\"\n"
                    "viscosity = \"150 Pa.s\"\nrelative_permittivity = 2.5\n[strip]\nlength = \"12 "
                    "mm\"\nwidth = \"13 mm\"\nlayers = 10\n[weight]\nmass = \"50 g\"\n[drive]\n"
                    "voltage = \"{}\"\n[mesh]\nacross = 2\n[[step]]\nkind = \"weight\"\n[[step]]\n"
                    "kind = \"voltage\"\n[[step]]\nkind = \"harmonic\"\npoints = 2\n",
                    voltage),
        "file = \"g.csv\"\nresponse = \"displacement\"\n", 0.4);
  };
  const std::vector<double> above = at("1 kV"), below = at("-1 kV");
  ASSERT_EQ(above.size(), 4U);
  EXPECT_GT(std::abs(above[0]), 0);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(below[i], above[i], 1e-7 * std::abs(above[i])) << i;
}

// Each row of the first milliseconds has its own time, however long the run goes on.
TEST_F(DeviceModels, TellShortTimesApartInALongRun) {
  write("t.csv", "time[s],stress_x[Pa]\n0.001,1\n0.002,1\n0.004,1\n0.01,1\n");
  const auto held = [&](double seconds) {
    return answers(
        fmt::format("[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"20 kPa\"\n"
                    "relative_permittivity = 3\n[[film.material.branch]]\nshear_modulus = \"40 kPa\"\n"
                    "relaxation_time = \"2 ms\"\n[patch]\nstretch_x = 1.5\n[[step]]\nkind = \"move\"\n"
                    "response = \"instantaneous\"\n[[step]]\nkind = \"hold\"\nduration = \"{} s\"\n",
                    seconds),
        "file = \"t.csv\"\nquantity = \"stress_x\"\n", 20);
  };
  const std::vector<double> brief = held(10), whole = held(1e5);
  ASSERT_EQ(brief.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(whole[i], brief[i], 0.05 * brief[i]) << i;
  EXPECT_GT(whole[1], 1.05 * whole[2]);
}

// The name as it is written before one with a unit at its end.
TEST_F(DeviceModels, TakeTheColumnOfTheirName) {
  write("v.csv", "voltage_V,gap_in,gap\n100,1,2\n200,3,4\n");
  write("case.toml",
        "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"20 kPa\"\nrelative_permittivity = "
        "3\n[rectangle]\nlength = \"20 mm\"\nwidth = \"10 mm\"\n[[support]]\nplace = \"left\"\nfix = "
        "[\"x\", \"y\"]\n[drive]\nvoltage = \"200 V\"\n[[step]]\nkind = \"voltage\"\n[[quantity]]\nname = "
        "\"gap\"\nkind = \"displacement\"\nof = \"right\"\nalong = \"x\"\n");
  write("identify.toml", "case = \"case.toml\"\n[identify]\nunknowns = [\"film.material.shear_modulus\"]\n"
                         "[[identify.test]]\nfile = \"v.csv\"\nquantity = \"gap\"\n");
  const DeviceTest test = read_identification(directory / "identify.toml").tests[0];
  EXPECT_EQ(test.measured[0].real(), 2);
  EXPECT_EQ(test.measured[1].real(), 4);
}

} // namespace
} // namespace dielast::cases::device_model_test
