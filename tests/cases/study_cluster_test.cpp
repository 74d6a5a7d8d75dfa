// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <cstdlib>
#include <filesystem>

// A study's points as a job array: sbatch and squeue are scripts of the test that run the tasks on this
// machine.
namespace dielast::test::study_cluster_test {
namespace {

class StudyOnCluster : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("study.toml", "title = \"Study\"\ncase = \"small.toml\"\n[study]\n"
                        "vary = { \"drive.voltage\" = [\"2 kV\", \"3 kV\", \"4 kV\", \"5 kV\", \"6 kV\"] }\n"
                        "collect = [\"eps_y\"]\nset = { \"output.error_estimate\" = false }\n");
    std::filesystem::create_directory(directory / "bin");
    // An array is a file of its number while it runs; of the first one only the first task is run.
    script("sbatch",
           "case \"$*\" in *--partition=none*) echo 'invalid partition' >&2; exit 1;; esac\n"
           "job=$(ls jobs 2>/dev/null | wc -l); mkdir -p jobs; touch jobs/$job running-$job\n"
           "for word; do case $word in --array=0-*) last=${word#--array=0-};; esac; script=$word; done\n"
           "[ $job = 0 ] && last=0\n"
           "(for task in $(seq 0 $last); do SLURM_ARRAY_TASK_ID=$task sh $script; done; rm running-$job) "
           ">/dev/null 2>&1 &\necho $job\n");
    script("squeue",
           "for word; do case $word in --jobs=*) job=${word#--jobs=};; esac; done\n"
           "[ -e waiting ] && { rm waiting; echo PENDING Nodes required for job are DRAINED; exit; }\n"
           "[ -e running-$job ] && echo RUNNING None; exit 0\n");
  }
  void script(const std::string& name, const std::string& text) const {
    const std::string file = "bin/" + name;
    write(file, "#!/bin/sh\n" + text);
    std::filesystem::permissions(directory / file, std::filesystem::perms::owner_all);
  }
  Ended study(std::vector<std::string> more) const {
    more.insert(more.begin(), {"study", "study.toml"});
    return dielast(more, [this] {
      setenv("PATH", ((directory / "bin").string() + ":" + std::getenv("PATH")).c_str(), 1);
    });
  }
};

TEST_F(StudyOnCluster, PointsThatAnArrayHasLeftAreSubmittedAgainAndTheTableIsThatOfThisMachine) {
  ASSERT_EQ(study({"-o", "here"}).exit_code, 0);
  const Ended ended = study({"-o", "there", "--slurm=--time=5", "--batch", "2"});
  ASSERT_EQ(ended.exit_code, 0) << ended.out << ended.err;
  EXPECT_NE(ended.out.find("job array 0: 5 points"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("job array 1: 3 points"), std::string::npos) << ended.out;
  EXPECT_EQ(content("there/study.csv"), content("here/study.csv"));
}

// A study that says nothing for an hour looks like one that hangs.
TEST_F(StudyOnCluster, WhatAnArrayWaitsForIsTold) {
  write("waiting", "");
  const Ended ended = study({"-o", "there", "--slurm=--time=5"});
  ASSERT_EQ(ended.exit_code, 0) << ended.out << ended.err;
  EXPECT_NE(ended.out.find("job array 0 waits: Nodes required for job are DRAINED\n"), std::string::npos)
      << ended.out;
}

TEST_F(StudyOnCluster, WhatSbatchRefusesIsTold) {
  const Ended ended = study({"-o", "there", "--slurm=--partition=none"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.err.find("sbatch refuses: invalid partition"), std::string::npos) << ended.err;
}

TEST_F(StudyOnCluster, PointsMayBeNamed) {
  ASSERT_EQ(study({"-o", "some", "--points", "2-3,5"}).exit_code, 0);
  for (int point = 1; point <= 5; ++point)
    EXPECT_EQ(exists(directory / ("some/point-000" + std::to_string(point))),
              point == 2 || point == 3 || point == 5);
  EXPECT_FALSE(exists(directory / "some/study.csv"));
  for (const char* wrong : {"0", "3-1", "x", "1,,2", ""})
    EXPECT_EQ(study({"-o", "some", "--points", wrong}).exit_code, 1) << wrong;
}

} // namespace
} // namespace dielast::test::study_cluster_test
