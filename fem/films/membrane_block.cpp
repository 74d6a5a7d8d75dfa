// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/films/membrane_block.hpp"

#include "fem/films/film_block.hpp"
#include "fem/films/rod_kinematics.hpp"

#include <numeric>

namespace dielast::fem {

namespace {

template<class Kinematics>
std::unique_ptr<ElementBlock> make_block(const meshing::Mesh& mesh, const meshing::CellBlock& cells,
                                         const MembraneSection& section, std::vector<int> electrodes,
                                         int integration_points, std::vector<int> numbers) {
  return std::visit(
      [&](const auto& law) -> std::unique_ptr<ElementBlock> {
        using Block = MembraneBlock<Kinematics, std::decay_t<decltype(law)>>;
        return std::make_unique<Block>(mesh, cells, section, law, std::move(electrodes), integration_points,
                                       std::move(numbers));
      },
      section.material.law);
}

} // namespace

std::unique_ptr<ElementBlock> make_membrane_block(const meshing::Mesh& mesh, const meshing::CellBlock& cells,
                                                  const MembraneSection& section, std::vector<int> electrodes,
                                                  Dimension dimension, int integration_points,
                                                  std::vector<int> numbers) {
  if (cells.size() == 0 || static_cast<int>(electrodes.size()) != cells.size())
    throw std::invalid_argument("a membrane needs elements, and one electrode number for each");
  if (numbers.empty()) {
    numbers.resize(electrodes.size());
    std::iota(numbers.begin(), numbers.end(), 0);
  }
  if ((dimension == Dimension::axisymmetric) != meshing::is_meridian(cells.type))
    throw std::invalid_argument("a film of revolution is made of meridians, any other of triangles or rods");
  const auto make = [&]<class Kinematics>() {
    return make_block<Kinematics>(mesh, cells, section, std::move(electrodes), integration_points,
                                  std::move(numbers));
  };
  const bool planar = dimension == Dimension::planar;
  switch (cells.type) {
  case meshing::CellType::triangle6:
    return planar ? make.template operator()<TriangleKinematics<6, 2>>()
                  : make.template operator()<TriangleKinematics<6, 3>>();
  case meshing::CellType::triangle3:
    return planar ? make.template operator()<TriangleKinematics<3, 2>>()
                  : make.template operator()<TriangleKinematics<3, 3>>();
  case meshing::CellType::meridian3:
    return make.template operator()<MeridianKinematics<3>>();
  case meshing::CellType::meridian2:
    return make.template operator()<MeridianKinematics<2>>();
  case meshing::CellType::rod2:
    return planar ? make.template operator()<RodKinematics<2>>()
                  : make.template operator()<RodKinematics<3>>();
  default:
    throw std::invalid_argument("a membrane is not made of walls");
  }
}

} // namespace dielast::fem
