// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/plot.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <regex>
#include <set>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace dielast::post::plot_test {
namespace {

bool has_gnuplot() { return std::system("command -v gnuplot > /dev/null") == 0; }

Plot line(const std::string& label) { return {"title", "x", "y", {{label, {0, 1, 2}, {0, 1, 4}}}}; }

std::vector<std::string> svgs_of(const std::vector<Plot>& plots) {
  std::vector<std::string> svgs;
  for (const Image& image : draw(plots)) svgs.push_back(image.svg);
  return svgs;
}

TEST(Plot, DrawsEachInOrder) {
  if (!has_gnuplot()) GTEST_SKIP();
  const auto svgs = svgs_of({line("first"), line("second")});
  ASSERT_EQ(svgs.size(), 2u);
  EXPECT_NE(svgs[0].find("first"), std::string::npos);
  EXPECT_EQ(svgs[0].find("second"), std::string::npos);
  EXPECT_NE(svgs[1].find("second"), std::string::npos);
  for (const auto& svg : svgs) EXPECT_TRUE(svg.find("<svg") < svg.find("</svg>"));
}

TEST(Plot, TextIsNeverACommand) {
  if (!has_gnuplot()) GTEST_SKIP();
  const std::string hostile = "it's `date` \"$x\" \\n a_b^c {/Bold d} <?xml & é\nset output '/dev/null'";
  const auto svgs = svgs_of({{hostile, hostile, hostile, {{hostile, {0, 1}, {1, 0}}}}, line("second")});
  EXPECT_NE(svgs[0].find("it's `date` \"$x\" \\n a_b^c {/Bold d} &lt;?xml &amp; é set output '/dev/null'"),
            std::string::npos);
  EXPECT_NE(svgs[1].find("second"), std::string::npos);
}

// As from a terminal: to all processes of the group.
TEST(Plot, InterruptsDoNotLoseFigures) {
  if (!has_gnuplot()) GTEST_SKIP();
  const pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);
    std::signal(SIGALRM, [](int) { ::kill(0, SIGINT); });
    struct sigaction noted {};
    noted.sa_handler = [](int) {};
    sigaction(SIGINT, &noted, nullptr);
    const itimerval often{{0, 2000}, {0, 2000}};
    setitimer(ITIMER_REAL, &often, nullptr);
    _exit(draw({line("first"), line("second")}).size() == 2 ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

/// Where the marks of a document's curves are, px.
std::vector<std::pair<double, double>> marks(const std::string& svg) {
  std::vector<std::pair<double, double>> places;
  const std::regex mark(R"(<use xlink:href='#gpPt6' transform='translate\(([0-9.]+),([0-9.]+)\))");
  for (std::sregex_iterator i(svg.begin(), svg.end(), mark), end; i != end; ++i)
    places.emplace_back(std::stod((*i)[1]), std::stod((*i)[2]));
  return places;
}

/// Texts of a document with their sizes.
std::vector<std::pair<std::string, double>> texts_of(const std::string& svg) {
  std::vector<std::pair<std::string, double>> texts;
  double size = 0;
  const std::regex token("font-size=\"([0-9.]+)\"|<text>([^<]*)</text>");
  for (std::sregex_iterator i(svg.begin(), svg.end(), token), end; i != end; ++i) {
    if ((*i)[1].matched)
      size = std::stod((*i)[1]);
    else
      texts.emplace_back((*i)[2], size);
  }
  return texts;
}

TEST(Plot, LongTitlesHaveRoom) {
  if (!has_gnuplot()) GTEST_SKIP();
  Plot plot = line("curve");
  plot.title = "A title of more than one hundred letters, which goes on and on until no page has room for "
               "it, not even this";
  const auto texts = texts_of(svgs_of({plot})[0]);
  std::string whole;
  for (const auto& [line_of_title, size] : texts) {
    if (plot.title.find(line_of_title) == std::string::npos || line_of_title.size() < 10) continue;
    EXPECT_LT(size * 0.6 * static_cast<double>(line_of_title.size()), 660);
    EXPECT_GE(size, 12);
    whole += (whole.empty() ? "" : " ") + line_of_title;
  }
  EXPECT_EQ(whole, plot.title); // in two lines
}

// The key stands below, so that axes are as wide with long labels as with none.
TEST(Plot, KeysTakeNoWidthFromTheAxes) {
  if (!has_gnuplot()) GTEST_SKIP();
  Plot plot{"title", "x", "y", {}};
  for (int i = 0; i < 6; ++i)
    plot.series.push_back({"quantity, film.prestretch = [4, 2.5], " + std::to_string(i),
                           {0, 1},
                           {0, 1.0 * i},
                           Series::Style::line_and_points});
  Plot plain = plot;
  for (Series& series : plain.series) series.label.clear();
  const auto svgs = svgs_of({plot, plain});
  const auto width = [](const std::string& svg) {
    const auto places = marks(svg);
    const auto [left, right] = std::ranges::minmax(places);
    return right.first - left.first;
  };
  EXPECT_NEAR(width(svgs[0]), width(svgs[1]), 80); // marks in the key stand left of the middle
  EXPECT_GT(width(svgs[0]), 450);
}

TEST(Plot, ASingleCurveIsNamedOnce) {
  if (!has_gnuplot()) GTEST_SKIP();
  const Plot plot{"radius", "time [s]", "size [mm]", {{"radius", {0, 1, 2}, {0, 1, 4}}}};
  const auto texts = texts_of(svgs_of({plot})[0]);
  EXPECT_EQ(std::ranges::count(texts, plot.title, &std::pair<std::string, double>::first), 1);
}

TEST(Plot, TicksDiffer) {
  if (!has_gnuplot()) GTEST_SKIP();
  const Plot plot{"", "x", "y", {{"", {0, 1, 2}, {2.003680, 2.003684, 2.003690}}}};
  std::set<std::string> seen;
  for (const auto& [text, size] : texts_of(svgs_of({plot})[0]))
    if (text.find("2.00368") != std::string::npos) {
      EXPECT_TRUE(seen.insert(text).second) << text;
    }
  EXPECT_GE(seen.size(), 2u);
}

TEST(Plot, SurvivesMissingData) {
  if (!has_gnuplot()) GTEST_SKIP();
  const auto svgs = svgs_of({{"none", "x", "y", {}},
                             {"not numbers", "x", "y", {{"a", {NAN, 1}, {0, INFINITY}}}},
                             {"one point", "x", "y", {{"b", {1}, {1}, Series::Style::points}}},
                             line("last")});
  ASSERT_EQ(svgs.size(), 4u);
  EXPECT_NE(svgs[3].find("last"), std::string::npos);
}

TEST(Plot, LogarithmicAxes) {
  if (!has_gnuplot()) GTEST_SKIP();
  const Series powers{"", {1, 10, 100, -1}, {1e-3, 1, 1e3, 1}, Series::Style::points};
  const Plot both{"both", "x", "y", {powers}, true, true};
  const auto svgs = svgs_of({both,
                             {"x only", "x", "y", {powers}, true, false},
                             line("linear"),
                             {"nothing positive", "x", "y", {{"", {-1, -2}, {1, 2}}}, true, true}});
  const auto places = marks(svgs[0]);
  ASSERT_EQ(places.size(), 3u) << "of the point that is not positive there must be none";
  EXPECT_NEAR(places[1].first - places[0].first, places[2].first - places[1].first, 1);
  EXPECT_NEAR(places[0].second - places[1].second, places[1].second - places[2].second, 1);
  const auto half = marks(svgs[1]);
  ASSERT_EQ(half.size(), 3u);
  EXPECT_NEAR(half[1].first - half[0].first, half[2].first - half[1].first, 1);
  EXPECT_LT(half[0].second - half[1].second, 0.01 * (half[1].second - half[2].second));
  for (const auto& svg : svgs) EXPECT_FALSE(svg.empty());
  EXPECT_EQ(svgs[2], svgs_of({line("linear")})[0]); // nothing stays behind
}

TEST(Plot, EqualAxes) {
  if (!has_gnuplot()) GTEST_SKIP();
  Plot square{"", "x", "y", {{"", {0, 3, 3}, {0, 0, 1}, Series::Style::points}}};
  square.equal_axes = true;
  const auto svgs = svgs_of({square, line("free")});
  const auto places = marks(svgs[0]);
  ASSERT_EQ(places.size(), 3u);
  EXPECT_NEAR(places[1].first - places[0].first, 3 * (places[1].second - places[2].second), 2);
  EXPECT_EQ(svgs[1], svgs_of({line("free")})[0]);
}

// Half of a meridian: 20 mm is 40 px.
TEST(Plot, LabelsOfAShortAxisHaveRoomBesideAnEquallyScaledLongOne) {
  if (!has_gnuplot()) GTEST_SKIP();
  Plot meridian{"", "r (mm)", "z (mm)", {{"", {0, 67, 0}, {67, 0, -67}}}};
  meridian.equal_axes = true;
  std::vector<std::string> labels;
  for (const auto& [text, size] : texts_of(svgs_of({meridian})[0])) labels.push_back(text);
  EXPECT_EQ(std::ranges::count(labels, "10"), 0);
  EXPECT_EQ(std::ranges::count(labels, "60"), 2); // of both axes
}

TEST(Plot, EmptyWithoutGnuplot) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const auto svgs = svgs_of({line("a"), line("b")});
  setenv("PATH", path.c_str(), 1);
  EXPECT_TRUE(svgs.empty());
}

TEST(Plot, LogarithmicAxesHavePowersOfTenOrEnoughOtherTicks) {
  if (!has_gnuplot()) GTEST_SKIP();
  const auto labels = [](double low, double high) {
    Plot plot{"title", "x", "y", {{"one", {low, high}, {1, 2}}}};
    plot.log_x = true;
    std::set<std::string> found;
    for (const auto& [text, size] : texts_of(draw({plot}).at(0).svg)) found.insert(text);
    return found;
  };
  for (const char* label : {"10⁻⁷", "10⁻³", "0.1", "10"})
    EXPECT_TRUE(labels(1e-7, 10).contains(label)) << label;
  for (const char* label : {"1", "2", "5", "10"}) EXPECT_TRUE(labels(1, 12).contains(label)) << label;
  for (const char* label : {"10⁻⁷", "5·10⁻⁸"}) EXPECT_TRUE(labels(3e-8, 1e-6).contains(label)) << label;
  const auto narrow = labels(0.96, 1.05); // no power of ten but 1
  for (const char* label : {"0.96", "1", "1.04"}) EXPECT_TRUE(narrow.contains(label)) << label;
}

// Ticks in steps of a rounding error were counted for ever, at ever more memory.
TEST(Plot, LogarithmicAxesOfValuesThatAreNearlyEqual) {
  if (!has_gnuplot()) GTEST_SKIP();
  const auto labels = [](double low, double high) {
    Plot plot{"title", "x", "y", {{"one", {1, 2, 3}, {low, high, low}}}};
    plot.log_y = true;
    std::set<std::string> found;
    for (const auto& [text, size] : texts_of(draw({plot}).at(0).svg)) found.insert(text);
    return found;
  };
  for (const double value : {1.9398396347822490e-8, 1.0, 4e12})
    for (const int roundings : {1, 2, 7, 300})
      EXPECT_FALSE(labels(value, value * (1 + roundings * 2.3e-16)).empty()) << value << " " << roundings;
  for (const char* label : {"3.00000002", "3.00000004"})
    EXPECT_TRUE(labels(3, 3 * (1 + 2e-8)).contains(label)) << label;
}

// Where the readings say that a point is, there gnuplot has drawn it.
TEST(Plot, ReadingsLieOnTheDrawnPoints) {
  if (!has_gnuplot()) GTEST_SKIP();
  Plot plot{"title", "x [mm]", "y [kV]", {{"one", {1, 3, 10, 40}, {-2, NAN, 7, 3}}}};
  plot.series[0].style = Series::Style::points;
  for (const bool logarithmic : {false, true}) {
    plot.log_x = logarithmic;
    const Image image = draw({plot, line("next")}).at(0);
    EXPECT_EQ(image.name, "title");
    EXPECT_TRUE(image.svg.ends_with("</svg>\n") || image.svg.ends_with("</svg>\n\n"))
        << image.svg.substr(image.svg.size() - 80);
    const auto readings = nlohmann::json::parse(image.readings);
    EXPECT_EQ(readings["x"]["label"], "x [mm]");
    EXPECT_EQ(readings["x"]["log"], logarithmic);
    const auto& one = readings["series"].at(0);
    EXPECT_EQ(one["label"], "one");
    EXPECT_EQ(one["x"], (nlohmann::json{1, 3, 10, 40}));
    EXPECT_TRUE(one["y"][1].is_null());
    const auto place = [&](const char* axis, double value, double from, double to) {
      double low = readings[axis]["ends"][0], high = readings[axis]["ends"][1];
      if (readings[axis]["log"]) low = std::log(low), high = std::log(high), value = std::log(value);
      return from + (value - low) / (high - low) * (to - from);
    };
    const auto drawn = marks(image.svg);
    std::size_t mark = 0;
    for (const std::size_t k : {0, 2, 3}) {
      ASSERT_LT(mark, drawn.size());
      EXPECT_NEAR(drawn[mark].first, place("x", one["x"][k], readings["frame"][0], readings["frame"][1]),
                  0.02);
      EXPECT_NEAR(drawn[mark++].second, place("y", one["y"][k], readings["frame"][3], readings["frame"][2]),
                  0.02);
    }
  }
}

TEST(Plot, NothingToDraw) { EXPECT_TRUE(svgs_of({}).empty()); }

} // namespace
} // namespace dielast::post::plot_test
