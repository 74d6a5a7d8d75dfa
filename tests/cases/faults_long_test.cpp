// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/faults_command.hpp"

namespace dielast::test::faults_long_test {
namespace {

class FaultsLong : public FaultTest {};

// At every call that changes a file of a run or fit, and every fifth of a study: more than 200 kills.
TEST_F(FaultsLong, KilledCommandsEndInTheSameBytes) {
  const int run = kill_and_resume("run", 1, 1), study = kill_and_resume("study", 1, 5),
            fit = kill_and_resume("fit", 1, 1);
  std::cout << "kills: run " << run << ", study " << study << ", fit " << fit << "\n";
  EXPECT_GE(run + study + fit, 200);
}

TEST_F(FaultsLong, AFullDiskIsToldAndResumeGoesOn) {
  fill_the_disk("run", 25);
  fill_the_disk("study", 20);
  fill_the_disk("fit", 5);
}

TEST_F(FaultsLong, DamagedCheckpointsChangeNoResult) { damage_checkpoints(500); }

} // namespace
} // namespace dielast::test::faults_long_test
