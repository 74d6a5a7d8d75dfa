// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/samples.hpp"
#include "meshing/mesh.hpp"
#include "post/fields.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dielast::post {

/// A field in the cells; NaN in a cell without integration points.
struct CellValues {
  /// Weighted by undeformed volume (film) or length (walls): the components of cell 0, then of cell 1, ...;
  /// fields of electrodes over what lies under an electrode, in cells where anything does.
  /// Of a shell with several layers that of the film itself.
  std::vector<double> average;
  /// At the cell's integration points, of all layers; empty for a field without a worst end.
  std::vector<double> worst;
};

/// One per field in their order. Precondition: every sample's cell < cell_count.
std::vector<CellValues> cell_values(std::span<const fem::MembraneSample> samples,
                                    std::span<const FilmField> fields, int cell_count);
std::vector<CellValues> cell_values(std::span<const fem::BeamSample> samples,
                                    std::span<const WallField> fields, int cell_count);

/// One scalar of the film at an integration point. Throws std::invalid_argument for an unknown name.
double film_value(const fem::MembraneSample& sample, std::string_view scalar);

enum class Part { film, walls };

/// A scalar that can be asked for by name: a scalar field, or one component as "cauchy_stress.xx".
struct Scalar {
  std::string name;
  Part part{};
  std::string_view unit;
  std::string_view meaning;
};

/// All of them, film first, in the tables' order.
std::vector<Scalar> scalars();

/// A scalar's value at the integration point where it is extreme, and the cell around it.
struct Extremum {
  double value = 0;
  int cell = 0;
  Part part{};
  int layer = 0;      ///< of a shell's film, see MembraneSample
  int electrode = -1; ///< that covers the point, see MembraneSample
};

/// Scalars of which the extremes are wanted.
class WantedScalars {
 public:
  /// Throws std::invalid_argument for an unknown name.
  explicit WantedScalars(std::vector<std::string> names);
  static const WantedScalars& all();

 private:
  friend class Extremes;
  template<class Point>
  struct Row {
    const Field<Point>* field;
    std::size_t component, number; ///< of the field's; among the names
  };
  std::vector<std::string> names_;
  std::vector<Row<FilmPoint>> film_;
  std::vector<Row<fem::BeamSample>> walls_;
};

/// The smallest and largest values of scalars of a state, found in one pass over its integration points.
class Extremes {
 public:
  /// `wanted` must outlive this.
  explicit Extremes(const fem::Samples& samples, const WantedScalars& wanted = WantedScalars::all());

  /// Nothing when the model has no points of that part. Throws std::invalid_argument for a scalar that was
  /// not wanted.
  std::optional<Extremum> find(std::string_view scalar, Extreme which) const;

 private:
  struct Ends {
    std::optional<Extremum> low, high;
  };
  const WantedScalars& wanted_;
  std::vector<Ends> ends_; ///< one per scalar
};

/// How steep a scalar is where it is extreme: the largest difference between the extremum and the values at
/// the integration points of its cell and of the cells next to it, in the scalar's unit. Cells next to it are
/// film cells of the same part (a number for each cell of the film), electrode and layer that share a side,
/// walls that alone share an end. Throws std::invalid_argument for an unknown name.
double rise_at(const Extremum& extremum, const fem::Samples& samples, const meshing::Mesh& mesh,
               std::span<const int> film_parts, std::string_view scalar);

/// Cell averages of one scalar, of the film over the samples of a layer. Throws std::invalid_argument for an
/// unknown name.
std::vector<double> average(const fem::Samples& samples, std::string_view scalar, int cell_count,
                            int layer = 0);
/// The largest of those of a shell's layers, of a scalar of the film.
std::vector<double> largest_average(const fem::Samples& samples, std::string_view scalar, int cell_count);

} // namespace dielast::post
