// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <fmt/format.h>

#include <map>

namespace dielast::test::interrupt_test {
namespace {

class Interrupt : public CommandTest {
 protected:
  std::size_t rows(const std::string& table) const { return lines_of(content(table)).size(); }

  const std::vector<std::string> many{
      "run", "small.toml", "--set", "step.voltage.increments=250", "--set", "output.error_estimate=false"};
  std::vector<std::string> into(const std::string& folder, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = many;
    words.insert(words.end(), {"-o", folder});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  void expect_same_results(const std::string& folder, const std::string& other) const {
    for (const char* file : {"history.csv", "summary.json", "resolved.toml", "small.pvd"})
      EXPECT_EQ(content(folder + "/" + file), content(other + "/" + file)) << file;
  }
};

TEST_F(Interrupt, ResumedRunsEndInTheSameBits) {
  ASSERT_EQ(dielast(into("straight")).exit_code, 0);
  int resumes = 0;
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::size_t enough = resumes ? 80 : 40;
    const pid_t process =
        start(into("stopped", resumes ? std::vector<std::string>{"--resume"} : std::vector<std::string>{}));
    ASSERT_TRUE(until([&] { return rows("stopped/history.csv") > enough; }));
    kill(process, signal);
    const Ended ended = wait_for(process);
    ASSERT_EQ(ended.exit_code, 130) << ended.err;
    EXPECT_NE(ended.out.find("go on with --resume"), std::string::npos);
    EXPECT_FALSE(exists("stopped/summary.json"));
    EXPECT_LT(rows("stopped/history.csv"), 252u);
    ++resumes;
  }
  const Ended ended = dielast(into("stopped", {"--resume"}));
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("resumed behind"), std::string::npos);
  expect_same_results("stopped", "straight");
}

// ParaView's files too: they must not depend on what the process had written before them.
TEST_F(Interrupt, ResumedSeriesHasTheSameBits) {
  ASSERT_EQ(dielast(into("straight")).exit_code, 0);
  const pid_t process = start(into("stopped"));
  ASSERT_TRUE(until([&] { return rows("stopped/history.csv") > 40; }));
  kill(process, SIGINT);
  ASSERT_EQ(wait_for(process).exit_code, 130);
  const Ended ended = dielast(into("stopped", {"--resume"}));
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  int different = 0;
  for (const auto& entry : std::filesystem::directory_iterator(directory / "straight"))
    if (entry.path().extension() == ".vtu")
      different += text_of(entry.path()) != text_of(directory / "stopped" / entry.path().filename());
  EXPECT_EQ(different, 0);
}

// Steps are solved with a factor of an earlier tangent, with which the resumed run goes on.
TEST_F(Interrupt, ResumedFilmsKeepTheirFactor) {
  write("film.toml", "[film]\nthickness = \"1 mm\"\nprestretch = 2\n[film.material]\n"
                     "shear_modulus = \"45 kPa\"\nrelative_permittivity = 4.5\n"
                     "[rectangle]\nlength = \"40 mm\"\nwidth = \"20 mm\"\nelectrode_length = \"15 mm\"\n"
                     "electrode_width = \"10 mm\"\n[mesh]\nacross = 24\n[drive]\nvoltage = \"2 kV\"\n"
                     "[[step]]\nkind = \"voltage\"\nincrements = 30\n"
                     "[output]\nerror_estimate = false\nfields = false\n");
  ASSERT_EQ(dielast({"run", "film.toml", "-o", "straight"}).exit_code, 0);
  const pid_t process = start({"run", "film.toml", "-o", "stopped"});
  ASSERT_TRUE(until([&] { return rows("stopped/history.csv") > 5; }));
  kill(process, SIGINT);
  ASSERT_EQ(wait_for(process).exit_code, 130);
  ASSERT_EQ(dielast({"run", "film.toml", "-o", "stopped", "--resume"}).exit_code, 0);
  EXPECT_EQ(content("stopped/history.csv"), content("straight/history.csv"));
}

TEST_F(Interrupt, KilledRunsStartFromTheirLastCheckpointOrAnew) {
  ASSERT_EQ(dielast(into("straight")).exit_code, 0);
  const pid_t process = start(into("killed"));
  ASSERT_TRUE(until([&] { return rows("killed/history.csv") > 50; }));
  kill(process, SIGKILL);
  EXPECT_EQ(wait_for(process).exit_code, -SIGKILL);
  ASSERT_EQ(dielast(into("killed", {"--resume"})).exit_code, 0);
  expect_same_results("killed", "straight");
}

TEST_F(Interrupt, CheckpointsOfAnotherCaseAreRefused) {
  const pid_t process = start(into("stopped"));
  ASSERT_TRUE(until([&] { return rows("stopped/history.csv") > 20; }));
  kill(process, SIGINT);
  ASSERT_EQ(wait_for(process).exit_code, 130);
  const std::string before = content("stopped/history.csv");
  const Ended ended = dielast(into("stopped", {"--resume", "--set", "drive.voltage=5 kV"}));
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("the case has changed since"), std::string::npos) << ended.err;
  EXPECT_EQ(content("stopped/history.csv"), before);
}

TEST_F(Interrupt, BrokenCheckpointsAreRefused) {
  const pid_t process = start(into("stopped"));
  ASSERT_TRUE(until([&] { return rows("stopped/history.csv") > 20; }));
  kill(process, SIGINT);
  ASSERT_EQ(wait_for(process).exit_code, 130);
  std::filesystem::path checkpoint;
  for (const auto& entry : std::filesystem::directory_iterator(directory / "stopped"))
    if (entry.path().filename().string().find("checkpoint") != std::string::npos) checkpoint = entry.path();
  const std::string whole = text_of(checkpoint);
  ASSERT_FALSE(whole.empty());
  for (const std::string& broken :
       {whole.substr(0, whole.size() / 2), std::string(), std::string("checkpoint"),
        whole.substr(0, whole.size() / 2) + static_cast<char>(whole[whole.size() / 2] ^ 1) +
            whole.substr(whole.size() / 2 + 1)}) {
    std::ofstream(checkpoint, std::ios::binary) << broken;
    const Ended ended = dielast(into("stopped", {"--resume"}));
    EXPECT_EQ(ended.exit_code, 1) << broken.size();
    EXPECT_NE(ended.err.find("without --resume"), std::string::npos) << ended.err;
  }
}

// A bit that changed in their kept part was carried on into the results.
TEST_F(Interrupt, HistoryAndSeriesAreMadeAnewOfTheCheckpoint) {
  ASSERT_EQ(dielast(into("straight")).exit_code, 0);
  const pid_t process = start(into("stopped"));
  ASSERT_TRUE(until([&] { return rows("stopped/history.csv") > 20; }));
  kill(process, SIGINT);
  ASSERT_EQ(wait_for(process).exit_code, 130);
  for (const std::string file : {"stopped/history.csv", "stopped/small.pvd"}) {
    std::string damaged = content(file);
    damaged[damaged.size() / 2] ^= 4;
    write(file, damaged);
  }
  ASSERT_EQ(dielast(into("stopped", {"--resume"})).exit_code, 0);
  expect_same_results("stopped", "straight");
}

// A strip that curls as it is cut free falls for seconds. No run begins on the way: it falls again.
TEST_F(Interrupt, AJumpStopsOnItsWay) {
  const std::string rubber = "shear_modulus = \"500 kPa\"\nrelative_permittivity = 3\n";
  write("strip.toml",
        "model = \"3d\"\n[film]\nsection = \"shell\"\nthickness = \"60 um\"\n[film.material]\n" + rubber +
            "[[film.layer]]\nside = \"above\"\nthickness = \"31.2 um\"\nprestretch = 1.02\n"
            "[film.layer.material]\n" +
            rubber +
            "[rectangle]\nlength = \"20 mm\"\nwidth = \"6 mm\"\n[mesh]\nacross = 3\n[[support]]\n"
            "place = \"left\"\nfix = [\"x\", \"y\", \"z\", \"turn_x\", \"turn_y\", \"turn_z\"]\n[[step]]\n"
            "kind = \"release\"\non_instability = \"jump\"\n[output]\nerror_estimate = false\n");
  const pid_t process = start({"run", "strip.toml", "-o", "stopped"});
  ASSERT_TRUE(until([&] { return content("stopped/run.log").find("point at") != std::string::npos; }));
  kill(process, SIGINT);
  const Ended ended = wait_for(process);
  ASSERT_EQ(ended.exit_code, 130) << ended.err;
  EXPECT_EQ(content("stopped/run.log").find("jumped"), std::string::npos);
  ASSERT_EQ(dielast({"run", "strip.toml", "-o", "stopped", "--resume"}).exit_code, 0);
  ASSERT_EQ(dielast({"run", "strip.toml", "-o", "straight"}).exit_code, 0);
  for (const char* file : {"history.csv", "summary.json"})
    EXPECT_EQ(content(fmt::format("stopped/{}", file)), content(fmt::format("straight/{}", file))) << file;
}

// What is solved for behind the last step stops, too; everything else is told, and made up for.
TEST_F(Interrupt, MarginsAndErrorEstimatesStop) {
  write("slow.toml", small_disc + "[output]\nmargins_up_to = 50\n");
  const std::vector<std::string> low{"--set", "drive.voltage=10 V"}, estimated{"--set", "mesh.rings=96"};
  const auto run = [&](std::vector<std::string> more, const char* folder, const char* resume = nullptr) {
    more.insert(more.begin(), {"run", "slow.toml", "-o", folder});
    if (resume) more.emplace_back(resume);
    return more;
  };
  const auto stop = [&](const std::vector<std::string>& words, const char* at) {
    const pid_t process = start(words);
    EXPECT_TRUE(until([&] { return content("stopped/run.log").find(at) != std::string::npos; }));
    kill(process, SIGINT);
    const Ended ended = wait_for(process);
    EXPECT_EQ(ended.exit_code, 130) << ended.err;
    EXPECT_NE(ended.out.find("go on with --resume"), std::string::npos) << ended.out;
    EXPECT_EQ(rows("stopped/history.csv"), 4u);
    return json_of("stopped/summary.json");
  };
  const nlohmann::json margins = stop(run(low, "stopped"), "margins: up to 50");
  EXPECT_EQ(margins["margins"]["pull-in"]["remark"], "not known: interrupted before it was solved for");
  EXPECT_EQ(margins["no_error_estimate_because"], "interrupted");
  ASSERT_EQ(dielast(run(low, "straight")).exit_code, 0);
  ASSERT_EQ(dielast(run(low, "stopped", "--resume")).exit_code, 0);
  for (const char* file : {"history.csv", "summary.json"})
    EXPECT_EQ(content(fmt::format("stopped/{}", file)), content(fmt::format("straight/{}", file))) << file;
  std::filesystem::remove_all(directory / "stopped");
  write("slow.toml", small_disc);
  EXPECT_EQ(stop(run(estimated, "stopped"), "error estimate:")["no_error_estimate_because"], "interrupted");
}

TEST_F(Interrupt, ResumingAFinishedRunRepeatsIt) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out"}).exit_code, 0);
  const std::string summary = content("out/summary.json"), history = content("out/history.csv");
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out", "--resume"}).exit_code, 0);
  EXPECT_EQ(content("out/summary.json"), summary);
  EXPECT_EQ(content("out/history.csv"), history);
}

} // namespace
} // namespace dielast::test::interrupt_test
