// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/vtk_series.hpp"

#include "post/fields.hpp"
#include "post/markup.hpp"
#include "post/reductions.hpp"
#include "post/revolution.hpp"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace dielast::post {

namespace {

int vtk_type(meshing::CellType type) {
  switch (type) {
  case meshing::CellType::line2:
  case meshing::CellType::rod2:
    return VTK_LINE;
  case meshing::CellType::line3:
    return VTK_QUADRATIC_EDGE;
  case meshing::CellType::triangle3:
    return VTK_TRIANGLE;
  case meshing::CellType::triangle6:
    return VTK_QUADRATIC_TRIANGLE;
  case meshing::CellType::meridian2:
  case meshing::CellType::meridian3:
    break; // drawn as a surface
  }
  return VTK_EMPTY_CELL;
}

Part part_of(meshing::CellType type) { return meshing::is_line(type) ? Part::walls : Part::film; }

/// `values`: of the mesh's cells; the array has a tuple per cell of the grid.
template<class Point>
vtkNew<vtkFloatArray> cell_array(const Field<Point>& field, const std::vector<double>& values,
                                 const std::vector<int>& mesh_cells) {
  vtkNew<vtkFloatArray> array;
  array->SetName(fmt::format("{} [{}]", field.name, field.unit).c_str());
  array->SetNumberOfComponents(field.width());
  for (std::size_t c = 0; c < field.components.size(); ++c)
    array->SetComponentName(static_cast<vtkIdType>(c), std::string(field.components[c]).c_str());
  const auto width = static_cast<std::size_t>(field.width());
  float* target = array->WritePointer(0, static_cast<vtkIdType>(mesh_cells.size() * width));
  for (const int cell : mesh_cells)
    target = std::copy_n(values.data() + static_cast<std::size_t>(cell) * width, width, target);
  return array;
}

} // namespace

/// One part's grid, built once; a step exchanges its data only.
class VtkSeries::PartFile {
 public:
  PartFile(const meshing::Mesh& mesh, const meshing::CellBlock& block)
      : part_(part_of(block.type)), cell_count_(block.size()) {
    if (meshing::is_meridian(block.type))
      add_surface(Revolution(mesh, block));
    else
      add_cells(mesh, block);
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const TurnedNode& point : points_) points->InsertNextPoint(point(mesh.nodes).data());
    grid_->SetPoints(points);

    prepare(displacement_, "displacement [m]");
    grid_->GetPointData()->SetVectors(displacement_);
    prepare(mode_, "mode");

    time_->SetName("TimeValue");
    time_->SetNumberOfTuples(1);
    grid_->GetFieldData()->AddArray(time_);
    step_->SetName("step");
    step_->SetNumberOfValues(1);
    grid_->GetFieldData()->AddArray(step_);
    load_factor_->SetName("load_factor");
    load_factor_->SetNumberOfTuples(1);
    grid_->GetFieldData()->AddArray(load_factor_);

    writer_->SetInputData(grid_);
    writer_->SetDataModeToAppended();
    writer_->EncodeAppendedDataOff();
    writer_->SetCompressorTypeToLZ4();
    writer_->SetCompressionLevel(1);
    // Through memory, as VTK does not say why a file could not be written.
    writer_->WriteToOutputStringOn();
  }

  std::string_view name() const { return part_ == Part::film ? "film" : "walls"; }

  std::string content(const SeriesStep& step, std::span<const Eigen::Vector3d> displacement,
                      const fem::Samples& samples, std::span<const Eigen::Vector3d> mode) {
    fill(displacement_, displacement);
    if (!mode.empty()) {
      fill(mode_, mode);
      grid_->GetPointData()->AddArray(mode_);
    }
    time_->SetValue(0, step.time);
    step_->SetValue(0, step.name);
    load_factor_->SetValue(0, step.load_factor);
    for (const SeriesStep::Voltage& voltage : step.voltages) {
      vtkNew<vtkDoubleArray> array;
      array->SetName((voltage.name + " [V]").c_str());
      array->InsertNextValue(voltage.value);
      grid_->GetFieldData()->AddArray(array); // replaces the last step's by its name
    }
    if (part_ == Part::film)
      set_cell_data(samples.film, film_fields());
    else
      set_cell_data(samples.walls, wall_fields());
    grid_->Modified();
    // A file must not tell of the one before: ranges that writing cached are dropped.
    time_->Modified();
    step_->Modified();
    load_factor_->Modified();
    for (vtkAbstractArray* kept :
         {static_cast<vtkAbstractArray*>(grid_->GetPoints()->GetData()),
          static_cast<vtkAbstractArray*>(displacement_), static_cast<vtkAbstractArray*>(mode_),
          static_cast<vtkAbstractArray*>(time_), static_cast<vtkAbstractArray*>(load_factor_)})
      kept->GetInformation()->Clear();
    if (writer_->Write() == 0) throw std::runtime_error("VTK could not encode a step");
    return writer_->GetOutputString();
  }

 private:
  void add_cells(const meshing::Mesh& mesh, const meshing::CellBlock& block) {
    std::vector<int> nodes = block.nodes;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<vtkIdType> point_of_node(mesh.nodes.size());
    for (const int node : nodes) {
      point_of_node[static_cast<std::size_t>(node)] = static_cast<vtkIdType>(points_.size());
      points_.push_back({node});
    }
    for (int i = 0; i < cell_count_; ++i) {
      std::vector<vtkIdType> corners;
      for (const int node : block.cell(i)) corners.push_back(point_of_node[static_cast<std::size_t>(node)]);
      add_cell(vtk_type(block.type), corners, i);
    }
  }
  void add_surface(Revolution film) {
    points_ = std::move(film.points);
    for (const Revolution::Facet& facet : film.facets)
      add_cell(facet.corners == 4 ? VTK_QUAD : VTK_TRIANGLE,
               {facet.points.begin(), facet.points.begin() + facet.corners}, facet.cell);
  }
  void add_cell(int type, const std::vector<vtkIdType>& points, int mesh_cell) {
    grid_->InsertNextCell(type, static_cast<vtkIdType>(points.size()), points.data());
    mesh_cells_.push_back(mesh_cell);
  }
  void prepare(vtkDoubleArray* array, const char* name) const {
    array->SetName(name);
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(static_cast<vtkIdType>(points_.size()));
    for (const int i : {0, 1, 2}) array->SetComponentName(i, std::string(1, "xyz"[i]).c_str());
  }
  void fill(vtkDoubleArray* array, std::span<const Eigen::Vector3d> vectors) const {
    double* values = array->GetPointer(0);
    for (const TurnedNode& point : points_) values = std::copy_n(point(vectors).data(), 3, values);
    array->Modified();
  }
  template<class Sample, class Point>
  void set_cell_data(const std::vector<Sample>& samples, std::span<const Field<Point>> fields) {
    const auto averages = average(samples, fields, cell_count_);
    for (std::size_t i = 0; i < fields.size(); ++i)
      grid_->GetCellData()->AddArray(
          cell_array(fields[i], averages[i], mesh_cells_)); // replaces the last step's by its name
  }

  Part part_;
  int cell_count_;                 ///< of the mesh's block
  std::vector<TurnedNode> points_; ///< of the grid
  std::vector<int> mesh_cells_;    ///< per cell of the grid
  vtkNew<vtkUnstructuredGrid> grid_;
  vtkNew<vtkDoubleArray> displacement_, mode_;
  vtkNew<vtkDoubleArray> time_, load_factor_;
  vtkNew<vtkStringArray> step_;
  vtkNew<vtkXMLUnstructuredGridWriter> writer_;
};

VtkSeries::~VtkSeries() = default;
VtkSeries::VtkSeries(VtkSeries&&) noexcept = default;

VtkSeries::VtkSeries(ResultsFolder& folder, std::string name, const meshing::Mesh& mesh,
                     std::vector<std::string> entries)
    : folder_(folder), name_(std::move(name)), entries_(std::move(entries)) {
  for (const Part part : {Part::film, Part::walls})
    for (const meshing::CellBlock& block : mesh.blocks)
      if (part_of(block.type) == part && block.size() > 0)
        parts_.push_back(std::make_unique<PartFile>(mesh, block));

  write_list();
}

std::string VtkSeries::file_name(std::string_view part, int step) const {
  return fmt::format("{}_{}_{:04}.vtu", name_, part, step);
}

int VtkSeries::steps() const {
  return static_cast<int>(entries_.size() / std::max<std::size_t>(parts_.size(), 1));
}

void VtkSeries::write(const SeriesStep& step, std::span<const Eigen::Vector3d> displacement,
                      const fem::Samples& samples, std::span<const Eigen::Vector3d> mode) {
  const int index = steps();
  std::vector<std::string> entries;
  for (const auto& part : parts_) {
    const std::string file = file_name(part->name(), index);
    folder_.write(file, part->content(step, displacement, samples, mode));
    entries.push_back(fmt::format(R"(    <DataSet timestep="{}" part="{}" name="{}" file="{}"/>)", step.time,
                                  entries.size(), part->name(), escape_markup(file)));
  }
  entries_.insert(entries_.end(), entries.begin(), entries.end());
  write_list();
}

void VtkSeries::write_list() {
  folder_.write(name_ + ".pvd",
                fmt::format("<?xml version=\"1.0\"?>\n"
                            "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
                            "  <Collection>\n{}{}  </Collection>\n</VTKFile>\n",
                            fmt::join(entries_, "\n"), entries_.empty() ? "" : "\n"));
}

} // namespace dielast::post
