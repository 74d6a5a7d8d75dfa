// SPDX-License-Identifier: GPL-3.0-or-later
// How many instructions small runs take, from their meshes to the last step, counted by callgrind: what gets
// slower by half is seen on a busy machine, too. The counts are those of instruction_counts.json, which
//   DIELAST_REMAKE_COUNTS=1 build/bin/instruction_counts_test
// makes again.
#include "tests/cases/command.hpp"

#include <cstdlib>
#include <regex>

namespace dielast::test::instruction_counts_test {
namespace {

constexpr double most = 1.5, least = 0.5; ///< of the recorded counts

class InstructionCounts : public CommandTest, public testing::WithParamInterface<const char*> {};

TEST_P(InstructionCounts, AreThoseThatWereRecorded) {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    GTEST_SKIP() << "this processor does not know the instructions that are counted";
  const Ended ended =
      dielast({"--tool=callgrind", "--callgrind-out-file=/dev/null", DIELAST_COUNTED, GetParam()}, [] {
        setenv("OPENBLAS_CORETYPE", "Haswell", 1); // the same everywhere, and one that valgrind knows
        setenv("OMP_THREAD_LIMIT", "1", 1);
      });
  ASSERT_EQ(ended.exit_code, 0) << ended.out << ended.err;
  std::smatch found;
  ASSERT_TRUE(std::regex_search(ended.err, found, std::regex("Collected : ([0-9]+)"))) << ended.err;
  const double count = std::stod(found[1]);
  const std::filesystem::path file = source_folder / "tests/bench/instruction_counts.json";
  nlohmann::json recorded = nlohmann::json::parse(text_of(file));
  if (std::getenv("DIELAST_REMAKE_COUNTS")) {
    recorded[GetParam()] = static_cast<long>(count);
    std::ofstream(file) << recorded.dump(2) << "\n";
    return;
  }
  const double before = recorded.at(GetParam());
  EXPECT_LE(count, most * before) << "slower: find out why, or record the counts again and say so";
  EXPECT_GE(count, least * before) << "faster: record the counts again, or the next loss is not seen";
}

INSTANTIATE_TEST_SUITE_P(Small, InstructionCounts, testing::Values("patch", "ring", "meridian"),
                         [](const auto& test) { return std::string(test.param); });

} // namespace
} // namespace dielast::test::instruction_counts_test
