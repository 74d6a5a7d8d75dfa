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
#include <vector>

namespace dielast::post {
namespace {

class VtkSeriesTest : public ScratchTest {
 protected:
  void SetUp() override {
    ScratchTest::SetUp();
    folder.emplace(directory, "test");
  }
  VtkSeriesTest() : mesh(square_mesh()), displacement(mesh.nodes.size()) {
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
    return {*folder, "run", mesh, std::move(entries)};
  }

  vtkSmartPointer<vtkUnstructuredGrid> read(const std::string& file) const {
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName((directory / file).c_str());
    reader->Update();
    return reader->GetOutput();
  }

  meshing::Mesh mesh;
  std::vector<Eigen::Vector3d> displacement;
  fem::Samples samples;
  std::optional<ResultsFolder> folder;
};

TEST_F(VtkSeriesTest, FilmReadsBack) {
  series().write({2.5, "release"}, displacement, samples);
  const auto grid = read("run_film_0000.vtu");
  ASSERT_EQ(grid->GetNumberOfPoints(), 9); // without the node that no cell uses
  ASSERT_EQ(grid->GetNumberOfCells(), 2);
  EXPECT_EQ(grid->GetCellType(1), VTK_QUADRATIC_TRIANGLE);
  vtkNew<vtkIdList> points;
  grid->GetCellPoints(1, points);
  for (int i = 0; i < 6; ++i) {
    const auto& expected =
        mesh.nodes[static_cast<std::size_t>(mesh.blocks[1].cell(1)[static_cast<std::size_t>(i)])];
    EXPECT_EQ(Eigen::Vector3d(grid->GetPoint(points->GetId(i))), expected);
  }

  vtkDataArray* moved = grid->GetPointData()->GetArray("displacement [m]");
  ASSERT_NE(moved, nullptr);
  EXPECT_EQ(moved->GetNumberOfComponents(), 3);
  EXPECT_STREQ(moved->GetComponentName(2), "z");
  EXPECT_EQ(Eigen::Vector3d(moved->GetTuple3(0)), displacement[1]);

  ASSERT_EQ(grid->GetCellData()->GetNumberOfArrays(), static_cast<int>(film_fields().size()));
  EXPECT_NEAR(grid->GetCellData()->GetArray("electric_field [V/m]")->GetTuple1(1), 1e6, 0.1);
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
  steps.write({0, "release", 1, {{"voltage_a", 0}, {"voltage_b", 10}}}, displacement, samples);
  steps.write({1, "voltage", 0.25, {{"voltage_a", 500}, {"voltage_b", -20}}}, displacement, samples);
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

TEST_F(VtkSeriesTest, WallsReadBack) {
  series().write({0, "release"}, displacement, samples);
  const auto grid = read("run_walls_0000.vtu");
  ASSERT_EQ(grid->GetNumberOfPoints(), 3);
  ASSERT_EQ(grid->GetNumberOfCells(), 1);
  EXPECT_EQ(grid->GetCellType(0), VTK_QUADRATIC_EDGE);
  ASSERT_EQ(grid->GetCellData()->GetNumberOfArrays(), static_cast<int>(wall_fields().size()));
  EXPECT_EQ(grid->GetCellData()->GetArray("axial_force [N]")->GetTuple1(0), 10);
  EXPECT_STREQ(grid->GetCellData()->GetArray("bending_moment [N m]")->GetComponentName(1), "3");
}

TEST_F(VtkSeriesTest, LinearCellsAndNoWalls) {
  mesh.blocks = {{meshing::CellType::triangle3, {1, 2, 3, 1, 3, 4}}};
  series().write({0, "release"}, displacement, samples);
  EXPECT_EQ(read("run_film_0000.vtu")->GetCellType(0), VTK_TRIANGLE);
  EXPECT_EQ(file_count(), 3u);
}

TEST_F(VtkSeriesTest, AFilmOfRevolutionIsASurface) {
  mesh.nodes = {{2, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1.5, 0, 0}, {0.5, 0, 0}};
  mesh.blocks = {{meshing::CellType::meridian3, {0, 1, 3, 1, 2, 4}}};
  displacement = {{0.1, 0, 0}, {0.2, 0, 3}, {0, 0, 5}, {0, 0, 0}, {0, 0, 0}};
  const std::vector<Eigen::Vector3d> mode{{1, 0, 0}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  series().write({0, "voltage"}, displacement, samples, mode);
  EXPECT_EQ(file_count(), 3u);
  const auto grid = read("run_film_0000.vtu");
  constexpr int sectors = Revolution::sectors;
  ASSERT_EQ(grid->GetNumberOfPoints(), 4 * sectors + 1);
  ASSERT_EQ(grid->GetNumberOfCells(), 4 * sectors);
  for (int i = 0; i < 4 * sectors; ++i)
    EXPECT_EQ(grid->GetCellType(i), i < 3 * sectors ? VTK_QUAD : VTK_TRIANGLE) << i;

  const auto at = [&](double x, double y) {
    const vtkIdType point = grid->FindPoint(x, y, 0);
    EXPECT_LT((Eigen::Vector3d(grid->GetPoint(point)) - Eigen::Vector3d(x, y, 0)).norm(), 1e-15);
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
  vtkDataArray* stress = grid->GetCellData()->GetArray("cauchy_stress [Pa]");
  ASSERT_EQ(voltage->GetNumberOfTuples(), 4 * sectors);
  for (int i = 0; i < 4 * sectors; ++i) {
    EXPECT_EQ(voltage->GetTuple1(i), i < 2 * sectors ? 0 : 500) << i;
    EXPECT_FLOAT_EQ(static_cast<float>(stress->GetComponent(i, 1)), i < 2 * sectors ? 1 : 2) << i;
  }
}

TEST_F(VtkSeriesTest, EveryStepHasItsOwnValues) {
  VtkSeries steps = series();
  steps.write({0, "release"}, displacement, samples);
  samples.film[1].voltage = 1000;
  displacement[1].x() = 7;
  steps.write({1, "voltage"}, displacement, samples);
  const auto first = read("run_film_0000.vtu"), second = read("run_film_0001.vtu");
  EXPECT_EQ(first->GetCellData()->GetArray("voltage [V]")->GetTuple1(1), 500);
  EXPECT_EQ(second->GetCellData()->GetArray("voltage [V]")->GetTuple1(1), 1000);
  EXPECT_EQ(second->GetPointData()->GetArray("displacement [m]")->GetTuple3(0)[0], 7);
  EXPECT_EQ(second->GetCellData()->GetNumberOfArrays(), static_cast<int>(film_fields().size()));
}

TEST_F(VtkSeriesTest, ListNamesPartsAndTimes) {
  VtkSeries steps = series();
  steps.write({0, "release"}, displacement, samples);
  steps.write({0.1, "voltage"}, displacement, samples);
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
  steps.write({0, "voltage"}, displacement, samples);
  const auto kept = steps.entries();
  for (const double time : {1.0, 2.0}) steps.write({time, "voltage"}, displacement, samples);
  const std::string first = content("run_film_0000.vtu");
  folder->begin({"run.pvd", "run_film_0000.vtu", "run_walls_0000.vtu"});
  VtkSeries resumed = series(kept);
  EXPECT_EQ(file_count(), 4u); // with the manifest
  resumed.write({7, "voltage"}, displacement, samples);
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
  steps.write({0, "release"}, displacement, samples);
  const std::string list = content("run.pvd");
  {
    const FileSizeLimit limit(2000);
    try {
      steps.write({1, "voltage"}, displacement, samples);
      FAIL() << "no error";
    } catch (const WriteError& error) {
      EXPECT_EQ(std::string(error.what()),
                "cannot write " + (directory / "run_film_0001.vtu").string() + ": File too large");
    }
  }
  EXPECT_EQ(content("run.pvd"), list);
  EXPECT_EQ(file_count(), 4u);
  steps.write({1, "voltage"}, displacement, samples); // room again
  EXPECT_EQ(read("run_film_0001.vtu")->GetNumberOfCells(), 2);
}

} // namespace
} // namespace dielast::post
