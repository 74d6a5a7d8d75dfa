// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <set>

namespace dielast::test::folders_test {
namespace {

/// What the folders of results hold, and whose they are.
class Folders : public CommandTest {
 protected:
  std::set<std::string> files(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory / folder))
      names.insert(entry.path().filename());
    return names;
  }
  Ended run(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"run", "small.toml", "-o", "out"};
    words.insert(words.end(), more.begin(), more.end());
    return dielast(words);
  }
  std::string changed(const Ended& resumed) const {
    EXPECT_EQ(resumed.exit_code, 1);
    EXPECT_TRUE(resumed.err.starts_with("error: out: the case has changed since: ")) << resumed.err;
    EXPECT_TRUE(resumed.err.ends_with("; run it again without --resume\n")) << resumed.err;
    return resumed.err;
  }
};

TEST_F(Folders, ASecondRunIsRefusedWhileTheFirstGoesOn) {
  const pid_t first = start({"run", "small.toml", "-o", "out", "--set", "step.voltage.increments=100"});
  ASSERT_TRUE(until([&] { return lines_of(content("out/history.csv")).size() > 10; }));
  kill(first, SIGSTOP);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, std::vector<std::string>{"--resume"}}) {
    const Ended second = run(more);
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_EQ(second.err,
              "error: out: in use by another run; wait until it has ended or choose another with -o\n");
  }
  kill(first, SIGCONT);
  EXPECT_EQ(wait_for(first).exit_code, 0);
  EXPECT_EQ(lines_of(content("out/history.csv")).size(), 103u);
  EXPECT_EQ(run({"--set", "step.voltage.increments=100", "--resume"}).exit_code, 0);
}

TEST_F(Folders, TheManifestListsEverythingThatARunWrites) {
  ASSERT_EQ(run().exit_code, 0);
  std::set<std::string> listed{"manifest.txt"};
  for (const std::string& line : lines_of(content("out/manifest.txt")))
    if (line.starts_with("file ")) listed.insert(line.substr(5));
  listed.erase("checkpoint.cbor"); // not needed any more
  EXPECT_EQ(files("out"), listed);
  EXPECT_EQ(lines_of(content("out/manifest.txt")).back(), "complete 0");
}

TEST_F(Folders, NothingOfAnotherCaseStaysAndForeignFilesDo) {
  ASSERT_EQ(run({"--set", "step.voltage.increments=6"}).exit_code, 0);
  write("out/notes.txt", "mine");
  write("out/small_film_0099.vtu", "mine");
  ASSERT_EQ(dielast({"run", "disc.toml", "-o", "out"}).exit_code, 0);
  ASSERT_EQ(dielast({"run", "disc.toml", "-o", "fresh"}).exit_code, 0);
  auto expected = files("fresh");
  expected.insert({"notes.txt", "small_film_0099.vtu"});
  EXPECT_EQ(files("out"), expected);
  EXPECT_EQ(content("out/notes.txt"), "mine");
}

// A measured history.csv beside the case was replaced by the run's.
TEST_F(Folders, WhatIsForeignIsNotOverwritten) {
  std::filesystem::create_directory(directory / "out");
  write("out/history.csv", "mine");
  const Ended ended = run();
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("out/history.csv: is none of these results"), std::string::npos) << ended.err;
  EXPECT_EQ(content("out/history.csv"), "mine");
  EXPECT_EQ(run({"--resume"}).exit_code, 1);
  EXPECT_EQ(content("out/history.csv"), "mine");
}

TEST_F(Folders, EveryCommandHasItsOwn) {
  write("small-study.toml", "case = \"small.toml\"\n[study]\nvary = { \"drive.voltage\" = [\"2 kV\"] }\n");
  std::filesystem::rename(directory / "small.toml", directory / "one.toml");
  write("small.toml", "case = \"one.toml\"\n[study]\nvary = { \"drive.voltage\" = [\"2 kV\"] }\n");
  ASSERT_EQ(dielast({"study", "small.toml"}).exit_code, 0);
  ASSERT_EQ(dielast({"run", "one.toml"}).exit_code, 0);
  ASSERT_EQ(dielast({"mesh", "one.toml"}).exit_code, 0);
  EXPECT_TRUE(exists("small-study/study.csv"));
  EXPECT_TRUE(exists("one-results/summary.json"));
  EXPECT_TRUE(exists("one-mesh/one-mesh.pvd"));
  const Ended ended = dielast({"study", "small.toml", "-o", "one-results"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.err, "error: one-results: holds the results of \"dielast run\"; choose another with -o\n");
  EXPECT_TRUE(exists("one-results/summary.json"));
}

TEST_F(Folders, StudiesOfFewerPointsLeaveNoneOfTheOthers) {
  const auto write_study = [&](const char* voltages) {
    write("study.toml", std::string("case = \"small.toml\"\n[study]\nvary = { \"drive.voltage\" = ") +
                            voltages + " }\ncollect = [\"eps_x\"]\n");
  };
  for (const std::string& resume : {std::string("--resume"), std::string()}) {
    std::vector<std::string> words{"study", "study.toml", "-o", "out"};
    write_study("[\"2 kV\", \"4 kV\", \"6 kV\"]");
    ASSERT_EQ(dielast(words).exit_code, 0);
    write("out/point-0003/notes.txt", "mine");
    write_study("[\"2 kV\"]");
    if (!resume.empty()) words.push_back(resume);
    ASSERT_EQ(dielast(words).exit_code, 0);
    EXPECT_EQ(files("out"), (std::set<std::string>{"manifest.txt", "point-0001", "point-0003", "report.html",
                                                   "resolved.toml", "study.csv"}));
    EXPECT_EQ(files("out/point-0003"), std::set<std::string>{"notes.txt"});
  }
}

TEST_F(Folders, ResumingAChangedCaseSaysWhatHasChangedAndStops) {
  ASSERT_EQ(run().exit_code, 0);
  const std::string summary = content("out/summary.json");
  EXPECT_NE(changed(run({"--resume", "--set", "drive.voltage=5 kV"}))
                .find("voltage is \"5000 V\", it was \"6000 V\""),
            std::string::npos);
  EXPECT_NE(changed(run({"--resume", "--set", "step.voltage.increments=4"}))
                .find("step[2].increments is 4, it was 3"),
            std::string::npos);
  EXPECT_EQ(content("out/summary.json"), summary);
  std::filesystem::remove(directory / "out/summary.json"); // as after a kill
  changed(run({"--resume", "--set", "drive.voltage=5 kV"}));
}

// The name of a mesh file says nothing of what stands in it.
TEST_F(Folders, AChangedMeshIsAChangedCase) {
  write("small.toml", "[film]\nmaterial = \"VHB 4910 (honeycomb)\"\nthickness = \"1 mm\"\nprestretch = 2\n"
                      "[mesh]\nfile = \"own.msh\"\nunit = \"1 m\"\n"
                      "[[support]]\nplace = \"frame\"\nfix = [\"x\", \"y\"]\n"
                      "[[electrode]]\nname = \"film\"\nplace = \"film\"\n[drive]\nvoltage = \"1 kV\"\n");
  const std::string mesh =
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
      "$PhysicalNames\n2\n1 1 \"frame\"\n2 2 \"film\"\n$EndPhysicalNames\n"
      "$Entities\n0 1 1 0\n1 0 0 0 1 1 0 1 1 0\n1 0 0 0 1 1 0 1 2 0\n$EndEntities\n"
      "$Nodes\n1 5 1 5\n2 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 0.4 0\n$EndNodes\n"
      "$Elements\n2 8 1 8\n1 1 1 4\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n"
      "2 1 2 4\n5 1 2 5\n6 2 3 5\n7 3 4 5\n8 4 1 5\n$EndElements\n";
  write("own.msh", mesh);
  ASSERT_EQ(run().exit_code, 0);
  EXPECT_EQ(run({"--resume"}).exit_code, 0);
  write("own.msh", mesh + "\n");
  EXPECT_NE(changed(run({"--resume"})).find("content of mesh.file is checksum "), std::string::npos);
}

TEST_F(Folders, WhatIsMissingOfAFinishedRunIsMadeAgain) {
  ASSERT_EQ(run().exit_code, 0);
  const std::string summary = content("out/summary.json");
  for (const char* file : {"out/report.html", "out/summary.json", "out/resolved.toml", "out/manifest.txt"}) {
    std::filesystem::remove(directory / file);
    ASSERT_EQ(run({"--resume"}).exit_code, 0) << file;
    EXPECT_NE(content(file), "") << file;
    EXPECT_EQ(content("out/summary.json"), summary) << file;
  }
  write("out/summary.json", "{}");
  ASSERT_EQ(run({"--resume"}).exit_code, 0);
  EXPECT_EQ(content("out/summary.json"), summary);
}

} // namespace
} // namespace dielast::test::folders_test
