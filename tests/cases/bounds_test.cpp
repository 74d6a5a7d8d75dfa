// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/readers/reader.hpp"
#include "cases/readers/resolved.hpp"
#include "cases/readers/study_reader.hpp"
#include "cases/studies/study_points.hpp"
#include "cases/text/input_file.hpp"
#include "cases/text/tree.hpp"
#include "tests/cases/scratch.hpp"

#include <algorithm>
#include <sys/stat.h>

// What a careless or hostile file could ask for without an end.
namespace dielast::cases::bounds_test {
namespace {

class Bounds : public test::ScratchTest {
 protected:
  template<class Error, class Read>
  static std::string error_of(const Read& read) {
    try {
      read();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  static std::string file_error(const std::filesystem::path& path) {
    return error_of<FileError>([&] { read_case(path); });
  }
  std::string case_error(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    write("case.toml", text);
    return error_of<CaseError>([&] { read_case(directory / "case.toml", overrides); });
  }
};

TEST_F(Bounds, StreamsWithoutAnEndAreNotOpened) {
  EXPECT_EQ(file_error("/dev/zero"), "/dev/zero: a device or a pipe, expected a case file");
  const std::filesystem::path pipe = directory / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(file_error(pipe), pipe.string() + ": a device or a pipe, expected a case file");
  const std::string error =
      case_error(test::small_disc, {R"(drive.voltage={ wave = "file", file = "pipe" })"});
  EXPECT_NE(error.find("a device or a pipe, expected a CSV file"), std::string::npos) << error;
}

TEST_F(Bounds, FilesAreOfABoundedSize) {
  write("large.toml", std::string((4 << 20) + 1, '#'));
  EXPECT_TRUE(file_error(directory / "large.toml").ends_with("is too large for a case file, allowed 4 MB"));
  std::string rows = "time_s,voltage_V\n";
  for (int i = 0; i <= 100000; ++i) rows += std::to_string(i) + ",1\n";
  write("long.csv", rows);
  const std::string error =
      case_error(test::small_disc, {R"(drive.voltage={ wave = "file", file = "long.csv" })"});
  EXPECT_NE(error.find("long.csv: error: found 100001 rows, allowed 100000"), std::string::npos) << error;
}

TEST_F(Bounds, DotsMakeNoTablesWithoutAnEnd) {
  const auto dotted = [](int dots) {
    std::string key;
    for (int i = 0; i < dots; ++i) key += "a.";
    return key + "a";
  };
  const auto told = [](const std::string& toml) {
    return error_of<CaseError>([&] { parse_tree(toml, "t"); });
  };
  for (const std::string& deep :
       {dotted(100000) + " = 1", "[" + dotted(100000) + "]", "[[" + dotted(21) + "]]",
        "b = { " + dotted(21) + " = 1 }", "b = [1, { c = 2, " + dotted(21) + " = 1 }]",
        "'x'." + dotted(20) + " = 1", R"("x\"."..)" + dotted(20) + " = 1"})
    EXPECT_EQ(told("x1 = '''\n' ''' # \"\n" + deep + "\n"), "t:3:1: error: a key has more than 20 dots")
        << deep.substr(0, 40);
  const std::string dots(100, '.');
  for (const std::string& shallow :
       {dotted(20) + " = 1", "[" + dotted(20) + "]", "b = \"" + dots + R"(\")" + dots + "\"",
        "b = '" + dots + "'", R"(b = """")" + dots + "\n" + dots + R"(\"""""")", "b = '''\n''" + dots + "'''",
        "# " + dots, "'" + dots + "' = 1",
        "b = [[1.5, 2.5, 3.5], [" + std::string(100, '[') + std::string(100, ']') + "]]"})
    EXPECT_EQ(told(shallow + "\n"), "no error") << shallow;
}

TEST_F(Bounds, ErrorsAreCountedAfterTheFirst) {
  std::string unknown = test::small_disc;
  for (int i = 0; i < 200000; ++i) unknown += "key_" + std::to_string(i) + " = 1\n";
  const std::string error = case_error(unknown, {"film.thicknes=1"});
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 50);
  EXPECT_TRUE(error.ends_with("\nand at least 199951 more errors")) << error.substr(error.size() - 100);
}

TEST_F(Bounds, ResolvedCasesAreReadBack) {
  const auto expect_round_trip = [&](const std::string& text, const std::vector<std::string>& overrides) {
    write("case.toml", text);
    const std::string resolved = resolved_text(read_case(directory / "case.toml", overrides));
    write("resolved.toml", resolved);
    EXPECT_EQ(resolved_text(read_case(directory / "resolved.toml")), resolved);
  };
  for (const char* zero : {"-0.0", "-0", "\"-0 V\"", "{ wave = \"constant\", to = -0.0 }"})
    expect_round_trip(test::small_disc, {std::string("drive.voltage=") + zero});
  // Energies have a unit like every other quantity that a check can name.
  expect_round_trip(test::small_disc + R"toml([[check]]
quantity = "stored_energy"
value = "2 mJ"
tolerance = "1 %"
source = "nobody"
)toml",
                    {});
}

TEST_F(Bounds, DamagedResultsOfAPointAreNone) {
  Study study;
  study.collect = {"charge"};
  const StudyPoint point{.values = {"1"}, .directory = directory};
  mark_done(point, 0, "");
  const std::string mark = content("point.json");
  const std::string whole =
      R"({"quantities": {"charge": {"value": 2, "unit": "C"}}, "message": "", "events": []})";
  write("summary.json", whole);
  const auto result = result_of(study, point);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->quantities[0], 2);
  for (const char* damaged : {"", "{}", "[]", "7", R"({"quantities": 7})", R"({"quantities": {"charge": 7}})",
                              R"({"quantities": {}, "message": 1, "events": []})",
                              R"({"quantities": {}, "message": "", "events": [1]})"}) {
    write("summary.json", damaged);
    EXPECT_FALSE(result_of(study, point)) << damaged;
  }
  write("summary.json", whole);
  for (const char* damaged :
       {"", "{}", "7", R"({"values": ["1"]})", R"({"values": ["1"], "exit_code": "0", "message": 1})"}) {
    write("point.json", damaged);
    EXPECT_FALSE(result_of(study, point)) << damaged;
  }
  write("point.json", mark);
  EXPECT_TRUE(result_of(study, point));
}

} // namespace
} // namespace dielast::cases::bounds_test
