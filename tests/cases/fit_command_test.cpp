// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <regex>

namespace dielast::test::fit_command_test {
namespace {

class FitCommand : public CommandTest {
 protected:
  /// A softening pull, and its file with these keys of [fit].
  void write_fit(const std::string& keys) const {
    write("pull.csv", "stretch,P_kPa\n1.2,7.7\n1.5,16.2\n2,26.1\n3,43.1\n4,58.4\n5,74.9\n6,90.1\n");
    write("fit.toml", "title = \"Soft film\"\n[film.material]\nlaw = \"gent\"\nshear_modulus = \"20 kPa\"\n"
                      "stretch_limit = 100\nrelative_permittivity = 3\n"
                      "[[film.material.branch]]\nshear_modulus = \"1 kPa\"\nrelaxation_time = \"2 s\"\n"
                      "[fit]\n" +
                          keys +
                          "\n[[test]]\nfile = \"pull.csv\"\nkind = \"uniaxial\"\nequilibrium = true\n"
                          "[[test]]\nfile = \"pull.csv\"\nkind = \"pure shear\"\nequilibrium = true\n"
                          "use = \"predict\"\n");
  }
  static constexpr const char* law_only = "parameters = [\"shear_modulus\", \"stretch_limit\"]";
};

TEST_F(FitCommand, WritesParametersTableMaterialAndReport) {
  write_fit(law_only);
  const Ended ended = dielast({"fit", "fit.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  const nlohmann::json fit = json_of("out/fit.json");
  EXPECT_EQ(fit["status"], "converged");
  ASSERT_EQ(fit["parameters"].size(), 2u);
  const nlohmann::json& modulus = fit["parameters"][0];
  EXPECT_EQ(modulus["name"], "shear_modulus");
  EXPECT_LT(modulus["low_95"], modulus["value"]);
  EXPECT_LT(modulus["value"], modulus["high_95"]);
  EXPECT_LT(fit["tests"][0]["rms_error"], 0.02);
  EXPECT_GT(fit["tests"][1]["rms_error"], fit["tests"][0]["rms_error"]);
  EXPECT_EQ(table_of(directory / "out/fit.csv").size(), 15u);
  EXPECT_EQ(table_of(directory / "out/fit.csv")[1][4], "7700");
  const std::string report = content("out/report.html");
  for (const char* part : {"</html>", "data:image/svg+xml", "95 % interval", "prediction"})
    EXPECT_NE(report.find(part), std::string::npos) << part;
  EXPECT_NE(ended.out.find("prediction"), std::string::npos);
}

TEST_F(FitCommand, TheMaterialCanBePastedIntoACase) {
  write_fit(law_only);
  ASSERT_EQ(dielast({"fit", "fit.toml", "-o", "out"}).exit_code, 0);
  std::string device = small_disc;
  const std::string named = "material = \"VHB 4910 (honeycomb)\"\n";
  device.replace(device.find(named), named.size(), "");
  write("device.toml", device + content("out/material.toml"));
  const Ended ended = dielast({"check", "device.toml"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(content("out/material.toml").find("relaxation_time = \"2 s\""), std::string::npos);
}

TEST_F(FitCommand, WhatTheTestsDoNotTellIsAWarning) {
  write_fit("");
  const Ended ended = dielast({"fit", "fit.toml", "-o", "out", "-q"}); // which hides no warning
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.err.find("warning: branch[1].relaxation_time is not identifiable"), std::string::npos)
      << ended.err;
  EXPECT_TRUE(json_of("out/fit.json")["parameters"][3]["low_95"].is_null());
}

TEST_F(FitCommand, ABoundOfTheUsersIsCalledSo) {
  write_fit("range = 1.01\n" + std::string(law_only));
  const Ended ended = dielast({"fit", "fit.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.err.find("shear_modulus is at the bound that fit.range sets, "), std::string::npos)
      << ended.err;
}

TEST_F(FitCommand, AFitThatGivesUpKeepsWhatItHas) {
  write_fit("max_iterations = 1\n" + std::string(law_only));
  const Ended ended = dielast({"fit", "fit.toml", "-o", "out"});
  EXPECT_EQ(ended.exit_code, 4);
  EXPECT_EQ(ended.err,
            "error: not converged after 2 iterations in several attempts: the best parameters so far\n");
  EXPECT_EQ(json_of("out/fit.json")["status"], "not converged");
  EXPECT_NE(content("out/material.toml").find("not converged after 2 iterations"), std::string::npos);
  EXPECT_NE(content("out/report.html").find("not converged after 2 iterations"), std::string::npos);
}

TEST_F(FitCommand, ResumeLeavesAFinishedFitAndMakesTheRestAgain) {
  write_fit(law_only);
  const std::vector<std::string> words{"fit", "fit.toml", "-o", "out", "--resume"};
  ASSERT_EQ(dielast(words).exit_code, 0);
  const std::string table = content("out/fit.csv");
  write("out/fit.csv", "kept");
  const Ended again = dielast(words);
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.out, "out: has run to its end, nothing to resume\n");
  EXPECT_EQ(content("out/fit.csv"), "kept");
  std::filesystem::remove(directory / "out/fit.csv");
  ASSERT_EQ(dielast(words).exit_code, 0);
  EXPECT_EQ(content("out/fit.csv"), table);
}

TEST_F(FitCommand, ResolvedFitsAreReadBack) {
  write_fit(law_only);
  ASSERT_EQ(dielast({"fit", "fit.toml", "-o", "out"}).exit_code, 0);
  write("again.toml", content("out/resolved.toml"));
  const Ended again = dielast({"fit", "again.toml", "-o", "again"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  for (const char* file : {"resolved.toml", "fit.csv", "material.toml"})
    EXPECT_EQ(content(std::string("again/") + file), content(std::string("out/") + file)) << file;
}

TEST_F(FitCommand, ResumeOfAChangedFitSaysWhatHasChangedAndStops) {
  write_fit(law_only);
  ASSERT_EQ(dielast({"fit", "fit.toml", "-o", "out"}).exit_code, 0);
  const auto changes = [&] {
    const Ended ended = dielast({"fit", "fit.toml", "-o", "out", "--resume"});
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_TRUE(ended.err.starts_with("error: out: the case has changed since: ")) << ended.err;
    return ended.err;
  };
  write_fit("parameters = [\"shear_modulus\"]");
  EXPECT_NE(changes().find("fit.parameters is "), std::string::npos);
  write_fit(law_only);
  write("pull.csv", "stretch,P_kPa\n1.2,7.7\n1.5,16.2\n2,26.1\n3,43.1\n");
  EXPECT_NE(changes().find("content of test[1].file is checksum "), std::string::npos);
}

// The data are those of 30 kPa beside a dashpot of 5 kPa s: P = mu (l - l^-2) + 3 eta l'/l^2.
TEST_F(FitCommand, TheFilmsOwnViscosityIsADashpotAndCanBeFitted) {
  std::string rows = "time_s,stretch,P_kPa\n0,1,0\n";
  for (int i = 1; i <= 30; ++i) {
    const double l = 1 + 0.05 * i;
    rows += fmt::format("{},{},{}\n", 0.1 * i, l, 30 * (l - 1 / (l * l)) + 15 * 0.5 / (l * l));
  }
  write("pull.csv", rows);
  const std::string test = "[[test]]\nfile = \"pull.csv\"\nkind = \"uniaxial\"\n";
  const std::string film = "[film.material]\nshear_modulus = \"20 kPa\"\nrelative_permittivity = 3\n";
  write("known.toml", film + "viscosity = \"5 kPa.s\"\n[fit]\nparameters = [\"shear_modulus\"]\n" + test);
  write("free.toml", film + "viscosity = \"1 kPa.s\"\n[fit]\n" + test);
  ASSERT_EQ(dielast({"fit", "known.toml", "-o", "known"}).exit_code, 0);
  ASSERT_EQ(dielast({"fit", "free.toml", "-o", "free"}).exit_code, 0);
  EXPECT_NEAR(json_of("known/fit.json")["parameters"][0]["value"].get<double>(), 30e3, 1e-3);
  const nlohmann::json found = json_of("free/fit.json")["parameters"];
  EXPECT_NEAR(found[0]["value"].get<double>(), 30e3, 1e-3);
  EXPECT_EQ(found[1]["name"], "viscosity");
  EXPECT_NEAR(found[1]["value"].get<double>(), 5e3, 1e-3);
  EXPECT_NE(content("free/material.toml").find("viscosity = \"5000 Pa s\""), std::string::npos);
  write("nominal.toml", film +
                            "viscosity = \"1 kPa.s\"\n[[film.material.branch]]\nshear_modulus = \"1 kPa\"\n"
                            "relaxation_time = \"1 s\"\ndashpot = \"nominal\"\n[fit]\n" +
                            test);
  const Ended refused = dielast({"fit", "nominal.toml", "-o", "nominal"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("a uniaxial test of a film with a viscosity and nominal dashpots"),
            std::string::npos)
      << refused.err;
}

// With the spring free, a branch keeps what the file says of its dashpot, in resolved.toml as well.
TEST_F(FitCommand, ABranchKeepsTheViscosityThatIsGiven) {
  write("pull.csv", "time_s,stretch,P_kPa\n0,1,0\n1,1.5,40\n2,2,60\n3,2.5,75\n4,3,90\n");
  const auto kept = [&](const std::string& dashpot, const std::string& parameters) {
    write("fit.toml", "[film.material]\nshear_modulus = \"20 kPa\"\nrelative_permittivity = 3\n"
                      "[[film.material.branch]]\nshear_modulus = \"20 kPa\"\n" +
                          dashpot + "\n[fit]\nparameters = [" + parameters +
                          "]\n[[test]]\nfile = \"pull.csv\"\nkind = \"uniaxial\"\n");
    EXPECT_EQ(dielast({"fit", "fit.toml", "-o", "out"}).exit_code, 0);
    const std::string material = content("out/material.toml"), resolved = content("out/resolved.toml");
    write("again.toml", resolved);
    EXPECT_EQ(dielast({"fit", "again.toml", "-o", "again"}).exit_code, 0);
    const std::string again = content("again/material.toml");
    EXPECT_EQ(again.substr(again.find('\n')), material.substr(material.find('\n')));
    return material.substr(material.find("directions"));
  };
  const std::string both = "\"shear_modulus\", \"branch[1].shear_modulus\"";
  EXPECT_NE(kept("viscosity = \"80 kPa.s\"", both).find("viscosity = \"80000 Pa s\""), std::string::npos);
  EXPECT_NE(kept("relaxation_time = \"4 s\"", both).find("relaxation_time = \"4 s\""), std::string::npos);
  EXPECT_NE(kept("viscosity = \"80 kPa.s\"", "\"shear_modulus\", \"branch[1].relaxation_time\"")
                .find("relaxation_time"),
            std::string::npos);
  EXPECT_NE(
      kept("relaxation_time = \"4 s\"", "\"shear_modulus\", \"branch[1].viscosity\"").find("viscosity = "),
      std::string::npos);
}

TEST_F(FitCommand, WrongInputAndFilesHaveTheirExitCodes) {
  write_fit("parameters = [\"shear_modulus\", \"strech_limit\"]");
  EXPECT_EQ(dielast({"fit", "fit.toml", "-o", "out"}).exit_code, 2);
  EXPECT_FALSE(exists("out"));
  EXPECT_EQ(dielast({"fit", "nowhere.toml"}).exit_code, 1);
  write_fit(law_only);
  EXPECT_EQ(dielast({"fit", "fit.toml", "-o", "pull.csv"}).exit_code, 1);
  EXPECT_EQ(dielast({"run", "fit.toml"}).exit_code, 2);
}

// What a testing machine writes is the measurement that "pull.csv" is: every way of saying it gives the fit.
TEST_F(FitCommand, TablesOfTestingMachinesAreRead) {
  write("plain.csv", "time_s,stretch,P_kPa\n60,1.2,7.5\n120,1.5,16\n180,2,26\n240,3,43\n");
  write("strain.csv",
        "time (min);strain (%);stress (MPa)\n1;20;0,0075\n2;50;0,016\n3;100;0,026\n4;200;0,043\n");
  // 10 mm x 2 mm x 50 mm long
  write("force.csv", "time (s),travel (mm),F (N)\n60,10,0.15\n120,25,0.32\n180,50,0.52\n240,100,0.86\n");
  const std::vector<std::pair<std::string, std::string>> ways{
      {"plain", ""},
      {"strain", "strain = \"strain (%)\"\n"},
      {"force",
       "displacement = \"travel (mm)\"\nlength = \"50 mm\"\nforce = \"F (N)\"\narea = \"20 mm^2\"\n"}};
  std::vector<double> moduli;
  for (const auto& [name, keys] : ways) {
    write(name + ".toml",
          "[film.material]\nlaw = \"neo-hookean\"\nshear_modulus = \"10 kPa\"\n[[film.material.branch]]\n"
          "law = \"neo-hookean\"\nshear_modulus = \"5 kPa\"\nrelaxation_time = \"100 s\"\n[fit]\n"
          "parameters = [\"shear_modulus\"]\n[[test]]\nfile = \"" +
              name + ".csv\"\nkind = \"uniaxial\"\n" + keys);
    const Ended ended = dielast({"fit", name + ".toml"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NE(ended.out.find("results in " + name + "-fit: "), std::string::npos) << ended.out;
    moduli.push_back(json_of(name + "-fit/fit.json")["parameters"][0]["value"]);
  }
  EXPECT_NEAR(moduli[1] / moduli[0], 1, 1e-9);
  EXPECT_NEAR(moduli[2] / moduli[0], 1, 1e-9);
  const auto wrong = [&](const std::string& keys) {
    write("wrong.toml",
          "[film.material]\nlaw = \"neo-hookean\"\nshear_modulus = \"10 kPa\"\n[fit]\n[[test]]\n"
          "file = \"force.csv\"\nkind = \"uniaxial\"\n" +
              keys);
    const Ended ended = dielast({"fit", "wrong.toml"});
    EXPECT_EQ(ended.exit_code, 2);
    return ended.err;
  };
  EXPECT_NE(wrong("displacement = \"travel (mm)\"\nforce = \"F (N)\"\narea = \"20 mm^2\"\n")
                .find("displacement and length need each other"),
            std::string::npos);
  EXPECT_NE(wrong("displacement = \"F (N)\"\nlength = \"50 mm\"\nforce = \"F (N)\"\narea = \"20 mm^2\"\n")
                .find("its name has no unit; allowed one of um mm cm m inch"),
            std::string::npos);
  EXPECT_NE(wrong("strain = \"travel (mm)\"\nstress = \"P\"\nforce = \"F (N)\"\narea = \"20 mm^2\"\n")
                .find("write either stress or force"),
            std::string::npos);
  write("force.csv", "strain,stress (kPa)\n20,7.5\n50,16\n");
  EXPECT_NE(wrong("strain = \"strain\"\n").find("rises to 50: a strain of 5000 %; where it is in percent"),
            std::string::npos);
}

// Data of 50 kPa up to 15 %: whatever way a name says percent, and only what may be a number is taken as one.
TEST_F(FitCommand, ColumnsOfStrainSayPercentInManyWays) {
  const auto fitted = [&](const std::string& column, const std::string& key, double unit, double start) {
    std::string rows = column + ";stress (kPa)\n";
    for (int i = 1; i <= 15; ++i) {
      const double l = 1 + 0.01 * i;
      rows += fmt::format("{};{}\n", start + unit * (l - 1), 50 * (l - 1 / (l * l)));
    }
    write("pull.csv", rows);
    write("fit.toml", "[film.material]\nshear_modulus = \"30 kPa\"\n[fit]\n[[test]]\nfile = \"pull.csv\"\n"
                      "kind = \"uniaxial\"\n" +
                          key + " = '" + column + "'\n");
    return dielast({"fit", "fit.toml", "-o", "out"});
  };
  for (const char* column : {"strain (%)", "strain %", "strain, %", "strain_percent", "strain (Percent)",
                             "percent strain", "strain_pct", "strain (pct)", "%strain", "Dehnung [%]"}) {
    const Ended ended = fitted(column, "strain", 100, 0);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_NEAR(json_of("out/fit.json")["parameters"][0]["value"].get<double>(), 50e3, 1e-2) << column;
    EXPECT_EQ(ended.err.find("warning"), std::string::npos) << ended.err;
    EXPECT_NE(ended.out.find("1.010 to 1.150"), std::string::npos) << ended.out;
  }
  for (const char* column : {"strain", "strain (mm/mm)", "strain [-]", "impact_strain"}) {
    EXPECT_EQ(fitted(column, "strain", 1, 0).exit_code, 0);
    EXPECT_NEAR(json_of("out/fit.json")["parameters"][0]["value"].get<double>(), 50e3, 1e-2) << column;
  }
  EXPECT_NE(
      fitted("strain", "strain", 50, 0).err.find("\"strain\" rises to 7.5, a strain of 750 %: if it is in"),
      std::string::npos);
  const auto refused = [&](const std::string& column, const std::string& key, double unit, double start,
                           const char* why) {
    const Ended ended = fitted(column, key, unit, start);
    EXPECT_EQ(ended.exit_code, 2) << column;
    EXPECT_NE(ended.err.find(why), std::string::npos) << ended.err;
  };
  refused("strain (mm)", "strain", 1, 0, "whose unit is none of a pure number");
  refused("true strain", "strain", 1, 0, "which is not the nominal strain by its name");
  refused("stretch (%)", "stretch", 100, 100, "wanted is the stretch as a number");
  refused("stretch", "stretch", 100, 100, "rises to 115; allowed a stretch up to 50");
}

// A fit's material goes into a case by the name of its file; what the case writes beside it comes first.
TEST_F(FitCommand, RunsTakeTheMaterialThatAFitHasWritten) {
  write_fit(law_only);
  ASSERT_EQ(dielast({"fit", "fit.toml", "-o", "fitted"}).exit_code, 0);
  std::string disc = small_disc;
  disc.replace(disc.find("\"VHB 4910 (honeycomb)\""), 22,
               "{ name = \"fitted/material.toml\", relative_permittivity = 4.5 }");
  write("disc.toml", disc);
  const Ended named = dielast({"run", "disc.toml", "-o", "named", "--set", "drive.voltage=1 kV"});
  ASSERT_EQ(named.exit_code, 0) << named.err;
  std::string fitted =
      std::regex_replace(content("fitted/material.toml"), std::regex("\npermittivity[^\n]*"), "");
  fitted.insert(fitted.find("[film.material]") + 16, "relative_permittivity = 4.5\n");
  std::string inline_disc = small_disc;
  inline_disc.replace(inline_disc.find("material = "), 33, "");
  inline_disc.insert(inline_disc.find("[disc]"), fitted.substr(fitted.find("[film.material]")));
  write("inline.toml", inline_disc);
  ASSERT_EQ(dielast({"run", "inline.toml", "-o", "inline", "--set", "drive.voltage=1 kV"}).exit_code, 0)
      << content("inline.toml");
  EXPECT_EQ(json_of("named/summary.json")["quantities"], json_of("inline/summary.json")["quantities"]);
  const Ended varied = dielast({"check", "disc.toml", "--set", "film.material.shear_modulus=1e99"});
  EXPECT_EQ(varied.exit_code, 2);
  const Ended missing = dielast({"check", "disc.toml", "--set", "film.material=nowhere.toml"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(
      missing.err.find("film.material: found \"nowhere.toml\": no such file; the path starts at the case "
                       "file's folder"),
      std::string::npos)
      << missing.err;
  write("bad.toml", "[film.material]\nlaw = \"gentt\"\n");
  const Ended bad = dielast({"check", "disc.toml", "--set", "film.material=bad.toml"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_NE(bad.err.find("bad.toml:2:7: error: film.material.law: found \"gentt\""), std::string::npos)
      << bad.err;
}

// A phase that leads where every circuit's lags behind.
TEST_F(FitCommand, AFunctionThatMissesWhatWasMeasuredIsToldSo) {
  for (const char* sign : {"-", ""}) {
    std::string table = "frequency[Hz],magnitude[Ohm],phase[deg]\n";
    for (const double f : {1.0, 3.0, 10.0, 30.0, 100.0}) {
      const std::complex<double> z = 1e5 + 1.0 / std::complex(1e-9, 2 * std::numbers::pi * f * 1e-9);
      table += fmt::format("{},{},{}{}\n", f, std::abs(z), sign, -std::arg(z) * 180 / std::numbers::pi);
    }
    write("z.csv", table);
    write("z.toml", "[[rational]]\nfile = \"z.csv\"\nresponse = \"impedance\"\n"
                    "circuit = [\"resistance\", \"leakage_resistance\", \"capacitance\"]\n");
    const Ended ended = dielast({"fit", "z.toml", "-o", "out"});
    EXPECT_EQ((ended.out + ended.err).find("the function misses what was measured by") == std::string::npos,
              *sign == '-')
        << ended.out << ended.err;
  }
}

TEST_F(FitCommand, HelpInfoAndSchemaKnowIt) {
  EXPECT_NE(dielast({"--help"}).out.find("fit a material to measured tests"), std::string::npos);
  const std::string info = dielast({"info", "fit"}).out;
  for (const char* word : {"[[test]]", "equal-biaxial", "parameters", "equilibrium", "predict"})
    EXPECT_NE(info.find(word), std::string::npos) << word;
  const auto schema = nlohmann::json::parse(dielast({"schema"}).out);
  EXPECT_TRUE(schema["properties"].contains("fit"));
  EXPECT_TRUE(schema["properties"]["test"]["items"]["properties"].contains("rate"));
}

TEST_F(FitCommand, TheGalleryFitConverges) {
  const Ended ended = dielast({"fit", source_folder / "cases/gallery/fit/ecoflex.toml", "-o", "out"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const nlohmann::json fit = json_of("out/fit.json");
  EXPECT_LT(fit["tests"][0]["rms_error"], 0.01);
  for (const auto& parameter : fit["parameters"]) EXPECT_TRUE(parameter["low_95"].is_number()) << parameter;
}

} // namespace
} // namespace dielast::test::fit_command_test
