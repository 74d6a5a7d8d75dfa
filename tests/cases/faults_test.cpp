// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/faults_command.hpp"

namespace dielast::test::faults_test {
namespace {

// Few of many: faults_long_test.cpp has the others.
class Faults : public FaultTest {};

TEST_F(Faults, KilledCommandsEndInTheSameBytes) {
  EXPECT_GE(kill_and_resume("run", 5, 31), 4);
  EXPECT_GE(kill_and_resume("fit", 3, 9), 2);
}

// The last files of a run: it said that it had run to its end, and the report never came.
TEST_F(Faults, ARunKilledBetweenItsLastFilesIsCompletedByResume) {
  ASSERT_EQ(dielast(words("run", "straight")).exit_code, 0);
  long call = 1000;
  while (killed_at(call, words("run", "out")).exit_code == 0) call /= 2; // within the run
  while (killed_at(call + 8, words("run", "out")).exit_code == -SIGKILL) call += 8;
  for (long late = call; killed_at(late, words("run", "out")).exit_code == -SIGKILL; ++late) {
    const Ended resumed = dielast(words("run", "out", true));
    EXPECT_EQ(resumed.exit_code, 0) << late << resumed.err;
    EXPECT_EQ(differences("out", "straight"), std::vector<std::string>{}) << late;
    EXPECT_NE(content("out/report.html").find("</html>"), std::string::npos) << late;
  }
}

// A run that would take days said nothing of it. The clock runs ahead here.
TEST_F(Faults, LongStepsSayHowLongTheyTake) {
  std::vector<std::string> command = words("run", "out");
  for (const char* word : {"--set", "step.voltage.increments=30"}) command.emplace_back(word);
  const Ended ended = with_disk(1000000000, command);
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_NE(ended.out.find("; at this pace the step takes "), std::string::npos) << ended.out;
}

// The last state of a step waits for the next one before it is written; a checkpoint in between keeps it.
TEST_F(Faults, ASeriesOfLastStatesSurvivesKills) {
  write("run.toml", small_honeycomb + "[output]\nerror_estimate = false\nstates = \"last\"\n");
  EXPECT_GT(kill_and_resume("run", 5, 9), 3);
}

TEST_F(Faults, AFullDiskIsToldAndResumeGoesOn) { fill_the_disk("run", 3); }

TEST_F(Faults, DamagedCheckpointsChangeNoResult) { damage_checkpoints(12); }

} // namespace
} // namespace dielast::test::faults_test
