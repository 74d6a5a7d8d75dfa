// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <cmath>

// Values that are allowed, and far from what anyone builds.
namespace dielast::test::extremes_test {
namespace {

class Extremes : public CommandTest {
 protected:
  Ended diaphragm(const std::string& file, const std::vector<std::string>& overrides) const {
    std::vector<std::string> words{"run", source_folder / "cases/gallery/diaphragm" / file, "-q", "-o",
                                   "out"};
    for (const std::string& one : overrides) words.insert(words.end(), {"--set", one});
    for (const char* off : {"output.error_estimate=false", "output.fields=false"})
      words.insert(words.end(), {"--set", off});
    return dielast(words);
  }
};

TEST_F(Extremes, WorksAreNumbersBehindTheSmallestResistance) {
  for (const char* voltage :
       {"{ wave = \"step\", to = \"5 kV\" }", "{ wave = \"ramp\", to = \"5 kV\", duration = \"0.05 s\" }"}) {
    const Ended ended =
        diaphragm("step.toml", {"circuit.resistance=1 mOhm", "step[2].increments=50",
                                "step[2].duration=0.1 s", std::string("drive.voltage=") + voltage});
    ASSERT_EQ(ended.exit_code, 0) << voltage << ended.err;
    const nlohmann::json quantities = json_of("out/summary.json")["quantities"];
    for (const char* name : {"electrical_work", "mechanical_work", "stored_energy", "dissipated_energy"}) {
      ASSERT_TRUE(quantities[name]["value"].is_number()) << voltage << name;
      EXPECT_LT(std::abs(quantities[name]["value"].get<double>()), 1) << voltage << name;
    }
  }
}

} // namespace
} // namespace dielast::test::extremes_test
