// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace dielast::test::diaphragm_test {
namespace {

/// The diaphragm's gallery as a user runs it; the numbers are those of the independent solutions.
class Diaphragm : public CommandTest {
 protected:
  std::string file(const std::string& name) const { return source_folder / "cases/gallery/diaphragm" / name; }
  double value(const std::string& folder, const std::string& quantity) const {
    return json_of(folder + "/summary.json")["quantities"][quantity]["value"];
  }
  /// A column of the rows of one step.
  std::vector<double> column(const std::string& table, const std::string& name,
                             const std::string& step) const {
    const auto rows = table_of(directory / table);
    const auto place = std::ranges::find(rows[0], name) - rows[0].begin();
    std::vector<double> values;
    for (const auto& row : rows)
      if (row[0] == step) values.push_back(std::stod(row[static_cast<std::size_t>(place)]));
    return values;
  }
};

struct Reference {
  const char *modulus, *mass, *voltage;
  double drop, stiffness, inner, outer, capacitance;
};
constexpr Reference references[] = {
    {"25 kPa", "50 g", "0 V", 5.3467315e-3, 91.831374, 2.0590921, 2.0023674, 2.39291e-9},
    {"25 kPa", "100 g", "0 V", 10.679107e-3, 92.153971, 2.2272887, 2.0093566, 2.44586e-9},
    {"25 kPa", "100 g", "5 kV", 12.847552e-3, 76.578541, 2.3726043, 2.0078324, 2.47806e-9},
    {"40 kPa", "100 g", "0 V", 6.6815559e-3, 147.04374, 2.0916249, 2.0036901, 2.40286e-9},
    {"40 kPa", "100 g", "5 kV", 7.4691849e-3, 131.59316, 2.1247034, 2.0035043, 2.40980e-9}};

TEST_F(Diaphragm, every_row_of_the_independent_solution) {
  for (const bool spatial : {false, true})
    for (const Reference& row : references) {
      ASSERT_EQ(dielast({"run", file("case.toml"), "-o", "out", "--set",
                         spatial ? "model=3d" : "model=axisymmetric", "--set",
                         std::string("film.material.shear_modulus=") + row.modulus, "--set",
                         std::string("plate.mass=") + row.mass, "--set",
                         std::string("drive.voltage=") + row.voltage, "--set", "output.fields=false", "--set",
                         "output.error_estimate=false"})
                    .exit_code,
                0);
      const double tolerance = spatial ? 1e-3 : 1e-4;
      EXPECT_NEAR(value("out", "drop"), row.drop, tolerance * row.drop);
      EXPECT_NEAR(value("out", "stiffness"), row.stiffness, tolerance * row.stiffness);
      EXPECT_NEAR(value("out", "stretch_inner"), row.inner, tolerance * row.inner);
      EXPECT_NEAR(value("out", "stretch_outer"), row.outer, tolerance * row.outer);
      EXPECT_NEAR(value("out", "capacitance"), row.capacitance, tolerance * row.capacitance);
    }
}

TEST_F(Diaphragm, frequency_with_and_without_the_mass_of_the_film) {
  for (const bool heavy : {false, true}) {
    ASSERT_EQ(dielast({"run", file("case.toml"), "-o", "out", "--set", "drive.voltage=0 V", "--set",
                       heavy ? "film.material.density=960 kg/m^3" : "film.material.density=0 kg/m^3"})
                  .exit_code,
              0);
    EXPECT_NEAR(value("out", "natural_frequency"), heavy ? 38.27 : 38.35, 0.01);
  }
}

TEST_F(Diaphragm, steps_to_its_peak_in_time) {
  ASSERT_EQ(
      dielast({"run", file("step.toml"), "-o", "out", "--set", "output.error_estimate=false"}).exit_code, 0);
  const auto time = column("out/history.csv", "time[s]", "transient");
  const auto stroke = column("out/history.csv", "stroke[m]", "transient");
  const auto peak = std::ranges::max_element(stroke) - stroke.begin();
  EXPECT_NEAR(stroke[static_cast<std::size_t>(peak)], 1.1687e-3, 0.001 * 1.1687e-3);
  EXPECT_NEAR(time[static_cast<std::size_t>(peak)], 0.096, 0.002);
}

TEST_F(Diaphragm, a_sine_has_a_second_harmonic) {
  ASSERT_EQ(
      dielast({"run", file("sine.toml"), "-o", "out", "--set", "output.error_estimate=false"}).exit_code, 0);
  const auto time = column("out/history.csv", "time[s]", "transient");
  const auto stroke = column("out/history.csv", "stroke[m]", "transient");
  const auto harmonic = [&](int number) { // over the last two periods
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < time.size(); ++i)
      if (time[i] > 4 + 1e-6) sum += stroke[i] * std::polar(1.0, -number * std::numbers::pi * time[i]);
    return std::abs(sum);
  };
  EXPECT_NEAR(harmonic(2) / harmonic(1), 0.11, 0.005);
}

TEST_F(Diaphragm, the_stiffness_tells_the_modulus) {
  const Ended ended = dielast({"study", file("stiffness.toml"), "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const std::string key = "at film.material.shear_modulus = ";
  const auto at = ended.out.find(key);
  ASSERT_NE(at, std::string::npos) << ended.out;
  EXPECT_NEAR(std::stod(ended.out.substr(at + key.size())), 43.54, 0.001 * 43.54);
}

TEST_F(Diaphragm, a_model_of_third_order_follows_the_whole_one) {
  const Ended ended = dielast({"linearise", file("harmonic.toml"), "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const auto model = json_of("out/linear_model.json");
  ASSERT_EQ(model["order"], 3);
  EXPECT_LT(model["largest_relative_error"], 0.01);
  // the denominator of the source's Eq. 5.16: one real pole and a pair
  double real = 0, square = 0;
  for (const auto& pole : model["poles_1_per_s"]) {
    const std::complex<double> at(pole[0], pole[1]);
    if (at.imag() == 0) real = -at.real();
    if (at.imag() > 0) square = std::norm(at);
  }
  EXPECT_NEAR(real, 1 / 0.0045, 0.01 / 0.0045);
  EXPECT_NEAR(square, 1444, 0.02 * 1444);
  const std::string script = content("out/linear_model.m");
  for (const char* word :
       {"A = [", "u: change of the source voltage of ", " V at ", "model = ss(A, B, C, D);"})
    EXPECT_NE(script.find(word), std::string::npos) << word << " is not in\n" << script;
  EXPECT_NE(content("out/report.html").find("Eq. 5.16"), std::string::npos);
}

/// A ring of film, fixed at one edge, under pressure or with a weight; with the lines that are a case's own.
std::string ring(const std::string& own) {
  return R"toml(
[film]
thickness = "0.5 mm"
prestretch = 1.5
[film.material]
shear_modulus = "50 kPa"
relative_permittivity = 4
[output]
error_estimate = false
fields = false
)toml" + own;
}
constexpr const char* drawn_ring = R"toml(
[annulus]
inner_radius = "8 mm"
outer_radius = "25 mm"
)toml";

TEST_F(Diaphragm, counts_the_drop_and_the_stiffness_of_its_plate_wherever_it_is) {
  write("outside.toml", ring(R"toml(
[plate]
mass = "20 g"
at = "outer"
[[support]]
place = "inner"
fix = ["x", "y", "z"]
)toml") + drawn_ring);
  const auto with = [&](const std::string& mass) {
    EXPECT_EQ(dielast({"run", "outside.toml", "-o", "out", "--set", "plate.mass=" + mass}).exit_code, 0);
    return value("out", "drop");
  };
  const double more = with("20.1 g"), less = with("19.9 g"), drop = with("20 g");
  EXPECT_NEAR(drop, (more + less) / 2, 1e-4 * drop);
  EXPECT_GT(drop, 1e-3);
  EXPECT_NEAR(value("out", "stiffness"), 0.2e-3 * 9.81 / (more - less), 1e-4 * value("out", "stiffness"));
}

// The hole is a polygon of 44 sides: 0.3 % less than the circle that the annulus counts.
TEST_F(Diaphragm, a_plate_closes_the_chamber_under_a_mesh_of_ones_own) {
  const std::string pressed = R"toml(
[plate]
mass = "1 g"
at = "inner"
[[support]]
place = "outer"
fix = ["x", "y", "z"]
[chamber]
pressure = "200 Pa"
[[step]]
kind = "pressure"
[[quantity]]
name = "rise"
kind = "displacement"
of = "plate"
along = "z"
[[quantity]]
name = "content"
kind = "volume"
)toml";
  write("drawn.toml", "model = \"3d\"\n" + ring(pressed) + drawn_ring + "[mesh]\nrings = 6\n");
  write("own.toml",
        "model = \"3d\"\n" + ring(pressed) + "[mesh]\nfile = \"drawn-mesh/drawn.msh\"\nunit = \"1 m\"\n");
  ASSERT_EQ(dielast({"mesh", "drawn.toml"}).exit_code, 0);
  for (const char* name : {"drawn", "own"})
    ASSERT_EQ(dielast({"run", std::string(name) + ".toml", "-o", name}).exit_code, 0);
  for (const char* quantity : {"rise", "content"})
    EXPECT_NEAR(value("own", quantity), value("drawn", quantity), 1e-4 * value("drawn", quantity))
        << quantity;

  const Ended outside =
      dielast({"run", "drawn.toml", "--set", "plate.at=outer", "--set", "support[1].place=inner"});
  EXPECT_EQ(outside.exit_code, 2);
  EXPECT_NE(outside.err.find("the plate must close a hole"), std::string::npos) << outside.err;
}

class MovingDiaphragm : public Diaphragm {
 protected:
  std::vector<std::string> into(const std::string& folder, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"run",  file("step.toml"), "-o",
                                   folder, "--set",           "output.error_estimate=false"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  std::size_t rows(const std::string& table) const { return lines_of(content(table)).size(); }
};

TEST_F(MovingDiaphragm, goes_on_bit_for_bit_after_an_interrupt_and_a_kill) {
  ASSERT_EQ(dielast(into("straight")).exit_code, 0);
  std::size_t enough = 60;
  bool resumed = false;
  for (const int signal : {SIGINT, SIGKILL}) {
    const pid_t process =
        start(into("stopped", resumed ? std::vector<std::string>{"--resume"} : std::vector<std::string>{}));
    ASSERT_TRUE(until([&] { return rows("stopped/history.csv") > enough; }));
    kill(process, signal);
    EXPECT_EQ(wait_for(process).exit_code, signal == SIGINT ? 130 : -SIGKILL);
    enough += 60;
    resumed = true;
  }
  ASSERT_EQ(dielast(into("stopped", {"--resume"})).exit_code, 0);
  for (const char* name : {"history.csv", "summary.json"})
    EXPECT_EQ(content(std::string("stopped/") + name), content(std::string("straight/") + name)) << name;
}

// A limit of file sizes stands in for a full disk.
TEST_F(MovingDiaphragm, a_full_disk_is_told_and_leaves_what_there_is) {
  const Ended ended = dielast(into("full"), [] {
    const rlimit limit{60000, 60000};
    setrlimit(RLIMIT_FSIZE, &limit);
  });
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("error: "), std::string::npos) << ended.err;
  const std::string list = content("full/step.pvd");
  EXPECT_NE(list.find("</VTKFile>"), std::string::npos);
  for (const auto& row : table_of(directory / "full/history.csv"))
    EXPECT_GE(row.size(), 20u); // whole rows only
}

} // namespace
} // namespace dielast::test::diaphragm_test
