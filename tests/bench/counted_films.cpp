// SPDX-License-Identifier: GPL-3.0-or-later
// The films of the counted runs and no others: with every law and kinematics this takes minutes to compile.
#include "fem/films/membrane_block.hpp"

#include "fem/films/film_of_law.hpp"

#include <numeric>

namespace dielast::fem {

std::unique_ptr<ElementBlock> make_membrane_block(const meshing::Mesh& mesh, const meshing::CellBlock& cells,
                                                  const MembraneSection& section, std::vector<int> electrodes,
                                                  Dimension dimension, int integration_points,
                                                  std::vector<int> numbers) {
  numbers.resize(electrodes.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  const auto make = [&]<class Kinematics, class Law>() -> std::unique_ptr<ElementBlock> {
    return std::make_unique<FilmOfLaw<Kinematics, Law>>(mesh, cells, section, std::move(electrodes),
                                                        integration_points, std::move(numbers));
  };
  if (dimension == Dimension::spatial) throw std::invalid_argument("a film in space is not counted");
  switch (cells.type) {
  case meshing::CellType::triangle6:
    return make.template operator()<TriangleKinematics<6, 2>, materials::NeoHookean>();
  case meshing::CellType::triangle3:
    return make.template operator()<TriangleKinematics<3, 2>, materials::Gent>();
  case meshing::CellType::meridian3:
    return make.template operator()<MeridianKinematics<3>, materials::ElasticLaw>();
  default:
    throw std::invalid_argument("a film of such cells is not counted");
  }
}

} // namespace dielast::fem
