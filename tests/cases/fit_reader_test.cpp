// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/fit_reader.hpp"
#include "cases/readers/reader.hpp"
#include "cases/readers/study_reader.hpp"
#include "tests/cases/scratch.hpp"

namespace dielast::cases::fit_reader_test {
namespace {

class FitReader : public test::ScratchTest {
 protected:
  void SetUp() override {
    ScratchTest::SetUp();
    std::filesystem::current_path(directory); // messages name files as the user does
    write("pull.csv", "stretch,P_kPa\n1.5,10\n2,15\n2.5,20\n3,26\n");
  }
  void TearDown() override {
    std::filesystem::current_path("/");
    ScratchTest::TearDown();
  }

  /// A film with a law and one branch, [fit] and one test with these keys.
  std::string fit_file(const std::string& fit, const std::string& test) const {
    return "[film.material]\nlaw = \"gent\"\nshear_modulus = \"15 kPa\"\nstretch_limit = 60\n"
           "[[film.material.branch]]\nshear_modulus = \"10 kPa\"\nrelaxation_time = \"5 s\"\n"
           "[fit]\n" +
           fit + "\n[[test]]\n" + test + "\n";
  }
  static constexpr const char* slow = "file = \"pull.csv\"\nkind = \"uniaxial\"\nequilibrium = true";
  static constexpr const char* law_only = "parameters = [\"shear_modulus\", \"stretch_limit\"]";

  Fit read(const std::string& fit, const std::string& test) const {
    write("fit.toml", fit_file(fit, test));
    return read_fit("fit.toml");
  }
  std::vector<std::string> errors(const std::string& text) const {
    write("fit.toml", text);
    std::vector<std::string> found;
    try {
      read_fit("fit.toml");
    } catch (const CaseError& error) {
      for (const Diagnostic& one : error.diagnostics()) found.push_back(one.text());
    }
    return found;
  }
  std::vector<std::string> errors(const std::string& fit, const std::string& test) const {
    return errors(fit_file(fit, test));
  }
  using Texts = std::vector<std::string>;
};

TEST_F(FitReader, TakesColumnsUnitsAndParameters) {
  const Fit fit = read(law_only, slow);
  EXPECT_EQ(fit.title, "fit");
  EXPECT_EQ(fit.parameters, (Texts{"shear_modulus", "stretch_limit"}));
  const MeasuredTest& measured = fit.tests.at(0).measured;
  EXPECT_EQ(measured.history.stretch, (std::vector{1.5, 2.0, 2.5, 3.0}));
  EXPECT_EQ(measured.stress, (std::vector{10e3, 15e3, 20e3, 26e3}));
  EXPECT_TRUE(measured.history.time.empty());
  EXPECT_EQ(
      read("", "file = \"pull.csv\"\nkind = \"uniaxial\"\nrate = \"0.1 1/s\"\n[[test]]\n" + std::string(slow))
          .parameters,
      (Texts{"shear_modulus", "stretch_limit", "branch[1].shear_modulus", "branch[1].relaxation_time"}));
}

TEST_F(FitReader, RatesOriginsAndNamedColumns) {
  write("raw.csv", "l_raw,P_kPa_raw\n0.99,1\n2.99,20\n1.99,10\n2.49,12\n2.59,13\n");
  const Fit fit = read(law_only, "file = \"raw.csv\"\nkind = \"pure shear\"\nstretch = \"l_raw\"\nstress = "
                                 "\"P_kPa_raw\"\nrate = \"0.5 1/s\"\nzero = true\nuse = \"fit\"\nweight = 2");
  const MeasuredTest& measured = fit.tests.at(0).measured;
  EXPECT_EQ(measured.history.mode, materials::Mode::pure_shear);
  EXPECT_EQ(measured.weight, 2);
  EXPECT_NEAR(measured.history.stretch[1], 3, 1e-12);
  EXPECT_NEAR(measured.stress[1], 19e3, 1e-9);
  EXPECT_NEAR(measured.history.time[1], 4, 1e-12);
  EXPECT_NEAR(measured.history.time[2], 6, 1e-12);
}

TEST_F(FitReader, TimesAreTakenWhereTheFileHasThem) {
  write("timed.csv",
        "time_min,time_s,stretch,P_MPa\n0,0,1,0\n1,2,1.5,0.01\n2,4,2,0.02\n3,6,2,0.02\n4,8,2,0.02\n");
  EXPECT_EQ(read("", "file = \"timed.csv\"\nkind = \"uniaxial\"").tests[0].measured.history.time,
            (std::vector{0.0, 2.0, 4.0, 6.0, 8.0}));
  EXPECT_EQ(read("", "file = \"timed.csv\"\nkind = \"uniaxial\"\ntime = \"time_min\"")
                .tests[0]
                .measured.history.time,
            (std::vector{0.0, 60.0, 120.0, 180.0, 240.0}));
}

TEST_F(FitReader, ATimeInAnUnknownUnitIsRefused) {
  for (const char* name : {"time (mins)", "time, min", "time_m", "t"}) {
    write("timed.csv",
          std::string(name) + ";stretch;P_MPa\n0;1;0\n1;1.5;0.01\n2;2;0.02\n3;2;0.02\n4;2;0.02\n");
    const Texts found =
        errors("", std::string("file = \"timed.csv\"\nkind = \"uniaxial\"\ntime = '") + name + "'");
    ASSERT_EQ(found.size(), 1u) << name;
    EXPECT_NE(found[0].find("its name has no unit; allowed one of ms s min h"), std::string::npos)
        << found[0];
  }
}

TEST_F(FitReader, ARateBesideTimesIsRefused) {
  write("timed.csv", "time (s),stretch,P_MPa\n0,1,0\n1,1.5,0.01\n2,2,0.02\n3,2,0.02\n4,2,0.02\n");
  EXPECT_EQ(
      errors("", "file = \"timed.csv\"\nkind = \"uniaxial\"\nrate = \"1 1/s\""),
      Texts{"fit.toml:13:8: error: test[1].rate: found a rate, but timed.csv has the times in its column "
            "\"time (s)\": leave the rate out, or the column"});
}

TEST_F(FitReader, FewerDataThanParameters) {
  EXPECT_EQ(errors("", slow),
            Texts{"fit.toml:8:1: error: fit: found 4 rows to fit 4 parameters to, allowed at least 5"});
  EXPECT_EQ(errors(law_only, std::string(slow) + "\nuse = \"predict\""),
            Texts{"fit.toml:8:1: error: fit: found 0 rows to fit 2 parameters to, allowed at least 3"});
}

TEST_F(FitReader, UnknownAndRepeatedParameters) {
  EXPECT_EQ(
      errors("parameters = [\"shear_modulas\", \"branch[0].shear_modulus\"]", slow),
      (Texts{"fit.toml:9:15: error: fit.parameters: found \"shear_modulas\": the material has no such "
             "parameter, allowed \"shear_modulus\", \"stretch_limit\", \"branch[1].shear_modulus\", "
             "\"branch[1].relaxation_time\"; did you mean \"shear_modulus\"?",
             "fit.toml:9:32: error: fit.parameters: found \"branch[0].shear_modulus\": the material has no "
             "such parameter, allowed \"shear_modulus\", \"stretch_limit\", \"branch[1].shear_modulus\", "
             "\"branch[1].relaxation_time\"; did you mean \"branch[1].shear_modulus\"?"}));
  EXPECT_EQ(errors("parameters = [\"stretch_limit\", \"stretch_limit\"]", slow),
            Texts{"fit.toml:9:32: error: fit.parameters: found \"stretch_limit\" twice"});
}

TEST_F(FitReader, BranchesNeedTheTime) {
  EXPECT_EQ(
      errors("", "file = \"pull.csv\"\nkind = \"uniaxial\""),
      Texts{"fit.toml:11:8: error: test[1].file: pull.csv has no column time_s, and the branches need the "
            "time: give time, one of \"stretch\", \"P_kPa\", or rate, or equilibrium = true"});
  EXPECT_EQ(errors("", "file = \"pull.csv\"\nkind = \"uniaxial\"\nrate = \"1 1/s\"\ntime = \"time_s\""),
            Texts{"fit.toml:13:8: error: test[1].rate: found \"1 1/s\": the column of the time says it"});
  EXPECT_EQ(errors("", std::string(slow) + "\nrate = \"1 1/s\""),
            Texts{"fit.toml:14:8: error: test[1].rate: found \"1 1/s\": in equilibrium there is no rate"});
}

TEST_F(FitReader, FilesThatAreNoTables) {
  const std::string test = "file = \"bad.csv\"\nkind = \"uniaxial\"";
  EXPECT_EQ(errors("", test),
            Texts{"fit.toml:11:8: error: test[1].file: found \"bad.csv\": no such file; the "
                  "path starts at this file's folder"});
  write("bad.csv", "time_s,stretch,P_kPa\n0,1,0\n1,,3\n2,wet,4\n3,2\n");
  EXPECT_EQ(errors("", test),
            (Texts{"bad.csv:3:3: error: stretch: the cell is empty, allowed a number",
                   "bad.csv:4:3: error: stretch: found \"wet\", allowed a number",
                   "bad.csv:5:1: error: found 2 cells, allowed 3: one for each name in line 1"}));
  write("bad.csv", "time_s,stretch,P_kPa\n0,1,0\n3,-2,1\n2,2,1\n");
  EXPECT_EQ(errors("", test),
            (Texts{"bad.csv:3:1: error: stretch: found -2, allowed a stretch above 0",
                   "bad.csv:4:1: error: time_s: found 2 after 3, allowed values that grow from row to row"}));
  write("bad.csv", "time_s,stretch,P_kPa\n0,1,0\n");
  EXPECT_EQ(errors("", test), Texts{"bad.csv: error: found 1 row of numbers, allowed at least 2"});
  write("bad.csv", "time_s,stretch,P_kPa\n0,1,0\n1,2,0\n");
  EXPECT_EQ(errors("", test),
            Texts{"fit.toml:11:8: error: test[1].file: bad.csv has no stress other than 0"});
}

TEST_F(FitReader, ColumnsThatAreMissing) {
  const std::string test = "file = \"odd.csv\"\nkind = \"uniaxial\"\nequilibrium = true";
  write("odd.csv", "strech,force\n1,2\n2,3\n");
  EXPECT_EQ(
      errors("", test),
      (Texts{"fit.toml:11:8: error: test[1].file: odd.csv has no column stretch: give stretch, strain or "
             "displacement, one of "
             "\"strech\", \"force\"",
             "fit.toml:11:8: error: test[1].file: odd.csv has no column that ends in a unit of stress, only "
             "\"strech\", \"force\": rename the column of the nominal stress, as in stress_kPa"}));
  EXPECT_EQ(
      errors("", test + "\nstretch = \"strec\"\nstress = \"force\""),
      (Texts{"fit.toml:14:11: error: test[1].stretch: found \"strec\": odd.csv has no such column, allowed "
             "\"strech\", \"force\"; did you mean \"strech\"?",
             "fit.toml:15:10: error: test[1].stress: found \"force\": its name has no unit of stress; rename "
             "the column, as in \"force_kPa\""}));
  write("odd.csv", "stretch,P_kPa,sigma_Pa\n1,2,3\n2,3,4\n");
  EXPECT_EQ(errors("", test),
            Texts{"fit.toml:11:8: error: test[1].file: odd.csv has several columns of stress: "
                  "give stress, one of \"P_kPa\", \"sigma_Pa\""});
  write("odd.csv", "stretch,true_stress_kPa\n1,2\n2,3\n3,4\n");
  const Texts told = errors("", test);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("is of true stress by its name"), std::string::npos) << told[0];
}

TEST_F(FitReader, AStartThatDoesNotReachTheTests) {
  write("far.csv", "stretch,P_kPa\n2,15\n6,50\n9,200\n10,300\n");
  EXPECT_EQ(
      errors(law_only, "file = \"far.csv\"\nkind = \"uniaxial\"\nequilibrium = true"),
      Texts{"fit.toml:1:1: error: film.material: the start values do not reach the stretch 9 of far.csv, "
            "line 4: start with a larger limit"});
}

TEST_F(FitReader, OnlyWhatAFitHas) {
  EXPECT_EQ(errors(test::small_disc),
            Texts{"fit.toml:1:1: error: fit: missing; add the section [fit], or use "
                  "`dielast run` for the case of a device"});
  EXPECT_EQ(
      errors(fit_file(law_only, slow) + "[drive]\nvoltage = \"1 kV\"\n"),
      Texts{"fit.toml:14:2: error: drive: a fit has only \"title\", [film.material], [fit] and [[test]]"});
  EXPECT_EQ(errors("[fit]\n"),
            (Texts{"fit.toml:1:1: error: film: missing; add the section [film]",
                   "fit.toml:1:1: error: test: missing; add a [[test]] with the file of a measured table"}));
  EXPECT_EQ(errors("steps = 3", slow),
            Texts{"fit.toml:9:1: error: fit.steps: unknown key, allowed \"parameters\", \"range\", "
                  "\"max_iterations\""});
}

TEST_F(FitReader, RunsAndStudiesRefuseAFit) {
  write("fit.toml", fit_file(law_only, slow));
  const std::string message = "fit.toml:8:2: error: fit: this file is a fit of a material: use `dielast fit`";
  for (const auto& read : {+[] { read_case("fit.toml"); }, +[] { read_study("fit.toml"); }}) {
    try {
      read();
      ADD_FAILURE();
    } catch (const CaseError& error) {
      EXPECT_EQ(error.what(), message);
    }
  }
}

} // namespace
} // namespace dielast::cases::fit_reader_test
