// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"
#include "tests/sanitized.hpp"

#include <clocale>
#include <cstdlib>
#include <langinfo.h>

// What the surroundings of the program must not change.
namespace dielast::test::environment_test {
namespace {

class Environment : public CommandTest {
 protected:
  /// Runs a case with more and more memory: some must be too little, which must be told, and some enough.
  void run_with_little_memory(const std::string& file, rlim_t least, rlim_t step) const {
    int told = 0, enough = 0;
    for (rlim_t megabytes = least; megabytes <= 620; megabytes += step) {
      const Ended ended = dielast({"run", file, "-j", "1", "-q", "-o", std::to_string(megabytes)}, [&] {
        limit(RLIMIT_AS, megabytes << 20);
        limit(RLIMIT_CPU, 120); // a guard against hangs, not a measure: the last run takes up to 30 s
      });
      EXPECT_TRUE(ended.exit_code == 0 || ended.exit_code == 1)
          << megabytes << " MB: " << ended.exit_code << ended.err;
      EXPECT_TRUE(ended.exit_code == 0 || ended.err.find(" memory") != std::string::npos) << ended.err;
      told += ended.exit_code == 1;
      enough += ended.exit_code == 0;
    }
    EXPECT_GT(told, 0);
    EXPECT_GT(enough, 0);
  }
};

/// Lines of a log or a report that tell the time that was needed are left out.
std::string timeless(const std::string& text) {
  std::string kept;
  for (const std::string& line : lines_of(text))
    if (line.find("; CPU ") == std::string::npos) kept += line + "\n";
  return kept;
}

// The locale is built here, as few machines have it.
TEST_F(Environment, DecimalCommasChangeNothing) {
  constexpr const char* german = "de_DE.UTF-8";
  const std::filesystem::path locales = directory / "locales";
  std::filesystem::create_directory(locales);
  const std::string build = "localedef -i de_DE -f UTF-8 '" + (locales / german).string() + "'";
  ASSERT_EQ(std::system(build.c_str()), 0) << "needs the package locales";
  setenv("LOCPATH", locales.c_str(), 1);
  const locale_t built = newlocale(LC_ALL_MASK, german, nullptr);
  ASSERT_NE(built, nullptr);
  EXPECT_STREQ(nl_langinfo_l(RADIXCHAR, built), ",");
  freelocale(built);
  std::filesystem::copy(source_folder / "tests/fuzz/corpus/gmsh/order1_41.msh", directory / "own.msh");
  write("own.toml", R"toml([film]
material = "VHB 4910 (honeycomb)"
thickness = "0.5 mm"
prestretch = 1.5
[mesh]
file = "own.msh"
unit = "50.5 mm"
[[support]]
place = "rim"
fix = ["x", "y"]
[[electrode]]
name = "film"
place = "film"
[drive]
voltage = "1.5 kV"
)toml");
  for (const std::string name : {"own", "disc"}) {
    std::vector<std::filesystem::path> folders;
    for (const char* locale : {"C", german}) {
      folders.push_back(directory / (name + locale));
      const Ended ended =
          dielast({"run", name + ".toml", "-o", folders.back()}, [&] { setenv("LC_ALL", locale, 1); });
      ASSERT_EQ(ended.exit_code, 0) << ended.err;
    }
    for (const auto& entry : std::filesystem::directory_iterator(folders[0]))
      EXPECT_EQ(timeless(text_of(entry.path())), timeless(text_of(folders[1] / entry.path().filename())))
          << entry.path().filename();
  }
}

TEST_F(Environment, LittleMemoryIsEnoughOrTold) {
  if (sanitized) GTEST_SKIP();
  run_with_little_memory("disc.toml", 110, 30);
}

// Indefinite tangents are factored by MUMPS; OpenBLAS would try for ever to get its buffer.
TEST_F(Environment, LittleMemoryForSolidsIsEnoughOrTold) {
  if (sanitized) GTEST_SKIP();
  std::filesystem::copy(source_folder / "cases/gallery/stack_on_table/case.toml", directory / "stack.toml");
  run_with_little_memory("stack.toml", 220, 80);
}

#ifdef __x86_64__
// OpenBLAS says on stderr which kernels it takes, each time that it is loaded.
TEST_F(Environment, SolidsTakeKernelsOfTheProcessor) {
  std::filesystem::copy(source_folder / "cases/gallery/stack_on_table/case.toml", directory / "stack.toml");
  const auto kernels = [&](const char* asked) {
    const Ended ended = dielast({"run", "stack.toml", "-o", directory / "stack"}, [&] {
      setenv("OPENBLAS_VERBOSE", "2", 1);
      asked ? setenv("OPENBLAS_CORETYPE", asked, 1) : unsetenv("OPENBLAS_CORETYPE");
    });
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const std::size_t at = ended.err.rfind("Core: ");
    return at == std::string::npos ? "" : ended.err.substr(at + 6, ended.err.find('\n', at) - at - 6);
  };
  EXPECT_EQ(kernels("Prescott"), "Prescott"); // as asked
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "the oldest kernels are those of this processor";
  const std::string own = kernels(nullptr);
  EXPECT_NE(own, "");
  EXPECT_NE(own, "Prescott");
}
#endif

} // namespace
} // namespace dielast::test::environment_test
