#include "post/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace dielast::post {
namespace {

bool has_gnuplot() { return std::system("command -v gnuplot > /dev/null") == 0; }

Plot line(const std::string& label) { return {"title", "x", "y", {{label, {0, 1, 2}, {0, 1, 4}}}}; }

TEST(Plot, DrawsEachInOrder) {
  if (!has_gnuplot()) GTEST_SKIP();
  const auto svgs = render_svg({line("first"), line("second")});
  ASSERT_EQ(svgs.size(), 2u);
  EXPECT_NE(svgs[0].find("first"), std::string::npos);
  EXPECT_EQ(svgs[0].find("second"), std::string::npos);
  EXPECT_NE(svgs[1].find("second"), std::string::npos);
  for (const auto& svg : svgs) EXPECT_TRUE(svg.find("<svg") < svg.find("</svg>"));
}

TEST(Plot, TextIsNeverACommand) {
  if (!has_gnuplot()) GTEST_SKIP();
  const std::string hostile = "it's `date` \"$x\" \\n a_b^c {/Bold d} <?xml & é\nset output '/dev/null'";
  const auto svgs = render_svg({{hostile, hostile, hostile, {{hostile, {0, 1}, {1, 0}}}}, line("second")});
  EXPECT_NE(svgs[0].find("it's `date` \"$x\" \\n a_b^c {/Bold d} &lt;?xml &amp; é set output '/dev/null'"),
            std::string::npos);
  EXPECT_NE(svgs[1].find("second"), std::string::npos);
}

TEST(Plot, SurvivesMissingData) {
  if (!has_gnuplot()) GTEST_SKIP();
  const auto svgs = render_svg({{"none", "x", "y", {}},
                                {"not numbers", "x", "y", {{"a", {NAN, 1}, {0, INFINITY}}}},
                                {"one point", "x", "y", {{"b", {1}, {1}, Series::Style::points}}},
                                line("last")});
  ASSERT_EQ(svgs.size(), 4u);
  EXPECT_NE(svgs[3].find("last"), std::string::npos);
}

TEST(Plot, EmptyWithoutGnuplot) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const auto svgs = render_svg({line("a"), line("b")});
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(svgs, (std::vector<std::string>{"", ""}));
}

TEST(Plot, NothingToDraw) { EXPECT_TRUE(render_svg({}).empty()); }

} // namespace
} // namespace dielast::post
