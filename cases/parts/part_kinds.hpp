// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/part_kind.hpp"
#include "cases/language/section_reader.hpp"
#include "materials/beam_section.hpp"

namespace dielast::cases {

/// A part, and what is written of it.
struct WrittenPart {
  SectionReader& reader;
  const Node& tree;
  const Case& one;
  const Part& part;

  /// The table in which it is written.
  const Node& top() const;
  std::string path(const std::string& key) const;
  /// Blames one of its tables, where that is not written all of it.
  void report(const std::string& table, const std::string& message) const;
  /// Blames a key of its [film], where that is not written the film.
  void report_film(const char* key, const std::string& message) const;
  /// Blames, at their kinds, quantities that film of this kind does not have.
  void refuse_quantities(bool QuantityKind::*has, const char* kind) const;
  /// The part in whose mesh it is; null: there is none, which is reported elsewhere.
  const Part* meshed() const;
};

/// Whether a part has a dashpot that knows x from y.
bool has_axes(const Part& part);

/// Whether a part has film that does, by that or by its prestretches.
bool knows_x_from_y(const Part& part);

template<FilmSection section>
bool is_film_of(const Part& part) {
  return part.film && part.film->section == section;
}
/// Of passive film on each face, m.
double cover_of(const Part& part);
/// Beams of that section; what has them besides a [beam] are lattices and antagonistic rolls.
AlikeBars beams_of(const materials::BeamSection& section, double offset = 0);

PartKind membrane_kind();
PartKind rod_kind();
PartKind shell_kind();
PartKind solid_kind();
PartKind beam_kind();
PartKind cable_kind();

} // namespace dielast::cases
