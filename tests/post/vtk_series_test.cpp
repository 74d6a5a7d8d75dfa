// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/vtk_series.hpp"

#include "post/fields.hpp"
#include "post/file_output.hpp"
#include "post/revolution.hpp"
#include "tests/post/samples.hpp"
#include "tests/post/scratch.hpp"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <set>
#include <vector>

namespace dielast::post::vtk_series_test {
namespace {

class VtkSeriesTest : public ScratchTest {
 protected:
  void SetUp() override {
    ScratchTest::SetUp();
    folder.emplace(directory, "test");
  }
  VtkSeriesTest()
      : mesh(square_mesh()), displacement(mesh.nodes.size()),
        rotation(mesh.nodes.size(), Eigen::Quaterniond::Identity()) {
    for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] = {static_cast<double>(i), 0.1, -1};
    for (const int cell : {0, 1}) {
      auto sample = film_sample(stretched(2, 1), (1 + cell) * Eigen::Matrix2d::Identity());
      sample.cell = cell;
      sample.voltage = 500 * cell;
      samples.film.push_back(sample);
    }
    samples.walls = {wall_sample(0, 1, 10)};
  }

  VtkSeries series(std::vector<std::string> entries = {}) {
    return {*folder,
            "run",
            {mesh, widths, heights, film_parts, bar_parts, {"unnamed", "ribs"}},
            std::move(entries)};
  }
  SeriesState state() const { return {displacement, rotation, samples}; }

  vtkSmartPointer<vtkUnstructuredGrid> read(const std::string& file) const {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName((directory / file).c_str());
    reader->Update();
    return reader->GetOutput();
  }

  meshing::Mesh mesh;
  std::vector<Eigen::Vector3d> displacement;
  std::vector<Eigen::Quaterniond> rotation;
  std::vector<double> widths{0.02}, heights{0.06}; // of the wall
  std::vector<int> film_parts, bar_parts{1};
  fem::Samples samples;
  std::optional<ResultsFolder> folder;
};

/// Of cells: means, worst values, and the part.
template<class Fields>
int array_count(const Fields& fields) {
  int count = 1;
  for (const auto& field : fields) count += field.worst ? 2 : 1;
  return count;
}

TEST_F(VtkSeriesTest, FilmReadsBack) {
  series().write({2.5, "release"}, state());
  const auto grid = read("run_film_0000.vtu");
  ASSERT_EQ(grid->GetNumberOfPoints(), 9); // without the node that no cell uses
  ASSERT_EQ(grid->GetNumberOfCells(), 2);
  EXPECT_EQ(grid->GetCellType(1), VTK_QUADRATIC_TRIANGLE);
  vtkNew<vtkIdList> points;
  grid->GetCellPoints(1, points);
  for (int i = 0; i < 6; ++i) {
    const auto node = static_cast<std::size_t>(mesh.blocks[1].cell(1)[static_cast<std::size_t>(i)]);
    EXPECT_EQ(Eigen::Vector3d(grid->GetPoint(points->GetId(i))), mesh.nodes[node] + displacement[node]);
  }

  vtkDataArray* moved = grid->GetPointData()->GetArray("displacement [m]");
  ASSERT_NE(moved, nullptr);
  EXPECT_EQ(moved->GetNumberOfComponents(), 3);
  EXPECT_STREQ(moved->GetComponentName(2), "z");
  EXPECT_EQ(Eigen::Vector3d(moved->GetTuple3(0)), displacement[1]);

  ASSERT_EQ(grid->GetCellData()->GetNumberOfArrays(), array_count(film_fields()));
  EXPECT_NEAR(grid->GetCellData()->GetArray("electric_field [V/m]")->GetTuple1(1), 1e6, 0.1);
  for (const int cell : {0, 1}) EXPECT_EQ(grid->GetCellData()->GetArray("part")->GetTuple1(cell), 0);
  vtkDataArray* stress = grid->GetCellData()->GetArray("cauchy_stress [Pa]");
  ASSERT_NE(stress, nullptr);
  ASSERT_EQ(stress->GetNumberOfComponents(), 6);
  EXPECT_STREQ(stress->GetComponentName(3), "xy");
  EXPECT_FLOAT_EQ(static_cast<float>(stress->GetComponent(1, 0)), 8);
  EXPECT_FLOAT_EQ(static_cast<float>(stress->GetComponent(1, 1)), 2);

  EXPECT_EQ(grid->GetFieldData()->GetArray("TimeValue")->GetTuple1(0), 2.5);
  EXPECT_EQ(vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray("step"))->GetValue(0),
            "release");
}

TEST_F(VtkSeriesTest, EveryFileSaysItsStepLoadFactorAndVoltages) {
  VtkSeries steps = series();
  steps.write({0, "release", 1, {{"voltage_a [V]", 0}, {"voltage_b [V]", 10}}}, state());
  steps.write({1, "voltage", 0.25, {{"voltage_a [V]", 500}, {"voltage_b [V]", -20}}}, state());
  for (const char* part : {"film", "walls"}) {
    const auto grid = read(std::string("run_") + part + "_0001.vtu");
    vtkFieldData* said = grid->GetFieldData();
    EXPECT_EQ(vtkStringArray::SafeDownCast(said->GetAbstractArray("step"))->GetValue(0), "voltage");
    EXPECT_EQ(said->GetArray("load_factor")->GetTuple1(0), 0.25);
    EXPECT_EQ(said->GetArray("voltage_a [V]")->GetTuple1(0), 500);
    EXPECT_EQ(said->GetArray("voltage_b [V]")->GetTuple1(0), -20);
    EXPECT_EQ(said->GetArray("voltage_b [V]")->GetNumberOfTuples(), 1);
  }
}

// A cell's mean hides how far its worst point goes; the table of results tells that point.
TEST_F(VtkSeriesTest, CellsSayTheirWorstPointBesideTheirMean) {
  auto sample = samples.film[1];
  sample.voltage = 800;
  samples.film.push_back(sample);
  series().write({0, "voltage"}, state());
  const auto grid = read("run_film_0000.vtu");
  vtkCellData* cells = grid->GetCellData();
  EXPECT_NEAR(cells->GetArray("electric_field [V/m]")->GetTuple1(1), 1.3e6, 0.1);
  EXPECT_NEAR(cells->GetArray("electric_field_max [V/m]")->GetTuple1(1), 1.6e6, 0.1);
  EXPECT_NEAR(cells->GetArray("thickness_min [m]")->GetTuple1(1), 0.5e-3, 1e-9);
  EXPECT_EQ(cells->GetArray("cauchy_stress_min [Pa]"), nullptr);
}

TEST_F(VtkSeriesTest, WallsAreBars) {
  series().write({0, "release"}, state());
  const auto grid = read("run_walls_0000.vtu");
  ASSERT_EQ(grid->GetNumberOfPoints(), 12);
  ASSERT_EQ(grid->GetNumberOfCells(), 2); // to the wall's middle node and from it on
  double volume = 0;
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(grid->GetCellType(i), VTK_HEXAHEDRON);
    EXPECT_EQ(grid->GetCellData()->GetArray("axial_force [N]")->GetTuple1(i), 10);
    EXPECT_EQ(grid->GetCellData()->GetArray("part")->GetTuple1(i), 1);
    vtkNew<vtkIdList> points;
    grid->GetCellPoints(i, points);
    const auto drawn = [&](int corner) {
      const vtkIdType point = points->GetId(corner);
      return Eigen::Vector3d(Eigen::Vector3d(grid->GetPoint(point)) -
                             Eigen::Vector3d(grid->GetPointData()->GetVectors()->GetTuple3(point)));
    };
    const Eigen::Vector3d width = drawn(1) - drawn(0), height = drawn(3) - drawn(0),
                          length = drawn(4) - drawn(0);
    EXPECT_NEAR(width.norm(), 0.02, 1e-15);
    EXPECT_LT((height - Eigen::Vector3d(0, 0, 0.06)).norm(), 1e-15);
    volume += width.cross(height).dot(length);
  }
  EXPECT_NEAR(volume, 0.02 * 0.06 * std::sqrt(2), 1e-15);
  ASSERT_EQ(grid->GetCellData()->GetNumberOfArrays(), array_count(wall_fields()));
  EXPECT_STREQ(grid->GetCellData()->GetArray("bending_moment [N m]")->GetComponentName(1), "3");
  EXPECT_EQ(vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray("part_names"))->GetValue(1),
            "ribs");
}

// Sections turn with their nodes, in states and in modes.
TEST_F(VtkSeriesTest, BarsTurnWithTheirNodes) {
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d(1, 1, 0).normalized()));
  rotation[1] = quarter; // about the wall: its upper side now lies to the right of it
  std::vector<Eigen::Vector3d> still(mesh.nodes.size(), Eigen::Vector3d::Zero()), spin = still;
  spin[1] = {0, 0, 3};
  displacement = still;
  series().write({0, "release"}, state(), {still, spin});
  const auto grid = read("run_walls_0000.vtu");
  int found = 0;
  for (vtkIdType i = 0; i < 4; ++i) { // those of the wall's first node, which is at the origin
    const Eigen::Vector3d at(grid->GetPoint(i)), mode(grid->GetPointData()->GetArray("mode")->GetTuple3(i));
    EXPECT_NEAR(std::abs(at.z()), 0.01, 1e-15);
    EXPECT_NEAR(at.head<2>().norm(), 0.03, 1e-15);
    EXPECT_LT((mode - Eigen::Vector3d(0, 0, 3).cross(at)).norm(), 1e-15);
    found += at.x() > 0;
  }
  EXPECT_EQ(found, 2);
}

TEST_F(VtkSeriesTest, LinearCellsAndNoWalls) {
  mesh.blocks = {{meshing::CellType::triangle3, {1, 2, 3, 1, 3, 4}}};
  series().write({0, "release"}, state());
  EXPECT_EQ(read("run_film_0000.vtu")->GetCellType(0), VTK_TRIANGLE);
  EXPECT_EQ(file_count(), 3u);
}

TEST_F(VtkSeriesTest, AFilmOfRevolutionIsASurface) {
  mesh.nodes = {{2, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1.5, 0, 0}, {0.5, 0, 0}};
  mesh.blocks = {{meshing::CellType::meridian3, {0, 1, 3, 1, 2, 4}}};
  displacement = {{0.1, 0, 0}, {0.2, 0, 3}, {0, 0, 5}, {0, 0, 0}, {0, 0, 0}};
  const std::vector<Eigen::Vector3d> mode{{1, 0, 0}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const Eigen::Vector3d along(1.6, 0, 1.2); // the meridian rises
  for (fem::MembraneSample& sample : samples.film) sample.F.col(0) = along;
  series().write({0, "voltage"}, state(), {mode});
  EXPECT_EQ(file_count(), 3u);
  const auto grid = read("run_film_0000.vtu");
  constexpr int sectors = Revolution::sectors;
  ASSERT_EQ(grid->GetNumberOfPoints(), 4 * sectors + 1);
  ASSERT_EQ(grid->GetNumberOfCells(), 4 * sectors);
  for (int i = 0; i < 4 * sectors; ++i)
    EXPECT_EQ(grid->GetCellType(i), i < 3 * sectors ? VTK_QUAD : VTK_TRIANGLE) << i;

  // As drawn: there the points are without their displacement.
  const auto at = [&](double x, double y) {
    vtkIdType point = 0;
    const auto away = [&](vtkIdType i) {
      return (Eigen::Vector3d(grid->GetPoint(i)) -
              Eigen::Vector3d(grid->GetPointData()->GetVectors()->GetTuple3(i)) - Eigen::Vector3d(x, y, 0))
          .norm();
    };
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
      if (away(i) < away(point)) point = i;
    EXPECT_LT(away(point), 1e-15);
    return point;
  };
  const auto expect_vector = [&](const char* name, vtkIdType point, const Eigen::Vector3d& expected) {
    EXPECT_LT((Eigen::Vector3d(grid->GetPointData()->GetArray(name)->GetTuple3(point)) - expected).norm(),
              1e-15)
        << name << " of " << point;
  };
  expect_vector("displacement [m]", at(0, 2), {0, 0.1, 0}); // a quarter turn on
  expect_vector("displacement [m]", at(-1, 0), {-0.2, 0, 3});
  expect_vector("displacement [m]", at(0, 0), {0, 0, 5});
  expect_vector("mode", at(-std::sqrt(2), std::sqrt(2)), {-std::sqrt(0.5), std::sqrt(0.5), 0});

  vtkDataArray* voltage = grid->GetCellData()->GetArray("voltage [V]");
  ASSERT_EQ(voltage->GetNumberOfTuples(), 4 * sectors);
  const auto tensor = [&](const char* name, int cell) {
    std::array<double, 6> t{};
    grid->GetCellData()->GetArray(name)->GetTuple(cell, t.data());
    return Eigen::Matrix3d{{t[0], t[3], t[5]}, {t[3], t[1], t[4]}, {t[5], t[4], t[2]}};
  };
  for (int i = 0; i < 4 * sectors; ++i) {
    EXPECT_EQ(voltage->GetTuple1(i), i < 2 * sectors ? 0 : 500) << i;
    // At the middle of each facet along the turned meridian, and around.
    Eigen::Vector3d outwards = Eigen::Vector3d::Zero();
    vtkNew<vtkIdList> corners;
    grid->GetCellPoints(i, corners);
    for (const vtkIdType corner : *corners) outwards += Eigen::Vector3d(grid->GetPoint(corner));
    outwards.z() = 0;
    outwards.normalize();
    const Eigen::Vector3d around = Eigen::Vector3d::UnitZ().cross(outwards),
                          meridian = along.x() * outwards + along.z() * Eigen::Vector3d::UnitZ();
    const double stress = i < 2 * sectors ? 1 : 2;
    const Eigen::Matrix3d expected = stress * (meridian * meridian.transpose() + around * around.transpose());
    EXPECT_LT((tensor("cauchy_stress [Pa]", i) - expected).norm(), 1e-5) << i;
    EXPECT_LT((tensor("log_strain [1]", i) * meridian - std::log(2) * meridian).norm(), 1e-5) << i;
    EXPECT_LT((tensor("log_strain [1]", i) * around).norm(), 1e-5) << i;
  }
}

TEST_F(VtkSeriesTest, FinsAreAPartOfTheirOwn) {
  SeriesModel model{mesh, widths, heights, film_parts, bar_parts, {"unnamed", "ribs"}};
  model.fins = {{3, 0, 1, 2}};
  VtkSeries(*folder, "run", model).write({2.5, "release"}, state());
  const auto grid = read("run_fins_0000.vtu");
  ASSERT_EQ(grid->GetNumberOfCells(), 1);
  EXPECT_EQ(grid->GetCellType(0), VTK_QUAD);
  vtkNew<vtkIdList> points;
  grid->GetCellPoints(0, points);
  for (int i = 0; i < 4; ++i) {
    const auto node = static_cast<std::size_t>(model.fins[0][static_cast<std::size_t>(i)]);
    EXPECT_EQ(Eigen::Vector3d(grid->GetPoint(points->GetId(i))), mesh.nodes[node] + displacement[node]);
  }
  EXPECT_NE(content("run.pvd").find("part=\"2\" name=\"fins\" file=\"run_fins_0000.vtu\""),
            std::string::npos);
}

TEST_F(VtkSeriesTest, EveryStepHasItsOwnValues) {
  VtkSeries steps = series();
  steps.write({0, "release"}, state());
  samples.film[1].voltage = 1000;
  displacement[1].x() = 7;
  steps.write({1, "voltage"}, state());
  const auto first = read("run_film_0000.vtu"), second = read("run_film_0001.vtu");
  EXPECT_EQ(first->GetCellData()->GetArray("voltage [V]")->GetTuple1(1), 500);
  EXPECT_EQ(second->GetCellData()->GetArray("voltage [V]")->GetTuple1(1), 1000);
  EXPECT_EQ(second->GetPointData()->GetArray("displacement [m]")->GetTuple3(0)[0], 7);
  EXPECT_EQ(second->GetCellData()->GetNumberOfArrays(), array_count(film_fields()));
}

TEST_F(VtkSeriesTest, ListNamesPartsAndTimes) {
  VtkSeries steps = series();
  steps.write({0, "release"}, state());
  steps.write({0.1, "voltage"}, state());
  EXPECT_EQ(content("run.pvd"),
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "  <Collection>\n"
            "    <DataSet timestep=\"0\" part=\"0\" name=\"film\" file=\"run_film_0000.vtu\"/>\n"
            "    <DataSet timestep=\"0\" part=\"1\" name=\"walls\" file=\"run_walls_0000.vtu\"/>\n"
            "    <DataSet timestep=\"0.1\" part=\"0\" name=\"film\" file=\"run_film_0001.vtu\"/>\n"
            "    <DataSet timestep=\"0.1\" part=\"1\" name=\"walls\" file=\"run_walls_0001.vtu\"/>\n"
            "  </Collection>\n"
            "</VTKFile>\n");
}

TEST_F(VtkSeriesTest, ResumesAfterTheStepsToKeep) {
  VtkSeries steps = series();
  steps.write({0, "voltage"}, state());
  const auto kept = steps.entries();
  for (const double time : {1.0, 2.0}) steps.write({time, "voltage"}, state());
  const std::string first = content("run_film_0000.vtu");
  folder->begin({"run.pvd", "run_film_0000.vtu", "run_walls_0000.vtu"});
  VtkSeries resumed = series(kept);
  EXPECT_EQ(file_count(), 4u); // with the manifest
  resumed.write({7, "voltage"}, state());
  EXPECT_EQ(content("run_film_0000.vtu"), first);
  EXPECT_EQ(file_count(), 6u);
  const std::string list = content("run.pvd");
  EXPECT_NE(list.find("timestep=\"0\""), std::string::npos);
  EXPECT_EQ(list.find("timestep=\"1\""), std::string::npos);
  EXPECT_NE(list.find("timestep=\"7\" part=\"1\" name=\"walls\" file=\"run_walls_0001.vtu\""),
            std::string::npos);
}

TEST_F(VtkSeriesTest, AFullDiskIsReportedAndKeepsTheSeriesReadable) {
  VtkSeries steps = series();
  steps.write({0, "release"}, state());
  const std::string list = content("run.pvd");
  {
    const FileSizeLimit limit(2000);
    try {
      steps.write({1, "voltage"}, state());
      FAIL() << "no error";
    } catch (const WriteError& error) {
      EXPECT_EQ(std::string(error.what()),
                "cannot write " + (directory / "run_film_0001.vtu").string() + ": File too large");
    }
  }
  EXPECT_EQ(content("run.pvd"), list);
  EXPECT_EQ(file_count(), 4u);
  steps.write({1, "voltage"}, state()); // room again
  EXPECT_EQ(read("run_film_0001.vtu")->GetNumberOfCells(), 2);
}

TEST_F(VtkSeriesTest, ContactPressuresAreThoseOfTheNodes) {
  std::vector<double> pressure(mesh.nodes.size());
  for (std::size_t n = 0; n < pressure.size(); ++n) pressure[n] = 100.0 * static_cast<double>(n);
  VtkSeries written = series();
  written.write({0, "voltage", 1}, {displacement, rotation, samples, pressure});
  const auto grid = read("run_film_0000.vtu");
  auto* array = grid->GetPointData()->GetArray("contact_pressure [Pa]");
  ASSERT_NE(array, nullptr);
  const auto film = mesh.film()->nodes;
  const std::set<int> nodes(film.begin(), film.end());
  ASSERT_EQ(array->GetNumberOfTuples(), std::ssize(nodes));
  vtkIdType point = 0;
  for (const int node : nodes) EXPECT_EQ(array->GetTuple1(point++), 100.0 * node);
  EXPECT_EQ(read("run_walls_0000.vtu")->GetPointData()->GetArray("contact_pressure [Pa]"), nullptr);
}

} // namespace
} // namespace dielast::post::vtk_series_test
