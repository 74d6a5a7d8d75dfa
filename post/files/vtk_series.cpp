// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/vtk_series.hpp"

#include "fem/model/contact_block.hpp"
#include "post/bars.hpp"
#include "post/fields.hpp"
#include "post/markup.hpp"
#include "post/reductions.hpp"
#include "post/revolution.hpp"

#include <SMP/Common/vtkSMPToolsAPI.h> // vtkSMPTools.h is not C++20
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace dielast::post {

namespace {

int vtk_type(meshing::CellType type) {
  switch (type) {
  case meshing::CellType::rod2:
    return VTK_LINE;
  case meshing::CellType::triangle3:
    return VTK_TRIANGLE;
  case meshing::CellType::triangle6:
    return VTK_QUADRATIC_TRIANGLE;
  case meshing::CellType::tetrahedron4:
    return VTK_TETRA;
  case meshing::CellType::tetrahedron10:
    return VTK_QUADRATIC_TETRA;
  case meshing::CellType::line2:
  case meshing::CellType::line3:
  case meshing::CellType::meridian2:
  case meshing::CellType::meridian3:
    break; // drawn as solids, and as a surface
  }
  return VTK_EMPTY_CELL;
}

/// VTK's loops run on the thread that calls them: they are small here, and its own threads would spend their
/// time looking for what there is to do. However that is, VTK asks for every array how many threads the C++
/// library would have, which counts the processors in a file of the system, but where it was told a number.
void use_one_thread() {
  [[maybe_unused]] static const bool done = [] {
    auto& threads = vtk::detail::smp::vtkSMPToolsAPI::GetInstance();
    threads.SetBackend("STDThread");
    threads.Initialize(1);
    return threads.SetBackend("Sequential");
  }();
}

Part part_of(meshing::CellType type) { return meshing::is_line(type) ? Part::walls : Part::film; }

/// A symmetric tensor (xx, yy, zz, xy, yz, xz) turned about z.
void turn(double cosine, double sine, std::span<float, 6> t) {
  const double xx = t[0], yy = t[1], xy = t[3], yz = t[4], xz = t[5];
  const double cc = cosine * cosine, ss = sine * sine, cs = cosine * sine;
  t[0] = static_cast<float>(cc * xx - 2 * cs * xy + ss * yy);
  t[1] = static_cast<float>(ss * xx + 2 * cs * xy + cc * yy);
  t[3] = static_cast<float>(cs * (xx - yy) + (cc - ss) * xy);
  t[4] = static_cast<float>(sine * xz + cosine * yz);
  t[5] = static_cast<float>(cosine * xz - sine * yz);
}

/// `values`: of the mesh's cells; the array has a tuple per cell of the grid.
vtkNew<vtkFloatArray> cell_array(const std::string& name, std::span<const std::string_view> components,
                                 const std::vector<double>& values, const std::vector<int>& mesh_cells) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name.c_str());
  const auto width = std::max<std::size_t>(components.size(), 1);
  array->SetNumberOfComponents(static_cast<int>(width));
  for (std::size_t c = 0; c < components.size(); ++c)
    array->SetComponentName(static_cast<vtkIdType>(c), std::string(components[c]).c_str());
  float* target = array->WritePointer(0, static_cast<vtkIdType>(mesh_cells.size() * width));
  for (const int cell : mesh_cells)
    target = std::copy_n(values.data() + static_cast<std::size_t>(cell) * width, width, target);
  return array;
}

} // namespace

/// The grid of the film, of the walls or of fins, built once; a step exchanges its points and its data.
class VtkSeries::PartFile {
 public:
  PartFile(const SeriesModel& model, const meshing::CellBlock& block)
      : part_(part_of(block.type)), name_(part_ == Part::film ? "film" : "walls"), cell_count_(block.size()) {
    if (part_ == Part::walls)
      add_bars(Bars(model.mesh, block, model.bar_widths, model.bar_heights));
    else if (meshing::is_meridian(block.type))
      add_surface(Revolution(model.mesh, block));
    else
      add_cells(model.mesh, block);
    add_parts(part_ == Part::walls ? model.bar_parts : model.film_parts, model.parts);
    begin(model.mesh);
  }
  /// Of fins, without fields.
  explicit PartFile(const SeriesModel& model) : name_("fins") {
    for (const std::array<int, 4>& fin : model.fins) {
      std::vector<vtkIdType> corners;
      for (const int node : fin) {
        corners.push_back(static_cast<vtkIdType>(points_.size()));
        points_.push_back({node});
      }
      add_cell(VTK_QUAD, corners, 0);
    }
    begin(model.mesh);
  }

  std::string_view name() const { return name_; }

  std::string content(const SeriesStep& step, const SeriesState& state, const SeriesMode& mode) {
    move(state);
    if (!mode.displacement.empty()) {
      fill(
          mode_, [&](const TurnedNode& point) { return point(mode.displacement); },
          [&](const BarPoint& point) { return point.motion(mode.displacement, mode.spin, state.rotation); });
      grid_->GetPointData()->AddArray(mode_);
    }
    time_->SetValue(0, step.time);
    step_->SetValue(0, step.name);
    load_factor_->SetValue(0, step.load_factor);
    for (const SeriesStep::Number& number : step.numbers) {
      vtkNew<vtkDoubleArray> array;
      array->SetName(number.name.c_str());
      array->InsertNextValue(number.value);
      grid_->GetFieldData()->AddArray(array); // replaces the last step's by its name
    }
    if (part_ == Part::film && !state.contact_pressure.empty()) set_pressure(state.contact_pressure);
    if (part_ == Part::film)
      set_cell_data(state.samples.film, film_fields());
    else if (part_ == Part::walls)
      set_cell_data(state.samples.walls, wall_fields());
    grid_->Modified();
    // A file must not tell of the one before: ranges that writing cached are dropped.
    time_->Modified();
    step_->Modified();
    load_factor_->Modified();
    for (vtkAbstractArray* kept :
         {static_cast<vtkAbstractArray*>(place_), static_cast<vtkAbstractArray*>(part_number_),
          static_cast<vtkAbstractArray*>(displacement_), static_cast<vtkAbstractArray*>(mode_),
          static_cast<vtkAbstractArray*>(time_), static_cast<vtkAbstractArray*>(load_factor_)})
      kept->GetInformation()->Clear();
    if (writer_->Write() == 0) throw std::runtime_error("VTK could not encode a step");
    return writer_->GetOutputString();
  }

 private:
  /// What every grid has, once its points and cells are known.
  void begin(const meshing::Mesh& mesh) {
    for (const TurnedNode& point : points_) drawn_.push_back(point(mesh.nodes));
    for (const BarPoint& point : edges_) drawn_.push_back(point.place(mesh.nodes));
    prepare(place_, "Points");
    vtkNew<vtkPoints> points;
    points->SetData(place_);
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
    for (const Revolution::Facet& facet : film.facets) {
      add_cell(facet.corners == 4 ? VTK_QUAD : VTK_TRIANGLE,
               {facet.points.begin(), facet.points.begin() + facet.corners}, facet.cell);
      sectors_.push_back(facet.sector);
    }
  }
  void add_bars(Bars bars) {
    edges_ = std::move(bars.points);
    for (const Bars::Hexahedron& bar : bars.hexahedra)
      add_cell(VTK_HEXAHEDRON, {bar.points.begin(), bar.points.end()}, bar.cell);
  }
  void add_parts(std::span<const int> part_of_cell, const std::vector<std::string>& names) {
    part_number_->SetName("part");
    for (const int cell : mesh_cells_)
      part_number_->InsertNextValue(part_of_cell.empty() ? 0 : part_of_cell[static_cast<std::size_t>(cell)]);
    grid_->GetCellData()->AddArray(part_number_);
    vtkNew<vtkStringArray> said;
    said->SetName("part_names");
    for (const std::string& name : names) said->InsertNextValue(name);
    if (!names.empty()) grid_->GetFieldData()->AddArray(said);
  }
  void add_cell(int type, const std::vector<vtkIdType>& points, int mesh_cell) {
    grid_->InsertNextCell(type, static_cast<vtkIdType>(points.size()), points.data());
    mesh_cells_.push_back(mesh_cell);
  }
  void prepare(vtkDoubleArray* array, const char* name) const {
    array->SetName(name);
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(static_cast<vtkIdType>(drawn_.size()));
    for (const int i : {0, 1, 2}) array->SetComponentName(i, std::string(1, "xyz"[i]).c_str());
  }
  /// A vector for each point: one of the two lists of points is empty.
  template<class OfNode, class OfBar>
  void fill(vtkDoubleArray* array, OfNode&& of_node, OfBar&& of_bar) const {
    Eigen::Map<Eigen::Matrix3Xd> values(array->GetPointer(0), 3, array->GetNumberOfTuples());
    Eigen::Index i = 0;
    for (const TurnedNode& point : points_) values.col(i++) = of_node(point);
    for (const BarPoint& point : edges_) values.col(i++) = of_bar(point);
    array->Modified();
  }
  void move(const SeriesState& state) {
    fill(
        displacement_, [&](const TurnedNode& point) { return point(state.displacement); },
        [&](const BarPoint& point) { return point.displacement(state.displacement, state.rotation); });
    const double* moved = displacement_->GetPointer(0);
    double* place = place_->GetPointer(0);
    for (const Eigen::Vector3d& drawn : drawn_)
      for (const int c : {0, 1, 2}) *place++ = drawn[c] + *moved++;
    place_->Modified();
    grid_->GetPoints()->Modified();
  }
  void set_pressure(const std::vector<double>& of_nodes) {
    vtkNew<vtkFloatArray> array; // replaces the last step's by its name
    array->SetName("contact_pressure [Pa]");
    for (const TurnedNode& point : points_)
      array->InsertNextValue(static_cast<float>(of_nodes[static_cast<std::size_t>(point.node)]));
    grid_->GetPointData()->AddArray(array);
  }
  template<class Sample, class Point>
  void set_cell_data(const std::vector<Sample>& samples, std::span<const Field<Point>> fields) {
    const auto values = cell_values(samples, fields, cell_count_);
    // Arrays replace those of the last step by their names.
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const Field<Point>& field = fields[i];
      const auto average = cell_array(fmt::format("{} [{}]", field.name, field.unit), field.components,
                                      values[i].average, mesh_cells_);
      for (std::size_t cell = 0; field.in_space && cell < sectors_.size(); ++cell) {
        const double angle = 2 * std::numbers::pi * (sectors_[cell] + 0.5) / Revolution::sectors;
        turn(std::cos(angle), std::sin(angle),
             std::span<float, 6>(average->GetPointer(6 * static_cast<vtkIdType>(cell)), 6));
      }
      grid_->GetCellData()->AddArray(average);
      if (field.worst)
        grid_->GetCellData()->AddArray(
            cell_array(fmt::format("{}_{} [{}]", field.name, *field.worst == Extreme::minimum ? "min" : "max",
                                   field.unit),
                       {}, values[i].worst, mesh_cells_));
    }
  }

  std::optional<Part> part_; ///< nothing: of fins
  const char* name_;
  int cell_count_ = 0;                 ///< of the mesh's block
  std::vector<TurnedNode> points_;     ///< of the grid, where it is of film
  std::vector<BarPoint> edges_;        ///< of the grid, where it is of walls
  std::vector<Eigen::Vector3d> drawn_; ///< the grid's points, m
  std::vector<int> mesh_cells_;        ///< per cell of the grid
  std::vector<int> sectors_;           ///< likewise, of a film of revolution: see Revolution::Facet
  vtkNew<vtkUnstructuredGrid> grid_;
  vtkNew<vtkDoubleArray> place_, displacement_, mode_;
  vtkNew<vtkIntArray> part_number_;
  vtkNew<vtkDoubleArray> time_, load_factor_;
  vtkNew<vtkStringArray> step_;
  vtkNew<vtkXMLUnstructuredGridWriter> writer_;
};

SeriesState series_state(const fem::Model& model, const fem::State& state, const fem::Samples& samples) {
  return {state.displacement, state.rotation, samples, fem::contact_pressure(model, state)};
}

VtkSeries::~VtkSeries() = default;
VtkSeries::VtkSeries(VtkSeries&&) noexcept = default;

VtkSeries::VtkSeries(ResultsFolder& folder, std::string name, const SeriesModel& model,
                     std::vector<std::string> entries)
    : folder_(folder), name_(std::move(name)), entries_(std::move(entries)) {
  use_one_thread();
  for (const Part part : {Part::film, Part::walls})
    for (const meshing::CellBlock& block : model.mesh.blocks)
      if (part_of(block.type) == part && block.size() > 0)
        parts_.push_back(std::make_unique<PartFile>(model, block));
  if (!model.fins.empty()) parts_.push_back(std::make_unique<PartFile>(model));

  write_list();
}

std::string VtkSeries::file_name(std::string_view part, int step) const {
  return fmt::format("{}_{}_{:04}.vtu", name_, part, step);
}

int VtkSeries::steps() const {
  return static_cast<int>(entries_.size() / std::max<std::size_t>(parts_.size(), 1));
}

void VtkSeries::write(const SeriesStep& step, const SeriesState& state, const SeriesMode& mode) {
  const int index = steps();
  std::vector<std::string> entries;
  for (const auto& part : parts_) {
    const std::string file = file_name(part->name(), index);
    folder_.write(file, part->content(step, state, mode));
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
