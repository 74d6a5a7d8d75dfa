// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/case/part.hpp"
#include "fem/elements/beam_block.hpp"

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace dielast::fem {
class ElementBlock;
struct Model;
} // namespace dielast::fem

namespace dielast::cases {

struct Case;
struct Section;
struct WrittenPart;

/// The film of one part, of which its kind makes blocks.
struct PartFilm {
  const Part* part;
  std::vector<int> cells;                  ///< of the mesh's film
  std::vector<int> electrodes;             ///< over each of them, or fem::passive
  std::vector<std::vector<int>> of_layers; ///< the electrodes of each of Film::further_layers
};

/// Bars along lines of the mesh that are alike.
struct AlikeBars {
  double width = 0, height = 0; ///< in the plane of x and y, and along z, m
  double offset = 0;            ///< of their axes from the lines, along z, m
  /// Their elements, of lines of the mesh by their numbers. Throws std::invalid_argument.
  std::function<std::unique_ptr<fem::ElementBlock>(const meshing::Mesh&, const std::vector<int>& lines)>
      block;
  /// Adds their rotary inertia at the nodes of these lines; null: they have none.
  std::function<void(const meshing::Mesh&, const std::vector<int>& lines, fem::RotaryInertia&)> rotary{};
};

/// All that is known of what a part can be (in mechanics: of a section), once. It is film, or it is bars;
/// what few have is null by default.
struct PartKind {
  std::string word, plural;             ///< "rod", "rods"
  std::string meaning{};                ///< of the word, where film.section says it
  std::optional<FilmSection> section{}; ///< that value
  Section (*table)() = nullptr;         ///< otherwise [part.NAME.WORD], of the Part
  bool at_top = false;                  ///< that stands at the top of a file, too
  bool (*is)(const Part& part) = nullptr;

  /// Refuses what it cannot be in a case; asked of every part.
  void (*check)(const WrittenPart& written) = nullptr;
  /// Of film: adds the blocks of all such parts of a case. Throws CaseError and std::invalid_argument.
  void (*add)(const Case& one, const meshing::Mesh& mesh, std::span<const PartFilm> films,
              fem::Model& model) = nullptr;
  AlikeBars (*bars)(const Part& part) = nullptr; ///< of bars
  /// Its mesh as a [line], from end to end.
  meshing::Mesh (*line)(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        const MeshOptions& options) = nullptr;
  bool one_element = false;   ///< that is one element, which is exact
  bool has_middles = true;    ///< that may have nodes between its elements' ends
  bool resists_along = false; ///< electrodes on it may have a sheet resistance
};

/// All kinds; a part is of the first that it is.
std::span<const PartKind> part_kinds();
/// Null: it is no more than a mesh.
const PartKind* kind_of(const Part& part);
/// Whether its mesh is one element, however fine it is meant to be.
bool is_one_element(const Part& part);

/// "a [rod], a [beam] or a [...]": the words of those kinds for which it holds, behind others.
template<class Rule>
std::string words_of_kinds(const Rule& rule, std::string words = "") {
  for (const PartKind& kind : part_kinds())
    if (rule(kind)) words += (words.empty() ? "a [" : ", a [") + kind.word + "]";
  if (const auto last = words.rfind(", "); last != std::string::npos) words.replace(last, 2, " or ");
  return words;
}

} // namespace dielast::cases
