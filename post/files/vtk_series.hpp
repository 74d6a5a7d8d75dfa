// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/model.hpp"
#include "meshing/mesh.hpp"
#include "post/files/results_folder.hpp"

#include <Eigen/Geometry>

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::post {

/// What a file says of the step that it shows, as field data.
struct SeriesStep {
  double time = 0;        ///< s, or a pseudo-time; larger than that of the step before. "TimeValue"
  std::string name;       ///< "step"
  double load_factor = 0; ///< "load_factor"
  struct Number {
    std::string name; ///< with its unit: "voltage [V]"
    double value;     ///< SI
  };
  std::vector<Number> numbers{}; ///< voltages of the electrodes, quantities
};

/// What a series shows: a mesh, the bars along its lines, and to which part of the device cells belong.
struct SeriesModel {
  const meshing::Mesh& mesh;
  std::span<const double> bar_widths{}, bar_heights{}; ///< per line, see Bars
  std::span<const int> film_parts{}, bar_parts{};      ///< per cell and line; empty: all are of part 0
  std::vector<std::string> parts{};                    ///< their names
  std::vector<std::array<int, 4>> fins{};              ///< flat fins, the nodes of their corners
};

/// A state of it.
struct SeriesState {
  const std::vector<Eigen::Vector3d>& displacement; ///< per mesh node, m
  const std::vector<Eigen::Quaterniond>& rotation;  ///< per mesh node, from the mesh as drawn
  const fem::Samples& samples;
  std::vector<double> contact_pressure{}; ///< per mesh node, Pa; empty: nothing may touch
};

/// What a state shows; it keeps references to both.
SeriesState series_state(const fem::Model& model, const fem::State& state, const fem::Samples& samples);

/// A small motion of the mesh nodes, about a state; empty: none.
struct SeriesMode {
  std::vector<Eigen::Vector3d> displacement{}, spin{};
};

/// The ParaView series of a run: per accepted step `<name>_film_0000.vtu` and, where the mesh has lines,
/// `<name>_walls_0000.vtu`, with fins `<name>_fins_0000.vtu` (binary, compressed), and `<name>.pvd` that
/// lists them by time with the blocks film, walls and fins.
///
/// Points are where the mesh's nodes are in that state; point data "displacement [m]", by which they have
/// moved since drawn. Walls are solids with their sections (post/bars.hpp), films of revolution surfaces
/// (post/revolution.hpp) with what is in space turned with them: vectors of points, and the meridian's
/// tensors to the middle of a facet. A solid of revolution is its half section, y around. Cell data: every
/// output field averaged over its cell, in single precision, named "electric_field [V/m]"; its extreme over
/// the cell's integration points where one matters, "electric_field_max [V/m]"; and "part", a number of field
/// data "part_names". Every file appears whole or not at all, and the list after the files it names, so a
/// killed run leaves a readable series.
class VtkSeries {
 public:
  /// Precondition: at most one film and one line block, as samples number their cells within a block.
  /// To resume, `entries` are those of the steps to keep. The folder must outlive this. Throws WriteError.
  VtkSeries(ResultsFolder& folder, std::string name, const SeriesModel& model,
            std::vector<std::string> entries = {});
  ~VtkSeries();
  VtkSeries(VtkSeries&&) noexcept;

  /// Adds a step. `mode`, if any, is written as point data "mode". Throws WriteError.
  void write(const SeriesStep& step, const SeriesState& state, const SeriesMode& mode = {});

  /// Lines of the list, one per step and part: what a checkpoint keeps.
  const std::vector<std::string>& entries() const { return entries_; }

 private:
  class PartFile;

  std::string file_name(std::string_view part, int step) const;
  int steps() const;
  void write_list();

  ResultsFolder& folder_;
  std::string name_;
  std::vector<std::unique_ptr<PartFile>> parts_;
  std::vector<std::string> entries_;
};

} // namespace dielast::post
