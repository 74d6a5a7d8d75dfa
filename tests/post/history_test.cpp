// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/history.hpp"

#include "post/file_output.hpp"
#include "tests/post/scratch.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace dielast::post::history_test {
namespace {

const std::vector<Column> columns{{"load_factor", "1"}, {"voltage", "V"}, {"length, outer", "m"}};

class HistoryTest : public ScratchTest {
 protected:
  std::filesystem::path path() const { return directory / "history.csv"; }

  void write_three_rows() const {
    History history(path(), columns);
    history.append("release", std::array{1.0, 0.0, 0.1});
    history.append("voltage", std::array{0.5, 5e3, std::nan("")});
    history.append("voltage", std::array{1.0, 7.5e3, -1e-300});
  }
};

TEST_F(HistoryTest, HasUnitsInItsHeaderAndEmptyCellsForMissingNumbers) {
  write_three_rows();
  EXPECT_EQ(content("history.csv"), "step,load_factor[1],voltage[V],\"length, outer[m]\"\n"
                                    "release,1,0,0.1\nvoltage,0.5,5000,\nvoltage,1,7500,-1e-300\n");
}

TEST_F(HistoryTest, NumbersReadBackToTheSameBits) {
  const std::array<double, 3> values{1.0 / 3, std::nextafter(0.1, 1),
                                     std::numeric_limits<double>::denorm_min()};
  History(path(), columns).append("a", values);
  std::istringstream stream(content("history.csv"));
  std::string line, cell;
  std::getline(stream, line);
  std::getline(stream, cell, ',');
  for (const double value : values) {
    std::getline(stream, cell, ',');
    EXPECT_EQ(std::strtod(cell.c_str(), nullptr), value);
  }
}

TEST_F(HistoryTest, EveryRowIsOnDiskAtOnce) {
  History history(path(), columns);
  history.append("a", std::array{1.0, 2.0, 3.0});
  EXPECT_TRUE(content("history.csv").ends_with("a,1,2,3\n"));
}

TEST_F(HistoryTest, ReplacesAnEarlierTable) {
  write_three_rows();
  const History history(path(), columns);
  EXPECT_EQ(content("history.csv").find('\n'), content("history.csv").size() - 1);
}

TEST_F(HistoryTest, StepNamesCannotBreakARow) {
  History(path(), columns).append("a \"b\",\nc", std::array{1.0, 2.0, 3.0});
  EXPECT_TRUE(content("history.csv").ends_with("\n\"a \"\"b\"\", c\",1,2,3\n"));
}

TEST_F(HistoryTest, ReportsAFullDisk) {
  History history(path(), columns);
  const FileSizeLimit limit(100);
  try {
    for (int i = 0; i < 100; ++i) history.append("step", std::array{1.0, 2.0, 3.0});
    FAIL() << "no error";
  } catch (const WriteError& error) {
    EXPECT_EQ(std::string(error.what()), "cannot write " + path().string() + ": File too large");
  }
}

TEST_F(HistoryTest, ReportsAMissingDirectory) {
  EXPECT_THROW(History(directory / "none" / "history.csv", columns), WriteError);
}

} // namespace
} // namespace dielast::post::history_test
