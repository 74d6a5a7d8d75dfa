// SPDX-License-Identifier: GPL-3.0-or-later
// Solids with inertia whose loads jump: displacements stand, and what has no mass follows at once.
#include "tests/cases/path_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

namespace dielast::cases::solids_that_jump_test {
namespace {

constexpr double jump = 4e-6;  ///< s
constexpr double much = 1e-14; ///< J, of 20 nJ or more that are exchanged
/// Likewise with a dashpot: its spring takes up 0.2 pJ at the jump and lets them go before the next state. Of
/// eight viscosities from 0.05 to 1 Pa s the largest error is 2.8e-13.
constexpr double much_of_springs = 5e-13;
constexpr double within_a_moment = 2; ///< Pa, of hundreds

class SolidsThatJump : public Paths {
 protected:
  /// A slab of 0.5 mm that shrinks and swells freely, a tenth of a microsecond from row to row.
  Run slab(const std::string& film, const std::string& material, const std::string& driven) {
    Run result =
        run("[film]\nthickness = \"0.5 mm\"\nwidth = \"10 mm\"\nsection = \"solid\"\n" + film +
                "[film.material]\nshear_modulus = \"40 kPa\"\nrelative_permittivity = 2.8\n" + material +
                "[slab]\nlength = \"2 mm\"\nheight = \"0.5 mm\"\n[mesh]\nacross = 1\ngrading = 1\n"
                "[[support]]\nplace = \"bottom\"\nfix = [\"y\"]\n"
                "[[support]]\nplace = \"left\"\nfix = [\"x\"]\n" +
                driven +
                "duration = \"4.5 us\"\nrecord = \"0.1 us\"\ninertia = true\n"
                "[output]\nerror_estimate = false\n",
            "min_principal_stress");
    EXPECT_EQ(result.outcome.ending, Ending::complete) << result.outcome.message;
    return result;
  }
  static double at_end(const Run& run, const std::string& name) {
    return std::ranges::find(run.results.quantities, name, &post::QuantityRow::name)->value;
  }
  /// The stress behind the jump, and a moment later.
  static std::pair<double, double> behind(const Run& run) {
    const auto next = std::ranges::find_if(run.rows, [](const Row& row) { return row.time > jump + 1e-9; });
    return {std::prev(next)->value, next->value};
  }
};

constexpr const char* transient = "[[step]]\nkind = \"transient\"\n";

// Pressures that keep the volume take up at once what would change it, and go on from there.
TEST_F(SolidsThatJump, pressures_follow_a_voltage_that_jumps) {
  for (const char* viscosity : {"", "viscosity = \"0.5 Pa.s\"\n"})
    for (const char* wave : {"to = \"1.5 kV\"", "from = \"1.5 kV\", to = 0",
                             "from = \"1.5 kV\", to = \"0.2 kV\"", "from = \"0.2 kV\", to = 0"}) {
      const Run found = slab("", viscosity,
                             std::string("[drive]\nvoltage = { wave = \"step\", at = \"4 us\", ") + wave +
                                 " }\n" + transient);
      const auto [here, later] = behind(found);
      EXPECT_NEAR(here, later, within_a_moment) << viscosity << wave;
      EXPECT_LT(at_end(found, "energy_error"), *viscosity ? much_of_springs : much) << viscosity << wave;
    }
}

TEST_F(SolidsThatJump, pressures_follow_a_force_that_jumps) {
  const Run found = slab("", "",
                         std::string("[drive]\nvoltage = 0\n[[load]]\nplace = \"right\"\nforce = [{ wave = "
                                     "\"step\", from = \"2 mN\", to = 0, at = \"4 us\" }, 0, 0]\n") +
                             transient);
  const auto [here, later] = behind(found);
  EXPECT_NEAR(here, later, within_a_moment);
}

// So does the potential within, with the voltage of a charge that is given.
TEST_F(SolidsThatJump, fields_follow_voltages_and_charges_that_jump) {
  const std::string electrode =
      "[[electrode]]\nname = \"e\"\nplace = \"top\"\nground = \"bottom\"\n[drive.e]\n";
  for (const char* viscosity : {"", "viscosity = \"0.5 Pa.s\"\n"})
    for (const char* driven : {"voltage = { wave = \"step\", from = \"1.5 kV\", to = \"0.5 kV\", at = \"4 "
                               "us\" }\n[[step]]\nkind = \"transient\"\n",
                               "charge = { wave = \"step\", from = \"1.5 nC\", to = \"0.5 nC\", at = \"4 "
                               "us\" }\n[[step]]\nkind = \"transient\"\ncontrol = \"charge\"\n"}) {
      const Run found = slab("field = \"potential\"\n", viscosity, electrode + driven);
      const auto [here, later] = behind(found);
      EXPECT_NEAR(here, later, within_a_moment) << driven;
      EXPECT_LT(at_end(found, "energy_error"), *viscosity ? much_of_springs : much) << viscosity << driven;
    }
}

} // namespace
} // namespace dielast::cases::solids_that_jump_test
