// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"
#include "tests/cases/held_by_rods.hpp"

namespace dielast::test::exit_codes_test {
namespace {

class ExitCodes : public CommandTest {
 protected:
  void expect_file_error(const std::vector<std::string>& arguments, const std::string& message) {
    const Ended ended = dielast(arguments);
    EXPECT_EQ(ended.exit_code, 1) << ended.err;
    EXPECT_EQ(ended.err, "error: " + message + "\n");
  }
};

TEST_F(ExitCodes, ZeroForARunInItsDefaultDirectory) {
  const Ended ended = dielast({"run", "small.toml"});
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_TRUE(exists("small-results/summary.json"));
  EXPECT_FALSE(exists("small-results/checkpoint.cbor"));
}

TEST_F(ExitCodes, QuietRunsSayNothing) {
  const Ended ended = dielast({"run", "small.toml", "--quiet"});
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_EQ(ended.out + ended.err, "");
  EXPECT_NE(content("small-results/run.log"), "");
}

TEST_F(ExitCodes, QuietStudiesAndModelsSayNothing) {
  write("study.toml", "case = \"small.toml\"\n[study]\nvary = { \"drive.voltage\" = [\"1 kV\", \"2 kV\"] }\n"
                      "collect = [\"eps_x\"]\n");
  for (const char* command : {"study", "linearise"}) {
    const Ended ended =
        dielast({command, command == std::string("study") ? "study.toml" : "small.toml", "-q"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(ended.out, "") << command;
  }
  EXPECT_TRUE(exists("study-study/study.csv"));
}

TEST_F(ExitCodes, OneForWrongUsage) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{},
                                             {"rum", "small.toml"},
                                             {"run"},
                                             {"run", "small.toml", "--sat", "a=1"},
                                             {"run", "small.toml", "-j", "-1"},
                                             {"run", "small.toml", "-j", "many"},
                                             {"check", "small.toml", "disc.toml"}}) {
    const Ended ended = dielast(words);
    EXPECT_EQ(ended.exit_code, 1) << testing::PrintToString(words);
    EXPECT_NE(ended.err, "") << testing::PrintToString(words);
  }
  EXPECT_FALSE(exists("small-results"));
}

TEST_F(ExitCodes, OneForAnUnknownTopic) {
  const Ended ended = dielast({"info", "device"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("did you mean \"devices\"?"), std::string::npos) << ended.err;
}

TEST_F(ExitCodes, OneForFilesThatCannotBeRead) {
  for (const char* command : {"run", "check", "mesh", "study"})
    for (const char* file : {"nowhere.toml", ".", ""}) {
      const Ended ended = dielast({
          command,
          file,
      });
      EXPECT_EQ(ended.exit_code, 1) << command << " " << file;
      EXPECT_TRUE(ended.err.starts_with("error: ")) << ended.err;
      EXPECT_EQ(lines_of(ended.err).size(), 1u) << ended.err;
    }
}

TEST_F(ExitCodes, OneForAnOutputDirectoryThatIsAFile) {
  write("taken", "text");
  expect_file_error({"run", "small.toml", "-o", "taken"},
                    "taken: is not a directory; choose another with -o");
  expect_file_error({"mesh", "small.toml", "-o", "taken"},
                    "taken: is not a directory; choose another with -o");
  expect_file_error({"run", "small.toml", "-o", "taken/inside"},
                    "taken/inside: cannot make the output directory: Not a directory");
  EXPECT_EQ(content("taken"), "text");
}

// The kernel's own files are closed to everyone, root too.
TEST_F(ExitCodes, OneForAnOutputDirectoryThatCannotBeMade) {
  const Ended ended = dielast({"run", "small.toml", "-o", "/proc/dielast"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_TRUE(ended.err.starts_with("error: /proc/dielast: cannot make the output directory")) << ended.err;
}

// A limit of file sizes stands in for a full disk: as there, writing fails in the middle of a run.
TEST_F(ExitCodes, OneForAFullDiskAndWhatWasWrittenStays) {
  const Ended ended = dielast(
      {"run", "small.toml", "--set", "step.voltage.increments=200", "--set", "output.error_estimate=false"},
      [] { limit(RLIMIT_FSIZE, 20000); });
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_TRUE(ended.err.starts_with("error: cannot write small-results/")) << ended.err;
  EXPECT_TRUE(ended.err.ends_with(": File too large\n")) << ended.err;
  EXPECT_EQ(lines_of(ended.err).size(), 1u) << ended.err;
  EXPECT_FALSE(exists("small-results/summary.json"));
  const std::string list = content("small-results/small.pvd");
  EXPECT_NE(list.find("</VTKFile>"), std::string::npos);
  for (const auto& entry : std::filesystem::directory_iterator(directory / "small-results")) {
    const std::string name = entry.path().filename();
    EXPECT_NE(entry.path().extension(), ".part") << name;
    if (entry.path().extension() == ".vtu") {
      EXPECT_NE(text_of(entry.path()).find("</VTKFile>"), std::string::npos) << name;
    }
  }
  EXPECT_GT(table_of(directory / "small-results/history.csv").size(), 1u);
}

TEST_F(ExitCodes, ThreeForABrokenMesh) {
  for (const char* text : {"", "$MeshFormat\n", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1",
                           "\x7f"
                           "ELF"}) {
    write("own.msh", text);
    std::filesystem::copy_file(source_folder / "tests/cases/valid/own_mesh.toml", directory / "own.toml",
                               std::filesystem::copy_options::overwrite_existing);
    for (const char* command : {"run", "check", "mesh"}) {
      const Ended ended = dielast({command, "own.toml"});
      EXPECT_EQ(ended.exit_code, 3) << command << " " << text;
      EXPECT_TRUE(ended.err.starts_with("error: ")) << ended.err;
      EXPECT_NE(ended.err.find("own.msh"), std::string::npos) << ended.err;
    }
  }
}

TEST_F(ExitCodes, ThreeForASurfaceThatBoundsNoVolume) {
  write("solid.toml", "model = \"3d\"\n[film]\nthickness = \"1 mm\"\nsection = \"solid\"\n[film.material]\n"
                      "shear_modulus = \"40 kPa\"\npermittivity = \"4e-11 F/m\"\n[mesh]\nfile = "
                      "\"open.off\"\nunit = \"1 mm\"\n");
  write("open.off", "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n");
  const std::string message = "error: " + (directory / "open.off").string() +
                              ": it is open: 3 edges belong to one triangle only; close its holes\n";
  for (const char* command : {"run", "check", "mesh"}) {
    const Ended ended = dielast({command, "solid.toml"});
    EXPECT_EQ(ended.exit_code, 3) << command;
    EXPECT_EQ(ended.err, message);
  }
}

/// The limit point at which a run ends is a result, too: other discretisations tell its error, or that they
/// have none there (a clamped strip that is compressed at its corners).
TEST_F(ExitCodes, FourAtALimitPointWhoseErrorIsTold) {
  const auto remark = [&](const std::string& file, const std::string& assignment) {
    EXPECT_EQ(dielast({"run", file, "-o", "out", "--set", assignment}).exit_code, 4);
    const nlohmann::json remarks = json_of("out/summary.json")["event_remarks"];
    EXPECT_EQ(remarks.size(), 1u);
    EXPECT_EQ(remarks[0]["kind"], "limit point");
    return remarks[0]["remark"].get<std::string>();
  };
  const std::string diaphragm = source_folder / "cases/gallery/diaphragm/case.toml";
  EXPECT_EQ(remark(diaphragm, "drive.voltage=20 kV"), "depends on the mesh: 11.659 kV ± 12 mV");
  write("strip.toml",
        "[film]\nthickness = \"0.5 mm\"\nprestretch = [2, 2]\n[film.material]\nshear_modulus = "
        "\"50 kPa\"\nrelative_permittivity = 4\n[strip]\nlength = \"40 mm\"\nwidth = \"40 mm\"\n"
        "[weight]\nmass = \"40 g\"\n[output]\nfields = false\n");
  EXPECT_EQ(remark("strip.toml", "drive.voltage=6 kV"),
            "depends on the mesh: with elements and time steps 2 times as large the run reaches its end");
}

TEST_F(ExitCodes, FourBeyondTheLimitPointAndEveryAcceptedStateIsKept) {
  const Ended ended = dielast({"run", "small.toml", "--set", "drive.voltage=30 kV"});
  EXPECT_EQ(ended.exit_code, 4);
  const nlohmann::json summary = json_of("small-results/summary.json");
  ASSERT_TRUE(summary.is_object());
  EXPECT_EQ(summary["status"], "not converged");
  const std::string message = summary["message"];
  EXPECT_TRUE(message.starts_with("limit point near ")) << message;
  EXPECT_NE(message.find(" kV: equilibrium found up to "), std::string::npos) << message;
  EXPECT_NE(ended.out.find(message), std::string::npos);
  const auto rows = table_of(directory / "small-results/history.csv");
  ASSERT_EQ(rows.size() - 1, summary["steps"]["accepted"].get<std::size_t>());
  EXPECT_GT(rows.size(), 3u);
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  EXPECT_EQ(count(content("small-results/small.pvd"), "part=\"0\""), rows.size() - 1);
  EXPECT_NE(content("small-results/report.html").find("limit point near"), std::string::npos);
  EXPECT_TRUE(summary["quantities"]["eps_y"]["value"].is_number());
}

TEST_F(ExitCodes, FiveForWorksThatTheIncrementsDoNotResolve) {
  write("creep.toml",
        "[film]\nthickness = \"1 mm\"\n[film.material]\nshear_modulus = \"40 kPa\"\npermittivity = \"4e-11 "
        "F/m\"\n"
        "[[film.material.branch]]\nshear_modulus = \"60 kPa\"\nrelaxation_time = \"0.1 s\"\n"
        "[patch]\nmode = \"pure-shear\"\n"
        "stress_x = { wave = \"unipolar sine\", amplitude = \"20 kPa\", frequency = \"1 Hz\" }\n"
        "[[step]]\nkind = \"transient\"\nduration = \"3 s\"\nincrements = 12\n"
        "[solver]\ntime_tolerance = 0.1\n");
  const Ended ended = dielast({"run", "creep.toml", "-o", "coarse"});
  EXPECT_EQ(ended.exit_code, 5) << ended.err;
  EXPECT_NE(ended.out.find("unresolved energy"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("more increments or [solver] a smaller time_tolerance"), std::string::npos);
  const nlohmann::json checks = json_of("coarse/summary.json")["checks"];
  ASSERT_EQ(checks.size(), 1u);
  EXPECT_EQ(checks[0]["quantity"], "energy error");
  EXPECT_EQ(checks[0]["passed"], false);
  EXPECT_EQ(dielast({"run", "creep.toml", "-o", "fine", "--set", "solver.time_tolerance=1e-6"}).exit_code, 0);
}

// Turns do not commute: of one that is fixed beside two that are not some is left, by the number of
// increments.
TEST_F(ExitCodes, FiveForAFixedTurnThatTheOthersCarryAway) {
  const auto text = [](const std::string& fixed) {
    return held_by_rods("fix = [" + fixed + "]\n",
                        "[gravity]\ndirection = [0.3, 0.5, -1]\n[[step]]\nkind = \"weight\"\n"
                        "increments = 5\n");
  };
  write("one.toml", text("\"turn_z\""));
  const Ended ended = dielast({"run", "one.toml"});
  EXPECT_EQ(ended.exit_code, 5) << ended.err;
  EXPECT_NE(ended.out.find("fixed turn of b"), std::string::npos) << ended.out;
  EXPECT_EQ(json_of("one-results/summary.json")["checks"].size(), 1u);
  write("two.toml", text("\"turn_z\", \"turn_x\""));
  EXPECT_EQ(dielast({"run", "two.toml"}).exit_code, 0);
}

TEST_F(ExitCodes, FiveForAFailedCheck) {
  const std::string check =
      "[[check]]\nquantity = \"eps_y\"\nvalue = 5\ntolerance = \"1 %\"\nsource = \"nobody\"\n";
  write("checked.toml", small_honeycomb + check);
  const Ended ended = dielast({"run", "checked.toml"});
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_NE(ended.out.find("FAILED"), std::string::npos);
  const nlohmann::json checks = json_of("checked-results/summary.json")["checks"];
  ASSERT_EQ(checks.size(), 1u);
  EXPECT_EQ(checks[0]["passed"], false);
  EXPECT_EQ(checks[0]["expected"], 5);
  const Ended quiet = dielast({"run", "checked.toml", "-q"});
  EXPECT_EQ(quiet.exit_code, 5);
  EXPECT_NE(quiet.err.find("check eps_y              FAILED: "), std::string::npos) << quiet.err;
  EXPECT_EQ(lines_of(quiet.err).size(), 1u) << quiet.err;
}

} // namespace
} // namespace dielast::test::exit_codes_test
