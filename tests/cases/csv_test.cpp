// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/csv.hpp"
#include "tests/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace dielast::cases::csv_test {
namespace {

const test::ScratchFolder folder;
const std::filesystem::path file = folder / "table.csv";

CsvTable read(const std::string& content, std::vector<Diagnostic>& wrong, int least_rows = 1) {
  std::ofstream(file, std::ios::binary) << content;
  return read_csv(file, least_rows, wrong);
}

std::vector<std::string> texts(const std::vector<Diagnostic>& wrong) {
  std::vector<std::string> all;
  for (const Diagnostic& one : wrong) all.push_back(one.text().substr(file.string().size()));
  return all;
}

TEST(Csv, ReadsColumnsByNameWithTheirUnits) {
  std::vector<Diagnostic> wrong;
  const CsvTable table = read(
      "\xEF\xBB\xBF# measured\r\ntime_s, \"voltage_kV\" ,note_taken\r\n\r\n0,1.5,7\r\n# later\n+2e0,-3,8",
      wrong);
  EXPECT_TRUE(wrong.empty()) << wrong.front().text();
  EXPECT_EQ(table.names, (std::vector<std::string>{"time_s", "voltage_kV", "note_taken"}));
  EXPECT_EQ(table.lines, (std::vector{4, 6}));
  EXPECT_EQ(table.find("note_taken"), 2);
  EXPECT_EQ(table.find("voltage"), -1);
  EXPECT_EQ(si_column(table, 1, "V"), (std::vector{1500.0, -3000.0}));
  EXPECT_EQ(si_column(table, 2, "V"), (std::vector{7.0, 8.0})); // "taken" is no unit
}

TEST(Csv, SemicolonsTabsAndDecimalCommas) {
  std::vector<Diagnostic> wrong;
  for (const char* text :
       {"time (s);stress [MPa]\n0,5;1,25\n1.5;-2e-1\n", "time (s)\tstress [MPa]\n0,5\t1,25\n1.5\t-2e-1\n"}) {
    const CsvTable table = read(text, wrong);
    EXPECT_TRUE(wrong.empty()) << wrong.front().text();
    EXPECT_EQ(table.names, (std::vector<std::string>{"time (s)", "stress [MPa]"}));
    EXPECT_EQ(table.columns, (std::vector<std::vector<double>>{{0.5, 1.5}, {1.25, -0.2}}));
    EXPECT_EQ(si_column(table, 1, "Pa"), (std::vector{1.25e6, -0.2e6}));
  }
  // "1.234,5" and "1,2,3" are no numbers that everybody reads alike
  read("a;b\n1.234,5;2\n1,2,3;4\n", wrong);
  EXPECT_EQ(texts(wrong), (std::vector<std::string>{":2:1: error: a: found \"1.234,5\", allowed a number",
                                                    ":3:1: error: a: found \"1,2,3\", allowed a number"}));
  // 13.678 Pa, or 13678 Pa as a spreadsheet shows them beside decimal commas?
  for (const std::string first : {"1,100000", "1,1"}) {
    wrong.clear();
    read("a;b\n" + first + ";13.678\n1,2;-1.250\n", wrong);
    EXPECT_EQ(texts(wrong), (std::vector{":2:" + std::to_string(first.size() + 2) +
                                         ": error: found \"13.678\" in a file with \"" + first +
                                         "\", allowed one sign for decimals and none between thousands"}));
  }
  wrong.clear();
  read("a;b\n0,5;0.678\n1,250000;1.2345\n1,2;100.5\n2,5;1.250e3\n", wrong);
  read("a;b\n5;13.678\n6;1.250\n", wrong);
  EXPECT_TRUE(wrong.empty()) << wrong.front().text();
  read("a,b\n0,5,1,25\n", wrong);
  EXPECT_EQ(texts(wrong),
            (std::vector<std::string>{":2:1: error: found 4 cells, allowed 2: one for each name in line "
                                      "1; with decimal commas cells are separated by semicolons"}));
}

/// Of loggers and test machines; where a column is read whose numbers are words it is missing, as is said.
TEST(Csv, LeavesColumnsOfWordsOut) {
  std::vector<Diagnostic> wrong;
  const CsvTable table =
      read("clock,time (ms),remark,force_N\n12:30:01,0,,1\n12:30:02,500,ramp 2,2\n", wrong);
  EXPECT_TRUE(wrong.empty()) << wrong.front().text();
  EXPECT_EQ(table.names, (std::vector<std::string>{"time (ms)", "force_N"}));
  EXPECT_EQ(table.columns, (std::vector<std::vector<double>>{{0, 500}, {1, 2}}));
  EXPECT_EQ(table.find_time(), 0);
  EXPECT_EQ(si_column(table, 0, "s"), (std::vector{0.0, 0.5}));
  EXPECT_EQ(
      table.listed_names(),
      "\"time (ms)\", \"force_N\"; no numbers stand in \"clock\" (\"12:30:01\"), \"remark\" (\"ramp 2\")");
  EXPECT_EQ(read("a,b,\n1,2,\n3,4,\n", wrong).names, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(wrong.empty()) << wrong.front().text();
  read("a,b\n1,x\n2,3\n", wrong); // some are numbers
  EXPECT_EQ(texts(wrong), std::vector<std::string>{":2:3: error: b: found \"x\", allowed a number"});
}

TEST(Csv, SaysEverythingThatIsWrongWithLineAndColumn) {
  std::vector<Diagnostic> wrong;
  read("time_s,force_N\n0,abc\n1,\n 2 , 3x,\n3,nan\n4,1e999\n", wrong, 9);
  EXPECT_EQ(texts(wrong),
            (std::vector<std::string>{":2:3: error: force_N: found \"abc\", allowed a number",
                                      ":3:3: error: force_N: the cell is empty, allowed a number",
                                      ":4:1: error: found 3 cells, allowed 2: one for each name in line 1",
                                      ":5:3: error: force_N: found \"nan\", allowed a number",
                                      ":6:3: error: force_N: found \"1e999\", allowed a number",
                                      ": error: found 5 rows of numbers, allowed at least 9"}));
}

TEST(Csv, ThatIsUtf16IsRefused) {
  std::vector<Diagnostic> wrong;
  for (const char* mark : {"\xff\xfe", "\xfe\xff"}) try {
      read(std::string(mark) + "t", wrong);
      ADD_FAILURE();
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("UTF-16"), std::string::npos) << error.what();
    }
}

TEST(Csv, RowsMustGrow) {
  std::vector<Diagnostic> wrong;
  const CsvTable table = read("time_s\n0\n2\n2\n1\n3\n", wrong);
  require_growing(table, 0, wrong);
  EXPECT_EQ(texts(wrong),
            (std::vector<std::string>{
                ":4:1: error: time_s: found 2 after 2, allowed values that grow from row to row",
                ":5:1: error: time_s: found 1 after 2, allowed values that grow from row to row"}));
}

TEST(Csv, AnEmptyFileHasNoRowsAndAMissingOneIsAnError) {
  std::vector<Diagnostic> wrong;
  EXPECT_EQ(read("# nothing\n", wrong, 2).rows(), 0);
  EXPECT_EQ(texts(wrong), std::vector<std::string>{": error: found 0 rows of numbers, allowed at least 2"});
  EXPECT_THROW(read_csv(file.parent_path() / "nowhere.csv", 1, wrong), FileError);
  EXPECT_THROW(read_csv(file.parent_path(), 1, wrong), FileError);
}

} // namespace
} // namespace dielast::cases::csv_test
