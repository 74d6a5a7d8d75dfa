#pragma once

#include "cases/diagnostics.hpp"
#include "materials/beam_section.hpp"
#include "materials/material.hpp"
#include "post/reductions.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace dielast::cases {

/// [film]
struct Film {
  std::string material_name;
  materials::Material material;
  double thickness = 0;               ///< undeformed H, m
  std::array<double, 2> prestretch{}; ///< lambda_p along x and y
};

/// [honeycomb]: the geometry template of the unidirectional actuator
struct Honeycomb {
  double angle = 0;         ///< interior angle at a cell's four equal vertices, rad
  std::vector<int> columns; ///< cells in each column, left to right
  double wall_length = 0, wall_width = 0, wall_height = 0; ///< m
  std::string wall_material_name;
  materials::ElasticSolid wall_material;
};

/// [disc]: clamped at its rim; dimensions as clamped, after the prestretch
struct Disc {
  double radius = 0;           ///< m
  double electrode_radius = 0; ///< m
};

/// [annulus]: dimensions as clamped, after the prestretch
struct Annulus {
  double inner_radius = 0, outer_radius = 0; ///< m
};

/// [mesh] file = "...": the user's own mesh, drawn after the prestretch, physical names as places
struct MeshFile {
  std::filesystem::path path;
};

using Geometry = std::variant<Honeycomb, Disc, Annulus, MeshFile>;

/// [mesh]
struct MeshOptions {
  double unit = 1;       ///< m per unit of length of a user's own mesh
  int order = 2;         ///< 1: 3-node triangles and 2-node beams; 2: 6-node triangles and 3-node beams
  int wall_elements = 8; ///< beams per wall (honeycomb)
  double grading = 0;    ///< largest film element over the wall's elements; 1 is uniform (honeycomb)
  int rings = 0;         ///< elements along a radius (disc, annulus)
  int quadrature = 0;    ///< integration points of a 6-node triangle: 3 or 6
};

/// [[electrode]]
struct Electrode {
  std::string name;
  std::string place;
};

/// [[support]]
struct Support {
  std::string place;
  std::array<bool, 3> fixed{}; ///< x, y, z
};

/// [[load]]: a dead force spread evenly over the nodes of a place, applied by steps of kind "force"
struct Load {
  std::string place;
  std::array<double, 3> force{}; ///< N
};

enum class StepKind { release, voltage, force };

/// [[step]]
struct Step {
  StepKind kind{};
  std::string name; ///< default: its kind
  int increments = 1;
};

enum class QuantityKind {
  distance,
  elongation,
  size,
  growth,
  displacement,
  radius,
  force,
  capacitance,
  charge,
  extreme
};

/// Elongation is the relative change of a distance, growth that of a size.
constexpr bool is_relative(QuantityKind kind) {
  return kind == QuantityKind::elongation || kind == QuantityKind::growth;
}

/// [[quantity]]: a number of the state, in every row of history.csv and in summary.json
struct Quantity {
  std::string name;
  QuantityKind kind{};
  std::array<std::string, 2> between; ///< distance, elongation: two places (their centroids)
  std::string of; ///< size, growth, displacement, radius, force: a place; capacitance, charge: an electrode;
                  ///< extreme: a field
  std::optional<int> along; ///< 0, 1, 2 = x, y, z; absent: magnitude
  post::Extreme extreme{};
  std::string at;        ///< the step at whose end summary.json reads it; empty: the last
  std::string since;     ///< elongation, growth: the step at whose end it is zero; empty: the mesh as drawn
  bool standard = false; ///< brought by the geometry's template, not written by the user
};

/// [[check]]
struct Check {
  std::string quantity;
  double value = 0;
  double tolerance =
      0; ///< absolute, in the quantity's unit (a "1 %" in the file is made absolute by the reader)
  std::string source;
};

/// [solver]
struct SolverOptions {
  double tolerance = 0;          ///< |R_free| over the reaction scale
  int max_iterations = 0;        ///< Newton iterations before a cutback
  double smallest_increment = 0; ///< load factor below which a step gives up
};

/// Everything the user asked for: validated, complete, in SI. No type of the file format gets past the
/// reader.
struct Case {
  std::string title;
  std::filesystem::path source; ///< the case file
  bool three_dimensional = false;
  Film film;
  Geometry geometry;
  MeshOptions mesh;
  std::vector<Electrode> electrodes;
  std::vector<Support> supports;
  std::vector<Load> loads;
  std::map<std::string, double> drives; ///< electrode name -> final voltage, V
  std::vector<Step> steps;
  std::vector<Quantity> quantities; ///< the template's and the user's
  std::vector<Check> checks;
  int skipped_checks = 0; ///< checks of another device than this one: the file's, before an override
  SolverOptions solver;
  bool error_estimate = true;  ///< [output] error_estimate: solve once more on a coarser mesh
  bool fields = true;          ///< [output] fields: write the VTK series
  std::vector<Mention> places; ///< every place that the case names, for check_places
};

} // namespace dielast::cases
