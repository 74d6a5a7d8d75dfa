// SPDX-License-Identifier: GPL-3.0-or-later
// What a source does that gives an electrode a charge in the course of time.
#include "tests/cases/film_cases.hpp"

#include <cmath>
#include <numbers>

namespace dielast::cases::given_charges_test {
namespace {

class GivenCharges : public FilmCases {
 protected:
  /// A film so stiff that its capacitance stays 42 pF, behind 20 GOhm and with a leak of 300 GOhm;
  /// `electrode`: what else there is of it.
  Ran film(const std::string& charge, const std::string& electrode = "") {
    std::string energies;
    for (const char* of : {"resistance_heat", "leak_heat", "source_work", "electrical_work"})
      energies += fmt::format("[[quantity]]\nname = \"{0}\"\nkind = \"energy\"\nof = \"{0}\"\n", of);
    return run(fmt::format(
        "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"4 GPa\"\npermittivity = \"4.2e-11 "
        "F/m\"\n[rectangle]\nlength = \"100 mm\"\nwidth = \"10 mm\"\n[mesh]\nacross = "
        "1\n{}[circuit]\nresistance "
        "= \"20 GOhm\"\nleakage_resistance = \"300 GOhm\"\n[drive]\ncharge = {}\n[[step]]\nkind = "
        "\"transient\"\nduration = \"20 s\"\nincrements = 400\ncontrol = \"charge\"\n[output]\nfields = "
        "false\nerror_estimate = false\n{}",
        electrode, charge, energies));
  }
};

constexpr double capacitance = 42e-12, resistance = 20e9, leakage = 1 / 300e9, charge = 30e-9, seconds = 20;

// Q sin wt: its source gives w Q cos wt and what leaks.
TEST_F(GivenCharges, HaveASourceThatPaysForLeakAndResistance) {
  constexpr double w = std::numbers::pi / seconds; // half a period
  const double leak = leakage / (capacitance * capacitance) * charge * charge * seconds / 2;
  const double through =
      leakage / capacitance * charge; // R (w Q cos + G Q/C sin)^2, sin cos is 0 in the mean
  const double heat = resistance * (std::pow(w * charge, 2) + std::pow(through, 2)) * seconds / 2;
  for (const char* electrode :
       {"",
        "[[electrode]]\nname = \"film\"\nplace = \"electrode\"\nsheet_resistance = \"1 kOhm\"\nterminal = "
        "\"left\"\n"}) {
    const Ran ran = film("{ wave = \"sine\", amplitude = \"30 nC\", frequency = \"0.025 Hz\" }", electrode);
    EXPECT_NEAR(ran.last("leak_heat"), leak, 1e-4 * leak) << electrode;
    EXPECT_NEAR(ran.last("resistance_heat"), heat, 1e-4 * heat) << electrode;
    EXPECT_NEAR(ran.last("source_work"), leak + heat, 1e-4 * (leak + heat)) << electrode;
  }
}

} // namespace
} // namespace dielast::cases::given_charges_test
