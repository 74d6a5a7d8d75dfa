// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/quantities.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/resolved.hpp"
#include "tests/cases/gallery_files.hpp"
#include "tests/cases/values_at_end.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>

namespace dielast::cases::similarity_test {
namespace {

/// Exponents of length, mass, time and current in the units that resolved cases and results are written in.
const std::map<std::string, std::array<int, 4>> dimensions{
    {"1", {0, 0, 0, 0}},      {"m", {1, 0, 0, 0}},      {"m^3", {3, 0, 0, 0}},    {"deg", {0, 0, 0, 0}},
    {"rad", {0, 0, 0, 0}},    {"g", {0, 1, 0, 0}},      {"kg", {0, 1, 0, 0}},     {"kg/m^3", {-3, 1, 0, 0}},
    {"kg m^2", {2, 1, 0, 0}}, {"s", {0, 0, 1, 0}},      {"1/s", {0, 0, -1, 0}},   {"Hz", {0, 0, -1, 0}},
    {"rad/s", {0, 0, -1, 0}}, {"m/s^2", {1, 0, -2, 0}}, {"N", {1, 1, -2, 0}},     {"N m", {2, 1, -2, 0}},
    {"N/m", {0, 1, -2, 0}},   {"N s/m", {0, 1, -1, 0}}, {"Pa", {-1, 1, -2, 0}},   {"kPa", {-1, 1, -2, 0}},
    {"Pa s", {-1, 1, -1, 0}}, {"J", {2, 1, -2, 0}},     {"W", {2, 1, -3, 0}},     {"C", {0, 0, 1, 1}},
    {"V", {2, 1, -3, -1}},    {"V/m", {1, 1, -3, -1}},  {"MV/m", {1, 1, -3, -1}}, {"F", {-2, -1, 4, 2}},
    {"F/m", {-3, -1, 4, 2}},  {"Ohm", {2, 1, -3, -2}},  {"A", {0, 0, 0, 1}}};

/// Lengths become 2^-10, masses 2^-30, times 2^-5 and currents 2^-20 of what they were: the acceleration of
/// gravity and the permittivity of vacuum stay.
double factor(const std::string& unit) {
  const auto found = dimensions.find(unit);
  if (found == dimensions.end()) {
    ADD_FAILURE() << "a unit without dimension: " << unit;
    return 1;
  }
  const auto& [length, mass, time, current] = found->second;
  return std::ldexp(1, -10 * length - 30 * mass - 5 * time - 20 * current);
}

/// A resolved case, which says all of its measures as "number unit", of a device that is similar.
std::string similar(const std::string& resolved) {
  std::istringstream lines(resolved);
  std::ostringstream scaled;
  scaled.precision(17);
  for (std::string line; std::getline(lines, line);) {
    const bool words = line.starts_with("title") || line.starts_with("source") || line.starts_with("#");
    std::istringstream pieces(line);
    bool quoted = false;
    for (std::string piece; std::getline(pieces, piece, '"'); quoted = !quoted) {
      char* unit = nullptr;
      const double number = std::strtod(piece.c_str(), &unit);
      if (quoted) scaled << '"';
      if (quoted && !words && unit != piece.c_str() && *unit == ' ')
        scaled << number * factor(unit + 1) << unit;
      else
        scaled << piece;
      if (quoted) scaled << '"';
    }
    scaled << '\n';
  }
  return scaled.str();
}

class Similarity : public test::ScratchTest, public testing::WithParamInterface<const char*> {};

// A bound or a tolerance that is a number of metres, volts or pascals would tell the two devices apart.
TEST_P(Similarity, DevicesThatAreAlikeInAllButSizeBehaveAlike) {
  const Case one = read_case(test::gallery / GetParam());
  write("similar.toml", similar(resolved_text(one)));
  const Case small = read_case(directory / "similar.toml");
  const std::map<std::string, double> values = test::values_at_end(one),
                                      of_small = test::values_at_end(small);
  ASSERT_EQ(values.size(), of_small.size());
  std::map<std::string, double> largest; // of each unit: what is 0 but for rounding is compared with it
  for (const Quantity& quantity : one.quantities) {
    double& scale = largest[unit_of(quantity, one.quantities)];
    scale = std::max(scale, std::abs(values.at(quantity.name)));
  }
  for (const Quantity& quantity : one.quantities) {
    const std::string unit = unit_of(quantity, one.quantities);
    EXPECT_NEAR(of_small.at(quantity.name) / factor(unit), values.at(quantity.name), 1e-8 * largest.at(unit))
        << quantity.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Gallery, Similarity,
                         testing::Values("antagonistic_rolls/case.toml", "benders/unimorph.toml",
                                         "circular/case.toml", "diaphragm/case.toml", "diaphragm/tilt.toml",
                                         "honeycomb/case.toml", "hung_stack/case.toml",
                                         "rolled_muscle/step.toml", "strip/case.toml",
                                         "wrinkles/tension_field.toml", "tendons/case.toml",
                                         "thick_sphere/case.toml"),
                         [](const auto& file) { return test::word_of(file.param); });

} // namespace
} // namespace dielast::cases::similarity_test
