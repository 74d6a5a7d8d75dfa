// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/samples.hpp"
#include "meshing/mesh.hpp"
#include "post/files/results_folder.hpp"

#include <Eigen/Core>

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
  struct Voltage {
    std::string name; ///< "<name> [V]"
    double value;     ///< V
  };
  std::vector<Voltage> voltages{}; ///< of the electrodes
};

/// The ParaView series of a run: per accepted step `<name>_film_0000.vtu` and, where the mesh has lines,
/// `<name>_walls_0000.vtu` (binary, compressed), and `<name>.pvd` that lists them by time with the parts film
/// and walls.
///
/// Points are the mesh's nodes, point data "displacement [m]", cell data every output field averaged over its
/// cell, in single precision, named "electric_field [V/m]". A film of revolution is written as the surface
/// (post/revolution.hpp), vectors of points turned with them; tensors stay those of the meridian's plane, x
/// along the radius and y around. Every file appears whole or not at all, and the
/// list after the files it names, so a killed run leaves a readable series.
class VtkSeries {
 public:
  /// Precondition: at most one film and one line block, as samples number their cells within a block.
  /// To resume, `entries` are those of the steps to keep. The folder must outlive this. Throws WriteError.
  VtkSeries(ResultsFolder& folder, std::string name, const meshing::Mesh& mesh,
            std::vector<std::string> entries = {});
  ~VtkSeries();
  VtkSeries(VtkSeries&&) noexcept;

  /// Adds a step. `displacement` per mesh node, m.
  /// `mode`, if any: a vector per mesh node, written as point data "mode". Throws WriteError.
  void write(const SeriesStep& step, std::span<const Eigen::Vector3d> displacement,
             const fem::Samples& samples, std::span<const Eigen::Vector3d> mode = {});

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
