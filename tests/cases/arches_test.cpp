// SPDX-License-Identifier: GPL-3.0-or-later
// Arches and bars under a dead load: paths by arclength where they are far softer than they are stiff.
#include "tests/cases/path_cases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dielast::cases::arches_test {
namespace {

class Arches : public Paths {
 protected:
  /// Of straight bars, 40 mm long and 10 mm high across the plane, with hinged or clamped feet and a force
  /// near its middle.
  static std::string arch(double rise, double width, int bars, bool clamped, double force, double aside,
                          int increments, const std::string& on_instability) {
    const auto node = [&](int k) {
      const double part = static_cast<double>(k) / bars;
      return fmt::format("[\"{} mm\", \"{:.9g} mm\", 0]", 40 * part - 20,
                         rise * std::sin(std::numbers::pi * part));
    };
    std::string text;
    for (int k = 0; k < bars; ++k)
      text += fmt::format(
          "[part.b{0}.line]\nfrom = {1}\nto = {2}\n[part.b{0}.beam]\nwidth = \"{3} mm\"\n"
          "height = \"10 mm\"\nmaterial = {{ youngs_modulus = \"60 MPa\", poisson_ratio = 0.3 }}\n"
          "[part.b{0}.mesh]\nwall_elements = 4\n",
          k, node(k), node(k + 1), width);
    for (int k = 0; k + 1 < bars; ++k)
      text += fmt::format("[[tie]]\nbetween = [\"b{}.end\", \"b{}.start\"]\n", k, k + 1);
    for (const std::string& foot : {std::string("b0.start"), fmt::format("b{}.end", bars - 1)})
      text += fmt::format("[[support]]\nplace = \"{}\"\nfix = [\"x\", \"y\"{}]\n", foot,
                          clamped ? ", \"turn_z\"" : "");
    return text + fmt::format(R"toml([part.sheet.film]
thickness = "0.5 mm"
[part.sheet.film.material]
shear_modulus = "45 kPa"
permittivity = "4e-11 F/m"
[part.sheet.rectangle]
length = "20 mm"
width = "10 mm"
[part.sheet.mesh]
across = 1
[[support]]
place = "sheet.left"
fix = ["x", "y"]
[[load]]
place = "b{0}.end"
force = ["{1} N", "{2} N", 0]
[[step]]
kind = "force"
increments = {3}
on_instability = "{4}"
[[quantity]]
name = "y"
kind = "displacement"
of = "b{0}.end"
along = "y"
[output]
error_estimate = false
fields = false
)toml",
                              bars / 2 - 1, aside, -force, increments, on_instability);
  }
};

// All that they move by is less than a hundred thousandth of what a load of their stiff directions would move
// them by: paths were given up at the limit point, or led back into the branch that they came from, for ever.
TEST_F(Arches, shallow_ones_are_followed_to_where_they_snap_to) {
  struct Arch {
    double rise, width, force; ///< mm, mm, N
  };
  for (const auto& [rise, width, force] : {Arch{0.5, 0.3, 0.0047}, {0.2, 0.1, 0.0001}})
    for (const int increments : {1, 60}) {
      const auto end = [&](const char* way) {
        const Run ran = run(arch(rise, width, 4, false, force, 0.4 * force, increments, way), "y");
        EXPECT_EQ(ran.outcome.ending, Ending::complete) << rise << " " << way << ": " << ran.outcome.message;
        return ran.rows.back().value;
      };
      const double snapped = end("jump");
      EXPECT_NEAR(end("follow"), snapped, 1e-6 * std::abs(snapped)) << rise << " " << increments;
    }
}

// Where the imperfection leaves a gap at a bifurcation the path turns; a step across the gap led to a path
// that the arch cannot come to.
TEST_F(Arches, a_path_that_comes_back_to_itself_ends) {
  const Run ran = run(arch(8, 1, 2, true, 82.8, 3.312, 40, "follow"), "y");
  EXPECT_EQ(ran.outcome.ending, Ending::gave_up);
  EXPECT_NE(ran.outcome.message.find("closed loop"), std::string::npos) << ran.outcome.message;
  EXPECT_LT(ran.rows.size(), 200U);
}

// A pinned bar under a dead load across it, 5e-5 of Euler's, passes the gap that this opens between its
// straight and its bent path: the elastica without that load has 0.22613 N and 23.391 mm.
TEST_F(Arches, ABarThatASmallLoadBendsHasNoCriticalPoint) {
  for (const char* way : {"stop", "follow"}) {
    const Run bent = run(fmt::format(R"toml(
film = {{ thickness = "0.1 mm", material = {{ shear_modulus = "40 kPa", relative_permittivity = 3 }} }}
rod = {{ width = "10 mm" }}
line = {{ from = [0, "50 mm", 0], to = ["10 mm", "50 mm", 0] }}
output = {{ error_estimate = false, fields = false }}
[part.bar]
line = {{ to = ["80 mm", 0, 0] }}
mesh = {{ wall_elements = 24 }}
[part.bar.beam]
width = "0.4 mm"
height = "8 mm"
material = {{ youngs_modulus = "3 GPa", poisson_ratio = 0.38 }}
[[support]]
place = "film"
fix = ["x", "y"]
[[support]]
place = "bar.start"
fix = ["x", "y"]
[[support]]
place = "bar.end"
fix = ["y"]
displacement = {{ x = "-20 mm" }}
[[load]]
place = "bar"
force = [0, "10 uN", 0]
[[step]]
kind = "force"
increments = 1
[[step]]
kind = "move"
increments = 4
on_instability = "{}"
[[quantity]]
name = "Fx"
kind = "force"
of = "bar.end"
along = "x"
)toml",
                                     way),
                         "Fx");
    EXPECT_EQ(bent.outcome.ending, Ending::complete) << way << ": " << bent.outcome.message;
    EXPECT_NEAR(bent.rows.back().value, -0.22613, 1e-4) << way;
    EXPECT_EQ(std::ranges::count_if(bent.events, [](const post::Event& e) { return is_critical(e.kind); }), 0)
        << way;
  }
}

} // namespace
} // namespace dielast::cases::arches_test
