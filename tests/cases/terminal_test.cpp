// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <fcntl.h>
#include <regex>

namespace dielast::test::terminal_test {
namespace {

/// What becomes of a run when its terminal, its streams or its user go away.
class Terminal : public CommandTest {
 protected:
  static inline const std::vector<std::string> run{"run", "small.toml", "-o", "out"};
  static inline const std::vector<std::string> long_run{
      "run",   "small.toml",         "-o", "out", "--set", "step.voltage.increments=200",
      "--set", "output.fields=false"};

  /// Starts a run and waits until it is under way.
  pid_t under_way(const Prepare& prepare = {}) const {
    const pid_t process = start(long_run, prepare);
    EXPECT_TRUE(until([&] { return lines_of(content("out/history.csv")).size() > 5; }));
    return process;
  }
  /// Sends signals that all arrive together.
  Ended send(pid_t process, const std::vector<int>& signals) const {
    kill(process, SIGSTOP);
    for (const int signal : signals) kill(process, signal);
    kill(process, SIGCONT);
    return wait_for(process);
  }
};

// The first file of results took the place of a closed stream, and the log went into it.
TEST_F(Terminal, ClosedStreamsChangeNoResult) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "straight"}).exit_code, 0);
  for (const std::vector<int>& closed :
       {std::vector<int>{1}, std::vector<int>{0, 1, 2}, std::vector<int>{2}}) {
    const Ended ended = dielast(run, [&] {
      for (const int stream : closed) close(stream);
    });
    EXPECT_EQ(ended.exit_code, 0);
    for (const char* file : {"history.csv", "summary.json", "resolved.toml", "manifest.txt"})
      EXPECT_EQ(content(std::string("out/") + file), content(std::string("straight/") + file)) << file;
  }
}

TEST_F(Terminal, AnOutputThatCannotBeWrittenIsAnError) {
  write("study.toml", "case = \"small.toml\"\n[study]\nvary = { \"drive.voltage\" = [\"2 kV\"] }\n");
  for (const std::vector<std::string>& words :
       {run, std::vector<std::string>{"check", "small.toml"}, std::vector<std::string>{"info"},
        std::vector<std::string>{"--help"}, std::vector<std::string>{"study", "study.toml"}}) {
    const Ended ended = dielast(words, [] { dup2(open("/dev/full", O_WRONLY), 1); });
    EXPECT_EQ(ended.exit_code, 1) << words[0];
    EXPECT_EQ(ended.err, "error: cannot write to the standard output\n") << words[0];
  }
  EXPECT_EQ(json_of("out/summary.json")["status"], "complete");
  EXPECT_EQ(lines_of(content("study-study/study.csv")).size(), 2u);
  const Ended ended = dielast({"run", "nowhere.toml"}, [] { dup2(open("/dev/full", O_WRONLY), 2); });
  EXPECT_EQ(ended.exit_code, 1);
}

TEST_F(Terminal, APipeWithoutAReaderStopsNothing) {
  write("study.toml",
        "case = \"small.toml\"\n[study]\nvary = { \"drive.voltage\" = [\"2 kV\", \"3 kV\", \"4 kV\"] }\n");
  for (const std::vector<std::string>& words :
       {run, std::vector<std::string>{"study", "study.toml", "-o", "many", "-j", "1"}}) {
    int ends[2];
    ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
    const pid_t process = start(words, [&] { dup2(ends[1], 1); });
    close(ends[1]);
    char first = 0;
    EXPECT_EQ(read(ends[0], &first, 1), 1); // as `| head -1` does
    close(ends[0]);
    const Ended ended = wait_for(process);
    EXPECT_EQ(ended.exit_code, 0) << words[0];
    EXPECT_EQ(ended.err, "") << words[0];
  }
  EXPECT_EQ(json_of("out/summary.json")["status"], "complete");
  EXPECT_EQ(lines_of(content("many/study.csv")).size(), 4u);
  EXPECT_NE(content("many/report.html").find("</html>"), std::string::npos);
}

TEST_F(Terminal, EverySignalToEndKeepsACheckpoint) {
  auto straight = long_run;
  straight[3] = "straight";
  ASSERT_EQ(dielast(straight).exit_code, 0);
  for (const int signal : {SIGHUP, SIGTERM, SIGINT}) {
    const Ended ended = send(under_way(), {signal});
    EXPECT_EQ(ended.exit_code, 130) << signal;
    EXPECT_NE(ended.out.find("go on with --resume"), std::string::npos) << signal;
    EXPECT_TRUE(exists("out/checkpoint.cbor")) << signal;
    auto resumed = long_run;
    resumed.emplace_back("--resume");
    EXPECT_EQ(dielast(resumed).exit_code, 0) << signal;
    for (const char* file : {"history.csv", "summary.json", "manifest.txt"})
      EXPECT_EQ(content(std::string("out/") + file), content(std::string("straight/") + file)) << file;
    std::filesystem::remove_all(directory / "out");
  }
}

// The second one does not wait for the state that is being computed.
TEST_F(Terminal, TheSecondSignalEndsTheRunAtOnce) {
  for (const auto& [first, second] :
       {std::pair{SIGINT, SIGTERM}, std::pair{SIGHUP, SIGTERM}, std::pair{SIGHUP, SIGINT}}) {
    const Ended ended = send(under_way(), {first, second});
    EXPECT_TRUE(ended.exit_code == -first || ended.exit_code == -second) << ended.exit_code;
    std::filesystem::remove_all(directory / "out");
  }
}

TEST_F(Terminal, NohupIsHeeded) {
  EXPECT_EQ(send(under_way([] { std::signal(SIGHUP, SIG_IGN); }), {SIGHUP}).exit_code, 0);
}

// Progress has the units of the results, and the last line says where these are.
TEST_F(Terminal, ProgressAndResultsSpeakAlike) {
  const Ended ended = dielast({"run", "small.toml", "-o", "out", "--set", "output.error_estimate=false"});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const std::vector<std::string> lines = lines_of(ended.out);
  std::smatch shown;
  std::string progress;
  for (const std::string& line : lines)
    if (std::regex_search(line, shown, std::regex("   eps_y ([-0-9.]+) %"))) progress = shown[1];
  const std::string result = content("out/run.log");
  ASSERT_TRUE(std::regex_search(result, shown, std::regex("\n  eps_y +([-0-9.]+) %")));
  ASSERT_FALSE(progress.empty()) << ended.out;
  EXPECT_NEAR(std::stod(progress), std::stod(shown[1]), 0.01);
  EXPECT_EQ(ended.out.find(" 1 iterations"), std::string::npos) << ended.out;
  EXPECT_EQ(lines.back(), "results in out: report.html, history.csv, summary.json, small.pvd for ParaView");
  EXPECT_EQ(dielast({"run", "small.toml", "-o", "out", "-q"}).out, "");
}

} // namespace
} // namespace dielast::test::terminal_test
