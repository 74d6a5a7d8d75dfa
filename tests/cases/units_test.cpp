// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/units.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <clocale>
#include <numbers>
#include <random>

namespace dielast::cases::units_test {
namespace {

struct Written {
  const char* text;
  const char* unit;
  double value;
};

TEST(Units, TextsOfEngineersBecomeSI) {
  for (const Written& one : {Written{"0.8 mm", "m", 0.0008},
                             {"8mm", "m", 0.008},
                             {" +1e-3 m ", "m", 0.001},
                             {"12 µm", "m", 12e-6},
                             {"12 um", "m", 12e-6},
                             {"45 kPa", "Pa", 45e3},
                             {"1 N/mm^2", "Pa", 1e6},
                             {"7.5 kV", "V", 7500},
                             {"100 MV/m", "V/m", 1e8},
                             {"100 V/um", "V/m", 1e8},
                             {"180 deg", "rad", 3.141592653589793},
                             {"180 °", "rad", 3.141592653589793},
                             {"1 %", "1", 0.01},
                             {"0.5", "1", 0.5},
                             {"2 uF", "F", 2e-6},
                             {"0.96 g/cm^3", "kg/m^3", 960},
                             {"4e-11 F/m", "F/m", 4e-11}})
    EXPECT_DOUBLE_EQ(parse_measure(one.text, one.unit).value, one.value) << one.text;
}

// A radian is no number here: 60 turns per minute are 1 Hz.
TEST(Units, FrequenciesAndAngularFrequenciesAreTwoThings) {
  constexpr double turn = 2 * std::numbers::pi;
  for (const Written& one : {Written{"60 rpm", "Hz", 1},
                             {"62 rad/s", "Hz", 62 / turn},
                             {"360 deg/s", "Hz", 1},
                             {"3 1/s", "Hz", 3},
                             {"2 kHz", "Hz", 2000},
                             {"10 Hz", "rad/s", 10 * turn},
                             {"1 kHz", "rad/s", 1000 * turn},
                             {"2 kilohertz", "rad/s", 2000 * turn},
                             {"60 rpm", "rad/s", turn},
                             {"3 1/s", "rad/s", 3},
                             {"40 rad/s", "rad/s", 40}})
    EXPECT_DOUBLE_EQ(parse_measure(one.text, one.unit).value, one.value) << one.text << " in " << one.unit;
}

TEST(Units, DecimalPrefixesAreExact) {
  EXPECT_EQ(parse_measure("0.8 mm", "m").value, 0.0008);
  for (int tenths = 1; tenths < 1000; ++tenths)
    EXPECT_EQ(parse_measure(fmt::format("{}.{} cm", tenths / 10, tenths % 10), "m").value,
              parse_measure(fmt::format("{} mm", tenths), "m").value);
  EXPECT_EQ(parse_measure("-3e-7 MPa", "Pa").value, -0.3);
  EXPECT_EQ(parse_measure("1 1/mm", "1/m").value, 1000);
}

TEST(Units, RefusesWhatIsNoMeasureOfTheKind) {
  for (const auto& [text, unit] :
       {std::pair{"1 kPa", "m"}, {"1", "m"},        {"", "m"},       {"mm", "m"},        {"1 mm mm", "m"},
        {"1 2 mm", "m"},         {"1 1/2 mm", "m"}, {"1/2 mm", "m"}, {"1 mm 2", "m"},    {"1,5 mm", "m"},
        {"1 mmm", "m"},          {"nan mm", "m"},   {"inf m", "m"},  {"1e999 m", "m"},   {"1 mm^-1", "m"},
        {"1 m @ 2", "m"},        {"0x10 m", "m"},   {"1 m/", "m"},   {"1 celsius", "1"}, {"--1 m", "m"}})
    EXPECT_THROW(parse_measure(text, unit), UnitError) << text;
}

TEST(Units, NamesTheUnknownUnit) {
  try {
    parse_measure("1 furlongs", "m");
    parse_measure("1 kv", "V");
    FAIL();
  } catch (const UnitError& error) {
    EXPECT_EQ(error.unknown_unit(), "kv");
  }
}

TEST(Units, FormatReadsBackExactly) {
  std::mt19937 generator(1);
  std::lognormal_distribution<double> size(0, 5);
  for (const Dimension& one : dimensions())
    for (int i = 0; i < 100; ++i) {
      const double value = size(generator);
      EXPECT_EQ(parse_measure(format_measure(value, one.unit), one.unit).value, value);
    }
  EXPECT_EQ(format_measure(0.001, "m"), "0.001 m");
  EXPECT_EQ(format_measure(parse_measure("150 deg", "rad").value, "rad"), "150 deg");
}

TEST(Units, EveryDimensionReadsItsOwnExampleAndUsualUnits) {
  for (const Dimension& one : dimensions()) {
    EXPECT_NO_THROW(parse_measure(one.example, one.unit)) << one.noun;
    std::string_view usual = one.usual;
    while (!usual.empty()) {
      const auto end = std::min(usual.find(' '), usual.size());
      EXPECT_NO_THROW(parse_measure("1 " + std::string(usual.substr(0, end)), one.unit)) << usual;
      usual.remove_prefix(std::min(end + 1, usual.size()));
    }
  }
}

TEST(Units, IndependentOfTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  std::setlocale(LC_ALL,
                 "de_DE.UTF-8"); // without that locale on the machine the test only repeats the others
  EXPECT_EQ(parse_measure("0.8 mm", "m").value, 0.0008);
  EXPECT_EQ(format_measure(0.5, "m"), "0.5 m");
  std::setlocale(LC_ALL, before.c_str());
}

} // namespace
} // namespace dielast::cases::units_test
