// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cases/command.hpp"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUtilities.h>

#include <cmath>
#include <map>
#include <set>

namespace dielast::test::series_test {
namespace {

/// What ParaView sees of a run, read by VTK's own readers.
class Series : public CommandTest {
 protected:
  struct State {
    double time = 0;
    std::map<std::string, vtkSmartPointer<vtkUnstructuredGrid>> blocks; ///< by name
  };

  std::vector<State> states(const std::string& list) const {
    const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(
        vtkXMLUtilities::ReadElementFromFile((directory / list).c_str()));
    std::vector<State> found;
    vtkXMLDataElement* entries = root->FindNestedElementWithName("Collection");
    for (int i = 0; i < entries->GetNumberOfNestedElements(); ++i) {
      vtkXMLDataElement* entry = entries->GetNestedElement(i);
      const double time = std::stod(entry->GetAttribute("timestep"));
      if (found.empty() || found.back().time != time) found.push_back({time, {}});
      const auto reader = vtkSmartPointer<vtkXMLUnstructuredGridReader>::New();
      reader->SetFileName((directory / list).replace_filename(entry->GetAttribute("file")).c_str());
      reader->Update();
      found.back().blocks[entry->GetAttribute("name")] = reader->GetOutput();
    }
    return found;
  }
  static double number(vtkUnstructuredGrid* grid, const char* name) {
    vtkDataArray* array = grid->GetFieldData()->GetArray(name);
    return array && array->GetNumberOfTuples() == 1 ? array->GetTuple1(0) : NAN;
  }
  static std::string word(vtkUnstructuredGrid* grid, const char* name, int i = 0) {
    auto* words = vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray(name));
    return words && i < words->GetNumberOfValues() ? words->GetValue(i) : "";
  }
  static double lowest(vtkUnstructuredGrid* grid, const char* name) {
    return grid->GetCellData()->GetArray(name)->GetRange()[0];
  }
  static double highest(vtkUnstructuredGrid* grid, const char* name) {
    return grid->GetCellData()->GetArray(name)->GetRange()[1];
  }
  static void expect_unique_times(const std::vector<State>& states) {
    for (std::size_t i = 1; i < states.size(); ++i) EXPECT_GT(states[i].time, states[i - 1].time) << i;
  }
};

TEST_F(Series, ExtremesAreThoseOfTheTable) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out", "--set", "output.error_estimate=false"}).exit_code, 0);
  const auto states = this->states("out/small.pvd");
  const auto table = table_of(directory / "out/history.csv");
  ASSERT_EQ(states.size(), table.size() - 1);
  expect_unique_times(states);
  const auto column = [&](std::size_t row, const std::string& name) {
    return std::stod(
        table[row + 1][static_cast<std::size_t>(std::ranges::find(table[0], name) - table[0].begin())]);
  };
  for (std::size_t i = 0; i < states.size(); ++i) {
    vtkUnstructuredGrid* film = states[i].blocks.at("film");
    vtkUnstructuredGrid* walls = states[i].blocks.at("walls");
    EXPECT_EQ(number(film, "TimeValue"), states[i].time);
    EXPECT_EQ(word(film, "step"), table[i + 1][0]);
    EXPECT_EQ(word(film, "part_names"), "unnamed");
    const auto expect_table = [&](double seen, const std::string& name) {
      const double told = column(i, name);
      EXPECT_NEAR(seen, told, 1e-6 * std::abs(told)) << name << " of state " << i;
    };
    expect_table(highest(film, "electric_field_max [V/m]"), "max_field[V/m]");
    expect_table(highest(film, "breakdown_ratio_max [1]"), "breakdown_ratio[1]");
    expect_table(lowest(film, "min_principal_stress_min [Pa]"), "min_principal_stress[Pa]");
    expect_table(highest(walls, "yield_ratio_max [1]"), "yield_ratio[1]");
    expect_table(number(film, "max_field [V/m]"), "max_field[V/m]"); // the table's numbers are there, too
    expect_table(number(walls, "voltage [V]"), "voltage[V]");
  }
}

// A wall of 0.8 x 2 mm is seen as such in every state: its section neither grows nor shrinks as it turns.
TEST_F(Series, WallsAreBarsWithTheirSection) {
  ASSERT_EQ(dielast({"run", "small.toml", "-o", "out", "--set", "output.error_estimate=false"}).exit_code, 0);
  for (const State& state : states("out/small.pvd")) {
    vtkUnstructuredGrid* walls = state.blocks.at("walls");
    ASSERT_GT(walls->GetNumberOfCells(), 0);
    for (vtkIdType c = 0; c < walls->GetNumberOfCells(); ++c) {
      ASSERT_EQ(walls->GetCellType(c), VTK_HEXAHEDRON);
      vtkIdType count = 0;
      const vtkIdType* points = nullptr;
      walls->GetCellPoints(c, count, points);
      const auto distance = [&](int a, int b) {
        std::array<double, 3> p{}, q{};
        walls->GetPoint(points[a], p.data());
        walls->GetPoint(points[b], q.data());
        return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
      };
      for (const int first : {0, 4}) {
        EXPECT_NEAR(distance(first, first + 1), 0.8e-3, 1e-12);
        EXPECT_NEAR(distance(first, first + 3), 2e-3, 1e-12);
      }
    }
  }
}

// Modes have the numbers of the table as times, and vectors about the state that they are of.
TEST_F(Series, ModesAndCriticalModesReadBack) {
  write("modes.toml",
        small_honeycomb + "[[step]]\nkind = \"modes\"\ncount = 3\n[output]\nerror_estimate = false\n");
  ASSERT_EQ(dielast({"run", "modes.toml", "-o", "out"}).exit_code, 0);
  const auto modes = states("out/modes-modes.pvd");
  ASSERT_EQ(modes.size(), 3u);
  const State last = states("out/modes.pvd").back();
  for (std::size_t i = 0; i < modes.size(); ++i) {
    EXPECT_EQ(modes[i].time, static_cast<double>(i) + 1);
    for (const auto& [name, grid] : modes[i].blocks) {
      EXPECT_TRUE(word(grid, "step").starts_with("mode " + std::to_string(i + 1))) << word(grid, "step");
      vtkDataArray* mode = grid->GetPointData()->GetArray("mode");
      ASSERT_NE(mode, nullptr) << name;
      EXPECT_GT(mode->GetMaxNorm(), 0.5) << name;
      for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(grid->GetPoint(p)[c], last.blocks.at(name)->GetPoint(p)[c], 1e-9);
    }
  }
  EXPECT_EQ(dielast({"run", "small.toml", "-o", "limit", "--set", "drive.voltage=30 kV"}).exit_code, 4);
  const auto critical = states("limit/small-critical.pvd");
  ASSERT_GE(critical.size(), 1u);
  EXPECT_EQ(critical[0].time, 1);
  expect_unique_times(critical);
  EXPECT_NE(word(critical[0].blocks.at("film"), "step"), "");
  EXPECT_NEAR(critical[0].blocks.at("film")->GetPointData()->GetArray("mode")->GetMaxNorm(), 1, 1e-6);
}

// Walls that are printed on one face are linked to the film by what a mesh file cannot say: there they lie in
// it.
TEST_F(Series, MeshFilesHaveNoLooseWalls) {
  const auto written = [&](const char* print) {
    const Ended ended = dielast({"mesh", "small.toml", "-o", "out", "--set", "model=3d", "--set",
                                 std::string("honeycomb.wall_print=") + print});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(ended.out.find("needs its offset") != std::string::npos, std::string(print) == "one face")
        << ended.out;
    return content("out/small.msh");
  };
  EXPECT_EQ(written("one face"), written("merged"));
}

// Films and bars of a device of several parts can be told apart.
TEST_F(Series, PartsAreNumbered) {
  const std::string slider = (source_folder / "cases/gallery/own_mesh/slider.toml").string();
  ASSERT_EQ(dielast({"mesh", slider, "-o", "out"}).exit_code, 0);
  const State drawn = states("out/slider-mesh.pvd").at(0);
  std::set<std::string> names;
  for (const auto& [block, grid] : drawn.blocks)
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
      names.insert(
          word(grid, "part_names", static_cast<int>(grid->GetCellData()->GetArray("part")->GetTuple1(c))));
  EXPECT_GE(names.size(), 3u);
  EXPECT_EQ(names.count(""), 0u);
}

} // namespace
} // namespace dielast::test::series_test
